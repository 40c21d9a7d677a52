// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "render/scene_data.h"
#include "trace/embree_query.h"

namespace ispace {

/// A square tile of a picture's lines of sight, relative to the middle of the plan, and what they
/// meet: `multiples` are depths.
struct SightTile : RayPacket {
    std::array<bool, kLanes> is_black{};
    std::array<std::uint32_t, kLanes> triangle{};
    std::array<SurfaceKind, kLanes> kind{};
    bool has_new_origins = true;   ///< since it was traced last
    bool is_one_triangle = false;  ///< that all lanes meet, but for black ones

    SightTile() {
        reach.fill(kFarthest);
        origin_x.fill(std::numeric_limits<double>::quiet_NaN());
    }
    void set(std::size_t lane, const SightLine& line, Vec3 shift);
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
class SightTracer {
  public:
    /// `hidden`: for each label, whether its bodies are not seen; may be shorter.
    SightTracer(const RenderScene::Data& scene, const std::vector<bool>& hidden, double min_depth);

    void trace(SightTile& tile);

  private:
    /// The depth of what a lane's ray has hit, with care.
    [[nodiscard]] double resolve(const SightTile& tile, std::size_t lane) const;

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

}  // namespace ispace
