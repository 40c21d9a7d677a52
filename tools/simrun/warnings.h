// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <optional>

#include "cli/common_options.h"
#include "layout/scene.h"
#include "sim/replay.h"
#include "sim/simulation.h"
#include "sim/world.h"

namespace ispace {

/// Says on stderr what robots run into, up to a number of lines that nobody reads beyond.
class CollisionLog {
  public:
    CollisionLog(const World& world, const CommonOptions& options)
        : world_(&world), options_(&options) {}
    /// Tells the collisions of the world's last step.
    void tell();

  private:
    const World* world_;
    const CommonOptions* options_;
    int count_ = 0;
};

/// Says on stderr when a run by the clock Real falls behind it, and when it keeps up again.
class LagLog {
  public:
    LagLog(const Simulation& simulation, const CommonOptions& options)
        : simulation_(&simulation), options_(&options) {}
    /// Looks at the clock after a step.
    void tell();

  private:
    const Simulation* simulation_;
    const CommonOptions* options_;
    std::chrono::nanoseconds lost_{};             // as last seen
    std::chrono::steady_clock::time_point last_;  // when some was lost
    bool is_behind_ = false;
    int count_ = 0;  // of times it fell behind
};

/// Says so if no sensor has noise, nor a robot that moves by itself.
void warnOfNoNoise(const Scene& scene, bool moves, const CommonOptions& options);

/// Says once what change of a recorded run cannot be made again.
class FailureLog {
  public:
    FailureLog(const std::optional<Replay>& replay, const CommonOptions& options)
        : replay_(replay ? &*replay : nullptr), options_(&options) {}
    void tell();

  private:
    const Replay* replay_;
    const CommonOptions* options_;
    bool is_told_ = false;
};

/// Says that a run changed its world, of which the picture shows the start.
void warnOfChanges(const Replay& replay, const CommonOptions& options);

}  // namespace ispace
