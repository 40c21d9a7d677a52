// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/per_thread.h"
#include "base/simd.h"
#include "geom/tolerance.h"
#include "sense/noise.h"
#include "sense/selection.h"

namespace ispace {

namespace {

Angle angleOf(const Laser& laser, const Pose3& pose) {
    switch (laser.sweep) {
        case SweepAxis::Tilt:
            return pose.tilt;
        case SweepAxis::Roll:
            return pose.roll;
        default:
            return pose.heading;
    }
}

/// Returns the angle from the first scan to the last, or a full turn.
Angle sweepOf(const Laser& laser) {
    const Angle turn = Angle::degrees(360);
    if (laser.sweep_span >= turn) return turn;
    return static_cast<double>(laser.scans() - 1) * laser.sweep_step;
}

double cosineOfHalf(Angle span) { return span >= Angle::degrees(360) ? -1 : cos(0.5 * span); }

}  // namespace

bool scansSlice(const Laser& laser, const Pose3& pose) {
    return pose.isLevel() && (laser.sweep == SweepAxis::None || laser.sweep == SweepAxis::Heading);
}

bool scansSlice(const Sensor& sensor) {
    return sensor.is<Laser>() && scansSlice(sensor.as<Laser>(), sensor.pose);
}

BearingWindow::BearingWindow(const Laser& laser, Angle more)
    : middle(unitVector(laser.first + 0.5 * (laser.span() + more))),
      cosine(cosineOfHalf(laser.span() + std::max(more, -more))) {}

bool BearingWindow::holds(Vec3 local) const {
    const double distance = std::sqrt(local.x * local.x + local.y * local.y);
    return dot(Vec2{local.x, local.y}, middle) >= (cosine - kUnitTolerance) * distance;
}

SweptScan::SweptScan(const Sensor& placed)
    : axis_(placed.as<Laser>().sweep),
      origin_(placed.pose.position),
      turns_{cosSin(placed.pose.heading), cosSin(placed.pose.tilt), cosSin(placed.pose.roll)},
      middle_(cosSin(angleOf(placed.as<Laser>(), placed.pose) + 0.5 * sweepOf(placed.as<Laser>()))),
      cosine_(cosineOfHalf(sweepOf(placed.as<Laser>()))),
      window_(placed.as<Laser>()),
      // An upside-down laser turns the other way in its frame.
      wide_(placed.as<Laser>(),
            (turns_.tilt.cos * turns_.roll.cos < 0 ? -1.0 : 1.0) * sweepOf(placed.as<Laser>())) {}

/// Rx(-roll) Ry(tilt) Rz(-heading).
Vec3 SweptScan::Turns::toSensor(Vec3 way) const {
    const Vec3 faced{heading.cos * way.x + heading.sin * way.y,
                     heading.cos * way.y - heading.sin * way.x, way.z};
    const Vec3 nodded{tilt.cos * faced.x + tilt.sin * faced.z, faced.y,
                      tilt.cos * faced.z - tilt.sin * faced.x};
    return {nodded.x, roll.cos * nodded.y + roll.sin * nodded.z,
            roll.cos * nodded.z - roll.sin * nodded.y};
}

CosSin& SweptScan::sweptOf(Turns& turns) const {
    switch (axis_) {
        case SweepAxis::Tilt:
            return turns.tilt;
        case SweepAxis::Roll:
            return turns.roll;
        default:
            return turns.heading;
    }
}

/// toSensor().z, by the cosine and the sine of the swept angle.
Vec3 SweptScan::equationOf(Vec3 way) const {
    const auto& [heading, tilt, roll] = turns_;
    const double x = heading.cos * way.x + heading.sin * way.y;
    const double y = heading.cos * way.y - heading.sin * way.x;
    switch (axis_) {
        case SweepAxis::Tilt:
            return {roll.cos * way.z, -roll.cos * x, -roll.sin * y};
        case SweepAxis::Roll:
            return {tilt.cos * way.z - tilt.sin * x, -y, 0};
        default:
            return {-roll.cos * tilt.sin * way.x - roll.sin * way.y,
                    roll.sin * way.x - roll.cos * tilt.sin * way.y, roll.cos * tilt.cos * way.z};
    }
}

bool SweptScan::isSeenAt(CosSin swept, Vec3 way) const {
    if (swept.cos * middle_.cos + swept.sin * middle_.sin < cosine_ - kUnitTolerance) return false;
    Turns turns = turns_;
    sweptOf(turns) = swept;
    return window_.holds(turns.toSensor(way));
}

bool SweptScan::passes(Point3 place) const {
    const Vec3 way = place - origin_;
    const auto [a, b, c] = equationOf(way);
    const double squared = a * a + b * b;
    const double slack = kUnitTolerance * kUnitTolerance * dot(way, way);
    if (squared <= slack) {
        // The point is on the axis of the sweep, or the plane turns in itself: it lies in the plane
        // of every scan, or of no scan.
        if (c * c > slack) return false;
        const bool turns_in_itself =
            axis_ == SweepAxis::Heading && turns_.tilt.sin == 0 && turns_.roll.sin == 0;
        return (turns_in_itself ? wide_ : window_).holds(turns_.toSensor(way));
    }
    const double rest = squared - c * c;
    if (rest < -slack) return false;
    const double root = std::sqrt(std::max(rest, 0.0));
    const CosSin one{(-a * c - b * root) / squared, (-b * c + a * root) / squared};
    const CosSin other{(-a * c + b * root) / squared, (-b * c - a * root) / squared};
    return isSeenAt(one, way) || isSeenAt(other, way);
}

std::shared_ptr<const Directions> LocalBeams::of(const Laser& laser) {
    auto& known = known_[{laser.first, laser.step, laser.beams}];
    if (known) return known;
    const auto beams = std::make_shared<Directions>();
    beams->resize(static_cast<std::size_t>(laser.beams));
    for (int k = 0; k < laser.beams; ++k) {
        const Vec2 flat = unitVector(laser.bearing(k));
        beams->set(static_cast<std::size_t>(k), {flat.x, flat.y, 0});
    }
    return known = beams;
}

Beams::Beams(const Laser& laser, bool turns, std::shared_ptr<const Directions> local)
    : first_(laser.first),
      step_(laser.step),
      turns_(turns),
      local_(local ? std::move(local) : LocalBeams().of(laser)) {
    if (!turns_) directions_.resize(local_->size());
}

const Directions& Beams::at(const Pose3& pose) {
    if (turns_) {
        auto& turned = perThread<Directions, struct TurnedBeams>();
        turn(pose, turned);
        return turned;
    }
    if (!known_ || pose.heading != heading_ || pose.tilt != tilt_ || pose.roll != roll_)
        point(pose);
    return directions_;
}

namespace {

/// Rotates level directions, each by a separate angle.
ISPACE_SIMD_CLONES void turnLevel(const double* x, const double* y, const double* cos,
                                  const double* sin, std::size_t count, double* out_x,
                                  double* out_y) {
    for (std::size_t k = 0; k < count; ++k) {
        out_x[k] = cos[k] * x[k] - sin[k] * y[k];
        out_y[k] = sin[k] * x[k] + cos[k] * y[k];
    }
}

void turnEach(const Directions& local, const BeamFrames& frames, Directions& out) {
    turnLevel(local.x.data(), local.y.data(), frames.cos.data(), frames.sin.data(), local.size(),
              out.x.data(), out.y.data());
    std::fill(out.z.begin(), out.z.end(), 0.0);
}

/// Rotates directions in the sensor's plane to the world frame.
ISPACE_SIMD_CLONES void turnAll(const double* x, const double* y, std::size_t count, Vec3 forward,
                                Vec3 left, double* out_x, double* out_y, double* out_z) {
    for (std::size_t k = 0; k < count; ++k) {
        out_x[k] = x[k] * forward.x + y[k] * left.x;
        out_y[k] = x[k] * forward.y + y[k] * left.y;
        out_z[k] = x[k] * forward.z + y[k] * left.z;
    }
}

}  // namespace

void Beams::turn(const Pose3& pose, Directions& directions) const {
    directions.resize(local_->size());
    directions.arc.reset();
    if (pose.isLevel()) directions.arc = Directions::Arc{pose.heading + first_, step_};
    const Frame3 frame(pose);
    turnAll(local_->x.data(), local_->y.data(), local_->size(), frame.forward, frame.left,
            directions.x.data(), directions.y.data(), directions.z.data());
}

void Beams::point(const Pose3& pose) {
    known_ = true;
    heading_ = pose.heading;
    tilt_ = pose.tilt;
    roll_ = pose.roll;
    if (!pose.isLevel()) return turn(pose, directions_);
    directions_.arc = Directions::Arc{heading_ + first_, step_};
    for (std::size_t k = 0; k < directions_.size(); ++k) {
        const Vec2 flat = unitVector(heading_ + (first_ + static_cast<double>(k) * step_));
        directions_.set(k, {flat.x, flat.y, 0});
    }
}

std::vector<float> castBeams(const RayWorld& world, const Sensor& sensor) {
    Beams beams(sensor.as<Laser>(), false);
    const Directions& directions = beams.at(sensor.pose);
    std::vector<float> ranges(directions.size());
    world.cast(sensor.pose.position, directions, sensor.as<Laser>().max_range, ranges);
    return ranges;
}

LaserCaster::LaserCaster(const RayScenes& worlds, const MovingBodies& bodies, const Sensor& sensor,
                         bool turns, const ReadingOptions& options,
                         std::shared_ptr<const Directions> local)
    : worlds_(&worlds),
      bodies_(&bodies),
      sensor_(&sensor),
      options_(options),
      id_hash_(hashOf(sensor.id)),
      own_(carrierOf(sensor)),
      beams_(sensor.as<Laser>(), turns, std::move(local)) {}

void LaserCaster::cast(Scan& scan) {
    const BeamsAmong all{0, static_cast<std::size_t>(sensor_->as<Laser>().beams), bodies_};
    cast(scan, std::span(&all, 1));
}

void LaserCaster::cast(Scan& scan, std::span<const BeamsAmong> parts) {
    castWith(scan, [&] {
        if (errors_.empty() && scan.beam_poses.empty())
            castFrom(scan.pose, scan.ranges, parts);
        else
            castApart(scan, parts);
    });
}

void LaserCaster::cast(Scan& scan, const BeamFrames& frames, std::span<const BeamsAmong> parts) {
    castWith(scan, [&] { castLevel(scan, frames, parts); });
}

/// Converts the ranges that `cast` computes to readings.
template <typename Cast>
void LaserCaster::castWith(Scan& scan, Cast cast) {
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
    cast();
    // Surfaces in the blind zone give no return, but hide surfaces behind them.
    addNoise(noisy ? laser.noise : RangeNoise(), laser.min_range, laser.max_range, key, cosines_,
             scan.ranges);
}

/// Rays with a separate origin each.
struct LaserCaster::RaysApart {
    Directions directions;
    std::vector<Point3> origins;

