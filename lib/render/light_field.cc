// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/light_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdlib>

#include "base/simd.h"
#include "trace/embree_query.h"

namespace ispace {

namespace {

/// Pixels of a row that are smoothed together.
constexpr int kBlock = 64;

/// What the pixels of a block show, and what those show that lie some way aside.
struct Block {
    std::array<const float*, 3> place{}, normal{};
    const float* depth = nullptr;
};

template <std::size_t kPlanes>
struct Sums {
    alignas(64) std::array<std::array<float, kBlock>, kPlanes> light{};
    alignas(64) std::array<float, kBlock> whole{};
};

/// Adds the light aside to `count` pixels of a block, from its pixel `begin` on, where both show
/// one surface.
template <std::size_t kPlanes>
ISPACE_INLINE void addAside(const Block& here, const Block& aside,
                            const std::array<const float*, kPlanes>& light, std::size_t begin,
                            std::size_t count, float weight, Sums<kPlanes>& sums) {
    alignas(64) std::array<float, kBlock> share;
    const auto [x, y, z] = here.place;
    const auto [nx, ny, nz] = here.normal;
    const auto [other_x, other_y, other_z] = aside.place;
    const auto [other_nx, other_ny, other_nz] = aside.normal;
    for (std::size_t i = 0; i < count; ++i) {
        const float cosine = nx[i] * other_nx[i] + ny[i] * other_ny[i] + nz[i] * other_nz[i];
        const float height =
            nx[i] * (other_x[i] - x[i]) + ny[i] * (other_y[i] - y[i]) + nz[i] * (other_z[i] - z[i]);
        const float most = LightField::heightOfOne(here.depth[i]);
        const bool is_one = (aside.depth[i] >= 0) & (cosine > LightField::kSameFacing) &
                            (height < most) & (height > -most);
        share[i] = simd::choose(is_one, weight, 0);
    }
    float* const whole = sums.whole.data() + begin;
    for (std::size_t i = 0; i < count; ++i) whole[i] += share[i];
    for (std::size_t k = 0; k < kPlanes; ++k) {
        const float* const from = light[k];
        float* const to = sums.light[k].data() + begin;
        for (std::size_t i = 0; i < count; ++i) to[i] += share[i] * from[i];
    }
}

ISPACE_SIMD_CLONES void addAll(const Block& here, const Block& aside,
                               const std::array<const float*, 6>& light, std::size_t begin,
                               std::size_t count, float weight, Sums<6>& sums) {
    addAside(here, aside, light, begin, count, weight, sums);
}

ISPACE_SIMD_CLONES void addBounced(const Block& here, const Block& aside,
                                   const std::array<const float*, 3>& light, std::size_t begin,
                                   std::size_t count, float weight, Sums<3>& sums) {
    addAside(here, aside, light, begin, count, weight, sums);
}

ISPACE_SIMD_CLONES void divide(float* values, const float* by, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) values[i] /= by[i];
}

}  // namespace

LightField::LightField(int columns, int rows) : columns_(columns), rows_(rows) {
    const std::size_t pixels = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    for (std::size_t k = 0; k < 3; ++k) {
        place_[k].resize(pixels);
        normal_[k].resize(pixels);
    }
    depth_.resize(pixels, -1);
    for (Plane& plane : light_) plane.resize(pixels);
}

void LightField::setPlace(std::size_t pixel, const FacingPlace& surface, float depth) {
    for (std::size_t k = 0; k < 3; ++k) {
        place_[k][pixel] = surface.place[k];
        normal_[k][pixel] = surface.normal[k];
    }
    depth_[pixel] = depth;
}

void LightField::setLight(std::size_t pixel, const Rgb& direct, const Rgb& bounced) {
    for (std::size_t k = 0; k < 3; ++k) {
        light_[k][pixel] = direct[k];
        light_[k + 3][pixel] = bounced[k];
    }
}

/// The mean of what lies `step` and two steps aside, the outermost for half, so that each point of
/// a tile's net counts the same (Keller and Heidrich, Interleaved Sampling, 2001), and then each
/// tile about (Dammertz et al., Edge-Avoiding A-Trous Wavelet Transform, 2010).
template <std::size_t kFirst>
void LightField::smoothRow(const LightPlanes& from, LightPlanes& to, int row, int step) const {
    constexpr std::size_t kPlanes = 6 - kFirst;
    const auto at = [this](int column, int line) {
        return static_cast<std::size_t>(line) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column);
    };
    const auto block = [this](std::size_t first) {
        Block out;
        for (std::size_t k = 0; k < 3; ++k) {
            out.place[k] = place_[k].data() + first;
            out.normal[k] = normal_[k].data() + first;
        }
        out.depth = depth_.data() + first;
        return out;
    };
    for (int column = 0; column < columns_; column += kBlock) {
        Sums<kPlanes> sums;
        const int count = std::min(kBlock, columns_ - column);
        for (int j = -2; j <= 2; ++j) {
            const int line = row + step * j;
            if (line < 0 || line >= rows_) continue;
            for (int i = -2; i <= 2; ++i) {
                // Beyond the picture's edges there is nothing.
                const int first = std::max(column, -step * i);
                const int end = std::min(column + count, columns_ - step * i);
                if (first >= end) continue;
                const std::size_t aside = at(first + step * i, line);
                std::array<const float*, kPlanes> light;
                for (std::size_t k = 0; k < kPlanes; ++k)
                    light[k] = from[kFirst + k].data() + aside;
                const float weight =
                    (std::abs(i) == 2 ? 0.5F : 1.0F) * (std::abs(j) == 2 ? 0.5F : 1.0F);
                const auto add = [&](auto one) {
                    one(block(at(first, row)), block(aside), light,
                        static_cast<std::size_t>(first - column),
                        static_cast<std::size_t>(end - first), weight, sums);
                };
                if constexpr (kFirst == 0)
                    add(addAll);
                else
                    add(addBounced);
            }
        }
        const std::size_t begin = at(column, row);
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
            if (depth_[begin + i] < 0) sums.whole[i] = 1;
        for (std::size_t k = 0; k < kPlanes; ++k) {
            divide(sums.light[k].data(), sums.whole.data(), static_cast<std::size_t>(count));
            std::copy_n(sums.light[k].data(), count, to[kFirst + k].data() + begin);
        }
    }
}

void LightField::smooth() {
    LightPlanes near;
    for (Plane& plane : near) plane.resize(depth_.size());
    tbb::parallel_for(0, rows_, [&](int row) { smoothRow<0>(light_, near, row, 1); });
    std::swap(light_, near);
    // Direct light stays as it is by now.
    tbb::parallel_for(0, rows_, [&](int row) { smoothRow<3>(light_, near, row, kTile); });
    for (std::size_t k = 3; k < 6; ++k) std::swap(light_[k], near[k]);
}

}  // namespace ispace
