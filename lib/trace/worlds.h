// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <shared_mutex>

#include "trace/ray_world.h"

namespace ispace {

/// The ray worlds of one environment: one slice per height for level sensors, the mesh for all
/// others, with and without clear glass.
///
/// One thread prepares, for the poses that are to come; any thread asks at() for poses that were
/// prepared, also while others are. A world stays where it is until the end.
class Worlds {
  public:
    /// A stream of poses may have any number of heights. Level poses at heights beyond these, in
    /// the order of prepare(), are traced in the mesh.
    static constexpr std::size_t kMaxSlices = 64;

    /// Which meshes there are.
    struct Meshes {
        bool opaque = false, solid = false;
    };

    explicit Worlds(const Environment& environment);
    void prepare(const Pose3& pose);
    /// For sensors that look in all directions: what stops light, or (Solid) sound.
    void prepareMesh(Surfaces surfaces = Surfaces::Opaque);
    /// The slice of a level pose's height if one is kept, else the mesh.
    /// \pre one of them was prepared: the slice by prepare() for a pose of this height, the mesh by
    ///      prepareMesh() or by prepare() for a pose that is not level or beyond kMaxSlices
    [[nodiscard]] const RayWorld& at(const Pose3& pose) const;
    /// The mesh as light meets it, or (Solid) sound, which clear glass stops.
    /// \pre it was prepared, see at()
    [[nodiscard]] const RayWorld& mesh(Surfaces surfaces = Surfaces::Opaque) const;
    /// Those prepared so far, as the thread that prepares knows it.
    [[nodiscard]] Meshes meshes() const { return {mesh_.has_value(), solid_.has_value()}; }

  private:
    /// True where these surfaces stop more than opaque ones do.
    [[nodiscard]] bool hearsMore(Surfaces surfaces) const {
        return has_clear_ && surfaces == Surfaces::Solid;
    }

    const Environment* environment_;
    mutable std::shared_mutex mutex_;  // of what follows; only prepare() adds to it
    std::map<double, RayWorld> slices_;
    std::optional<RayWorld> mesh_;
    std::optional<RayWorld> solid_;  // where it is not the same as mesh_
    bool has_clear_;
};

}  // namespace ispace
