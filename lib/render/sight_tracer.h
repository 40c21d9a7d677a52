// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/scene_data.h"
#include "trace/embree_query.h"

namespace ispace {

/// A square tile of a picture's lines of sight, in doubles, and what they meet.
struct alignas(64) SightTile {
    using Lanes = std::array<double, kLanes>;

    Lanes x, y, z;                       ///< of the directions
    Lanes origin_x, origin_y, origin_z;  ///< relative to the middle of the plan
    std::array<bool, kLanes> is_black{};
    Lanes depth;  ///< to the surface met, +infinity without one
    std::array<std::uint32_t, kLanes> triangle;
    std::array<SurfaceKind, kLanes> kind;

    void set(std::size_t lane, const SightLine& line, Vec3 shift);
    [[nodiscard]] Vec3 direction(std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
    [[nodiscard]] Point3 origin(std::size_t lane) const {
        return {origin_x[lane], origin_y[lane], origin_z[lane]};
    }
    /// \pre depth is finite
    [[nodiscard]] Point3 place(std::size_t lane) const {
        return origin(lane) + depth[lane] * direction(lane);
    }
    [[nodiscard]] bool meets(std::size_t lane) const { return depth[lane] < kFarthest; }
};

/// Finds what a picture's lines of sight meet; one for each thread.
class SightTracer {
  public:
    /// `hidden`: for each label, whether its bodies are not seen; may be shorter.
    SightTracer(const RenderScene::Data& scene, const std::vector<bool>& hidden, double min_depth);

    void trace(SightTile& tile);

  private:
    void resolve(SightTile& tile) const;

    const RenderScene::Data& scene_;
    const std::vector<bool>& hidden_;
    std::size_t width_;
    alignas(64) RTCRayHit16 hits_{};
    alignas(64) std::array<int, kLanes> valid_{};
};

}  // namespace ispace
