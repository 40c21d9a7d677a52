// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <shared_mutex>

#include "trace/ray_world.h"

namespace ispace {

/// The ray worlds of one environment: one slice per height for level sensors, the mesh for all
/// others.
///
/// One thread prepares, for every pose that is to come; any thread asks at() for poses that were
/// prepared, also while others are. A world stays where it is until the end.
class Worlds {
  public:
    /// A stream of poses may have any number of heights. Level poses at heights beyond these, in
    /// the order of prepare(), are traced in the mesh.
    static constexpr std::size_t kMostSlices = 64;

    explicit Worlds(const Environment& environment) : environment_(&environment) {}
    void prepare(const Pose3& pose);
    /// For sensors that look in all directions.
    void prepareMesh();
    /// \pre prepare() was called for a pose of this height and levelness
    [[nodiscard]] const RayWorld& at(const Pose3& pose) const;
    /// \pre prepareMesh() was called, or prepare() for a pose that is not level
    [[nodiscard]] const RayWorld& mesh() const;

  private:
    const Environment* environment_;
    mutable std::shared_mutex mutex_;  // of what follows; only prepare() adds to it
    std::map<double, RayWorld> slices_;
    std::optional<RayWorld> mesh_;
};

}  // namespace ispace
