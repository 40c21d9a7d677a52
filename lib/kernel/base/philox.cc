// SPDX-License-Identifier: GPL-3.0-or-later
// Computes Philox' rounds. Compilers turn plain code into 64-bit multiplications; processors have a
// faster instruction that multiplies the lower halves of 64-bit lanes. Words are therefore stored
// in the lower halves, and the upper halves are ignored.
#include <array>
#include <span>

#include "base/random.h"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12
#define ISPACE_PHILOX_LANES
// GCC 12 warns of values that its own header deliberately leaves uninitialised.
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <immintrin.h>
#endif

namespace ispace::random_loops {

namespace {

using Word = std::uint32_t;

constexpr Word kMultiplier0 = 0xD2511F53U, kMultiplier1 = 0xCD9E8D57U;
constexpr Word kWeyl0 = 0x9E3779B9U, kWeyl1 = 0xBB67AE85U;
constexpr int kRounds = 10;

void computePlainly(const Philox& philox, Word first, Word* a, Word* b, Word* c) {
    std::array<Word, kGroup> x0, x1, x2, x3;  // NOLINT: set in the loop
    for (Word i = 0; i < kGroup; ++i) {
        x0[i] = first + i;
        x1[i] = philox.counter1;
        x2[i] = philox.counter2;
        x3[i] = philox.counter3;
    }
    Word key0 = philox.key0, key1 = philox.key1;
    for (int round = 0; round < kRounds; ++round) {
        for (std::size_t i = 0; i < kGroup; ++i) {
            const std::uint64_t p0 = std::uint64_t{kMultiplier0} * x0[i];
            const std::uint64_t p1 = std::uint64_t{kMultiplier1} * x2[i];
            x0[i] = static_cast<Word>(p1 >> 32U) ^ x1[i] ^ key0;
            x2[i] = static_cast<Word>(p0 >> 32U) ^ x3[i] ^ key1;
            x1[i] = static_cast<Word>(p1);
            x3[i] = static_cast<Word>(p0);
        }
        key0 += kWeyl0;
        key1 += kWeyl1;
    }
    for (std::size_t i = 0; i < kGroup; ++i) {
        a[i] = x0[i];
        b[i] = x1[i];
        c[i] = x2[i];
    }
}

#ifdef ISPACE_PHILOX_LANES

/// The lower halves of the lanes.
__attribute__((target("arch=x86-64-v4"))) inline void storeWords(Word* to, __m512i lanes) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm512_cvtepi64_epi32(lanes));
}

/// Computes `kVectors` vectors of 8 elements at once: about as many as there are registers.
__attribute__((target("arch=x86-64-v4"))) void computeIn512(const Philox& philox, Word first,
                                                            Word* a, Word* b, Word* c) {
    constexpr std::size_t kLanes = 8, kVectors = kGroup / kLanes;
    const __m512i times0 = _mm512_set1_epi64(kMultiplier0);
    const __m512i times1 = _mm512_set1_epi64(kMultiplier1);
    const __m512i steps = _mm512_set_epi64(7, 6, 5, 4, 3, 2, 1, 0);
    __m512i x0[kVectors], x1[kVectors], x2[kVectors], x3[kVectors];
#pragma GCC unroll 8
    for (std::size_t k = 0; k < kVectors; ++k) {
        const Word begin = first + static_cast<Word>(kLanes * k);
        x0[k] = _mm512_add_epi64(_mm512_set1_epi64(begin), steps);
        x1[k] = _mm512_set1_epi64(philox.counter1);
        x2[k] = _mm512_set1_epi64(philox.counter2);
        x3[k] = _mm512_set1_epi64(philox.counter3);
    }
    constexpr int kExclusiveOr = 0x96;  // truth table of a ^ b ^ c
    Word key0 = philox.key0, key1 = philox.key1;
#pragma GCC unroll 10
    for (int round = 0; round < kRounds; ++round) {
        const __m512i keys0 = _mm512_set1_epi64(key0), keys1 = _mm512_set1_epi64(key1);
#pragma GCC unroll 8
        for (std::size_t k = 0; k < kVectors; ++k) {
            const __m512i p0 = _mm512_mul_epu32(x0[k], times0);
            const __m512i p1 = _mm512_mul_epu32(x2[k], times1);
            x0[k] =
                _mm512_ternarylogic_epi64(_mm512_srli_epi64(p1, 32), x1[k], keys0, kExclusiveOr);
            x2[k] =
                _mm512_ternarylogic_epi64(_mm512_srli_epi64(p0, 32), x3[k], keys1, kExclusiveOr);
            x1[k] = p1;
            x3[k] = p0;
        }
        key0 += kWeyl0;
        key1 += kWeyl1;
    }
#pragma GCC unroll 8
    for (std::size_t k = 0; k < kVectors; ++k) {
        storeWords(a + kLanes * k, x0[k]);
        storeWords(b + kLanes * k, x1[k]);
        storeWords(c + kLanes * k, x2[k]);
    }
}

