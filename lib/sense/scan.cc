// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/scan.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "base/simd.h"
#include "sense/noise.h"
#include "sense/sensors.h"

namespace ispace {

Beams::Beams(const Laser& laser, bool turns)
    : first_(laser.first), step_(laser.step), turns_(turns) {
    const auto count = static_cast<std::size_t>(laser.beams);
    directions_.resize(count);
    local_.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        const Vec2 flat = unitVector(laser.bearing(static_cast<int>(k)));
        local_.set(k, {flat.x, flat.y, 0});
    }
}

const Directions& Beams::at(const Pose3& pose) {
    if (!known_ || pose.heading != heading_ || pose.tilt != tilt_ || pose.roll != roll_)
        point(pose);
    return directions_;
}

namespace {

/// Turns directions in the plane of the sensor into the world.
ISPACE_SIMD_CLONES void turn(const double* x, const double* y, std::size_t count, Vec3 forward,
                             Vec3 left, double* out_x, double* out_y, double* out_z) {
    for (std::size_t k = 0; k < count; ++k) {
        out_x[k] = x[k] * forward.x + y[k] * left.x;
        out_y[k] = x[k] * forward.y + y[k] * left.y;
        out_z[k] = x[k] * forward.z + y[k] * left.z;
    }
}

}  // namespace

void Beams::point(const Pose3& pose) {
    known_ = true;
    heading_ = pose.heading;
    tilt_ = pose.tilt;
    roll_ = pose.roll;
    directions_.arc.reset();
    if (pose.isLevel()) directions_.arc = Directions::Arc{heading_ + first_, step_};
    if (pose.isLevel() && !turns_) {
        for (std::size_t k = 0; k < directions_.size(); ++k) {
            const Vec2 flat = unitVector(heading_ + (first_ + static_cast<double>(k) * step_));
            directions_.set(k, {flat.x, flat.y, 0});
        }
        return;
    }
    const Frame3 frame(pose);
    turn(local_.x.data(), local_.y.data(), local_.size(), frame.forward, frame.left,
         directions_.x.data(), directions_.y.data(), directions_.z.data());
}

std::vector<float> castBeams(const RayWorld& world, const Sensor& sensor) {
    Beams beams(sensor.as<Laser>(), false);
    const Directions& directions = beams.at(sensor.pose);
    std::vector<float> ranges(directions.size());
    world.cast(sensor.pose.position, directions, sensor.as<Laser>().max_range, ranges);
    return ranges;
}

LaserCaster::LaserCaster(const Worlds& worlds, const MovingBodies& bodies, const Sensor& sensor,
                         bool turns, const ReadingOptions& options)
    : worlds_(&worlds),
      bodies_(&bodies),
      sensor_(&sensor),
      options_(options),
      id_hash_(hashOf(sensor.id)),
      own_(carrierOf(sensor)),
      beams_(sensor.as<Laser>(), turns) {}

void LaserCaster::cast(Scan& scan) {
    const BeamsAmong all{0, static_cast<std::size_t>(sensor_->as<Laser>().beams), bodies_};
    cast(scan, std::span(&all, 1));
}

void LaserCaster::cast(Scan& scan, std::span<const BeamsAmong> parts) {
    const Laser& laser = sensor_->as<Laser>();
    const auto count = static_cast<std::size_t>(laser.beams);
    scan.ranges.resize(count);
    const bool noisy = options_.noise_seed.has_value();
    const NoiseKey key{.seed = options_.noise_seed.value_or(0),
                       .sensor = id_hash_,
                       .frame = static_cast<std::uint64_t>(scan.frame) *
                                    static_cast<std::uint64_t>(laser.scans()) +
                                static_cast<std::uint64_t>(scan.number)};
    cosines_.resize(noisy && laser.noise.dropsByIncidence() ? count : 0);
    errors_.resize(noisy && laser.noise.angle_sigma > Angle() ? count : 0);
    if (!errors_.empty()) bearingErrors(laser.noise, key, errors_);
    if (errors_.empty() && scan.beam_poses.empty())
        castFrom(scan.pose, scan.ranges, parts);
    else
        castApart(scan, parts);
    // Surfaces in the blind zone give no return, and hide what lies behind them all the same.
    addNoise(noisy ? laser.noise : RangeNoise(), laser.min_range, laser.max_range, key, cosines_,
             scan.ranges);
}

namespace {

/// Of some beams; of none if there are no cosines.
std::span<float> valuesOf(std::span<float> values, const BeamsAmong& part) {
    return values.empty() ? values : values.subspan(part.begin, part.end - part.begin);
}

}  // namespace

const Directions& LaserCaster::partOf(const Directions& all, const BeamsAmong& part) {
    if (part.begin == 0 && part.end == all.size()) return all;
    const auto copy = [&part](const std::vector<double>& from, std::vector<double>& to) {
        to.assign(from.begin() + static_cast<std::ptrdiff_t>(part.begin),
                  from.begin() + static_cast<std::ptrdiff_t>(part.end));
    };
    copy(all.x, part_.x);
    copy(all.y, part_.y);
    copy(all.z, part_.z);
    part_.arc = all.arc;
    if (part_.arc)
        part_.arc->first = part_.arc->first + static_cast<double>(part.begin) * part_.arc->step;
    return part_;
}

void LaserCaster::castFrom(const Pose3& pose, std::span<float> ranges,
                           std::span<const BeamsAmong> parts) {
    const Directions& directions = beams_.at(pose);
    const double far = sensor_->as<Laser>().max_range;
    worlds_->at(pose).cast(pose.position, directions, far, ranges, cosines_);
    for (const BeamsAmong& part : parts)
        part.bodies->shorten(pose.position, partOf(directions, part), far, own_,
                             valuesOf(ranges, part), valuesOf(cosines_, part));
}

/// Each beam by itself: it has a place or an error of its own.
void LaserCaster::castApart(Scan& scan, std::span<const BeamsAmong> parts) {
    const Laser& laser = sensor_->as<Laser>();
    const std::size_t count = scan.ranges.size();
    apart_.resize(count);
    origins_.resize(count);
    bool level = true;
    Frame3 frame;
    for (std::size_t k = 0; k < count; ++k) {
        const Pose3& pose = scan.poseAt(k);
        if (k == 0 || !scan.beam_poses.empty()) frame = Frame3(pose);
        Vec2 beam = beams_.local(k);
        if (!errors_.empty()) {
            const auto [c, s] = cosSin(Angle::radians(static_cast<double>(errors_[k])));
            beam = {c * beam.x - s * beam.y, s * beam.x + c * beam.y};
        }
        apart_.set(k, frame * Vec3{beam.x, beam.y, 0});
        origins_[k] = pose.position;
        level = level && pose.isLevel() && pose.position.z == scan.pose.position.z;
    }
    const RayWorld& world = level ? worlds_->at(scan.pose) : worlds_->mesh();
    world.cast(origins_, apart_, laser.max_range, scan.ranges, cosines_);
    for (const BeamsAmong& part : parts)
        part.bodies->shorten(
            std::span<const Point3>(origins_).subspan(part.begin, part.end - part.begin),
            partOf(apart_, part), laser.max_range, own_, valuesOf(scan.ranges, part),
            valuesOf(cosines_, part));
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
