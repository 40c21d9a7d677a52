// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/radars/radar_frame.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.h"
#include "sense/noise.h"
#include "sense/sighting.h"

namespace ispace::radars {

namespace {

/// A detection, before noise.
struct Echo {
    Detection detection;
    double cosine = 1;   ///< of the angle between the line of sight and the normal
    std::size_t number;  ///< of the mover, among those in the bodies
};

/// Returns the echoes of all movers in sight that are fast enough, in the order of the bodies.
std::vector<Echo> echoesOf(const RayWorld& mesh, const MovingBodies& bodies,
                           const MoverVelocities& velocities, const Sensor& sensor,
                           const Pose3& pose) {
    const Radar& radar = sensor.as<Radar>();
    const Observer observer{fieldOfView(radar, pose), radar.min_range, carrierOf(sensor)};
    const Point3 origin = pose.position;
    std::vector<Echo> echoes;
    const auto any = [](std::uint32_t /*owner*/) { return true; };
    for (const Sighting& seen : sightingsOf(observer, mesh, bodies, any)) {
        const Point3 at = origin + seen.range * seen.direction;
        const Vec2 motion = velocities.of(seen.body->owner).at(at.onFloor());
        if (!senses(radar, motion, seen.direction)) continue;
        const double speed = motion.x * seen.direction.x + motion.y * seen.direction.y;
        const Vec3 local = observer.view.frame.toLocal(at);
        const double level = std::hypot(local.x, local.y);
        const double cosine = -dot(seen.body->normalAt(at), seen.direction);
        echoes.push_back({{seen.range, Angle::radians(std::atan2(local.y, local.x)),
                           Angle::radians(std::atan2(local.z, level)), speed},
                          std::clamp(cosine, 0.0, 1.0),
                          seen.number});
    }
    return echoes;
}

/// Removes detections that the radar cannot tell from a nearer one, and the farthest of too many.
void resolve(const Radar& radar, std::vector<Echo>& echoes) {
    std::stable_sort(echoes.begin(), echoes.end(), [](const Echo& a, const Echo& b) {
        return a.detection.range < b.detection.range;
    });
    std::vector<Echo> kept;
    for (const Echo& echo : echoes) {
        const Detection& one = echo.detection;
        const bool is_merged = std::any_of(kept.begin(), kept.end(), [&](const Echo& other) {
            const Detection& near = other.detection;
            return one.range - near.range < radar.noise.resolution &&
                   std::fabs((one.bearing - near.bearing).degrees()) <
                       radar.angle_resolution.degrees() &&
                   std::fabs(one.speed - near.speed) < radar.speed_resolution;
        });
        if (is_merged) continue;
        kept.push_back(echo);
        if (kept.size() == static_cast<std::size_t>(radar.detections)) break;
    }
    echoes = std::move(kept);
}

/// Adds noise; detections that drop out get an infinite range.
void disturb(const Radar& radar, const std::string& id, int frame, std::uint64_t seed,
             std::vector<Echo>& echoes) {
    const std::uint64_t sensor = hashOf(id);
    for (Echo& echo : echoes) {
        Detection& one = echo.detection;
        // A sequence of its own for each mover, so that others do not change its noise.
        const std::uint64_t mover = sensor ^ mixedBits(echo.number + 1);
        const auto of_frame = static_cast<std::uint64_t>(frame);
        const NoiseKey key{seed, mover, of_frame, Purpose::Range};
        auto range = static_cast<float>(one.range);
        const auto cosine = static_cast<float>(echo.cosine);
        addNoise(radar.noise, radar.min_range, radar.max_range, key, std::span(&cosine, 1),
                 std::span(&range, 1));
        one.range = range;
        std::array<float, 2> angles{};
        bearingErrors(radar.noise, {seed, mixedBits(mover), of_frame, Purpose::Range}, angles);
        one.bearing = one.bearing + Angle::radians(static_cast<double>(angles[0]));
        one.elevation = one.elevation + Angle::radians(static_cast<double>(angles[1]));
        std::array<float, 1> normal{};
        draw({seed, Purpose::Range, mixedBits(mover), of_frame}, 2, {.normal = normal});
        one.speed += radar.speed_sigma * static_cast<double>(normal[0]);
        if (radar.speed_resolution > 0)
            one.speed = std::round(one.speed / radar.speed_resolution) * radar.speed_resolution;
    }
    std::erase_if(echoes, [](const Echo& echo) { return std::isinf(echo.detection.range); });
}

/// Folds a speed into [-most, most).
double folded(double speed, double most) {
    if (most == 0 || (speed >= -most && speed < most)) return speed;
    return speed - 2 * most * std::floor((speed + most) / (2 * most));
}

}  // namespace

RadarFrame castRadar(const RayWorld& mesh, const MovingBodies& bodies,
                     const MoverVelocities& velocities, const Sensor& sensor, const Pose3& pose,
                     int frame, std::optional<std::uint64_t> noise_seed) {
    const Radar& radar = sensor.as<Radar>();
    std::vector<Echo> echoes = echoesOf(mesh, bodies, velocities, sensor, pose);
    resolve(radar, echoes);
    if (noise_seed && radar.isNoisy()) disturb(radar, sensor.id, frame, *noise_seed, echoes);
    RadarFrame out;
    out.detections.reserve(echoes.size());
    for (Echo& echo : echoes) {
        echo.detection.speed = folded(echo.detection.speed, radar.max_speed);
        out.detections.push_back(echo.detection);
    }
    return out;
}

RadarFrame readingOf(const Radar& /*radar*/, const Moment& now) {
    return castRadar(now.mesh(), now.bodies, now.options.velocities, now.sensor, now.pose,
                     now.frame, now.options.noise_seed);
}

}  // namespace ispace::radars
