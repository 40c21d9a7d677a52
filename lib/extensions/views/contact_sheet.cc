// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/views/contact_sheet.h"

#include <algorithm>
#include <cmath>

#include "drawing/color.h"

namespace ispace::views {

ContactSheet::ContactSheet(const std::vector<PictureSize>& shapes)
    : page_(shapes.front()), em_(std::max(9.0, shapes.front().columns / 80.0)) {
    places_.push_back({{0, 0}, shapes.front()});
    constexpr std::size_t kMaxARow = 4;
    const std::size_t others = shapes.size() - 1;
    if (others == 0) return;
    // Rows of similar length: five are three and two.
    const std::size_t rows = (others + kMaxARow - 1) / kMaxARow;
    const auto a_row = static_cast<int>((others + rows - 1) / rows);
    const int gap = std::max(2, page_.columns / 100);
    const int width = std::max(1, (page_.columns - (a_row - 1) * gap) / a_row);
    const int name = static_cast<int>(std::ceil(1.7 * em_));
    int top = page_.rows + gap, highest = 0, column = 0;
    for (std::size_t i = 1; i < shapes.size(); ++i) {
        const double shape = 1.0 * shapes[i].rows / shapes[i].columns;
        const int height = std::max(1, static_cast<int>(std::lround(width * shape)));
        places_.push_back({{1.0 * column * (width + gap), 1.0 * top + name}, {width, height}});
        highest = std::max(highest, height);
        if (++column < a_row && i + 1 < shapes.size()) continue;
        top += name + highest + gap;
        column = highest = 0;
    }
    page_.rows = top - gap;
}

Image ContactSheet::draw(const std::vector<Image>& images,
                         const std::vector<std::string>& names) const {
    Picture page(page_.columns, page_.rows);
    for (std::size_t i = 0; i < images.size(); ++i) {
        page.image(places_[i].corner, images[i], 1, 1);
        const TextStyle style{em_, true, Align::Left, palette::kInk, {}};
        if (i > 0)
            page.text(places_[i].corner + Vec2{0, -0.45 * em_},
                      fitText(names[i], places_[i].size.columns, style), style);
    }
    return rasterOf(page);
}

}  // namespace ispace::views
