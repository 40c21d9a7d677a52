// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/radar_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "sense/noise.h"

namespace ispace {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// A detection, before noise.
struct Echo {
    Detection detection;
    double cosine = 1;   ///< of the angle between the line of sight and the normal
    std::size_t number;  ///< of the mover, among those in the bodies
};

/// The line of sight to a body.
struct Sighting {
    double range = kNever;
    Vec3 direction;
    std::size_t body = 0;
};

class Caster {
  public:
    Caster(const RayWorld& mesh, const MovingBodies& bodies, const Sensor& sensor,
           const Pose3& pose)
        : mesh_(mesh),
          bodies_(bodies.bodies()),
          carrier_(carrierOf(sensor)),
          radar_(sensor.as<Radar>()),
          view_(fieldOfView(radar_, pose)),
          origin_(pose.position) {}

    [[nodiscard]] std::vector<Echo> echoes(const MoverVelocities& velocities) const {
        std::vector<Echo> echoes;
        std::size_t number = 0;
        // The bodies of a mover follow one another.
        for (std::size_t begin = 0, end = 0; begin < bodies_.size(); begin = end, ++number) {
            const std::uint32_t owner = bodies_[begin].owner;
            while (end < bodies_.size() && bodies_[end].owner == owner) ++end;
            if (owner == carrier_) continue;
            const MoverVelocity velocity = velocities.of(owner);
            const Sighting seen = nearest(begin, end);
            if (seen.range == kNever) continue;
            const Point3 at = origin_ + seen.range * seen.direction;
            const Vec2 motion = velocity.at(at.onFloor());
            const double speed = motion.x * seen.direction.x + motion.y * seen.direction.y;
            if (std::fabs(speed) < radar_.min_speed || speed == 0) continue;
            const Vec3 local = view_.frame.toLocal(at);
            const double level = std::hypot(local.x, local.y);
            const double cosine = -dot(bodies_[seen.body].normalAt(at), seen.direction);
            echoes.push_back({{seen.range, Angle::radians(std::atan2(local.y, local.x)),
                               Angle::radians(std::atan2(local.z, level)), speed},
                              std::clamp(cosine, 0.0, 1.0),
                              number});
        }
        return echoes;
    }

  private:
    [[nodiscard]] Sighting nearest(std::size_t begin, std::size_t end) const {
        Sighting best;
        for (std::size_t i = begin; i < end; ++i) {
            const MovingBody& body = bodies_[i];
            const Point2 foot = body.pose.position;
            const Vec3 way = Point3{foot.x, foot.y, body.middle()} - origin_;
            const double distance = length(way);
            if (distance == 0) continue;
            const Vec3 direction = (1 / distance) * way;
            const double range = body.meet(origin_, direction);
            // From inside, the ray meets the surface behind the centre.
            if (range > distance || range >= best.range || !isInView(range, direction) ||
                !isFree(range, direction, body.owner))
                continue;
            best = {range, direction, i};
        }
        return best;
    }

    [[nodiscard]] bool isInView(double range, Vec3 direction) const {
        return static_cast<float>(range) >= static_cast<float>(radar_.min_range) &&
               view_.holds(origin_ + range * direction);
    }

    [[nodiscard]] bool isFree(double range, Vec3 direction, std::uint32_t owner) const {
        if (range == 0) return true;
        const bool is_hidden =
            std::any_of(bodies_.begin(), bodies_.end(), [&](const MovingBody& body) {
                return body.owner != carrier_ && body.owner != owner &&
                       body.meet(origin_, direction) < range;
            });
        if (is_hidden) return false;
        const Point3 at = origin_ + range * direction;
        std::uint8_t seen = 0;
        mesh_.query(origin_, std::span(&at, 1), std::span(&seen, 1));
        return seen != 0;
    }

    const RayWorld& mesh_;
    std::span<const MovingBody> bodies_;
    std::uint32_t carrier_;
    const Radar& radar_;
    FieldOfView view_;
    Point3 origin_;
};

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
    std::vector<Echo> echoes = Caster(mesh, bodies, sensor, pose).echoes(velocities);
    resolve(radar, echoes);
    if (noise_seed && radar.isNoisy()) disturb(radar, sensor.id, frame, *noise_seed, echoes);
    RadarFrame out{.frame = frame, .pose = pose, .detections = {}};
    for (Echo& echo : echoes) {
        echo.detection.speed = folded(echo.detection.speed, radar.max_speed);
        out.detections.push_back(echo.detection);
    }
    return out;
}

}  // namespace ispace
