// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/scan.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace ispace {

namespace {

/// Surfaces in the blind zone give no return, and hide what lies behind them all the same.
void applyBlindZone(const Laser& laser, std::vector<float>& ranges) {
    // As float32, as max_range is: a surface exactly at min_range is seen.
    const auto blind = static_cast<float>(laser.min_range);
    for (float& range : ranges) {
        if (range < blind) range = std::numeric_limits<float>::infinity();
    }
}

}  // namespace

Beams::Beams(const PlacedLaser& sensor)
    : first_(sensor.laser.first), step_(sensor.laser.step), rides_(sensor.mount.has_value()) {
    const auto count = static_cast<std::size_t>(sensor.laser.beams);
    directions_.resize(count);
    if (isSum(sensor.pose)) return;
    local_.reserve(count);
    for (int k = 0; k < sensor.laser.beams; ++k)
        local_.push_back(unitVector(sensor.laser.bearing(k)));
}

std::span<const Vec3> Beams::at(const Pose3& pose) {
    if (!known_ || pose.heading != heading_ || pose.tilt != tilt_ || pose.roll != roll_)
        point(pose);
    return directions_;
}

void Beams::point(const Pose3& pose) {
    known_ = true;
    heading_ = pose.heading;
    tilt_ = pose.tilt;
    roll_ = pose.roll;
    if (isSum(pose)) {
        for (std::size_t k = 0; k < directions_.size(); ++k) {
            const Vec2 flat = unitVector(heading_ + (first_ + static_cast<double>(k) * step_));
            directions_[k] = {flat.x, flat.y, 0};
        }
        return;
    }
    const Vec3 forward = pose.beam({}), left = pose.beam(Angle::degrees(90));
    for (std::size_t k = 0; k < directions_.size(); ++k) {
        const auto [x, y] = local_[k];
        directions_[k] = {x * forward.x + y * left.x, x * forward.y + y * left.y,
                          x * forward.z + y * left.z};
    }
}

std::vector<float> castBeams(const RayWorld& world, const PlacedLaser& sensor) {
    Beams beams(sensor);
    const std::span<const Vec3> directions = beams.at(sensor.pose);
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

Scan castScan(const RayWorld& world, const PlacedLaser& sensor, Beams& beams,
              const MovingBodies& bodies) {
    const Laser& laser = sensor.laser;
    const std::span<const Vec3> directions = beams.at(sensor.pose);
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
        Beams beams(sensors[i]);
        scans[i] = castScan(ready.at(sensors[i].pose), sensors[i], beams, bodies);
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
