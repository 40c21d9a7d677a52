// SPDX-License-Identifier: GPL-3.0-or-later
// A sensor and its surroundings at one time: all that a reading depends on.
//
// A kind computes its reading from these values alone, without state, so that readings may be taken
// in any order, and by several threads at once. Members refer to data of the caller, valid while
// the reading is taken.
//
//     DoorCount readingOf(const DoorCounter& counter, const Moment& now);  // of a kind
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "base/random.h"
#include "scene/sensor/sensor.h"
#include "sense/photo.h"
#include "sense/selection.h"
#include "trace/moving_bodies.h"
#include "trace/ray_world.h"

namespace ispace {

class SharedResults;

/// Conditions of all readings of a run.
struct TakerOptions {
    std::optional<std::uint64_t> noise_seed = {};  ///< empty: no noise
    double celsius = 20;                           ///< of the air, for the speed of sound
    /// Sensors move from job to job: their beams are rotated as a whole; see Beams.
    bool follows_poses = false;
    /// Required for cameras; null: no cameras. It outlives the sampler.
    const Photographer* photographer = nullptr;
    MoverVelocities velocities = {};  ///< of the movers whose bodies sensors meet
    /// Results that the readings of some moments share; null: each reading computes its own.
    std::shared_ptr<SharedResults> shared = {};
};

/// The mean motion of a carried sensor over the time since its last reading.
struct MeanMotion {
    double turn = 0;         ///< radians a second
    Vec2 acceleration = {};  ///< m/s^2, in the axes of the room at the end
};

/// Each kind that is read all at once has a function `VALUE readingOf(const KIND&, const Moment&)`.
struct Moment {
    const Sensor& sensor;
    const Pose3& pose;
    int frame = 0;
    double time = 0;  ///< seconds
    const RayScenes& worlds;
    const MovingBodies& bodies;
    std::span<const Sensor> receivers;
    const TakerOptions& options;
    /// In a run, of a carried sensor of a kind that integrates.
    std::optional<MeanMotion> mean = {};

    /// Returns the surfaces that stop the sensor's rays. \pre they are prepared
    [[nodiscard]] const RayWorld& mesh() const {
        return worlds.mesh(kindOf(sensor.model).stopped_by);
    }
    /// Returns the key of the noise of this reading, or of one part of it. \pre there is a seed
    [[nodiscard]] RandomKey noiseKey(std::uint64_t part = 0) const {
        return {*options.noise_seed, Purpose::Range, hashOf(sensor.id) ^ mixedBits(part),
                static_cast<std::uint64_t>(frame)};
    }
};

}  // namespace ispace
