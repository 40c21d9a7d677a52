// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/scene_data.h"
#include "render/sight_tracer.h"

namespace ispace {

/// A surface where a line of sight meets it.
struct SurfacePoint {
    Point3 place;        ///< relative to the middle of the plan
    Vec3 normal;         ///< unit, towards the viewer
    Rgb color{};         ///< what it throws back of white light
    Rgb glow{};          ///< its own light
    float haze = 0;      ///< how much of it the distance hides
    double lift = 1e-4;  ///< rays that leave it begin this far above it
};

/// Colours of surfaces, and of what lies between them and the viewer.
class Shading {
  public:
    /// \param light not Auto
    Shading(const RenderScene::Data& scene, Illumination light, const RenderOptions& options);

    /// What the lane shows behind everything clear: a surface, or nothing but background. Lanes
    /// that look down at nothing see the ground about the building.
    [[nodiscard]] bool meetsSurface(const SightTile& tile, std::size_t lane) const;
    /// \pre meetsSurface
    [[nodiscard]] SurfacePoint surface(const SightTile& tile, std::size_t lane) const;
    /// What a lane shows that meets no surface.
    [[nodiscard]] Rgb background(const SightTile& tile, std::size_t lane) const;
    /// What a surface in this light looks like.
    [[nodiscard]] Rgb lit(const SurfacePoint& point, const Rgb& light) const;

  private:
    [[nodiscard]] SurfacePoint met(const SightTile& tile, std::size_t lane) const;
    [[nodiscard]] SurfacePoint ground(const SightTile& tile, std::size_t lane) const;
    [[nodiscard]] Vec3 normalAt(const SightTile& tile, std::size_t lane, Point3 place) const;

    const RenderScene::Data& scene_;
    Illumination light_;
    const RenderOptions& options_;
    double far_;  ///< where the haze over the ground becomes thick
};

/// Something clear before a surface.
struct ClearLayer {
    float depth;
    Rgb light{};   ///< what it adds
    Rgb passes{};  ///< what share of the light from behind it lets through
    bool is_lit;   ///< `light` is a colour, in the light of what is behind it
};

/// Finds the clear layers before the surfaces of a tile; one for each thread.
class ClearTracer {
  public:
    ClearTracer(const RenderScene::Data& scene, double min_depth);

    /// True if nothing in the scene is clear.
    [[nodiscard]] bool isIdle() const { return sets_.empty(); }
    /// Layers of each lane, nearest first.
    const std::array<std::vector<ClearLayer>, kLanes>& trace(const SightTile& tile);

  private:
    void add(SurfaceKind kind, std::size_t lane, std::uint32_t triangle, float depth);
    struct Query;

    const RenderScene::Data& scene_;
    std::vector<SurfaceKind> sets_;
    alignas(64) RTCRayHit16 hits_{};
    std::array<std::vector<ClearLayer>, kLanes> layers_;
};

}  // namespace ispace
