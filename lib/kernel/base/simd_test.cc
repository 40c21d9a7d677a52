// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/simd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace ispace {

namespace simd_test {

constexpr int kSamples = 400'000;

/// Of both signs of exponents, evenly in the logarithm.
float positive(std::mt19937& random, double decades) {
    return static_cast<float>(
        std::pow(10.0, std::uniform_real_distribution<>(-decades, decades)(random)));
}

TEST(SimdMath, ChooseTakesBitsAsTheyAre) {
    EXPECT_EQ(simd::choose(true, 1.5F, 2.5F), 1.5F);
    EXPECT_EQ(simd::choose(false, 1.5F, 2.5F), 2.5F);
    EXPECT_EQ(simd::choose(false, 1.5F, INFINITY), INFINITY);
    EXPECT_TRUE(std::isnan(simd::choose(true, NAN, 0.0F)));
}

TEST(SimdMath, SquareRootOfFloat) {
    EXPECT_EQ(simd::squareRoot(0), 0);
    std::mt19937 random(1);
    double worst = 0;
    for (int i = 0; i < kSamples; ++i) {
        const float x = positive(random, 30);
        const double exact = std::sqrt(static_cast<double>(x));
        worst = std::max(worst, std::abs(static_cast<double>(simd::squareRoot(x)) / exact - 1));
    }
    EXPECT_LT(worst, 2e-7);
}

TEST(SimdMath, LogarithmOfFloat) {
    EXPECT_EQ(simd::logarithm(1), 0);
    std::mt19937 random(2);
    double worst = 0;
    for (int i = 0; i < kSamples; ++i) {
        const float x = positive(random, i % 2 == 0 ? 37 : 0.3);
        const double exact = std::log(static_cast<double>(x));
        const double error = std::abs(static_cast<double>(simd::logarithm(x)) - exact);
        worst = std::max(worst, error / std::max(1.0, std::abs(exact)));
    }
    EXPECT_LT(worst, 1e-7);
    // Near 1 it is small, and still has all digits.
    const float next = std::nextafter(1.0F, 0.0F);
    EXPECT_FLOAT_EQ(simd::logarithm(next), std::log(next));
}

TEST(SimdMath, SineOfTurn) {
    EXPECT_EQ(simd::sineOfTurn(0), 0);
    EXPECT_EQ(simd::sineOfTurn(0x40000000U), 1);
    EXPECT_EQ(simd::sineOfTurn(0x80000000U), 0);
    EXPECT_EQ(simd::sineOfTurn(0xc0000000U), -1);
    std::mt19937 random(3);
    double worst = 0;
    for (int i = 0; i < kSamples; ++i) {
        const auto turn = static_cast<std::uint32_t>(random());
        const double exact = std::sin(2 * std::numbers::pi * turn / 0x1p32);
        worst = std::max(worst, std::abs(static_cast<double>(simd::sineOfTurn(turn)) - exact));
    }
    EXPECT_LT(worst, 1.2e-7);
}

TEST(SimdMath, ArcCosine) {
    EXPECT_EQ(simd::arcCosine(1), 0);
    EXPECT_NEAR(simd::arcCosine(0), std::numbers::pi / 2, 1e-6);
    double worst = 0;
    for (int i = 0; i <= kSamples; ++i) {
        const float x = static_cast<float>(i) / static_cast<float>(kSamples);
        const double error =
            static_cast<double>(simd::arcCosine(x)) - std::acos(static_cast<double>(x));
        worst = std::max(worst, std::abs(error));
    }
    EXPECT_LT(worst, 4e-7);
}

}  // namespace simd_test

}  // namespace ispace
