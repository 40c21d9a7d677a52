// SPDX-License-Identifier: GPL-3.0-or-later
// Inside BoxViews: half-planes that cut convex polygons, by other code than that of the search.
#pragma once

#include <algorithm>

#include "extensions/proofs/poses/convex.h"

namespace ispace::proofs::poses {

using Convex = Outline;

/// The points q with dot(outwards, q - at) <= 0.
struct Side2 {
    Point2 at;
    Vec2 outwards;
    [[nodiscard]] double beyond(Point2 q) const { return dot(outwards, q - at); }
};

/// Divides a convex polygon into its parts inside and outside of a half-plane.
inline void divide(const Convex& polygon, const Side2& side, Convex& inside, Convex* outside) {
    inside.clear();
    if (outside != nullptr) outside->clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double from = side.beyond(a), to = side.beyond(b);
        if (from <= 0) inside.push_back(a);
        if (from >= 0 && outside != nullptr) outside->push_back(a);
        if ((from < 0 && to > 0) || (from > 0 && to < 0)) {
            const Point2 cut = a + (from / (from - to)) * (b - a);
            inside.push_back(cut);
            if (outside != nullptr) outside->push_back(cut);
        }
    }
    if (inside.size() < 3) inside.clear();
    if (outside != nullptr && outside->size() < 3) outside->clear();
}

inline void keepInside(Convex& polygon, const Side2& side) {
    if (std::none_of(polygon.begin(), polygon.end(),
                     [&side](Point2 p) { return side.beyond(p) > 0; }))
        return;
    Convex kept;
    divide(polygon, side, kept, nullptr);
    polygon.swap(kept);
}

}  // namespace ispace::proofs::poses