__attribute__((target("arch=x86-64-v3"))) inline void storeWords(Word* to, __m256i lanes) {
    const __m256i order = _mm256_set_epi32(7, 5, 3, 1, 6, 4, 2, 0);
    const __m256i packed = _mm256_permutevar8x32_epi32(lanes, order);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm256_castsi256_si128(packed));
}

/// Computes vectors of 4 elements, with half of the registers.
__attribute__((target("arch=x86-64-v3"))) void computeIn256(const Philox& philox, Word first,
                                                            Word* a, Word* b, Word* c) {
    constexpr std::size_t kLanes = 4, kVectors = 2;
    const __m256i times0 = _mm256_set1_epi64x(kMultiplier0);
    const __m256i times1 = _mm256_set1_epi64x(kMultiplier1);
    const __m256i steps = _mm256_set_epi64x(3, 2, 1, 0);
    for (std::size_t at = 0; at < kGroup; at += kLanes * kVectors) {
        __m256i x0[kVectors], x1[kVectors], x2[kVectors], x3[kVectors];
        for (std::size_t k = 0; k < kVectors; ++k) {
            const Word begin = first + static_cast<Word>(at + kLanes * k);
            x0[k] = _mm256_add_epi64(_mm256_set1_epi64x(begin), steps);
            x1[k] = _mm256_set1_epi64x(philox.counter1);
            x2[k] = _mm256_set1_epi64x(philox.counter2);
            x3[k] = _mm256_set1_epi64x(philox.counter3);
        }
        Word key0 = philox.key0, key1 = philox.key1;
        for (int round = 0; round < kRounds; ++round) {
            const __m256i keys0 = _mm256_set1_epi64x(key0), keys1 = _mm256_set1_epi64x(key1);
#pragma GCC unroll 2
            for (std::size_t k = 0; k < kVectors; ++k) {
                const __m256i p0 = _mm256_mul_epu32(x0[k], times0);
                const __m256i p1 = _mm256_mul_epu32(x2[k], times1);
                x0[k] = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(p1, 32), x1[k]), keys0);
                x2[k] = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(p0, 32), x3[k]), keys1);
                x1[k] = p1;
                x3[k] = p0;
            }
            key0 += kWeyl0;
            key1 += kWeyl1;
        }
        for (std::size_t k = 0; k < kVectors; ++k) {
            storeWords(a + at + kLanes * k, x0[k]);
            storeWords(b + at + kLanes * k, x1[k]);
            storeWords(c + at + kLanes * k, x2[k]);
        }
    }
}

#endif

/// Fastest first.
constexpr GroupFunction kFunctions[] = {
#ifdef ISPACE_PHILOX_LANES
    computeIn512, computeIn256,
#endif
    computePlainly};

}  // namespace

std::span<const GroupFunction> groupFunctions() {
    const std::span<const GroupFunction> all(kFunctions);
#ifdef ISPACE_PHILOX_LANES
    if (__builtin_cpu_supports("x86-64-v4") != 0) return all;
    return all.subspan(__builtin_cpu_supports("x86-64-v3") != 0 ? 1 : 2);
#else
    return all;
#endif
}

}  // namespace ispace::random_loops
