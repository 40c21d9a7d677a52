// SPDX-License-Identifier: GPL-3.0-or-later
// Candidates under ceiling frames.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/error.h"
#include "base/number.h"
#include "geom/planar_map.h"
#include "place/sites.h"

namespace ispace {

namespace {

Point2 middleOf(Point2 a, Point2 b) { return a + 0.5 * (b - a); }

/// The mid-line of a bar along its length. \pre the footprint is a rectangle
Segment2 midLine(const Polygon& bar) {
    const bool is_along = distance(bar[0], bar[1]) >= distance(bar[1], bar[2]);
    return is_along ? Segment2{middleOf(bar[3], bar[0]), middleOf(bar[1], bar[2])}
                    : Segment2{middleOf(bar[0], bar[1]), middleOf(bar[2], bar[3])};
}

}  // namespace

std::vector<Point3> framePlaces(const Environment& environment, double step) {
    assert(step > 0);
    std::vector<Point3> places;
    for (const Element& element : environment.elements()) {
        if (element.record.keyword() != "infra") continue;
        for (const Prism& bar : element.body.prisms) {
            const auto [a, b] = midLine(bar.footprint);
            const double count = std::max(1.0, std::round((distance(a, b) + kWeldDistance) / step));
            if (static_cast<double>(places.size()) + count > kMostSites)
                throw UsageError("a step of " + formatDouble(step) +
                                 " m makes more than a million places under the frames: those are "
                                 "too many, use a larger GRID in --candidates GRID,WALL,HEADINGS");
            for (int i = 0; i < static_cast<int>(count); ++i) {
                const Point2 place = a + ((i + 0.5) / count) * (b - a);
                places.push_back({place.x, place.y, bar.bottom - kUnderBar});
            }
        }
    }
    return places;
}

}  // namespace ispace
