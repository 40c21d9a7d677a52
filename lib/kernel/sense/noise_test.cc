// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace ispace {
namespace noise_test {

using Floats = std::vector<float>;

constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr std::size_t kMany = 1'000'000;
/// Standard deviations beyond which a fixed seed shall not come.
constexpr double kSigmas = 5;

const NoiseKey kKey{42, hashOf("l1"), 7};

Floats noisy(const RangeNoise& noise, Floats ranges, const Floats& cosines = {},
             const NoiseKey& key = kKey, double min_range = 0, double max_range = 1e6) {
    addNoise(noise, min_range, max_range, key, cosines, ranges);
    return ranges;
}

double shareLost(const Floats& ranges) {
    return static_cast<double>(std::count(ranges.begin(), ranges.end(), kNone)) /
           static_cast<double>(ranges.size());
}

/// How far a share of kMany may be from its expectation.
double tolerance(double share) {
    return kSigmas * std::sqrt(share * (1 - share) / static_cast<double>(kMany)) + 1e-7;
}

float parsed(const std::string& text) {
    float value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

struct Moments {
    double mean = 0, sigma = 0;
};
Moments momentsOf(const Floats& values, double about) {
    double sum = 0, squares = 0;
    for (const float value : values) {
        const double x = static_cast<double>(value) - about;
        sum += x;
        squares += x * x;
    }
    const auto n = static_cast<double>(values.size());
    return {about + sum / n, std::sqrt(squares / n - sum / n * sum / n)};
}

TEST(Noise, WithoutAnyOnlyLimitsHold) {
    const Floats ranges{0, 0.1F, 0.5F, 5.6F, 5.7F, kNone};
    EXPECT_EQ(noisy({}, ranges), ranges);
    EXPECT_EQ(noisy({}, ranges, {}, kKey, 0.1, 5.6),
              (Floats{kNone, 0.1F, 0.5F, 5.6F, kNone, kNone}));
    EXPECT_EQ(noisy({}, {}), Floats());
}

TEST(Noise, BiasMovesAll) {
    RangeNoise noise;
    noise.bias = -0.25;
    EXPECT_EQ(noisy(noise, {1, 2.5F, kNone, 0.125F}), (Floats{0.75F, 2.25F, kNone, 0}));
}

TEST(Noise, HasMeanAndSigmaOfItsRange) {
    RangeNoise noise;
    noise.bias = 0.02;
    noise.sigma = {0.005, 0.002, 0.0003};
    for (const double range : {0.5, 4.0, 20.0}) {
        const Floats result = noisy(noise, Floats(kMany, static_cast<float>(range)));
        const double sigma = 0.005 + 0.002 * range + 0.0003 * range * range;
        const auto n = static_cast<double>(kMany);
        const Moments moments = momentsOf(result, range);
        // Ranges are float32: 20 m are known to 2e-6 m.
        EXPECT_NEAR(moments.mean, range + 0.02, kSigmas * sigma / std::sqrt(n) + 1e-7);
        EXPECT_NEAR(moments.sigma, sigma, kSigmas * sigma / std::sqrt(2 * n));

        // Chi-square of 64 bins of equal probability; one sample in 10^9 lies beyond 145.
        std::array<double, 64> bins{};
        for (const float value : result) {
            const double deviation = (static_cast<double>(value) - range - 0.02) / sigma;
            const double share = 0.5 * std::erfc(-deviation / std::sqrt(2.0));
            ++bins[std::min<std::size_t>(63, static_cast<std::size_t>(share * 64))];
        }
        double chi_square = 0;
        for (const double count : bins)
            chi_square += (count - n / 64) * (count - n / 64) / (n / 64);
        EXPECT_LT(chi_square, 145) << range;
    }
}

TEST(Noise, ANegativeSpreadIsNone) {
    RangeNoise noise;
    noise.sigma = {-0.01, 0.005, 0};
    EXPECT_EQ(noisy(noise, {0.5F, 1.0F, 2.0F}), (Floats{0.5F, 1.0F, 2.0F}));
    EXPECT_NE(noisy(noise, {3.0F})[0], 3.0F);
    // Even if that of infinity is minus infinity, or not a number.
    noise.sigma = {0.01, 0, -1};
    EXPECT_EQ(noisy(noise, {kNone})[0], kNone);
    noise.sigma = {0, 1, -1};
    EXPECT_EQ(noisy(noise, {kNone})[0], kNone);
}

TEST(Noise, NoReturnStaysNoReturn) {
    RangeNoise noise;
    noise.bias = -3;
    noise.sigma = {0.1, 0.1, 0.1};
    noise.dropout = 0.1;
    noise.graze_from = Angle::degrees(60);
    noise.graze_to = Angle::degrees(80);
    noise.resolution = 0.01;
    const Floats result = noisy(noise, Floats(kMany, kNone), Floats(kMany, 1.0F));
    EXPECT_TRUE(std::all_of(result.begin(), result.end(), [](float r) { return r == kNone; }));
}

TEST(Noise, LosesItsShare) {
    RangeNoise noise;
    for (const double share : {0.001, 0.05, 0.5, 0.999}) {
        noise.dropout = share;
        const Floats result = noisy(noise, Floats(kMany, 2.0F));
        EXPECT_NEAR(shareLost(result), share, tolerance(share));
        EXPECT_EQ(static_cast<std::size_t>(std::count(result.begin(), result.end(), 2.0F)) +
                      static_cast<std::size_t>(std::count(result.begin(), result.end(), kNone)),
                  kMany);
    }
    noise.dropout = 1;
    EXPECT_EQ(shareLost(noisy(noise, Floats(kMany, 2.0F))), 1);
}

TEST(Noise, LosesMoreTheMoreItGrazes) {
    RangeNoise noise;
    noise.dropout = 0.1;
    noise.graze_from = Angle::degrees(60);
    noise.graze_to = Angle::degrees(80);
    for (int degrees = 0; degrees <= 90; degrees += 5) {
        const auto cosine = static_cast<float>(cos(Angle::degrees(degrees)));
        const double ramp = std::clamp((degrees - 60) / 20.0, 0.0, 1.0);
        const double share = 0.1 + 0.9 * ramp;
        const double lost = shareLost(noisy(noise, Floats(kMany, 2.0F), Floats(kMany, cosine)));
        EXPECT_NEAR(lost, share, tolerance(share)) << degrees;
        if (ramp == 1) {
            EXPECT_EQ(lost, 1) << degrees;
        }
    }
    // Without drop-out none is lost before the ramp begins.
    noise.dropout = 0;
    EXPECT_EQ(shareLost(noisy(noise, Floats(kMany, 2.0F), Floats(kMany, 0.5001F))), 0);
    // A cosine may have been rounded up.
    EXPECT_EQ(shareLost(noisy(noise, Floats(kMany, 2.0F), Floats(kMany, 1.0000001F))), 0);
}

TEST(Noise, GrazesAtOneAngle) {
    RangeNoise noise;
    noise.graze_from = noise.graze_to = Angle::degrees(75);
    Floats cosines;
    for (const double degrees : {0.0, 74.9, 75.0, 75.1, 90.0})
        cosines.push_back(static_cast<float>(cos(Angle::degrees(degrees))));
    EXPECT_EQ(noisy(noise, Floats(5, 2.0F), cosines), (Floats{2, 2, kNone, kNone, kNone}));
}

TEST(Noise, MultiplesOfTheResolutionReadAsWritten) {
    RangeNoise noise;
    for (const std::string resolution : {"0.001", "0.01", "0.002", "0.0025", "0.25"}) {
        noise.resolution = std::stod(resolution);
        const std::size_t decimals = resolution.size() - 2;
        std::mt19937 random(8);
        std::uniform_real_distribution<double> any(0, 60);
        for (int i = 0; i < 20000; ++i) {
            const double range = any(random);
            const float result = noisy(noise, {static_cast<float>(range)})[0];
            ASSERT_LE(std::abs(static_cast<double>(result) - range), noise.resolution / 2 + 4e-6);
            // As a decimal number of as many places it is the same float.
            std::array<char, 64> text{};
            const auto end =
                std::to_chars(text.data(), text.data() + text.size(), static_cast<double>(result),
                              std::chars_format::fixed, static_cast<int>(decimals));
            ASSERT_EQ(parsed(std::string(text.data(), end.ptr)), result) << text.data();
            const double steps = static_cast<double>(result) / noise.resolution;
            ASSERT_NEAR(steps, std::round(steps), 1e-2);
        }
    }
    noise.resolution = 0.001;
    EXPECT_EQ(noisy(noise, {1.2344F, 1.2336F, 0.0004F, 0.0F, kNone}),
              (Floats{1.234F, 1.234F, 0, 0, kNone}));
    // All that a millimetre device can say up to 65 m.
    Floats all(65536);
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i] = static_cast<float>(static_cast<double>(i) / 1000);
    EXPECT_EQ(noisy(noise, all), all);
}

TEST(Noise, AResolutionTooFineIsNone) {
    RangeNoise noise;
    for (const double resolution : {1e-9, 1e-12, 1e-13, 1e-300, 1e-320}) {
        noise.resolution = resolution;
        EXPECT_EQ(noisy(noise, {1.2345678F, 54321.0F, kNone}),
                  (Floats{1.2345678F, 54321.0F, kNone}))
            << resolution;
    }
}

TEST(Noise, LimitsAreAboutTheTrueRange) {
    RangeNoise noise;
    noise.resolution = 0.01;
    // Rounding neither returns readings from out of range nor drops those within it.
    EXPECT_EQ(noisy(noise, {5.604F, 5.598F, 0.098F, 0.104F}, {}, kKey, 0.1, 5.6),
              (Floats{kNone, 5.6F, kNone, 0.1F}));
    noise.resolution = 0;
    noise.sigma = {0.05, 0, 0};
    for (const double bias : {0.0, 0.2, -0.2}) {
        noise.bias = bias;
        for (const float outside : {0.0F, 0.06F, 0.0999F, 5.6001F, 5.65F, kNone})
            EXPECT_EQ(shareLost(noisy(noise, Floats(kMany, outside), {}, kKey, 0.1, 5.6)), 1)
                << outside;
        for (const float inside : {0.1F, 0.12F, 3.0F, 5.58F, 5.6F})
            EXPECT_EQ(shareLost(noisy(noise, Floats(kMany, inside), {}, kKey, 0.1, 5.6)), 0)
                << inside;
    }
}

TEST(Noise, WhatIsMeasuredBeyondALimitIsTheLimit) {
    RangeNoise noise;
    noise.sigma = {0.05, 0, 0};
    // As many as a normal distribution has beyond half a sigma.
    const double share = 0.5 * std::erfc(0.5 / std::sqrt(2.0));
    for (const bool far : {false, true}) {
        const float limit = far ? 5.6F : 0.1F, range = far ? 5.575F : 0.125F;
        const Floats result = noisy(noise, Floats(kMany, range), {}, kKey, 0.1, 5.6);
        const auto [least, greatest] = std::minmax_element(result.begin(), result.end());
        EXPECT_EQ(far ? *greatest : *least, limit);
        EXPECT_NEAR(static_cast<double>(std::count(result.begin(), result.end(), limit)) / kMany,
                    share, tolerance(share));
    }
    // No range is below 0.
    const Floats result = noisy(noise, Floats(kMany, 0.0F));
    EXPECT_EQ(*std::min_element(result.begin(), result.end()), 0);
    EXPECT_NEAR(static_cast<double>(std::count(result.begin(), result.end(), 0.0F)) / kMany, 0.5,
                tolerance(0.5));
}

RangeNoise everything() {
    RangeNoise noise;
    noise.bias = 0.01;
    noise.sigma = {0.01, 0.002, 0.0001};
    noise.angle_sigma = Angle::degrees(0.1);
    noise.dropout = 0.02;
    noise.graze_from = Angle::degrees(60);
    noise.graze_to = Angle::degrees(85);
    noise.resolution = 0.001;
    return noise;
}

TEST(Noise, EachBeamIsOnItsOwn) {
    const std::size_t count = 1500;
    std::mt19937 random(9);
    std::uniform_real_distribution<float> range(0, 12);
    std::uniform_real_distribution<float> cosine(0, 1);
    Floats ranges(count), cosines(count);
    for (std::size_t i = 0; i < count; ++i) {
        ranges[i] = i % 9 == 0 ? kNone : range(random);
        cosines[i] = cosine(random);
    }
    const Floats whole = noisy(everything(), ranges, cosines, kKey, 0.1, 10);
    // The first beams alone.
    for (const std::size_t some : {1U, 7U, 255U, 256U, 511U, 512U, 513U, 1024U, 1499U}) {
        const auto end = static_cast<std::ptrdiff_t>(some);
        EXPECT_EQ(noisy(everything(), Floats(ranges.begin(), ranges.begin() + end),
                        Floats(cosines.begin(), cosines.begin() + end), kKey, 0.1, 10),
                  Floats(whole.begin(), whole.begin() + end));
    }
    // All other beams changed.
    for (std::size_t i = 0; i < count; i += 97) {
        Floats others(count, kNone);
        others[i] = ranges[i];
        Floats normals(count, 0.0F);
        normals[i] = cosines[i];
        EXPECT_EQ(noisy(everything(), others, normals, kKey, 0.1, 10)[i], whole[i]);
    }
    // Another frame, sensor, seed or purpose: other noise.
    for (const NoiseKey& key :
         {NoiseKey{42, hashOf("l1"), 8}, NoiseKey{42, hashOf("l2"), 7},
          NoiseKey{43, hashOf("l1"), 7}, NoiseKey{42, hashOf("l1"), 7, Purpose::Ultrasound}})
        EXPECT_NE(noisy(everything(), ranges, cosines, key, 0.1, 10), whole);
}

TEST(Noise, ReturnsAreTheSameAmongAnyNumberOfOthers) {
    std::mt19937_64 random(9);
    std::uniform_real_distribution<float> range(0.5F, 9);
    Floats all(5000), cosines(all.size());
    for (float& r : all) r = range(random);
    for (float& c : cosines) c = range(random) / 9;
    const Floats whole = noisy(everything(), all, cosines, kKey, 0.1, 10);
    for (int round = 0; round < 50; ++round) {
        // Runs of any length that are out of range, or nothing.
        Floats some = all;
        for (std::size_t begin = random() % 400; begin < some.size(); begin += random() % 400) {
            const std::size_t end = std::min(some.size(), begin + random() % 400);
            const float other = round % 3 == 0 ? kNone : round % 3 == 1 ? 0.05F : 11.0F;
            for (; begin < end; ++begin) some[begin] = other;
        }
        const Floats measured = noisy(everything(), some, cosines, kKey, 0.1, 10);
        for (std::size_t i = 0; i < some.size(); ++i)
            ASSERT_EQ(measured[i], some[i] == all[i] ? whole[i] : kNone) << round << ' ' << i;
    }
}

[[gnu::noinline]] void applyPlainly(const noise_loops::Parameters& parameters, std::size_t count,
                                    const float* normal, const float* uniform, const float* cosines,
                                    float* ranges) {
    noise_loops::limit(parameters, count, ranges);
    noise_loops::apply(parameters, count, normal, uniform, cosines, ranges);
}

TEST(Noise, IsTheSameForAnyProcessor) {
    const RangeNoise noise = everything();
    for (const std::size_t count : {1U, 3U, 8U, 31U, 200U, 512U}) {
        Floats plain(count), normal(count), uniform(count), cosines(count);
        for (std::size_t i = 0; i < count; ++i) {
            plain[i] = i % 11 == 5 ? kNone : 0.023F * static_cast<float>(i);
            cosines[i] = static_cast<float>(i % 50) / 50;
        }
        const Floats chosen = noisy(noise, plain, cosines, kKey, 0.1, 10);
        draw({42, Purpose::Range, hashOf("l1"), 7}, 0, {.normal = normal, .uniform = uniform});
        noise_loops::Parameters parameters;
        parameters.bias = 0.01F;
        parameters.sigma = {0.01F, 0.002F, 0.0001F};
        parameters.dropout = 0.02F;
        parameters.graze_from = static_cast<float>(noise.graze_from.radians());
        parameters.graze_slope =
            static_cast<float>(1 / (noise.graze_to - noise.graze_from).radians());
        parameters.graze_cosine = static_cast<float>(cos(noise.graze_to));
        parameters.resolution = 0.001;
        parameters.per_metre = 1 / 0.001;
        parameters.min_range = 0.1F;
        parameters.max_range = 10;
        applyPlainly(parameters, count, normal.data(), uniform.data(), cosines.data(),
                     plain.data());
        EXPECT_EQ(plain, chosen) << count;
    }
}

TEST(BearingErrors, AreNormalAndTheirOwn) {
    RangeNoise noise;
    noise.angle_sigma = Angle::degrees(0.5);
    noise.sigma = {1, 0, 0};
    Floats errors(kMany);
    bearingErrors(noise, kKey, errors);
    const double sigma = noise.angle_sigma.radians();
    const auto n = static_cast<double>(kMany);
    const Moments moments = momentsOf(errors, 0);
    EXPECT_NEAR(moments.mean, 0, kSigmas * sigma / std::sqrt(n));
    EXPECT_NEAR(moments.sigma, sigma, kSigmas * sigma / std::sqrt(2 * n));
    // Not those of the ranges.
    const Floats ranges = noisy(noise, Floats(kMany, 100.0F));
    double product = 0;
    for (std::size_t i = 0; i < kMany; ++i) {
        product += static_cast<double>(errors[i]) / sigma * (static_cast<double>(ranges[i]) - 100);
    }
    EXPECT_NEAR(product / n, 0, kSigmas / std::sqrt(n));

    noise.angle_sigma = {};
    bearingErrors(noise, kKey, errors);
    EXPECT_EQ(errors, Floats(kMany));
}

}  // namespace noise_test
}  // namespace ispace
