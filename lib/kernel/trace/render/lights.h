// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/trace/render: lamps, sky, and the light of a picture before it is smoothed.
//
// Radiance is relative: 1 is a white surface in the light of the whole room. Light is smoothed by
// an edge-avoiding a-trous filter (H. Dammertz et al., Edge-avoiding a-trous wavelet transform for
// fast global illumination filtering, 2010) over pixels of one surface: normals within acos 0.9,
// heights within 3 mm and 0.2 % of the depth.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "env/environment.h"
#include "geom/point.h"
#include "trace/render/render.h"

namespace ispace {

/// Square panels that shine downwards: those of the `lamp` records that are on, or without such
/// records panels evenly distributed over each part of the indoor region.
class Lamps {
  public:
    struct Lamp {
        float x = 0, y = 0;  ///< centre, relative to the middle of the plan
        float strength = 0;  ///< radiance of a white surface one metre below it
        Rgb color{1, 1, 0.97F};
        float cosine = 1, sine = 0;  ///< of the heading of two of its sides
    };
    /// Half the side of a panel, metres.
    static constexpr float kHalf = 0.35F;

    Lamps() = default;
    Lamps(const Environment& environment, Vec3 shift);

    [[nodiscard]] std::span<const Lamp> all() const { return lamps_; }
    /// Returns true if the environment has `lamp` records, on or off.
    [[nodiscard]] bool areRecords() const { return are_records_; }
    [[nodiscard]] float height() const { return height_; }
    /// Returns the height of all lamps of an environment: below the ceiling.
    static double heightIn(const Environment& environment);
    /// Returns the indices of the lamps that reach a point. Light fades out at their maximum
    /// distance.
    [[nodiscard]] std::span<const std::uint32_t> near(float x, float y) const;
    [[nodiscard]] float reach() const { return reach_; }
    /// True for points on a panel, seen from below.
    [[nodiscard]] bool shinesAt(float x, float y) const;

  private:
    [[nodiscard]] std::size_t cellOf(float x, float y) const;
    void addRecords(const Environment& environment, Vec3 shift, double spacing);
    void index();

    std::vector<Lamp> lamps_;
    float height_ = 0, reach_ = 0;
    bool are_records_ = false;
    // Cells of a grid over the plan, each with the lamps that reach it.
    float left_ = 0, bottom_ = 0, cell_ = 1;
    std::size_t columns_ = 1, rows_ = 1;
    std::vector<std::uint32_t> first_ = {0, 0}, near_;
};

/// Sun and sky of a clear afternoon.
struct Sky {
    static constexpr float kSunHeight = 0.72F;  ///< sine of its elevation
    /// Returns the unit vector to the sun.
    static Vec3 sun();
    /// Radiance of a white surface that faces the sun, by the sun alone.
    static constexpr Rgb kSunlight{0.95F, 0.90F, 0.80F};
    /// Tangent of half the sun's apparent angle: enlarged for softer shadows.
    static constexpr float kSunRadius = 0.025F;
    /// Computes the radiance of a direction as a light source.
    static Rgb light(float up);
    /// Computes its visible colour; below the horizon, the haze over the ground.
    static Rgb seen(float up);
};

/// Colour of the ground around a building.
constexpr Rgb kGround{0.30F, 0.31F, 0.27F};

/// A point on a surface and its normal, in float32.
struct FacingPlace {
    std::array<float, 3> place{}, normal{};

    FacingPlace(Point3 at, Vec3 facing)
        : place{static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)},
          normal{static_cast<float>(facing.x), static_cast<float>(facing.y),
                 static_cast<float>(facing.z)} {}
};

/// The light at the pixels' centres, in one plane per component. Threads may set pixels
/// concurrently.
class LightField {
  public:
    /// Prepares for a picture; keeps the memory of the last one.
    void reset(int columns, int rows);

    /// \param depth not below 0
    void setPlace(std::size_t pixel, const FacingPlace& surface, float depth);
    void setLight(std::size_t pixel, const Rgb& direct, const Rgb& bounced);

    /// Call once all pixels are set. Smooths lamp shadows within a tile and bounced light over
    /// several tiles; never across edges.
    void smooth();

    /// True if the pixel's surface continues at another point, which then has the same light.
    [[nodiscard]] bool reaches(std::size_t pixel, const FacingPlace& to) const {
        if (depth_[pixel] < 0) return false;
        float cosine = 0, height = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            cosine += normal_[k][pixel] * to.normal[k];
            height += normal_[k][pixel] * (to.place[k] - place_[k][pixel]);
        }
        return cosine > kSameFacing && std::fabs(height) < heightOfOne(depth_[pixel]);
    }
    /// Minimum cosine between normals of one surface, and maximum distance from its plane.
    static constexpr float kSameFacing = 0.9F;
    static constexpr float heightOfOne(float depth) { return 0.003F + 0.002F * depth; }
    /// \pre smooth() was called
    [[nodiscard]] Rgb light(std::size_t pixel) const {
        return {light_[0][pixel] + light_[3][pixel], light_[1][pixel] + light_[4][pixel],
                light_[2][pixel] + light_[5][pixel]};
    }

  private:
    using Plane = std::vector<float>;
    /// Direct light of three colours, then bounced light.
    using LightPlanes = std::array<Plane, 6>;

    [[nodiscard]] bool hasSurface(int row, int column, int count) const;
    template <std::size_t kFirst>
    void smoothRow(const LightPlanes& from, LightPlanes& to, int row, int step) const;

    int columns_ = 0, rows_ = 0;
    std::array<Plane, 3> place_, normal_;
    Plane depth_;  ///< below 0: no surface
    /// Arbitrary, but finite, where there is no surface.
    LightPlanes light_, smoothed_;
};

}  // namespace ispace
