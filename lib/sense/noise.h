// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "base/random.h"
#include "sensor/noise.h"

namespace ispace {

/// What keeps the noise of one reading apart from that of any other.
struct NoiseKey {
    std::uint64_t seed = 0;
    std::uint64_t sensor = 0;  ///< hashOf its id
    std::uint64_t frame = 0;   ///< of a sweep: frame * scans + number of the scan
    Purpose purpose = Purpose::Range;
};

/// What a device says of true ranges: one outside [min_range, max_range] (ends included, both as
/// float32) is no return, as are infinity and what is not a number, whatever the noise; to all
/// others noise is added: bias and spread, drop-out, resolution, in this order. What is measured
/// beyond a limit then is told as that limit. Vectorised; the same values for any processor.
/// Element k draws element k of the key's sequence (its `normal` and `uniform`; `other` is that of
/// bearingErrors), whatever the other elements are.
///
/// A return is lost with probability p = d + (1 - d) g: d is noise.dropout; g rises in proportion
/// to the angle between beam and normal from 0 at graze_from to 1 at graze_to, or jumps there if
/// both are the same. p counts in steps of 2^-24. A multiple of the resolution is the float32
/// nearest to n * resolution: the one that its decimal notation reads as. \param cosines |cosine|
/// between beam and normal of each, empty unless noise.dropsByIncidence()
void addNoise(const RangeNoise& noise, double min_range, double max_range, const NoiseKey& key,
              std::span<const float> cosines, std::span<float> ranges);

/// How far each bearing is off, in radians: N(0, angle_sigma).
void bearingErrors(const RangeNoise& noise, const NoiseKey& key, std::span<float> radians);

}  // namespace ispace
