// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/slice_sight.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "geom/predicates.h"

namespace ispace {

namespace {

std::vector<Segment2> linesOf(const Slice& slice) {
    std::vector<Segment2> lines;
    slice.forEachLine([&lines](const Segment2& line) { lines.push_back(line); });
    return lines;
}

std::vector<Box2> boxesOf(const std::vector<Polygon>& solids) {
    std::vector<Box2> boxes;
    boxes.reserve(solids.size());
    for (const Polygon& solid : solids) boxes.push_back(bounds(solid));
    return boxes;
}

double distanceFromEdges(const Polygon& solid, Point2 p) {
    double least = std::numeric_limits<double>::infinity();
    forEachEdge(solid, [&](const Segment2& edge) { least = std::min(least, distance(p, edge)); });
    return least;
}

}  // namespace

SliceSight::SliceSight(Slice slice) : map_(linesOf(slice)) {
    solids_ = std::move(slice.solids);
    boxes_ = BoxTree(boxesOf(solids_));
}

void SliceSight::look(Point2 viewpoint, double max_range, VisibleRegion& region) const {
    if (!isInSolid(viewpoint)) {
        map_.look(viewpoint, max_range, region);
        return;
    }
    region.viewpoint = viewpoint;
    region.max_range = max_range;
    region.is_whole = true;
    region.ends.clear();
}

bool SliceSight::isInSolid(Point2 p) const {
    bool inside = false;
    boxes_.search({p, p}, [&](std::size_t i) {
        inside = inside || (locate(solids_[i], p) == Side::Inside &&
                            distanceFromEdges(solids_[i], p) > kSightContact);
    });
    return inside;
}

std::vector<Polygon> SliceSight::solidsTouching(Point2 p) const {
    constexpr Vec2 kReach{kSightContact, kSightContact};
    std::vector<Polygon> touching;
    boxes_.search({p - kReach, p + kReach}, [&](std::size_t i) {
        if (distanceFromEdges(solids_[i], p) <= kSightContact) touching.push_back(solids_[i]);
    });
    return touching;
}

}  // namespace ispace
