// SPDX-License-Identifier: GPL-3.0-or-later
// The errors of measured ranges, as RangeNoise describes them, in float32. A draw belongs to seed,
// sensor, frame and number of the beam: a sensor that is added changes the noise of no other, and a
// reading can be taken again. Thread-safe for different ranges; O(ranges), of which blocks without
// return are skipped.
//
//     const NoiseKey key{.seed = 1, .sensor = hashOf("front"), .frame = 7};
//     addNoise(laser.noise, laser.min_range, laser.max_range, key, {}, ranges);
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/random.h"
#include "base/simd.h"
#include "scene/sensor/sensor_keys.h"
#include "trace/rays.h"

namespace ispace {

/// Identifies the noise of one reading.
struct NoiseKey {
    std::uint64_t seed = 0;
    std::uint64_t sensor = 0;  ///< hashOf of its id
    std::uint64_t frame = 0;   ///< of a sweep: frame * scans + number of the scan
    Purpose purpose = Purpose::Range;
};

/// Converts true ranges to measured ones. A true range outside [min_range, max_range] (ends
/// included, both as float32), infinity and NaN become no return. All others get bias and spread,
/// drop-out and resolution, in this order; results are clamped to the limits. Vectorised, with
/// equal values on any processor. Element k draws element k of the key's sequence (its `normal` and
/// `uniform`; `other` belongs to bearingErrors), independent of the other elements.
///
/// A return is lost with probability p = d + (1 - d) g: d is noise.dropout; g rises linearly with
/// the angle between beam and normal from 0 at graze_from to 1 at graze_to, or jumps there if both
/// are equal. p is rounded to steps of 2^-24. A multiple of the resolution is the float32 nearest
/// to n * resolution, the value that its decimal notation reads as.
/// \param cosines cosine of the angle between beam and normal for each range, empty unless
///        noise.dropsByIncidence()
void addNoise(const RangeNoise& noise, double min_range, double max_range, const NoiseKey& key,
              std::span<const float> cosines, std::span<float> ranges);

/// Computes the error of each bearing in radians: N(0, angle_sigma).
void bearingErrors(const RangeNoise& noise, const NoiseKey& key, std::span<float> radians);

}  // namespace ispace

/// The loops of addNoise(), compiled for several processors.
namespace ispace::noise_loops {

/// A device's parameters in the form that the loops read.
struct Parameters {
    float bias = 0;
    std::array<float, 3> sigma{0, 0, 0};
    float dropout = 0;
    /// Of incidence: start of the ramp, its slope (0: a step), and the cosine at its end.
    float graze_from = 0, graze_slope = 0, graze_cosine = 0;
    double resolution = 0, per_metre = 0;  // per_metre is its inverse
    float min_range = 0, max_range = 0;
};

/// Adds bias and spread. `normal` null: no spread.
ISPACE_INLINE void spread(const Parameters& parameters, std::size_t count, const float* normal,
                          float* __restrict ranges) {
    const float bias = parameters.bias;
    if (normal == nullptr) {
        for (std::size_t k = 0; k < count; ++k) ranges[k] += bias;
        return;
    }
    const auto [s0, s1, s2] = parameters.sigma;
    for (std::size_t k = 0; k < count; ++k) {
        const float r = ranges[k];
        const float sigma = s0 + r * (s1 + r * s2);
        const float measured = r + (bias + 0.5F * (sigma + std::fabs(sigma)) * normal[k]);
        // The spread of infinity may be NaN.
        ranges[k] = simd::choose(r < kNoReturn, measured, kNoReturn);
    }
}

/// Removes lost returns. `cosines` null: incidence is ignored.
ISPACE_INLINE void drop(const Parameters& parameters, std::size_t count, const float* cosines,
                        const float* uniform, float* __restrict ranges) {
    const float dropout = parameters.dropout;
    if (cosines == nullptr) {
        for (std::size_t k = 0; k < count; ++k) {
            ranges[k] = simd::choose(uniform[k] < dropout, kNoReturn, ranges[k]);
        }
        return;
    }
    const float kept = 1.0F - dropout;
    const float from = parameters.graze_from;
    const float slope = parameters.graze_slope;
    const float end = parameters.graze_cosine;
    for (std::size_t k = 0; k < count; ++k) {
        // Rounding may make a cosine exceed 1.
        const float cosine = simd::choose(cosines[k] < 1.0F, cosines[k], 1.0F);
        const float ramp = (simd::arcCosine(cosine) - from) * slope;
        const float share = simd::choose(ramp > 0, ramp, 0.0F);
        const float lost = simd::choose(cosine <= end, 1.0F, dropout + kept * share);
        ranges[k] = simd::choose(uniform[k] < lost, kNoReturn, ranges[k]);
    }
}

ISPACE_INLINE void quantise(const Parameters& parameters, std::size_t count,
                            float* __restrict ranges) {
    // Adding and subtracting this number rounds to an integer; values too large for it stay
    // unchanged up to double rounding.
    constexpr double kRounder = 0x1.8p52;
    const double resolution = parameters.resolution;
    const double per_metre = parameters.per_metre;
    for (std::size_t k = 0; k < count; ++k) {
        const double n = static_cast<double>(ranges[k]) * per_metre;
        const double rounded = (n + kRounder) - kRounder;
        ranges[k] = static_cast<float>(rounded * resolution);
    }
}

/// Converts ranges outside the limits and NaN to no return.
ISPACE_INLINE void limit(const Parameters& parameters, std::size_t count,
                         float* __restrict ranges) {
    const float low = parameters.min_range;
    const float high = parameters.max_range;
    for (std::size_t k = 0; k < count; ++k) {
        const float r = ranges[k];
        const float not_low = simd::choose(r >= low, r, kNoReturn);
        ranges[k] = simd::choose(r <= high, not_low, kNoReturn);
    }
}

/// Clamps noisy returns to the limits.
ISPACE_INLINE void keepInRange(const Parameters& parameters, std::size_t count,
                               float* __restrict ranges) {
    const float low = parameters.min_range;
    const float high = parameters.max_range;
    for (std::size_t k = 0; k < count; ++k) {
        const float r = ranges[k];
        const float not_low = simd::choose(r > low, r, low);
        const float within = simd::choose(not_low < high, not_low, high);
        ranges[k] = simd::choose(r < kNoReturn, within, kNoReturn);
    }
}

/// Applies all noise to a block of ranges after limit(); unneeded arrays are null.
ISPACE_INLINE void apply(const Parameters& parameters, std::size_t count, const float* normal,
                         const float* uniform, const float* cosines, float* ranges) {
    const bool moves = normal != nullptr || parameters.bias != 0;
    if (moves) spread(parameters, count, normal, ranges);
    if (uniform != nullptr) drop(parameters, count, cosines, uniform, ranges);
    if (parameters.resolution > 0) quantise(parameters, count, ranges);
    if (moves || parameters.resolution > 0) keepInRange(parameters, count, ranges);
}

}  // namespace ispace::noise_loops
