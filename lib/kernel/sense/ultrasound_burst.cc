// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/ultrasound_burst.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "geom/tolerance.h"
#include "sense/noise.h"
#include "sense/selection.h"

namespace ispace {

namespace {

/// Returns the cosine of the angle between a sensor's axis and the direction to a point; 1 at the
/// sensor itself.
double axisCosine(const Pose3& pose, Point3 place) {
    const Vec3 towards = place - pose.position;
    const double distance = length(towards);
    return distance > 0 ? dot(pose.beam({}), towards) / distance : 1;
}

/// Directions on the cone itself are inside, whatever rounding does.
bool isWithinCone(Angle fov, double axis_cosine) {
    return axis_cosine >= cos(0.5 * fov) - kUnitTolerance;
}

/// Bodies of either carrier do not block the line.
bool isBodyBetween(const MovingBodies& bodies, Point3 a, Point3 b, std::uint32_t carrier_of_a,
                   std::uint32_t carrier_of_b) {
    if (carrier_of_a == MovingBodies::kNoOwner || carrier_of_a == carrier_of_b)
        return bodies.between(a, b, carrier_of_b);
    if (carrier_of_b == MovingBodies::kNoOwner) return bodies.between(a, b, carrier_of_a);
    // Robots rarely hear each other.
    const double distance = length(b - a);
    const Vec3 direction = (1 / distance) * (b - a);
    return bodies.anyAlong(a, b, [&](std::size_t i) {
        const std::uint32_t owner = bodies.bodies()[i].owner;
        return owner != carrier_of_a && owner != carrier_of_b &&
               bodies.meet(i, a, direction) < distance;
    });
}

bool isInSight(const RayWorld& environment, const MovingBodies& bodies, const Sensor& tag,
               const Sensor& receiver) {
    const Point3 from = receiver.pose.position;
    const Point3 to = tag.pose.position;
    if (from == to) return true;
    std::uint8_t seen = 0;
    environment.query(from, std::span(&to, 1), std::span(&seen, 1));
    return seen != 0 && !isBodyBetween(bodies, from, to, carrierOf(receiver), carrierOf(tag));
}

/// Hashes the pair, in this order.
std::uint64_t hashOfPair(const Sensor& tag, const Sensor& receiver) {
    return (std::rotl(hashOf(tag.id), 29) ^ hashOf(receiver.id)) * 0x9e3779b97f4a7c15U;
}

/// Returns the measured distance if the burst is heard.
std::optional<double> distanceHeard(const RayWorld& environment, const MovingBodies& bodies,
                                    const Sensor& tag, const Sensor& placed, int frame,
                                    std::optional<std::uint64_t> noise_seed) {
    const Receiver& receiver = placed.as<Receiver>();
    const double distance = length(tag.pose.position - placed.pose.position);
    auto range = static_cast<float>(distance);
    if (range < static_cast<float>(receiver.min_range) ||
        range > static_cast<float>(receiver.max_range))
        return std::nullopt;
    const double axis_cosine = axisCosine(placed.pose, tag.pose.position);
    if (!isWithinCone(receiver.fov, axis_cosine)) return std::nullopt;
    if (!isWithinCone(tag.as<Tag>().fov, axisCosine(tag.pose, placed.pose.position)))
        return std::nullopt;
    if (!isInSight(environment, bodies, tag, placed)) return std::nullopt;
    if (!noise_seed || receiver.noise.isNone()) return distance;

    const NoiseKey key{*noise_seed, hashOfPair(tag, placed), static_cast<std::uint64_t>(frame),
                       Purpose::Ultrasound};
    const auto cosine = static_cast<float>(std::max(axis_cosine, 0.0));
    addNoise(receiver.noise, receiver.min_range, receiver.max_range, key, std::span(&cosine, 1),
             std::span(&range, 1));
    if (range == std::numeric_limits<float>::infinity()) return std::nullopt;
    return static_cast<double>(range);
}

/// Estimates the standard deviation of a distance.
double errorOf(const RangeNoise& noise, double distance) {
    const auto& [s0, s1, s2] = noise.sigma;
    const double sigma = std::max(0.0, s0 + distance * (s1 + distance * s2));
    return std::hypot(sigma, noise.bias, noise.resolution);
}

std::optional<PositionFix> fixOf(std::span<const TimeOfFlight> heard,
                                 std::span<const Sensor> receivers, bool has_noise) {
    std::vector<Hearing> hearings;
    hearings.reserve(heard.size());
    for (const TimeOfFlight& flight : heard) {
        const Sensor& placed = receivers[flight.receiver];
        const double error = has_noise ? errorOf(placed.as<Receiver>().noise, flight.distance) : 0;
        hearings.push_back({placed.pose.position, placed.pose.beam({}), placed.as<Receiver>().fov,
                            flight.distance, error});
    }
    return locate(hearings);
}

/// Computes eq. (3.7)-(3.10) of the thesis, whose floor is x-z.
Point2 simplePlace(const Sensor& tag, int frame, std::optional<std::uint64_t> noise_seed) {
    const Point2 place = tag.pose.position.onFloor();
    if (!noise_seed) return place;
    const RandomKey key{*noise_seed, Purpose::Ultrasound, hashOf(tag.id),
                        static_cast<std::uint64_t>(frame)};
    std::array<float, 1> along_x{};
    std::array<float, 1> along_y{};
    draw(key, 0, {.normal = along_x, .other = along_y});
    const double sigma = tag.as<Tag>().simple_sigma;
    return place +
           Vec2{sigma * static_cast<double>(along_x[0]), sigma * static_cast<double>(along_y[0])};
}

}  // namespace

double speedOfSound(double celsius) { return 331.3 + 0.606 * celsius; }

Burst castBurst(const RayWorld& environment, const MovingBodies& bodies, const Sensor& tag,
                std::span<const Sensor> receivers, int frame, double time,
                const UltrasoundOptions& options) {
    Burst burst{
        .time = time, .frame = frame, .pose = tag.pose, .heard = {}, .fix = {}, .simple = {}};
    const double speed = speedOfSound(options.celsius);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const auto distance =
            distanceHeard(environment, bodies, tag, receivers[i], frame, options.noise_seed);
        if (distance) burst.heard.push_back({i, *distance / speed, *distance});
    }
    if (tag.as<Tag>().is_simple) {
        burst.simple = simplePlace(tag, frame, options.noise_seed);
    } else {
        burst.fix = fixOf(burst.heard, receivers, options.noise_seed.has_value());
    }
    return burst;
}

}  // namespace ispace
