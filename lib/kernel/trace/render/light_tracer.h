// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/kernel/trace/render: light at surface points, sixteen at a time.
//
// Monte Carlo over lamps (or the sun) and one direction of bounced light a sample. The sixteen
// pixels of a tile take the sixteen points of one net (I. M. Sobol, On the distribution of points
// in a cube, 1967), shuffled so that neighbours lie far apart (A. Keller, W. Heidrich, Interleaved
// sampling, 2001): the mean over any 4 x 4 pixels is that of a stratified sample, which
// LightField::smooth() takes. Light in float32: noise is far above rounding.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "trace/embree_query.h"
#include "trace/render/lights.h"
#include "trace/render/render_scene.h"

namespace ispace {

/// Sixteen points on surfaces, relative to the middle of the plan, and their light.
struct alignas(64) LitPlaces {
    using Lanes = std::array<float, kLanes>;

    std::array<bool, kLanes> is_wanted{};
    Lanes x{}, y{}, z{};                       ///< slightly above the surface
    Lanes normal_x{}, normal_y{}, normal_z{};  ///< unit, towards the viewer
    /// Radiance of a white surface there, by lamps or the sun, and by all other light.
    std::array<Rgb, kLanes> direct{}, bounced{};

    void set(std::size_t lane, Point3 place, Vec3 normal, double lift);
};

/// Uniform random numbers per light sample of a point.
constexpr std::size_t kLightDraws = 5;

/// Computes the light at surface points; one instance per thread.
class LightTracer {
  public:
    /// \param light not Auto
    LightTracer(const RenderScene::Data& scene, Illumination light, int samples);

    [[nodiscard]] int samples() const { return samples_; }
    /// Computes the light. Lanes stand for the pixels of a tile of 4 x 4, whose samples are points
    /// of one net: the mean over any such square has little noise.
    /// `draws` holds kLightDraws numbers for each sample of each lane.
    void gather(LitPlaces& places, std::span<const float> draws);

  private:
    struct Choice;
    void towardsLamps(const LitPlaces& places, std::span<const float> draws, int sample);
    void towardsSun(const LitPlaces& places, std::span<const float> draws, int sample);
    void addDirect(LitPlaces& places);
    void addBounced(LitPlaces& places, std::span<const float> draws, int sample);
    [[nodiscard]] Rgb bounced(std::size_t lane) const;
    void aimShadow(std::size_t lane, const LitPlaces& places, float x, float y, float z, float far);

    const RenderScene::Data& scene_;
    Illumination light_;
    int samples_;
    alignas(64) RTCRay16 shadows_{};
    alignas(64) RTCRayHit16 hits_{};
    alignas(64) std::array<int, kLanes> valid_{};
    std::array<Rgb, kLanes> strength_{};  ///< light at the end of each shadow ray
};

}  // namespace ispace
