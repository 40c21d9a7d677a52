// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pirs/pir_state.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.h"
#include "sense/sighting.h"

namespace ispace::pirs {

namespace {

constexpr double kSecondsAnHour = 3600;

/// Draws a number in [0, 1) for a person of a reading, or for the sensor as person 0.
double chance(const Sensor& sensor, std::uint64_t person, int frame, std::uint64_t seed) {
    std::array<float, 1> uniform{};
    draw({seed, Purpose::Range, hashOf(sensor.id) ^ mixedBits(person),
          static_cast<std::uint64_t>(frame)},
         0, {.uniform = uniform});
    return static_cast<double>(uniform[0]);
}

}  // namespace

PirState castPir(const RayWorld& mesh, const MovingBodies& bodies,
                 const MoverVelocities& velocities, const Sensor& sensor, const Pose3& pose,
                 int frame, std::optional<std::uint64_t> noise_seed) {
    const Pir& pir = sensor.as<Pir>();
    PirState state;
    const auto moves = [](const MoverVelocity& velocity) {
        return velocity.linear.x != 0 || velocity.linear.y != 0;
    };
    // Most of a day is without motion.
    if (std::any_of(velocities.people.begin(), velocities.people.end(), moves)) {
        const Observer observer{fieldOfView(pir, pose), pir.min_range, carrierOf(sensor)};
        const auto is_meant = [&](std::uint32_t owner) {
            return owner >= kFirstPerson && moves(velocities.of(owner));
        };
        for (const Sighting& seen : sightingsOf(observer, mesh, bodies, is_meant)) {
            // A turn on the spot moves limbs, but not the person.
            const Vec2 motion = velocities.of(seen.body->owner).linear;
            if (!senses(pir, motion)) continue;
            const bool is_lost =
                noise_seed && chance(sensor, seen.number + 1, frame, *noise_seed) < pir.dropout;
            state.motion = state.motion || !is_lost;
        }
    }
    if (noise_seed && pir.false_alarms > 0 && !state.motion)
        state.motion =
            chance(sensor, 0, frame, *noise_seed) < pir.false_alarms / kSecondsAnHour / pir.rate;
    if (state.motion) state.held = pir.hold;
    return state;
}

PirState readingOf(const Pir& /*pir*/, const Moment& now) {
    return castPir(now.mesh(), now.bodies, now.options.velocities, now.sensor, now.pose, now.frame,
                   now.options.noise_seed);
}

void keepOn(const PirState& before, double passed, PirState& now) {
    const double rest = before.held - passed;
    if (now.motion || passed < 0 || rest <= 0) return;
    now.motion = true;
    now.held = rest;
}

}  // namespace ispace::pirs
