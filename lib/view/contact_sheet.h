// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "draw/picture.h"
#include "view/view.h"

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

}  // namespace ispace
