// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/scan.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace ispace {

namespace {

/// Unit vectors of all beams in the world frame.
std::vector<Vec3> beamDirections(const PlacedLaser& sensor) {
    const Laser& laser = sensor.laser;
    const Pose3& pose = sensor.pose;
    std::vector<Vec3> directions(static_cast<std::size_t>(laser.beams));
    if (pose.isLevel()) {
        // Degrees add up exactly where their cosines do not: a beam at 45 degrees of a sensor that
        // faces 45 degrees runs along y.
        for (int k = 0; k < laser.beams; ++k) {
            const Vec2 direction = unitVector(pose.heading + laser.bearing(k));
            directions[static_cast<std::size_t>(k)] = {direction.x, direction.y, 0};
        }
        return directions;
    }
    const Vec3 forward = pose.beam({}), left = pose.beam(Angle::degrees(90));
    for (int k = 0; k < laser.beams; ++k) {
        const Vec2 local = unitVector(laser.bearing(k));
        directions[static_cast<std::size_t>(k)] = {local.x * forward.x + local.y * left.x,
                                                   local.x * forward.y + local.y * left.y,
                                                   local.x * forward.z + local.y * left.z};
    }
    return directions;
}

}  // namespace

std::vector<float> castBeams(const RayWorld& world, const PlacedLaser& sensor) {
    const std::vector<Vec3> directions = beamDirections(sensor);
    std::vector<float> ranges(directions.size());
    world.cast(sensor.pose.position, directions, sensor.laser.max_range, ranges);
    return ranges;
}

Scan castScan(const RayWorld& world, const PlacedLaser& sensor) {
    Scan scan;
    scan.ranges = castBeams(world, sensor);
    // As float32, as max_range is: a surface exactly at min_range is seen.
    const auto blind = static_cast<float>(sensor.laser.min_range);
    for (float& range : scan.ranges) {
        if (range < blind) range = std::numeric_limits<float>::infinity();
    }
    return scan;
}

std::vector<Scan> castScans(Worlds& worlds, std::span<const PlacedLaser> sensors) {
    for (const PlacedLaser& sensor : sensors) worlds.prepare(sensor.pose);
    const Worlds& ready = worlds;
    std::vector<Scan> scans(sensors.size());
    tbb::parallel_for(std::size_t{0}, sensors.size(), [&](std::size_t i) {
        scans[i] = castScan(ready.at(sensors[i].pose), sensors[i]);
    });
    return scans;
}

double sliceArea(const Laser& laser, std::span<const float> ranges) {
    double squares = 0;
    for (const float range : ranges) {
        const double distance = std::isinf(range) ? laser.max_range : static_cast<double>(range);
        squares += distance * distance;
    }
    return laser.step.degrees() * std::numbers::pi * squares / 360;
}

}  // namespace ispace
