// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/detection.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "base/per_thread.h"
#include "env/level.h"
#include "scene/robot.h"
#include "scene/sensor/sensor.h"
#include "sense/scan.h"
#include "sense/selection.h"
#include "trace/ray_world.h"

namespace ispace {

namespace {

/// A sensor with values precomputed for all its poses.
struct Watcher {
    Sensor sensor;  // at its start
    std::uint32_t carrier = MovingBodies::kNoOwner;
    Pose3 from_carrier;                   // of a sensor mounted on a mover
    std::optional<FieldOfView> view;      // of all but lasers, at the start
    std::optional<BearingWindow> window;  // of lasers
    double reach = 0;                     // no point in view is farther away on the floor
    std::size_t together = 1;             // number of its kind required for a detection
    bool is_blind = false;                // it is inside a solid
    bool is_outside = false;              // of the room, see OutsideWatch

    [[nodiscard]] bool rides() const { return carrier != MovingBodies::kNoOwner; }
    [[nodiscard]] Pose3 poseAt(const WatchMoment& moment) const;
};

Pose3 Watcher::poseAt(const WatchMoment& moment) const {
    if (!rides()) return sensor.pose;
    const std::span<const Pose2> poses = sensor.mount ? moment.robots : moment.people;
    const std::size_t index = sensor.mount ? sensor.mount->robot : *sensor.person;
    return index < poses.size() ? mountedPose(poses[index], from_carrier) : sensor.pose;
}

/// Pose of a sensor at a moment, with the sine and cosine of its heading, which all targets share.
struct Stance {
    Stance(const Pose3& at, double reach)
        : pose(at), heading(cosSin(at.heading)), reach2(reach * reach) {}
    [[nodiscard]] bool reaches(Point2 place) const {
        const Vec2 way = place - pose.position.onFloor();
        return dot(way, way) <= reach2;
    }
    Pose3 pose;
    CosSin heading;
    double reach2;
};

/// Returns the start poses of a scene's people, in order.
std::vector<Pose2> peopleOf(const Scene& scene) {
    std::vector<Pose2> people;
    for (const PlacedRecord& placed : scene.placed)
        if (scene.records[placed.record].keyword() == "human")
            people.push_back({placed.pose.position.onFloor(), placed.pose.heading});
    return people;
}

Watcher watcherOf(const Sensor& sensor, const std::vector<Pose2>& people, double density) {
    Watcher watcher;
    watcher.sensor = sensor;
    watcher.carrier = carrierOf(sensor);
    if (Camera* camera = std::get_if<Camera>(&watcher.sensor.model))
        *camera = withDensity(*camera, density);
    watcher.view = fieldOfView(watcher.sensor);
    const Laser* const laser = std::get_if<Laser>(&watcher.sensor.model);
    // A counter-clockwise sweep adds its whole angle to the first bearing.
    if (laser != nullptr) watcher.window.emplace(*laser, laser->sweptSpan() - laser->span());
    const double range = laser != nullptr ? laser->max_range : watcher.view.value().farthest();
    watcher.reach = range * (1 + kFloatTolerance) + kRayEpsilon;
    watcher.together = kindOf(sensor.model).together;
    if (sensor.mount)
        watcher.from_carrier = sensor.mount->robot_from_sensor;
    else if (sensor.person)
        watcher.from_carrier = poseOn(people[*sensor.person], sensor.pose);
    return watcher;
}

}  // namespace

struct DetectionMonitor::Data {
    Data(const Scene& scene, const WatchOptions& options);

    [[nodiscard]] bool sees(const Watcher& watcher, const Stance& stance, Point2 place) const;
    [[nodiscard]] bool scans(const Watcher& watcher, const Stance& stance, Point2 place) const;
    [[nodiscard]] bool scansAslant(const Watcher& watcher, const Pose3& pose, Point2 place) const;
    [[nodiscard]] bool isClear(const Watcher& watcher, Point3 origin, Point3 target) const;

