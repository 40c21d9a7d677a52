// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/slice_sight.h"

#include <algorithm>
#include <utility>

#include "geom/predicates.h"

namespace ispace {

namespace {

std::vector<Segment2> linesNear(const Slice& slice, std::span<const Box2> reach) {
    std::vector<Segment2> lines;
    slice.forEachLine([&](const Segment2& line) {
        const Box2 box = bounds(line);
        if (reach.empty() || std::any_of(reach.begin(), reach.end(),
                                         [&box](const Box2& one) { return meets(one, box); }))
            lines.push_back(line);
    });
    return lines;
}

std::vector<Box2> boxesOf(const std::vector<Polygon>& solids) {
    std::vector<Box2> boxes;
    boxes.reserve(solids.size());
    for (const Polygon& solid : solids) boxes.push_back(bounds(solid));
    return boxes;
}

}  // namespace

SliceSight::SliceSight(Slice slice, std::span<const Box2> reach) : map_(linesNear(slice, reach)) {
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
        if (inside || locate(solids_[i], p) != Side::Inside) return;
        inside = true;
        forEachEdge(solids_[i], [&](const Segment2& edge) {
            inside = inside && distance(p, edge) > kSightContact;
        });
    });
    return inside;
}

}  // namespace ispace
