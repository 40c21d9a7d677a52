// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "env/environment.h"
#include "render/render.h"

namespace ispace {

/// Square panels that shine downwards, evenly spread over each part of the indoor region.
class Lamps {
  public:
    struct Lamp {
        float x = 0, y = 0;  ///< of its middle, relative to the middle of the plan
        float strength = 0;  ///< what a white surface one metre below it shines with
    };
    /// Half the side of a panel, metres.
    static constexpr float kHalf = 0.35F;

    Lamps() = default;
    Lamps(const Environment& environment, Vec3 shift);

    [[nodiscard]] std::span<const Lamp> all() const { return lamps_; }
    [[nodiscard]] float height() const { return height_; }
    /// Those that matter at a place, as indices; and how far one does: light fades out there.
    [[nodiscard]] std::span<const std::uint32_t> near(float x, float y) const;
    [[nodiscard]] float reach() const { return reach_; }
    /// True for places on a panel, seen from below.
    [[nodiscard]] bool shinesAt(float x, float y) const;

  private:
    [[nodiscard]] std::size_t cellOf(float x, float y) const;
    void index();

    std::vector<Lamp> lamps_;
    float height_ = 0, reach_ = 0;
    // Cells of a grid over the plan, each with the lamps that reach it.
    float left_ = 0, bottom_ = 0, cell_ = 1;
    std::size_t columns_ = 1, rows_ = 1;
    std::vector<std::uint32_t> first_ = {0, 0}, near_;
};

/// Sun and sky as a clear afternoon has them.
struct Sky {
    static constexpr float kSunHeight = 0.72F;  ///< sine of its elevation
    /// Unit vector to the sun.
    static Vec3 sun();
    /// What a white surface that faces it shines with, of the sun alone.
    static constexpr Rgb kSunlight{0.95F, 0.90F, 0.80F};
    /// Tangent of half the angle under which the sun is seen: more than it is, for softer shadows.
    static constexpr float kSunRadius = 0.025F;
    /// Radiance of a direction as light.
    static Rgb light(float up);
    /// The same as one sees it; below the horizon, the haze over the ground.
    static Rgb seen(float up);
};

/// What lies about a building.
constexpr Rgb kGround{0.30F, 0.31F, 0.27F};

}  // namespace ispace
