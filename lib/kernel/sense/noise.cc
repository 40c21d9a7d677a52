// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/noise.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>

#include "base/simd.h"

namespace ispace {

namespace {

using noise_loops::Parameters;

/// Number of elements processed together; a multiple of the block size of random numbers.
constexpr std::size_t kBlock = 512;
/// Number of elements that are skipped together if they have no return.
constexpr std::size_t kPart = 64;

ISPACE_SIMD_CLONES void disturb(const Parameters& parameters, std::size_t count,
                                const float* normal, const float* uniform, const float* cosines,
                                float* ranges) {
    noise_loops::apply(parameters, count, normal, uniform, cosines, ranges);
}

ISPACE_INLINE std::uint32_t limitPart(const Parameters& parameters, std::size_t count,
                                      float* ranges) {
    noise_loops::limit(parameters, count, ranges);
    std::uint32_t any = 0;
    for (std::size_t k = 0; k < count; ++k) any |= ranges[k] < kNoReturn ? 1U : 0U;
    return any;
}

/// Converts ranges outside the limits to no return.
/// \return a bit for each part of kPart ranges that has a return
ISPACE_SIMD_CLONES std::uint32_t partsWithReturns(const Parameters& parameters, std::size_t count,
                                                  float* ranges) {
    std::uint32_t parts = 0;
    std::size_t begin = 0;
    for (; begin + kPart <= count; begin += kPart)
        parts |= limitPart(parameters, kPart, ranges + begin) << (begin / kPart);
    if (begin < count)
        parts |= limitPart(parameters, count - begin, ranges + begin) << (begin / kPart);
    return parts;
}

Parameters parametersOf(const RangeNoise& noise, double min_range, double max_range) {
    Parameters parameters;
    parameters.bias = static_cast<float>(noise.bias);
    std::transform(noise.sigma.begin(), noise.sigma.end(), parameters.sigma.begin(),
                   [](double s) { return static_cast<float>(s); });
    parameters.dropout = static_cast<float>(noise.dropout);
    parameters.graze_from = static_cast<float>(noise.graze_from.radians());
    if (const Angle ramp = noise.graze_to - noise.graze_from; ramp > Angle())
        parameters.graze_slope = static_cast<float>(1 / ramp.radians());
    parameters.graze_cosine = static_cast<float>(cos(noise.graze_to));
    // Steps far below those of a float have no effect, and cannot be counted exactly.
    if (noise.resolution > 1e-12) {
        parameters.resolution = noise.resolution;
        parameters.per_metre = 1 / noise.resolution;
    }
    parameters.min_range = static_cast<float>(min_range);
    parameters.max_range = static_cast<float>(max_range);
    return parameters;
}

RandomKey randomKey(const NoiseKey& key) {
    return {.seed = key.seed, .purpose = key.purpose, .sensor = key.sensor, .frame = key.frame};
}

}  // namespace

void addNoise(const RangeNoise& noise, double min_range, double max_range, const NoiseKey& key,
              std::span<const float> cosines, std::span<float> ranges) {
    const bool grazes = noise.dropsByIncidence();
    assert(!grazes || cosines.size() == ranges.size());
    const bool spreads = noise.sigma != std::array<double, 3>{0, 0, 0};
    const bool drops = grazes || noise.dropout > 0;
    const Parameters parameters = parametersOf(noise, min_range, max_range);
    const RandomKey random = randomKey(key);
    alignas(64) std::array<float, kBlock> normal;   // NOLINT: drawn if needed
    alignas(64) std::array<float, kBlock> uniform;  // NOLINT
    const auto disturb_part = [&](std::size_t first, std::size_t count) {
        RandomDraws draws;
        if (spreads) draws.normal = std::span(normal).first(count);
        if (drops) draws.uniform = std::span(uniform).first(count);
        draw(random, static_cast<std::uint32_t>(first), draws);
        disturb(parameters, count, spreads ? normal.data() : nullptr,
                drops ? uniform.data() : nullptr, grazes ? cosines.data() + first : nullptr,
                ranges.data() + first);
    };
    for (std::size_t k = 0; k < ranges.size(); k += kBlock) {
        const std::size_t count = std::min(kBlock, ranges.size() - k);
        std::uint32_t parts = partsWithReturns(parameters, count, ranges.data() + k);
        // Adjacent parts are processed together.
        while (parts != 0) {
            const auto begin = static_cast<std::size_t>(std::countr_zero(parts));
            const auto end = begin + static_cast<std::size_t>(std::countr_one(parts >> begin));
            parts &= ~0U << end;
            disturb_part(k + begin * kPart, std::min(count, end * kPart) - begin * kPart);
        }
    }
}

void bearingErrors(const RangeNoise& noise, const NoiseKey& key, std::span<float> radians) {
    const auto sigma = static_cast<float>(noise.angle_sigma.radians());
    if (!(sigma > 0)) {
        std::fill(radians.begin(), radians.end(), 0.0F);
        return;
    }
    draw(randomKey(key), 0, {.other = radians});
    for (float& error : radians) error *= sigma;
}

}  // namespace ispace
