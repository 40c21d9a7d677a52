// SPDX-License-Identifier: GPL-3.0-or-later
// Thins lines of many points, such as the borders of maps and of traced plans.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "geom/point.h"
#include "geom/polygon.h"

namespace ispace {

/// Thins the polyline point(begin) … point(end) by the method of Douglas and Peucker (Algorithms
/// for the reduction of the number of points required to represent a digitized line, 1973): calls
/// keep(i) for each index after `begin` whose point stays, ascending; the last one is `end`. A
/// chord replaces its run of points where accepts(from, to, apart) is true, `apart` being the
/// largest distance of these points from the chord (a closed segment), in metres.
///
/// Guarantee: with accepts = (apart <= t) every dropped point lies within t of the chord over it.
/// The thinned line may cross itself or its neighbours; simplified() in polygon.h never does. Of
/// equal distances the first splits, so the result depends on the points alone. O(n log n) for
/// lines that split evenly, O(n^2) at worst; the stack lies on the heap.
///
///     thinPolyline(0, path.size() - 1, [&](std::size_t i) { return path[i]; },
///                  [](std::size_t, std::size_t, double apart) { return apart <= 0.01; },
///                  [&](std::size_t i) { thin.push_back(path[i]); });
///
/// \pre begin < end
template <typename PointAt, typename Accepts, typename Keep>
void thinPolyline(std::size_t begin, std::size_t end, PointAt point, Accepts accepts, Keep keep) {
    std::vector<std::pair<std::size_t, std::size_t>> open{{begin, end}};
    while (!open.empty()) {
        const auto [from, to] = open.back();
        open.pop_back();
        const Segment2 chord{point(from), point(to)};
        std::size_t farthest = from + 1;
        double apart = -1;
        for (std::size_t i = from + 1; i < to; ++i)
            if (const double off = distance(point(i), chord); off > apart) {
                apart = off;
                farthest = i;
            }
        if (to == from + 1 || accepts(from, to, apart)) {
            keep(to);
        } else {
            open.emplace_back(farthest, to);
            open.emplace_back(from, farthest);
        }
    }
}

}  // namespace ispace
