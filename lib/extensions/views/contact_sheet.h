// SPDX-License-Identifier: GPL-3.0-or-later
// The page of scan --view with several views: their pictures, with names.
#pragma once

#include <string>
#include <vector>

#include "drawing/drawing.h"
#include "extensions/views/projector.h"
#include "geom/point.h"

namespace ispace::views {

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

}  // namespace ispace::views