    double plane;
    OutsideWatch outside;
    RayScenes worlds;  // with the rooms around, which hide floor from sensors of the room, too
    std::vector<Watcher> watchers;
};

DetectionMonitor::Data::Data(const Scene& scene, const WatchOptions& options)
    : plane(options.plane),
      outside(options.outside ? options.outside(scene) : OutsideWatch{}),
      worlds(scene.environment, outside.room) {
    const std::vector<Pose2> people = peopleOf(scene);
    const Environment& room = outside.room ? outside.room->environment() : scene.environment;
    for (const Sensor& sensor : scene.sensors) {
        if (!kindOf(sensor.model).perceives) continue;
        Watcher& watcher = watchers.emplace_back(watcherOf(sensor, people, options.density));
        const Point3 place = sensor.pose.position;
        watcher.is_blind = !watcher.rides() && room.level(place.z)->isInsideSolid(place.onFloor());
        if (scansSlice(sensor))
            worlds.prepare(sensor.pose);
        else
            worlds.prepareMesh(kindOf(sensor.model).stopped_by);
    }
    for (const Sensor& sensor : outside.sensors) {
        watchers.push_back(watcherOf(sensor, people, options.density));
        watchers.back().is_outside = true;
    }
    if (!outside.sensors.empty()) static_cast<void>(outside.room->mesh());
}

bool DetectionMonitor::Data::isClear(const Watcher& watcher, Point3 origin, Point3 target) const {
    if (target == origin) return true;
    const std::array<Point3, 1> targets = {target};
    std::array<std::uint8_t, 1> seen = {0};
    const RayWorld& mesh = watcher.is_outside
                               ? outside.room->mesh()
                               : worlds.mesh(kindOf(watcher.sensor.model).stopped_by);
    mesh.query(origin, targets, seen);
    return seen[0] != 0;
}

/// True if a level scan sees the point: in its slice, or, if there are too many slices, in the
/// mesh.
bool DetectionMonitor::Data::scans(const Watcher& watcher, const Stance& stance,
                                   Point2 place) const {
    const Pose3& pose = stance.pose;
    const Vec2 way = place - pose.position.onFloor();
    const auto [c, s] = stance.heading;
    if (!watcher.window->holds({way.x * c + way.y * s, way.y * c - way.x * s, 0})) return false;
    const double distance = std::hypot(way.x, way.y);
    if (!withinRange(distance, watcher.sensor.as<Laser>().max_range)) return false;
    if (distance <= kRayEpsilon) return true;
    auto& direction = perThread<Directions, struct RayOfSight>();
    direction.resize(1);
    direction.set(0, {way.x / distance, way.y / distance, 0});
    std::array<float, 1> range = {kNoReturn};
    worlds.at(pose).cast(pose.position, direction, distance, range);
    return static_cast<double>(range[0]) >= distance * (1 - kFloatTolerance) - kRayEpsilon;
}

/// True if a scan in a plane that is not level crosses the floor at the point.
bool DetectionMonitor::Data::scansAslant(const Watcher& watcher, const Pose3& pose,
                                         Point2 place) const {
    const Laser& laser = watcher.sensor.as<Laser>();
    const auto is_near = [&](Point3 target) {
        const Vec3 way = target - pose.position;
        return withinRange(std::sqrt(dot(way, way)), laser.max_range);
    };
    if (laser.sweep != SweepAxis::None) {
        const Point3 target{place.x, place.y, plane};
        Sensor moved = watcher.sensor;
        moved.pose = pose;
        return is_near(target) && SweptScan(moved).passes(target) &&
               isClear(watcher, pose.position, target);
    }
    const ScanPlane scan(pose);
    if (scan.up() == 0) return false;  // upright: a line, as seen from above
    const Point3 target{place.x, place.y, scan.heightAt(place)};
    return target.z >= 0 && is_near(target) &&
           watcher.window->holds(scan.frame().toLocal(target)) &&
           isClear(watcher, pose.position, target);
}

bool DetectionMonitor::Data::sees(const Watcher& watcher, const Stance& stance,
                                  Point2 place) const {
    if (watcher.is_blind) return false;
    const Pose3& pose = stance.pose;
    if (!watcher.view) {
        const bool is_level = scansSlice(watcher.sensor.as<Laser>(), pose);
        return is_level ? scans(watcher, stance, place) : scansAslant(watcher, pose, place);
    }
    const Point3 target{place.x, place.y, plane};
    if (!watcher.rides())
        return watcher.view->holds(target) && isClear(watcher, pose.position, target);
    FieldOfView view = *watcher.view;
    view.frame = Frame3(pose);
    return view.holds(target) && isClear(watcher, pose.position, target);
}

DetectionMonitor::DetectionMonitor(const Scene& scene, const WatchOptions& options)
    : data_(std::make_unique<Data>(scene, options)) {}
DetectionMonitor::~DetectionMonitor() = default;
DetectionMonitor::DetectionMonitor(DetectionMonitor&&) noexcept = default;
DetectionMonitor& DetectionMonitor::operator=(DetectionMonitor&&) noexcept = default;

std::size_t DetectionMonitor::sensors() const {
    std::size_t alone = 0, parts = 0, together = 0;
    for (const Watcher& watcher : data_->watchers) {
        (watcher.together > 1 ? parts : alone) += 1;
        together = std::max(together, watcher.together);
    }
    return alone + (parts > 0 && parts >= together ? 1 : 0);
}

bool DetectionMonitor::rides() const {
    const auto& watchers = data_->watchers;
    return std::any_of(watchers.begin(), watchers.end(),
                       [](const Watcher& watcher) { return watcher.rides(); });
}

std::size_t DetectionMonitor::seenBy(const Target& target, const WatchMoment& moment) const {
    return seenBy(std::span(&target, 1), moment).front();
}

std::vector<std::size_t> DetectionMonitor::seenBy(std::span<const Target> targets,
                                                  const WatchMoment& moment) const {
    const std::vector<Watcher>& watchers = data_->watchers;
    std::vector<Stance> stances;
    std::vector<Point2> places;
    double reach = 0;
    for (const Watcher& watcher : watchers) {
        stances.emplace_back(watcher.poseAt(moment), watcher.reach);
        places.push_back(stances.back().pose.position.onFloor());
        reach = std::max(reach, watcher.reach);
    }
    FloorGrid grid;
    grid.rebuild(places, reach);
    const auto count = [&](const Target& target) {
        std::size_t alone = 0, parts = 0, together = 0;
        grid.forEachNear({target.place, target.place}, [&](std::size_t k) {
            if (!stances[k].reaches(target.place)) return;
            const Watcher& watcher = watchers[k];
            const bool is_own = watcher.rides() && watcher.carrier == target.owner;
            if (is_own || !data_->sees(watcher, stances[k], target.place)) return;
            ++(watcher.together == 1 ? alone : parts);
            if (watcher.together > 1) together = watcher.together;
        });
        return alone + (parts > 0 && parts >= together ? 1 : 0);
    };
    std::vector<std::size_t> counts(targets.size());
    tbb::parallel_for(std::size_t{0}, targets.size(),
                      [&](std::size_t i) { counts[i] = count(targets[i]); });
    return counts;
}

}  // namespace ispace
