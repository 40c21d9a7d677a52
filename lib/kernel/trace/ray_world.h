// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/trace: rays against static surfaces and moving bodies. Uses scene and below; Embree
// inside.
//
// Level rays meet the lines of the plan, exact up to rounding (flat_world.h), 2 to 8 times as fast
// as triangles; all others meet triangles, found in float32 and computed in doubles
// (embree_scene.h). Moving bodies shorten ranges afterwards (moving_bodies.h).
//
//     const RayWorld world = RayWorld::ofLevel(environment, 0.3, nullptr);
//     Directions beams;
//     beams.resize(2);
//     beams.set(0, {1, 0, 0});
//     beams.set(1, {0, 1, 0});
//     std::array<float, 2> ranges;
//     world.cast({2, 1, 0.3}, beams, 8, ranges);  // metres; +infinity without return
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <shared_mutex>
#include <span>
#include <utility>

#include "base/parallel.h"
#include "env/environment.h"
#include "env/mesh.h"
#include "geom/point.h"
#include "geom/visibility/visibility.h"  // kRayEpsilon
#include "trace/rays.h"

namespace ispace {

/// Rays against a slice (a FlatWorld) or against the whole mesh (an EmbreeScene).
///
/// Surfaces are closed sets without thickness. Rays ignore surfaces seen exactly edge-on (within
/// the rounding of float32 in the mesh), surfaces within kRayEpsilon of their origin, and coplanar
/// continuations of these: a sensor drawn on a wall sees out of it on both sides and along it. Rays
/// cannot slip between touching surfaces. Ranges are computed in doubles, and round bodies are met
/// on their exact curves. Coordinates are stored relative to the middle of the plan, so that
/// float32, in which the mesh is searched, is exact to micrometres in any building. Thread-safe
/// once built; results do not depend on the number of threads.
class RayWorld {
  public:
    /// Builds a world for level rays that start in the slice; their z is ignored. O(n log n) in
    /// lines.
    static RayWorld ofSlice(const Slice& slice);
    /// Builds the world of the environment's slice at this height.
    /// \param before such a world of the same height: its tree is copied and updated if few
    /// elements
    ///        changed since it was built; may be null
    static RayWorld ofLevel(const Environment& environment, double height, const RayWorld* before);
    /// Builds a world for rays of any direction, against these surfaces of all bodies and the
    /// floor. Opaque surfaces stop light, which passes clear glass.
    /// \param packet_width rays Embree traces together: 1, 4, 8, 16, or 0 for the processor's best;
    ///        see cast() for how it may affect results
    /// O(n log n) in triangles: 2.7 s for 1 840 rooms.
    /// \throws std::runtime_error if Embree fails, std::bad_alloc if it is out of memory
    static RayWorld ofEnvironment(const Environment& environment,
                                  Surfaces surfaces = Surfaces::Opaque, int packet_width = 0);
    RayWorld(RayWorld&&) noexcept;
    RayWorld& operator=(RayWorld&&) noexcept;
    ~RayWorld();

    /// Computes the distance to the first surface along each direction, up to max_range inclusive;
    /// +infinity without return. Fastest for neighbouring directions, and in a slice for directions
    /// with an arc. Packet width and the grouping of rays do not matter, except for rays of the
    /// mesh that pass an edge within the resolution of float32: see EmbreeScene for the accuracy of
    /// a range. In a slice ranges are exact up to rounding of doubles. `cosines`, if not empty:
    /// |cosine| of the angle between ray and surface normal, 1 without return. \pre ranges.size()
    /// == directions.size(), cosines.size() as well or 0
    void cast(Point3 origin, const Directions& directions, double max_range,
              std::span<float> ranges, std::span<float> cosines = {}) const;
    /// The same with an origin for each ray.
    void cast(std::span<const Point3> origins, const Directions& directions, double max_range,
              std::span<float> ranges, std::span<float> cosines = {}) const;
    /// The same for the rays of a picture, row by row, as multiples of each ray's vector up to
    /// `most` inclusive. Traced in square tiles. \pre not of a slice
    void cast(Point3 origin, const RayGrid& grid, double most, std::span<float> multiples,
              std::span<float> cosines = {}) const;

