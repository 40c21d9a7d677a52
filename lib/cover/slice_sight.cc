// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/slice_sight.h"

#include <utility>

namespace ispace {

SliceSight::SliceSight(Slice slice)
    : map_(slice.straightLines(), slice.curves()), solids_(std::move(slice.solids)) {}

void SliceSight::query(Point2 viewpoint, double max_range, VisibleRegion& region) const {
    if (!solids_.isInside(viewpoint, kRayEpsilon)) {
        map_.query(viewpoint, max_range, region);
        return;
    }
    region.viewpoint = viewpoint;
    region.max_range = max_range;
    region.is_whole = true;
    region.edges.clear();
}

}  // namespace ispace
