// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers by key and index: no generator has a state, so any thread draws any part of any
// sequence, in any order, and gets the same bits; a sensor that is added changes no other's noise.
//
//     std::array<float, 181> noise;
//     draw({seed, Purpose::Range, hashOf("front"), frame}, 0, {.normal = noise});
//
// Method: ten rounds of Philox4x32 (J. K. Salmon et al., Parallel random numbers: as easy as 1, 2,
// 3, 2011), tested against Random123's known answers; normals by G. E. P. Box, M. E. Muller, A note
// on the generation of random normal deviates, 1958. The bits are part of our formats: they are the
// same on every processor, compiler and vector width. Not for secrets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "base/simd.h"

namespace ispace {

/// Purpose of random numbers; sequences of different purposes are independent.
enum class Purpose : std::uint32_t {
    Range = 1,
    Ultrasound = 2,
    Placement = 3,
    Candidates = 4,
    Light = 5,
    Picture = 6,
    Wander = 7,
    Motion = 8,
    Odometry = 9,
    Start = 10,
    Mounting = 11,
    Crowd = 12,
    Storeys = 13
};

/// A 64-bit hash of an id (FNV-1a by G. Fowler, L. C. Noll, K.-P. Vo), the same on every machine.
/// One multiplication a byte; collisions of ids are as likely as of random numbers, but easy to
/// make.
std::uint64_t hashOf(std::string_view id);

/// Mixes all bits, one to one (SplitMix64; Steele et al., Fast Splittable Pseudorandom Number
/// Generators, 2014), to compute hashes of numbers; the same on every machine.
constexpr std::uint64_t mixedBits(std::uint64_t bits) {
    bits += 0x9e3779b97f4a7c15U;
    bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
    bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
    return bits ^ (bits >> 31U);
}

/// Key of a sequence of random numbers. Element k depends on the key and k alone, so any thread may
/// draw any part of it. A sequence has 2^32 elements. Keys that differ in any bit give independent
/// sequences, except that the upper halves of seed and sensor share 32 bits.
struct RandomKey {
    std::uint64_t seed = 0;
    Purpose purpose = Purpose::Range;
    std::uint64_t sensor = 0;  ///< hashOf its id
    std::uint64_t frame = 0;   ///< below 2^56
};

/// Elements first, first + 1, ... of a sequence. All arrays have one size; unwanted ones are empty.
struct RandomDraws {
    std::span<float> normal = {};   ///< N(0, 1), within ±6.7
    std::span<float> other = {};    ///< N(0, 1), independent of it
    std::span<float> uniform = {};  ///< in [0, 1), multiples of 2^-24, independent of both
};
/// Computes the elements; those of unwanted arrays change no other. Thread-safe, without
/// allocation.
void draw(const RandomKey& key, std::uint32_t first, const RandomDraws& draws);

}  // namespace ispace

/// The loops of draw(), compiled once for each kind of processor.
namespace ispace::random_loops {

/// Elements held in memory at a time.
constexpr std::size_t kBlock = 256;
/// Elements whose rounds run together.
constexpr std::size_t kGroup = 64;

/// The part of Philox' input that all elements of a sequence share; word 0 of its counter holds the
/// element.
struct Philox {
    std::uint32_t counter1 = 0, counter2 = 0, counter3 = 0;
    std::uint32_t key0 = 0, key1 = 0;
};

/// Three of the four random words of each element.
struct Words {
    alignas(64) std::array<std::uint32_t, kBlock> a, b, c;
};

/// Destinations of the draws of a block; null if unwanted.
struct Targets {
    float* normal = nullptr;
    float* other = nullptr;
    float* uniform = nullptr;
};

/// Computes Philox4x32-10 of elements first .. first + kGroup - 1: three words of each.
using GroupFunction = void (*)(const Philox& philox, std::uint32_t first, std::uint32_t* a,
                               std::uint32_t* b, std::uint32_t* c);
/// Functions that this processor can run, fastest first, plain C++ last. All compute the same
/// words.
std::span<const GroupFunction> groupFunctions();

/// Draws elements first .. first + count - 1, their words from `compute`. \pre count <= kBlock
///
/// Normals are computed by the method of Box and Muller: the root of -2 ln u in the direction of a
/// random angle.
ISPACE_INLINE void drawBlock(const Philox& philox, std::uint32_t first, std::size_t count,
                             const Targets& targets, GroupFunction compute) {
    Words words;  // NOLINT: computed as far as it is read
    for (std::size_t k = 0; k < count; k += kGroup) {
        compute(philox, first + static_cast<std::uint32_t>(k), &words.a[k], &words.b[k],
                &words.c[k]);
    }
    if (float* __restrict uniform = targets.uniform; uniform != nullptr) {
        for (std::size_t k = 0; k < count; ++k) {
            uniform[k] = static_cast<float>(static_cast<std::int32_t>(words.c[k] >> 8U)) * 0x1p-24F;
        }
    }
    float* __restrict normal = targets.normal;
    float* __restrict other = targets.other;
    if (normal == nullptr && other == nullptr) return;
    alignas(64) std::array<float, kBlock> radius;  // NOLINT: computed as far as it is read
    for (std::size_t k = 0; k < count; ++k) {
        // In [2^-32, 1], with 31 bits even for small values, which determine the tails.
        const float u =
            (static_cast<float>(static_cast<std::int32_t>(words.a[k] >> 1U)) + 0.5F) * 0x1p-31F;
        radius[k] = simd::squareRoot(-2.0F * simd::logarithm(u));
    }
    if (normal != nullptr) {
        for (std::size_t k = 0; k < count; ++k) {
            normal[k] = radius[k] * simd::sineOfTurn(words.b[k] + 0x40000000U);
        }
    }
    if (other != nullptr) {
        for (std::size_t k = 0; k < count; ++k) {
            other[k] = radius[k] * simd::sineOfTurn(words.b[k]);
        }
    }
}

}  // namespace ispace::random_loops
