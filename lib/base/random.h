// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace ispace {

/// What random numbers are for: those of different purposes are independent.
enum class Purpose : std::uint32_t { Range = 1, Ultrasound = 2, Placement = 3, Candidates = 4 };

/// A 64-bit hash of an id (FNV-1a), the same on every machine.
std::uint64_t hashOf(std::string_view id);

/// Mixes all bits, one to one (SplitMix64; Steele et al., Fast Splittable Pseudorandom Number
/// Generators, 2014): for hashes of numbers, the same on every machine.
constexpr std::uint64_t mixedBits(std::uint64_t bits) {
    bits += 0x9e3779b97f4a7c15U;
    bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
    bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
    return bits ^ (bits >> 31U);
}

/// Names a sequence of random numbers. Element k depends on the key and on k alone, so that any
/// thread may draw any part of it (Philox4x32-10; Salmon et al., Parallel Random Numbers: As Easy
/// as 1, 2, 3, 2011).
struct RandomKey {
    std::uint64_t seed = 0;
    Purpose purpose = Purpose::Range;
    std::uint64_t sensor = 0;  ///< hashOf its id
    std::uint64_t frame = 0;   ///< below 2^56
};

/// Elements first, first + 1, ... of a sequence; the arrays are of one size, or empty if not
/// wanted.
struct RandomDraws {
    std::span<float> normal = {};   ///< N(0, 1)
    std::span<float> other = {};    ///< N(0, 1), independent of it
    std::span<float> uniform = {};  ///< in [0, 1), independent of both
};
void draw(const RandomKey& key, std::uint32_t first, const RandomDraws& draws);

}  // namespace ispace
