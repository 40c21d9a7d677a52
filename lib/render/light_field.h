// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "geom/point.h"
#include "render/render.h"

namespace ispace {

/// A place on a surface and the direction it faces, in float32.
struct FacingPlace {
    std::array<float, 3> place{}, normal{};

    FacingPlace(Point3 at, Vec3 facing)
        : place{static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)},
          normal{static_cast<float>(facing.x), static_cast<float>(facing.y),
                 static_cast<float>(facing.z)} {}
};

/// The light on what the pixels' centres show, plane by plane. Pixels may be set by any threads.
class LightField {
  public:
    LightField() = default;
    LightField(int columns, int rows);

    /// \param depth not below 0
    void setPlace(std::size_t pixel, const FacingPlace& surface, float depth);
    void setLight(std::size_t pixel, const Rgb& direct, const Rgb& bounced);

    /// Once all pixels are set. Shadows of lamps are smoothed within a tile, what surfaces throw
    /// back over several; never across edges.
    void smooth();

    /// True if the surface that the pixel shows goes on at another place: that then has the same
    /// light.
    [[nodiscard]] bool reaches(std::size_t pixel, const FacingPlace& to) const {
        if (depth_[pixel] < 0) return false;
        float cosine = 0, height = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            cosine += normal_[k][pixel] * to.normal[k];
            height += normal_[k][pixel] * (to.place[k] - place_[k][pixel]);
        }
        return cosine > kSameFacing && std::fabs(height) < heightOfOne(depth_[pixel]);
    }
    /// The least cosine between normals of one surface, and how far off its plane it goes on.
    static constexpr float kSameFacing = 0.9F;
    static constexpr float heightOfOne(float depth) { return 0.003F + 0.002F * depth; }
    /// \pre smooth() was called
    [[nodiscard]] Rgb light(std::size_t pixel) const {
        return {light_[0][pixel] + light_[3][pixel], light_[1][pixel] + light_[4][pixel],
                light_[2][pixel] + light_[5][pixel]};
    }

  private:
    using Plane = std::vector<float>;
    /// Direct light of three colours, then what surfaces throw back.
    using LightPlanes = std::array<Plane, 6>;

    template <std::size_t kFirst>
    void smoothRow(const LightPlanes& from, LightPlanes& to, int row, int step) const;

    int columns_ = 0, rows_ = 0;
    std::array<Plane, 3> place_, normal_;
    Plane depth_;  ///< below 0: there is nothing
    LightPlanes light_;
};

}  // namespace ispace
