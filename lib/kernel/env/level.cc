// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of levels are computed by the first caller. That may be one of many tasks of a parallel
// loop: uncancelled() keeps an exception in another task from cutting short the part that is
// stored. Levels whose slices are equal share one Cut, found by comparing slices.
#include "env/level.h"

#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

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

std::shared_ptr<const Level::Cut> Level::Cuts::find(Slice slice) {
    const std::scoped_lock lock(mutex_);
    std::erase_if(cuts_, [](const auto& cut) { return cut.expired(); });
    for (const auto& held : cuts_)
        if (auto cut = held.lock(); cut != nullptr && cut->slice == slice) return cut;
    auto cut = std::make_shared<const Cut>(std::move(slice));
    cuts_.push_back(cut);
    return cut;
}

Level::Level(std::shared_ptr<const Environment::Data> room, double height,
             std::shared_ptr<Cuts> cuts)
    : room_(std::move(room)), height_(height), cuts_(std::move(cuts)) {}

const Level::Cut& Level::cut() const {
    return *cut_.get(
        [this] { return cuts_->find(uncancelled([this] { return room_->slice(height_); })); });
}

const Slice& Level::slice() const { return cut().slice; }

const std::vector<Region>& Level::freeFloor() const {
    return cut().free_floor.get([this] {
        return uncancelled([this] { return less(room_->walls->indoor, slice().solids); });
    });
}

const PolygonIndex& Level::solids() const {
    return cut().solids.get([this] { return PolygonIndex(slice().solids); });
}

const VisibilityMap& Level::sight() const {
    return cut().sight.get([this] {
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
    if (room_->walls->indoorIndex().locate(p) != Side::Inside || solids().holder(p)) return false;
    return !cut().sheets.get([this] { return SheetIndex(slice().sheets); }).holds(p);
}

bool Level::isInsideSolid(Point2 p) const { return solids().containsWithMargin(p, kRayEpsilon); }

std::vector<Polygon> Level::solidsTouching(Point2 p) const {
    return solids().touching(p, kRayEpsilon);
}

void Level::query(Point2 viewpoint, double max_range, VisibleRegion& region) const {
    LevelViews(*this).query(viewpoint, max_range, region);
}

void LevelViews::query(Point2 viewpoint, double max_range, VisibleRegion& region) const {
    if (!level_.isInsideSolid(viewpoint)) {
        level_.sight().query(viewpoint, max_range, region, reach_);
        return;
    }
    region.viewpoint = viewpoint;
    region.max_range = max_range;
    region.is_whole = true;
    region.edges.clear();
}

std::size_t Level::linesMade() const {
    const std::shared_ptr<const Cut>* const cut = cut_.peek();
    if (cut == nullptr) return 0;
    std::size_t lines = (*cut)->slice.sheets.size();
    for (const Polygon& solid : (*cut)->slice.solids) lines += solid.size();
    return lines;
}

}  // namespace ispace
