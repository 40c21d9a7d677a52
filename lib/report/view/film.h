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
    /// \param shapes columns and rows of each picture as if it stood alone; the first is the size
    /// it has, the others keep their shape \pre not empty
    explicit ContactSheet(const std::vector<PictureSize>& shapes);

    /// The size that a picture is to have.
    [[nodiscard]] PictureSize sizeOf(std::size_t picture) const { return places_[picture].size; }
    /// \pre images[i] has sizeOf(i)
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

/// Encodes pictures on other cores while the next ones are drawn, and writes them in order, from
/// the thread that adds them.
class EncodeAhead {
  public:
    using Encode = std::function<std::string(const Image& image)>;  ///< from any thread
    using Write = std::function<void(const std::string& file, const std::string& bytes)>;

    EncodeAhead(Encode encode, Write write);
    /// Without finish(), after an error, what was added is written all the same; further errors
    /// are passed over.
    ~EncodeAhead();
    EncodeAhead(const EncodeAhead&) = delete;
    EncodeAhead& operator=(const EncodeAhead&) = delete;

    /// Writes earlier ones where more are on their way than there are cores, or than have 64
    /// million pixels. \throws what encoding and writing those throws
    void add(std::string file, Image image);
    /// Writes all that is left. \throws likewise
    void finish();

  private:
    struct Job;
    struct Queue;
    std::unique_ptr<Queue> queue_;
};

/// A film in GIF, picture by picture, that goes round for ever in whatever shows it.
///
/// Each picture holds what has changed since the one before, in up to 256 colours of its own. That
/// is for drawings: their flat colours are right, and shades at edges by the nearest of the others.
class GifFilm {
  public:
    /// Pictures a second: the format counts in hundredths, and what shows it takes two of them at
    /// least.
    static constexpr double kSlowest = 0.01, kFastest = 50;

    /// \pre kSlowest <= fps <= kFastest
    explicit GifFilm(double fps);
    ~GifFilm();
    GifFilm(const GifFilm&) = delete;
    GifFilm& operator=(const GifFilm&) = delete;

    /// The bytes that come next. \pre all pictures have the size of the first
    /// \throws FormatError if that is above 65535 pixels, which the format does not know
    std::string add(const Image& image);
    /// The last bytes. \pre at least one picture was added
    std::string end();

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
