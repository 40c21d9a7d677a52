// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/over_poses.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "arrange/gallery/gallery.h"
#include "base/number.h"
#include "coverage/coverage.h"
#include "env/level.h"
#include "geom/arrangement.h"
#include "geom/predicates.h"
#include "geom/tolerance.h"

namespace ispace {

namespace {

[[noreturn]] void refusePoses(const std::string& reason) {
    throw UsageError("--proof poses: " + reason);
}

/// Returns the floor that the lasers must see.
std::vector<Region> floorFor(const Scene& scene, const Laser& laser, double height) {
    const std::shared_ptr<const Level> level = scene.environment.level(height);
    const Slice& slice = level->slice();
    if (!slice.rounds.empty()) refusePoses("round bodies stand at the height of the lasers");
    std::vector<Region> floor = level->freeFloor();
    // The middle of a line rounds, so that those of boundaries may lie inside, too.
    const auto is_inside = [&floor](const Segment2& line) {
        const Point2 middle = line.a + 0.5 * (line.b - line.a);
        return std::any_of(floor.begin(), floor.end(), [middle](const Region& region) {
            if (region.locate(middle) != Side::Inside) return false;
            bool is_clear = true;
            region.forEachEdge([&](const Segment2& edge) {
                is_clear = is_clear && distance(middle, edge) > kCornerTolerance;
            });
            return is_clear;
        });
    };
    if (std::any_of(slice.sheets.begin(), slice.sheets.end(), is_inside))
        refusePoses("a wall without thickness stands in the room, with floor on both sides");
    Box2 box;
    for (const Region& region : floor)
        for (const Point2 p : region.outline) box.add(p);
    const double extent = std::hypot(box.width(), box.depth());
    if (!floor.empty() && laser.max_range < extent)
        refusePoses("the range of " + formatDouble(laser.max_range) +
                    " m ends within the room of " + formatFixed(extent, 1) +
                    " m; give range=" + formatDouble(std::ceil(extent)) + " or more");
    return floor;
}

const Laser& laserOf(const Scene& scene, const std::vector<SensorGroup>& groups,
                     const ArrangeOptions& options) {
    if (options.target != 1) refusePoses("needs --target 100%");
    if (!options.weights.isUniform()) refusePoses("zones and weights are not supported");
    if (groups.size() != 1) refusePoses("give one kind of sensor");
    const auto* laser = std::get_if<Laser>(&groups.front().model);
    if (laser == nullptr || !laser->seesAround())
        refusePoses("wanted level lasers that see all around, as laser,range=1000,fov=360");
    for (const Sensor& sensor : scene.sensors)
        if (kindOf(sensor.model).perceives)
            refusePoses("sensors stand in the room already: leave them out");
    return *laser;
}

void measurePlaced(const Scene& scene, const std::vector<SensorGroup>& groups,
                   const ArrangeOptions& options, Arrangement& result) {
    const Scene whole = withPlaced(scene, groups, result.sensors);
    Worlds worlds(whole.environment);
    const Coverage measured =
        measureCoverage(whole, worlds, {.plane = options.plane, .exact = false});
    result.coverage = measured.report.coverage.grid.value_or(0);
    result.area = measured.report.total_effective_area.grid.value_or(0);
    result.grid = measured.target.grid;
}

}  // namespace

Arrangement arrangeOverPoses(const Scene& scene, const std::vector<SensorGroup>& groups,
                             const ArrangeOptions& options, Progress& progress) {
    const Laser& laser = laserOf(scene, groups, options);
    const std::vector<double>& heights = options.mount.heights;
    const double height = heights.empty() ? kScanHeight : heights.front();
    const std::vector<Region> floor = floorFor(scene, laser, height);
    const GalleryCover cover = guardGallery(floor, progress);

    Arrangement result;
    const std::vector<SensorClass> kinds = kindsOf(groups);
    std::vector<Pose3> poses;
    for (const Point2 p : cover.guards) {
        if (poses.size() == static_cast<std::size_t>(kinds.front().most)) break;
        poses.push_back({{p.x, p.y, height}, {}, {}, {}});
    }
    result.is_reached = !cover.guards.empty() && poses.size() == cover.guards.size();
    result.sensors = placementsOf(scene, groups, kinds, {std::move(poses)});
    result.cost = static_cast<double>(result.sensors.size());
    result.candidates = cover.candidates;
    result.is_complete = cover.isProven() || !progress.stopped();
    result.least = static_cast<double>(cover.bound);
    const double area = totalArea(floor);
    result.over_poses =
        PosesProof{cover.guards.size(), cover.bound, cover.missed, area, cover.witnesses};
    measurePlaced(scene, groups, options, result);
    result.candidate_value =
        result.is_reached && area > 0 ? 1 - cover.missed / area : result.coverage;
    return result;
}

}  // namespace ispace
