// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "draw/picture.h"

namespace ispace {

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
