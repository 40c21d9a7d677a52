// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/level.h"

#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <cassert>
#include <utility>

#include "geom/arrangement.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

std::vector<Region> less(const Regions& indoor, std::vector<Polygon> solids) {
    const Box2 box = bounds(indoor);
    std::erase_if(solids, [&box](const Polygon& solid) { return !bounds(solid).meets(box); });
    if (solids.empty()) return indoor.parts;
    return difference(indoor, solids);
}

}  // namespace

Level::Level(Slice slice) : height_(slice.height), slice_(std::move(slice)) {}

Level::Level(std::shared_ptr<const Environment::Data> room, double height)
    : room_(std::move(room)), height_(height) {}

const Slice& Level::slice() const {
    return slice_.get([this] { return uncancelled([this] { return room_->slice(height_); }); });
}

const std::vector<Region>& Level::freeFloor() const {
    assert(room_ != nullptr);
    return free_floor_.get([this] {
        return uncancelled([this] { return less(room_->walls->indoor, slice().solids); });
    });
}

const PolygonIndex& Level::solids() const {
    return solids_.get([this] { return PolygonIndex(slice().solids); });
}

const VisibilityMap& Level::sight() const {
    return sight_.get([this] {
        return uncancelled(
            [this] { return VisibilityMap(slice().straightLines(), slice().curves()); });
    });
}

void Level::prepareSight() const {
    // A thread that waits here must not start other tasks.
    tbb::this_task_arena::isolate([this] {
        tbb::parallel_invoke([this] { static_cast<void>(solids()); },
                             [this] { static_cast<void>(sight()); });
    });
}

bool Level::isFree(Point2 p) const {
    assert(room_ != nullptr);
    if (room_->walls->indoorIndex().locate(p) != Side::Inside || solids().holder(p)) return false;
    const std::vector<Segment2>& sheets = slice().sheets;
    bool is_on_sheet = false;
    sheets_.get([&] { return SegmentTree(sheets); }).search({p, p}, 0, [&](std::size_t i) {
        is_on_sheet = is_on_sheet || intersects(sheets[i], {p, p});
    });
    return !is_on_sheet;
}

bool Level::isInsideSolid(Point2 p) const { return solids().containsWithMargin(p, kRayEpsilon); }

std::vector<Polygon> Level::solidsTouching(Point2 p) const {
    return solids().touching(p, kRayEpsilon);
}

void Level::query(Point2 viewpoint, double max_range, VisibleRegion& region) const {
    if (!isInsideSolid(viewpoint)) {
        sight().query(viewpoint, max_range, region);
        return;
    }
    region.viewpoint = viewpoint;
    region.max_range = max_range;
    region.is_whole = true;
    region.edges.clear();
}

std::size_t Level::linesMade() const {
    const Slice* const slice = slice_.peek();
    if (slice == nullptr) return 0;
    std::size_t lines = slice->sheets.size();
    for (const Polygon& solid : slice->solids) lines += solid.size();
    return lines;
}

}  // namespace ispace
