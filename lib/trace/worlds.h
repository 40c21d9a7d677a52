// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "trace/ray_world.h"

namespace ispace {

/// The ray worlds of one environment, made on first use: one slice per height for level sensors,
/// the mesh for all others. Not thread-safe while a world is made: call prepare() for every pose
/// first, then at() from any thread.
class Worlds {
  public:
    explicit Worlds(const Environment& environment) : environment_(&environment) {}
    void prepare(const Pose3& pose);
    /// \pre prepare() was called for a pose of this height and levelness
    [[nodiscard]] const RayWorld& at(const Pose3& pose) const;

  private:
    const Environment* environment_;
    std::map<double, RayWorld> slices_;
    std::optional<RayWorld> mesh_;
};

}  // namespace ispace
