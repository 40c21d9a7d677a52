// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/coarse_sight.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "arrange/candidate_generator.h"
#include "coverage/camera_rules.h"

namespace ispace {

namespace {

constexpr double kCells = 4'000;  // about so many
constexpr double kLeastEdge = 0.1, kMostEdge = 0.5;
/// Errors of cells along an outline cancel out, but where an edge of a field of view runs through
/// centres, which counts them all: measured in furnished rooms, views rarely have so many more, and
/// never twice as many more, cells than were counted.
constexpr double kCellsOfError = 8;

double edgeFor(const Box2& limits) {
    return std::clamp(std::sqrt(limits.width() * limits.depth() / kCells), kLeastEdge, kMostEdge);
}

}  // namespace

CoarseSight::CoarseSight(const Environment& environment, const SuggestOptions& options)
    : worlds_(environment),
      sight_(environment, options.measure.plane, &worlds_),
      options_(options),
      target_(
          makeTarget(environment, CellSize{edgeFor(environment.limits())}, options.measure.height)),
      cell_(target_.grid.cellArea()),
      error_(kCellsOfError * cell_),
      counted_(target_.indoor) {
    for (const PrivacyRule& rule : options.privacy)
        private_.push_back({rule.density, privateCells(rule, environment, target_)});
}

bool CoarseSight::estimates(const Scene& scene, const SuggestOptions& options) {
    return options.requirements.empty() && options.facing.empty() &&
           std::none_of(scene.sensors.begin(), scene.sensors.end(),
                        [](const Sensor& sensor) { return isPartial(sensor.model); });
}

void CoarseSight::count(std::span<const Sensor> sensors, const Sensor& moving) {
    counted_ = target_.indoor;
    for (const Sensor& sensor : sensors) {
        if (sensor.id == moving.id || !kindOf(sensor.model).perceives) continue;
        sight_.prepare(sensor);
        sight_.cellsOf(target_.grid, sensor).forEach([&](std::size_t cell) {
            counted_.reset(cell);
        });
    }
}

FloorGain CoarseSight::gainOf(const Sensor& sensor) const {
    FloorGain gain;
    gain.gained =
        cell_ * static_cast<double>(countCommon(sight_.cellsOf(target_.grid, sensor), counted_));
    if (!sensor.is<Camera>()) return gain;
    for (const Private& rule : private_) {
        Sensor camera = sensor;
        camera.model = withDensity(sensor.as<Camera>(), rule.density);
        gain.required -= cell_ * static_cast<double>(
                                     countCommon(sight_.cellsOf(target_.grid, camera), rule.cells));
    }
    return gain;
}

std::vector<FloorGain> CoarseSight::at(const Sensor& sensor, std::span<const Pose3> poses) {
    sight_.prepare(sensor);
    std::vector<FloorGain> gains(poses.size());
    tbb::parallel_for(std::size_t{0}, poses.size(), [&](std::size_t i) {
        // A thread that waits for rows of cells in here must not begin with another pose.
        tbb::this_task_arena::isolate([&] {
            Sensor moved = sensor;
            moved.pose = poses[i];
            gains[i] = gainOf(moved);
        });
    });
    return gains;
}

FloorGain CoarseSight::whole(std::span<const Sensor> sensors) {
    FloorGain sum;
    CellSet seen(target_.grid.size());
    for (const Sensor& sensor : sensors) {
        if (!kindOf(sensor.model).perceives) continue;
        sight_.prepare(sensor);
        sum.required += gainOf(sensor).required;
        seen |= sight_.cellsOf(target_.grid, sensor);
    }
    sum.gained = cell_ * static_cast<double>(countCommon(seen, target_.indoor));
    return sum;
}

}  // namespace ispace
