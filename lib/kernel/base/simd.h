// SPDX-License-Identifier: GPL-3.0-or-later
// Vector code without intrinsics: loops that the compiler vectorises for each generation of the
// processor, and elementary functions for them. Results are the same bits on every processor, in
// vectors of any width, since the tree is compiled without contraction to fused operations.
//
//     ISPACE_SIMD_CLONES void rootsOf(float* values, std::size_t count) {
//         for (std::size_t i = 0; i < count; ++i) values[i] = simd::squareRoot(values[i]);
//     }
#pragma once

#include <bit>
#include <cstddef>  // defines __GLIBC__
#include <cstdint>

/// Put before a function, compiles it for several generations of the processor; the program runs
/// the fastest version that the machine supports. Its loops must be plain enough for the compiler
/// to vectorise, and the functions it calls must be inlined (ISPACE_INLINE) to profit.
///
/// Expands to no attribute where resolvers do not work (other processors and C
/// libraries, Clang, sanitizers) or the compiler does not know those generations (GCC before 12).
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    __GNUC__ >= 12 && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ISPACE_SIMD_CLONES \
    __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define ISPACE_SIMD_CLONES
#endif

/// Inlines a function into its callers regardless of the compiler's heuristics.
#define ISPACE_INLINE [[gnu::always_inline]] inline

/// Elementary functions of float for loops that the compiler vectorises. They use additions,
/// multiplications and bit operations only, which IEEE 754 defines to the bit. The polynomials of
/// logarithm, sine and cosine are from S. L. Moshier's Cephes. Error bounds stand beside each
/// function; simd_test compares them with double.
///
/// Arguments outside of the stated ranges give wrong numbers, without traps.
namespace ispace::simd {

/// `a` if `first`, else `b`, without a branch: it would keep a loop from being vectorised, as the
/// compiler assumes that all arithmetic may trap.
ISPACE_INLINE float choose(bool first, float a, float b) {
    const std::uint32_t mask = 0U - static_cast<std::uint32_t>(first);
    return std::bit_cast<float>((std::bit_cast<std::uint32_t>(a) & mask) |
                                (std::bit_cast<std::uint32_t>(b) & ~mask));
}

ISPACE_INLINE double choose(bool first, double a, double b) {
    const std::uint64_t mask = first ? ~std::uint64_t{0} : 0;
    return std::bit_cast<double>((std::bit_cast<std::uint64_t>(a) & mask) |
                                 (std::bit_cast<std::uint64_t>(b) & ~mask));
}

/// Square root, within 2 ulp (relative 2e-7). \pre 0 or within [1e-30, 1e30]
ISPACE_INLINE float squareRoot(float x) {
    // The reciprocal root by Newton's method, from a guess that halves the exponent. For 0 it stays
    // finite.
    float y = std::bit_cast<float>(0x5f375a86U - (std::bit_cast<std::uint32_t>(x) >> 1U));
    const float half = 0.5F * x;
    y *= 1.5F - half * y * y;
    y *= 1.5F - half * y * y;
    y *= 1.5F - half * y * y;
    return x * y;
}

/// Natural logarithm; the error is at most 1e-7 times max(1, |ln x|). \pre x is normal and positive
ISPACE_INLINE float logarithm(float x) {
    // x = 2^e (1 + t), 1 + t between the roots of 1/2 and of 2.
    constexpr std::int32_t kRootOfHalf = 0x3f3504f3;
    const auto bits = std::bit_cast<std::int32_t>(x);
    const std::int32_t exponent = (bits - kRootOfHalf) >> 23;
    const float t = std::bit_cast<float>(bits - exponent * (1 << 23)) - 1.0F;
    const auto e = static_cast<float>(exponent);
    float p = 7.0376836292e-2F;
    p = p * t - 1.1514610310e-1F;
    p = p * t + 1.1676998740e-1F;
    p = p * t - 1.2420140846e-1F;
    p = p * t + 1.4249322787e-1F;
    p = p * t - 1.6668057665e-1F;
    p = p * t + 2.0000714765e-1F;
    p = p * t - 2.4999993993e-1F;
    p = p * t + 3.3333331174e-1F;
    const float square = t * t;
    // ln 2 in two parts, the first exact in products with e.
    return (t + (t * square * p - 0.5F * square - 2.12194440e-4F * e)) + 0.693359375F * e;
}

/// Sine of turn * 2^-32 full turns, within 1.2e-7.
ISPACE_INLINE float sineOfTurn(std::uint32_t turn) {
    // The nearest quarter turn, and the remainder of at most an eighth.
    const std::uint32_t shifted = turn + 0x20000000U;
    const std::uint32_t quarter = shifted >> 30U;
    const auto rest = static_cast<std::int32_t>(shifted & 0x3fffffffU) - 0x20000000;
    const float x = static_cast<float>(rest) * 1.46291807926715968e-9F;  // pi / 2^31
    const float square = x * x;
    float s = -1.9515295891e-4F;
    s = s * square + 8.3321608736e-3F;
    s = s * square - 1.6666654611e-1F;
    s = s * square * x + x;
    float c = 2.443315711809948e-5F;
    c = c * square - 1.388731625493765e-3F;
    c = c * square + 4.166664568298827e-2F;
    c = c * square * square - 0.5F * square + 1.0F;
    const float value = choose((quarter & 1U) != 0, c, s);
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) ^ ((quarter & 2U) << 30U));
}

/// Arc cosine in radians, within 4e-7. \pre x in [0, 1]
ISPACE_INLINE float arcCosine(float x) {
    // Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.46.
    float p = -0.0012624911F;
    p = p * x + 0.0066700901F;
    p = p * x - 0.0170881256F;
    p = p * x + 0.0308918810F;
    p = p * x - 0.0501743046F;
    p = p * x + 0.0889789874F;
    p = p * x - 0.2145988016F;
    p = p * x + 1.5707963050F;
    return squareRoot(1.0F - x) * p;
}

}  // namespace ispace::simd
