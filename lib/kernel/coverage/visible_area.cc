// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/visible_area.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

#include "coverage/plane_cells.h"
#include "coverage/sector_cells.h"
#include "geom/overlay/overlay.h"
#include "geom/tolerance.h"
#include "scene/sensor/sensor.h"

namespace ispace {

namespace {

std::vector<Curve> regionOfScan(const Level& level, double reach, const Sensor& sensor) {
    const Point2 place = sensor.pose.position.onFloor();
    const Laser& laser = sensor.as<Laser>();
    VisibleRegion region;
    LevelViews(level, reach).query(place, laser.max_range, region);
    Curve outline =
        outlineOf(sectorOf(region, sensor.pose.heading + laser.first, laser.sweptSpan()));
    if (outline.empty()) return {};
    const std::vector<Polygon> solids = level.solidsTouching(place);
    if (solids.empty()) return {std::move(outline)};
    // A sensor in contact with a body looks into it, but sees no floor there.
    std::vector<Layer> layers = {{.curves = {std::move(outline)}, .counts = false, .marks = 1}};
    for (const Polygon& solid : solids) layers.push_back({.curves = {curveOf(solid)}});
    return Overlay(layers).curves(
        [](const LayerLabel& label) { return label.marks == 1 && label.count == 0; });
}

CellSet cellsOfScan(const Grid& grid, const LevelViews& level, const Sensor& sensor) {
    const Laser& laser = sensor.as<Laser>();
    std::vector<Angle> limits;
    std::size_t seen = 0;  // number of the seen part before the last
    if (const auto sector = sectorOf(laser, sensor.pose.heading)) {
        limits = {std::min(sector->first, sector->beyond), std::max(sector->first, sector->beyond)};
        seen = sector->first < sector->beyond ? 0 : 1;
    }
    CellParts parts;
    cellsBySector(grid, level, sensor.pose.position.onFloor(), laser.max_range, limits, parts);
    CellSet cells = cellsOf(parts, limits.size(), grid.size());
    if (!limits.empty()) cells |= cellsOf(parts, seen, grid.size());
    return cells;
}

SensorModel withoutLists(SensorModel model) {
    kindOf(model).forget(model);
    return model;
}

}  // namespace

bool seeAlike(const Sensor& a, const Sensor& b) {
    const SensorKind& kind = kindOf(a.model);
    if (a.pose != b.pose || &kind != &kindOf(b.model)) return false;
    return a.model == b.model ||
           (kind.forget != nullptr && withoutLists(a.model) == withoutLists(b.model));
}

/// Regions by model and pose.
class VisibleArea::KnownRegions {
  public:
    using Region = std::optional<std::vector<Curve>>;

    /// Returns null for a region that is not known.
    std::shared_ptr<const Region> find(const Sensor& sensor) {
        const std::lock_guard lock(mutex_);
        const auto [first, last] = regions_.equal_range(keyOf(sensor.pose));
        const auto known = std::find_if(
            first, last, [&](const auto& one) { return seeAlike(one.second.sensor, sensor); });
        return known == last ? nullptr : known->second.region;
    }
    void store(const Sensor& sensor, std::shared_ptr<const Region> region) {
        constexpr std::size_t kMost = 20'000;
        const std::lock_guard lock(mutex_);
        if (regions_.size() < kMost)
            regions_.emplace(keyOf(sensor.pose), Known{sensor, std::move(region)});
    }
    /// Returns make(), computed once for sensors that differ in their place on the plan alone.
    template <typename Make>
    Box2 boxAboutFoot(Sensor sensor, Make make) {
        constexpr std::size_t kMost = 20'000;
        sensor.pose.position = {0, 0, sensor.pose.position.z};
        const std::lock_guard lock(mutex_);
        const auto [first, last] = boxes_.equal_range(keyOf(sensor.pose));
        const auto known = std::find_if(
            first, last, [&](const auto& one) { return seeAlike(one.second.first, sensor); });
        if (known != last) return known->second.second;
        const Box2 box = make();
        if (boxes_.size() < kMost) boxes_.emplace(keyOf(sensor.pose), std::pair(sensor, box));
        return box;
    }

  private:
    struct Known {
        Sensor sensor;
        std::shared_ptr<const Region> region;
    };
    using Key = std::tuple<double, double, double>;
    static Key keyOf(const Pose3& pose) {
        return {pose.position.x, pose.position.y, pose.heading.degrees()};
    }

    std::mutex mutex_;
    std::multimap<Key, Known> regions_;
    std::multimap<Key, std::pair<Sensor, Box2>> boxes_;
};

void VisibleArea::keepRegions() { known_ = std::make_shared<KnownRegions>(); }

void VisibleArea::prepare(const Sensor& sensor) const {
    if (!scansSlice(sensor)) worlds_->prepareMesh(kindOf(sensor.model).stopped_by);
}

const RayWorld& VisibleArea::meshFor(const SensorModel& model) const {
    return worlds_->mesh(kindOf(model).stopped_by);
}

std::optional<std::vector<Curve>> VisibleArea::regionOf(const Sensor& sensor) const {
    const Point3 place = sensor.pose.position;
    const std::shared_ptr<const Level> level = levelAt(place.z);
    if (scansSlice(sensor)) return regionOfScan(*level, reach_, sensor);
    if (level->isInsideSolid(place.onFloor())) return std::vector<Curve>();
    if (known_ != nullptr)
        if (const auto known = known_->find(sensor)) return *known;
    auto region =
        shadows_.get([this] { return ShadowCaster(environment_); }).regionSeen(sensor, plane_);
    if (known_ != nullptr)
        known_->store(sensor, std::make_shared<const KnownRegions::Region>(region));
    return region;
}

Box2 VisibleArea::boxOf(const Sensor& sensor) const {
    constexpr double kRounding = 1e-3;
    const Point2 foot = sensor.pose.position.onFloor();
    const auto view = fieldOfView(sensor);
    const double range = view ? view->farthest() : maxRange(sensor.model);
    const Box2 all = Box2{foot, foot}.expanded(range + kRounding);
    if (!view || scansSlice(sensor)) return all;
    const double drop = plane_ - sensor.pose.position.z;
    if (std::fabs(drop) <= kRayEpsilon) return all;
    const auto about_foot = [&] { return Footprint(*view, drop, false).box; };
    const Box2 box = known_ != nullptr ? known_->boxAboutFoot(sensor, about_foot) : about_foot();
    const Vec2 way = foot - Point2{};
    return box.empty() ? Box2() : Box2{box.low + way, box.high + way}.expanded(kRounding);
}

CellSet VisibleArea::cellsOf(const Grid& grid, const Sensor& sensor, const CountedCells* counted,
                             KnownSight* known) const {
    const Point3 place = sensor.pose.position;
    const std::shared_ptr<const Level> level = levelAt(place.z);
    if (scansSlice(sensor)) return cellsOfScan(grid, {*level, reach_}, sensor);
    if (level->isInsideSolid(place.onFloor())) return CellSet(grid.size());
    return cellsOnPlane(grid, meshFor(sensor.model), sensor, plane_, counted, known);
}

}  // namespace ispace