    /// Sets seen[i] to 1 if the way from the origin to target i is free, apart from its last
    /// kRayEpsilon metres. Fastest if nearby targets are adjacent in the list.
    /// \pre not of a slice; seen.size() == targets.size()
    void query(Point3 origin, std::span<const Point3> targets, std::span<std::uint8_t> seen) const;

  private:
    struct Data;
    explicit RayWorld(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

/// A room joined with those around it, and its mesh for rays of light, which is built when it is
/// first required. Thread-safe.
class SurroundedRoom {
  public:
    explicit SurroundedRoom(Environment environment) : environment_(std::move(environment)) {}
    [[nodiscard]] const Environment& environment() const { return environment_; }
    /// \throws as RayWorld::ofEnvironment()
    [[nodiscard]] const RayWorld& mesh() const {
        return mesh_.get([this] { return RayWorld::ofEnvironment(environment_); });
    }

  private:
    Environment environment_;
    Lazy<RayWorld> mesh_;
};

/// The ray worlds of one environment: one slice per height for level sensors, the mesh for all
/// others, with and without clear glass.
///
/// One thread prepares worlds for coming poses; any thread may call at() for prepared poses, also
/// meanwhile. Worlds keep their address.
class RayScenes {
  public:
    /// Maximum number of slices. Level poses at further heights, in the order of prepare(), are
    /// traced in the mesh.
    static constexpr std::size_t kMaxSlices = 64;

    /// Prepared meshes.
    struct Meshes {
        bool opaque = false, solid = false;
    };

    /// \param around the same room with those around it, which light meets, in level slices, too;
    ///        null: the room alone. Sound is that of the room
    explicit RayScenes(const Environment& environment,
                       std::shared_ptr<const SurroundedRoom> around = nullptr);
    /// \param before worlds of another environment, which may share its data; see ofLevel()
    void prepare(const Pose3& pose, const RayScenes* before = nullptr);
    /// Builds the mesh for sensors that look in all directions: surfaces that stop light, or
    /// (Solid) sound.
    void prepareMesh(Surfaces surfaces = Surfaces::Opaque);
    /// Returns the slice of a level pose's height if there is one, else the mesh.
    /// \pre it was prepared: the slice by prepare() for a pose of this height, the mesh by
    /// prepareMesh() or by prepare() for a pose that is not level or beyond kMaxSlices
    [[nodiscard]] const RayWorld& at(const Pose3& pose) const;
    /// Returns the mesh for light, or (Solid) for sound, which clear glass stops.
    /// \pre it was prepared, see at()
    [[nodiscard]] const RayWorld& mesh(Surfaces surfaces = Surfaces::Opaque) const;
    [[nodiscard]] const Environment& environment() const { return *environment_; }
    /// Prepared meshes, as known to the preparing thread.
    [[nodiscard]] Meshes meshes() const {
        return {mesh_.has_value() || is_around_prepared_, solid_.has_value()};
    }

  private:
    /// Returns the slice of a height, or null.
    [[nodiscard]] const RayWorld* sliceAt(double height) const;
    /// True if these surfaces may stop other rays than the opaque ones.
    [[nodiscard]] bool hearsMore(Surfaces surfaces) const {
        return (has_clear_ || around_ != nullptr) && surfaces == Surfaces::Solid;
    }

    const Environment* environment_;
    std::shared_ptr<const SurroundedRoom> around_;
    mutable std::shared_mutex mutex_;  // guards the members below; only prepare() adds to them
    std::map<double, RayWorld> slices_;
    std::optional<RayWorld> mesh_;
    std::optional<RayWorld> solid_;  // if it differs from mesh_
    bool has_clear_;
    bool is_around_prepared_ = false;
};

}  // namespace ispace
