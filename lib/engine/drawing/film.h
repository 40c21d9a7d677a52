// SPDX-License-Identifier: GPL-3.0-or-later
// Films: pictures of one size in a file, or files that are written one by one. Equal pictures give
// equal bytes, for any number of threads.
//
//     GifFilm film(25);
//     for (const Image& image : images) file.write(film.add(image));
//     file.write(film.end());
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drawing/drawing.h"

namespace ispace {

/// Encodes pictures on other cores while the next ones are drawn, and writes them in order, in the
/// thread that adds them.
class EncodeAhead {
  public:
    using Encode = std::function<std::string(const Image& image)>;  ///< called from any thread
    using Write = std::function<void(const std::string& file, const std::string& bytes)>;

    EncodeAhead(Encode encode, Write write);
    /// Without finish(), after an error, writes all pictures added before; ignores further errors.
    ~EncodeAhead();
    EncodeAhead(const EncodeAhead&) = delete;
    EncodeAhead& operator=(const EncodeAhead&) = delete;

    /// Adds a picture; first writes earlier ones if more pictures are pending than there are cores,
    /// or more than 64 million pixels. \throws any error of encoding and writing them
    void add(std::string file, Image image);
    /// Writes all pending pictures. \throws likewise
    void finish();

  private:
    struct Job;
    struct Queue;
    std::unique_ptr<Queue> queue_;
};

/// Writes a film in GIF, picture by picture, which repeats for ever.
///
/// Each picture stores its changes since the one before, in a separate palette of up to 256
/// colours. The format suits drawings: flat colours are exact, shades at edges use the nearest
/// colour.
class GifFilm {
  public:
    /// Limits of pictures a second: the format counts in hundredths of a second, and viewers
    /// require at least two of them.
    static constexpr double kSlowest = 0.01, kFastest = 50;

    /// Starts a film. \pre kSlowest <= fps <= kFastest
    explicit GifFilm(double fps);
    ~GifFilm();
    GifFilm(const GifFilm&) = delete;
    GifFilm& operator=(const GifFilm&) = delete;

    /// Adds a picture and returns the next bytes. \pre all pictures have the size of the first
    /// \throws FormatError for a side above 65535 pixels, the limit of the format
    std::string add(const Image& image);
    /// Returns the last bytes. \pre at least one picture was added
    std::string end();

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Writes the header of a film in YUV4MPEG2 (4:2:0, BT.601), which ffmpeg and mpv read; y4mFrame()
/// writes its pictures.
/// \param fps pictures a second, with up to three decimals
std::string y4mHeader(int width, int height, double fps);
/// Writes a picture of a film. \pre width and height are even
std::string y4mFrame(const Image& image);

}  // namespace ispace
