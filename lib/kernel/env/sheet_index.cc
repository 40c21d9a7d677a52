// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/sheet_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geom/predicates.h"

namespace ispace {

namespace {

constexpr double kMostPieces = 32;

/// Returns the boxes about a place of the plan, on average.
double boxesAbout(std::span<const Segment2> sheets) {
    Box2 all;
    double area = 0;
    for (const Segment2& sheet : sheets) {
        const Box2 box = bounds(sheet);
        all.add(box.low);
        all.add(box.high);
        area += box.width() * box.depth();
    }
    const double whole = all.width() * all.depth();
    return whole > 0 ? area / whole : 0;
}

}  // namespace

SheetIndex::SheetIndex(std::span<const Segment2> sheets) : sheets_(sheets) {
    constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
    pieces_ = static_cast<std::size_t>(std::clamp(boxesAbout(sheets), 1.0, kMostPieces));
    std::vector<Box2> boxes;
    boxes.reserve(pieces_ * sheets.size());
    for (const auto& [a, b] : sheets) {
        // More than the rounding of the places where it is cut.
        const double farthest =
            std::max({std::abs(a.x), std::abs(a.y), std::abs(b.x), std::abs(b.y)});
        Point2 from = a;
        for (std::size_t k = 1; k <= pieces_; ++k) {
            const double share = static_cast<double>(k) / static_cast<double>(pieces_);
            const Point2 to = k == pieces_ ? b : a + share * (b - a);
            boxes.push_back(bounds(Segment2{from, to}).expanded(8 * kEpsilon * farthest));
            from = to;
        }
    }
    tree_ = BoxTree(boxes);
}

bool SheetIndex::holds(Point2 p) const {
    bool is_held = false;
    tree_.search({p, p}, [&](std::size_t i) {
        is_held = is_held || intersects(sheets_[i / pieces_], {p, p});
    });
    return is_held;
}

}  // namespace ispace
