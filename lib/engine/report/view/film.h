// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drawing/drawing.h"
#include "report/view/view.h"

namespace ispace {

/// Several pictures on one page: the first as wide as the page, the others below it, in rows of
/// equal width with their names (thesis, fig. 3.15).
class ContactSheet {
  public:
    /// Computes the layout. \param shapes columns and rows of each picture shown alone; the first
    /// keeps its size, the others their aspect ratio \pre not empty
    explicit ContactSheet(const std::vector<PictureSize>& shapes);

    /// Returns the size that a picture must have.
    [[nodiscard]] PictureSize sizeOf(std::size_t picture) const { return places_[picture].size; }
    /// Composes the page. \pre images[i] has sizeOf(i)
    [[nodiscard]] Image draw(const std::vector<Image>& images,
                             const std::vector<std::string>& names) const;

  private:
    struct Place {
        Point2 corner;
        PictureSize size;
    };
    std::vector<Place> places_;
    PictureSize page_;
    double em_;
};

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

}  // namespace ispace
