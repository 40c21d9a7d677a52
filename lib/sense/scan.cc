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

/// Surfaces in the blind zone give no return, and hide what lies behind them all the same.
void applyBlindZone(const Laser& laser, std::vector<float>& ranges) {
    // As float32, as max_range is: a surface exactly at min_range is seen.
    const auto blind = static_cast<float>(laser.min_range);
    for (float& range : ranges) {
        if (range < blind) range = std::numeric_limits<float>::infinity();
    }
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
    applyBlindZone(sensor.laser, scan.ranges);
    return scan;
}

Scan castScan(const RayWorld& world, const PlacedLaser& sensor, const MovingBodies& bodies) {
    const Laser& laser = sensor.laser;
    const std::vector<Vec3> directions = beamDirections(sensor);
    Scan scan;
    scan.ranges.resize(directions.size());
    world.cast(sensor.pose.position, directions, laser.max_range, scan.ranges);
    const std::uint32_t own =
        sensor.mount ? static_cast<std::uint32_t>(sensor.mount->robot) : MovingBodies::kNobody;
    bodies.shorten(sensor.pose, laser.first, laser.step, directions, laser.max_range, own,
                   scan.ranges);
    applyBlindZone(laser, scan.ranges);
    return scan;
}

std::vector<Scan> castScans(Worlds& worlds, std::span<const PlacedLaser> sensors,
                            const MovingBodies& bodies) {
    for (const PlacedLaser& sensor : sensors) worlds.prepare(sensor.pose);
    const Worlds& ready = worlds;
    std::vector<Scan> scans(sensors.size());
    tbb::parallel_for(std::size_t{0}, sensors.size(), [&](std::size_t i) {
        scans[i] = castScan(ready.at(sensors[i].pose), sensors[i], bodies);
    });
    return scans;
}

MovingBody robotBody(const RobotModel& model, const Pose2& pose, std::uint32_t owner) {
    MovingBody body;
    body.pose = {pose * Point2{model.center, 0}, pose.heading};
    if (model.length > 0) {
        body.half_length = model.length / 2;
        body.half_width = model.width / 2;
    } else {
        body.radius = model.radius;
    }
    body.top = model.height;
    body.owner = owner;
    return body;
}

std::vector<MovingBody> robotBodies(std::span<const PlacedRobot> robots) {
    std::vector<MovingBody> bodies;
    bodies.reserve(robots.size());
    for (const PlacedRobot& robot : robots)
        bodies.push_back(
            robotBody(robot.model, robot.pose, static_cast<std::uint32_t>(bodies.size())));
    return bodies;
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
