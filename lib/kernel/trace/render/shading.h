// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/kernel/trace/render: lines of sight in tiles of 4 x 4 pixels, the surfaces they
// meet, and their colours. Depths are computed in doubles as those of EmbreeScene, and do not
// depend on tiles, samples or threads. One tracer per thread; Shading is const and shared.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "trace/embree_query.h"
#include "trace/render/render_scene.h"

namespace ispace {

/// Lines of sight of the pixels of a tile and of those about it, row by row.
struct SurroundedTile {
    static constexpr int kSide = kTile + 2;
    using Pixels = std::array<double, std::size_t{kSide} * kSide>;

    alignas(64) Pixels x{}, y{}, z{};  ///< directions
    Pixels origin_x{}, origin_y{}, origin_z{};

    void set(std::size_t pixel, const PixelRay& line) {
        x[pixel] = line.direction.x;
        y[pixel] = line.direction.y;
        z[pixel] = line.direction.z;
        origin_x[pixel] = line.origin.x;
        origin_y[pixel] = line.origin.y;
        origin_z[pixel] = line.origin.z;
    }
};

/// A square tile of a picture's lines of sight, relative to the middle of the plan, and their hits:
/// `multiples` are depths.
struct RayTile : RayPacket {
    std::array<bool, kLanes> is_black{};
    std::array<std::uint32_t, kLanes> triangle{};
    std::array<SurfaceKind, kLanes> kind{};
    bool has_new_origins = true;   ///< changed since the last trace
    bool is_one_triangle = false;  ///< hit by all lanes that are not black

    RayTile() {
        reach.fill(kMaxRayReach);
        origin_x.fill(std::numeric_limits<double>::quiet_NaN());
    }
    void set(std::size_t lane, const PixelRay& line, Vec3 shift);
    /// Sets the lines of sight of a tile with the first pixel `first`; may exceed the picture.
    void set(const EvenPixelRays& lines, PixelPoint first, Vec3 shift);
    /// Sets the lines of sight at a fraction of a pixel beside the centres, by interpolation.
    void set(const SurroundedTile& lines, PixelPoint at, Vec3 shift);
    [[nodiscard]] Vec3 direction(std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
    [[nodiscard]] Point3 origin(std::size_t lane) const {
        return {origin_x[lane], origin_y[lane], origin_z[lane]};
    }
    [[nodiscard]] double depth(std::size_t lane) const {
        return static_cast<double>(multiples[lane]);
    }
    [[nodiscard]] bool meets(std::size_t lane) const { return multiples[lane] < kNoReturn; }
    /// \pre the lane has a hit
    [[nodiscard]] Point3 place(std::size_t lane) const {
        return origin(lane) + depth(lane) * direction(lane);
    }
};

/// Sample positions in a pixel, all different in either direction: edges along rows and columns
/// have as many shades as there are samples (Hammersley's points by their ranks, so that their mean
/// is the centre).
std::vector<PixelPoint> placesInPixel(int count);

/// Traces the lines of sight of a picture; one instance per thread.
class TileTracer {
  public:
    /// \param hidden for each label, whether its bodies are invisible; may be shorter
    TileTracer(const RenderScene::Data& scene, const std::vector<bool>& hidden, double min_depth);

    void trace(RayTile& tile);

  private:
    /// Computes the depth of a lane's hit by the exact test.
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

/// A surface at the hit of a line of sight.
struct SurfacePoint {
    Point3 place;        ///< relative to the middle of the plan
    Vec3 normal;         ///< unit, towards the viewer
    Rgb color{};         ///< reflected share of white light
    Rgb glow{};          ///< emitted light
    float haze = 0;      ///< share hidden by haze
    double lift = 1e-4;  ///< offset of secondary rays above the surface
};

/// The triangle that a thread met last: most pixels show that of the pixel before.
struct Facet {
    SurfaceKind kind{};
    std::uint32_t triangle = ~0U;
    bool is_plain = false;  ///< flat, in one colour: `point` holds but for the place
    SurfacePoint point;
};

/// Computes colours of surfaces and of clear layers before them.
class Shading {
  public:
    /// \param light not Auto
    Shading(const RenderScene::Data& scene, Illumination light, const RenderOptions& options);

    /// True if the lane meets an opaque surface, else it shows background. Lanes that look down
    /// past all surfaces see the ground around the building.
    [[nodiscard]] bool meetsSurface(const RayTile& tile, std::size_t lane) const;
    /// \pre meetsSurface
    [[nodiscard]] SurfacePoint surface(const RayTile& tile, std::size_t lane, Facet& last) const;
    /// Returns the background colour of a lane without a surface.
    [[nodiscard]] Rgb background(const RayTile& tile, std::size_t lane) const;
    /// Returns the colour of a surface in this light.
    [[nodiscard]] Rgb lit(const SurfacePoint& point, const Rgb& light) const;

  private:
    [[nodiscard]] SurfacePoint met(const RayTile& tile, std::size_t lane) const;
    [[nodiscard]] bool isPlain(SurfaceKind kind, std::uint32_t triangle) const;
    [[nodiscard]] SurfacePoint ground(const RayTile& tile, std::size_t lane) const;
    [[nodiscard]] Vec3 normalAt(const RayTile& tile, std::size_t lane, Point3 place) const;

    const RenderScene::Data& scene_;
    Illumination light_;
    const RenderOptions& options_;
    double far_;  ///< distance at which the haze over the ground becomes thick
};

/// A clear layer before a surface.
struct ClearLayer {
    float depth;
    Rgb light{};   ///< light that it adds
    Rgb passes{};  ///< share of the light behind it that it transmits
    bool is_lit;   ///< `light` is a colour, lit by the light behind it
};

/// Finds the clear layers before the surfaces of a tile; one instance per thread.
class ClearTracer {
  public:
    ClearTracer(const RenderScene::Data& scene, double min_depth);

    /// True if the scene has no clear surfaces.
    [[nodiscard]] bool isIdle() const { return sets_.empty(); }
    /// Returns the layers of each lane, nearest first.
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