    /// Returns the buffer of this thread, which takes many scans.
    static RaysApart& ofThread(std::size_t count) {
        auto& rays = perThread<RaysApart, RaysApart>();
        rays.directions.resize(count);
        rays.origins.resize(count);
        return rays;
    }
};

namespace {

/// Returns the values of some beams; empty if there are no cosines.
std::span<float> valuesOf(std::span<float> values, const BeamsAmong& part) {
    return values.empty() ? values : values.subspan(part.begin, part.end - part.begin);
}

const Directions& partOf(const Directions& all, const BeamsAmong& part) {
    if (part.begin == 0 && part.end == all.size()) return all;
    auto& some = perThread<Directions, struct SomeBeams>();
    const auto copy = [&part](const std::vector<double>& from, std::vector<double>& to) {
        to.assign(from.begin() + static_cast<std::ptrdiff_t>(part.begin),
                  from.begin() + static_cast<std::ptrdiff_t>(part.end));
    };
    copy(all.x, some.x);
    copy(all.y, some.y);
    copy(all.z, some.z);
    some.arc = all.arc;
    if (some.arc)
        some.arc->first = some.arc->first + static_cast<double>(part.begin) * some.arc->step;
    return some;
}

}  // namespace

void LaserCaster::castFrom(const Pose3& pose, std::span<float> ranges,
                           std::span<const BeamsAmong> parts) {
    const Directions& directions = beams_.at(pose);
    const double far = sensor_->as<Laser>().max_range;
    worlds_->at(pose).cast(pose.position, directions, far, ranges, cosines_);
    for (const BeamsAmong& part : parts)
        part.bodies->shorten(pose.position, partOf(directions, part), far, own_,
                             valuesOf(ranges, part), valuesOf(cosines_, part));
}

/// Returns a beam's direction with its bearing error.
Vec2 LaserCaster::localBeam(std::size_t beam) const {
    const Directions& local = beams_.local();
    const Vec2 exact{local.x[beam], local.y[beam]};
    if (errors_.empty()) return exact;
    const auto [c, s] = cosSin(Angle::radians(static_cast<double>(errors_[beam])));
    return {c * exact.x - s * exact.y, s * exact.x + c * exact.y};
}

/// Casts each beam separately: it has an origin or an error that differs.
void LaserCaster::castApart(Scan& scan, std::span<const BeamsAmong> parts) {
    const std::size_t count = scan.ranges.size();
    RaysApart& rays = RaysApart::ofThread(count);
    bool level = true;
    Frame3 frame;
    for (std::size_t k = 0; k < count; ++k) {
        const Pose3& pose = scan.poseAt(k);
        if (k == 0 || !scan.beam_poses.empty()) frame = Frame3(pose);
        const Vec2 beam = localBeam(k);
        rays.directions.set(k, frame * Vec3{beam.x, beam.y, 0});
        rays.origins[k] = pose.position;
        level = level && pose.isLevel() && pose.position.z == scan.pose.position.z;
    }
    castRays(level ? worlds_->at(scan.pose) : worlds_->mesh(), rays, scan, parts);
}

void LaserCaster::castLevel(Scan& scan, const BeamFrames& frames,
                            std::span<const BeamsAmong> parts) {
    const std::size_t count = scan.ranges.size();
    RaysApart& rays = RaysApart::ofThread(count);
    if (errors_.empty())
        turnEach(beams_.local(), frames, rays.directions);
    else
        for (std::size_t k = 0; k < count; ++k) {
            const Vec2 beam = localBeam(k);
            const double c = frames.cos[k], s = frames.sin[k];
            rays.directions.set(k, {c * beam.x - s * beam.y, s * beam.x + c * beam.y, 0});
        }
    for (std::size_t k = 0; k < count; ++k)
        rays.origins[k] = {frames.x[k], frames.y[k], scan.pose.position.z};
    castRays(worlds_->at(scan.pose), rays, scan, parts);
}

void LaserCaster::castRays(const RayWorld& world, const RaysApart& rays, Scan& scan,
                           std::span<const BeamsAmong> parts) {
    const double far = sensor_->as<Laser>().max_range;
    world.cast(rays.origins, rays.directions, far, scan.ranges, cosines_);
    for (const BeamsAmong& part : parts)
        part.bodies->shorten(rays.origins, rays.directions, part.begin, part.end, far, own_,
                             scan.ranges, cosines_);
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
