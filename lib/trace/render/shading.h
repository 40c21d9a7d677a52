// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "trace/embree_query.h"
#include "trace/render/render_scene.h"

namespace ispace {

/// A square tile of a picture's lines of sight, relative to the middle of the plan, and what they
/// meet: `multiples` are depths.
struct RayTile : RayPacket {
    std::array<bool, kLanes> is_black{};
    std::array<std::uint32_t, kLanes> triangle{};
    std::array<SurfaceKind, kLanes> kind{};
    bool has_new_origins = true;   ///< since it was traced last
    bool is_one_triangle = false;  ///< that all lanes meet, but for black ones

    RayTile() {
        reach.fill(kMaxRayReach);
        origin_x.fill(std::numeric_limits<double>::quiet_NaN());
    }
    void set(std::size_t lane, const PixelRay& line, Vec3 shift);
    /// Those of the places from `first` on, also beyond the picture.
    void set(const EvenSightLines& lines, PixelPoint first, Vec3 shift);
    [[nodiscard]] Vec3 direction(std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
    [[nodiscard]] Point3 origin(std::size_t lane) const {
        return {origin_x[lane], origin_y[lane], origin_z[lane]};
    }
    [[nodiscard]] double depth(std::size_t lane) const {
        return static_cast<double>(multiples[lane]);
    }
    [[nodiscard]] bool meets(std::size_t lane) const { return multiples[lane] < kNoReturn; }
    /// \pre it meets something
    [[nodiscard]] Point3 place(std::size_t lane) const {
        return origin(lane) + depth(lane) * direction(lane);
    }
};

/// Places in a pixel that lie apart in either direction: edges along rows and columns have as many
/// shades as there are samples (Hammersley's points by their ranks, so that their mean is the
/// centre).
std::vector<PixelPoint> placesInPixel(int count);

/// Finds what a picture's lines of sight meet; one for each thread.
class TileTracer {
  public:
    /// `hidden`: for each label, whether its bodies are not seen; may be shorter.
    TileTracer(const RenderScene::Data& scene, const std::vector<bool>& hidden, double min_depth);

    void trace(RayTile& tile);

  private:
    /// The depth of what a lane's ray has hit, with care.
    [[nodiscard]] double resolve(const RayTile& tile, std::size_t lane) const;

    const RenderScene::Data& scene_;
    const std::vector<bool>& hidden_;
    std::size_t width_;
    EmbreeQuery query_;
    BodyQuery people_;
    double min_depth_;
    alignas(64) RTCRayHit16 hits_{};
    alignas(64) std::array<int, kLanes> valid_{};
    alignas(64) std::array<float, kLanes> far_{};
};

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
    [[nodiscard]] bool meetsSurface(const RayTile& tile, std::size_t lane) const;
    /// \pre meetsSurface
    [[nodiscard]] SurfacePoint surface(const RayTile& tile, std::size_t lane) const;
    /// What a lane shows that meets no surface.
    [[nodiscard]] Rgb background(const RayTile& tile, std::size_t lane) const;
    /// What a surface in this light looks like.
    [[nodiscard]] Rgb lit(const SurfacePoint& point, const Rgb& light) const;

  private:
    [[nodiscard]] SurfacePoint met(const RayTile& tile, std::size_t lane) const;
    [[nodiscard]] SurfacePoint ground(const RayTile& tile, std::size_t lane) const;
    [[nodiscard]] Vec3 normalAt(const RayTile& tile, std::size_t lane, Point3 place) const;

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
    const std::array<std::vector<ClearLayer>, kLanes>& trace(const RayTile& tile);

  private:
    void add(SurfaceKind kind, std::size_t lane, std::uint32_t triangle, float depth);
    struct Query;

    const RenderScene::Data& scene_;
    std::vector<SurfaceKind> sets_;
    alignas(64) RTCRayHit16 hits_{};
    std::array<std::vector<ClearLayer>, kLanes> layers_;
};

}  // namespace ispace
