// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/random.h"

#include <Random123/philox.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace ispace {

namespace random_test {

using Floats = std::vector<float>;
using random_loops::Philox;
using random_loops::Targets;

struct Drawn {
    Floats normal, other, uniform;
    friend bool operator==(const Drawn&, const Drawn&) = default;
};

Drawn drawAll(const RandomKey& key, std::uint32_t first, std::size_t count) {
    Drawn drawn{Floats(count), Floats(count), Floats(count)};
    draw(key, first, {drawn.normal, drawn.other, drawn.uniform});
    return drawn;
}

TEST(MixedBits, AreTheGeneratorsFirstNumbers) {
    // Seed 1234567, as published for SplitMix64.
    EXPECT_EQ(mixedBits(1234567), 6457827717110365317U);
    EXPECT_EQ(mixedBits(1234567 + 0x9e3779b97f4a7c15U), 3203168211198807973U);
}

/// Three words of each of kGroup elements.
using Group = std::array<std::array<std::uint32_t, random_loops::kGroup>, 3>;

Group groupOf(random_loops::GroupFunction compute, const Philox& philox, std::uint32_t first) {
    Group group{};
    compute(philox, first, group[0].data(), group[1].data(), group[2].data());
    return group;
}

/// Share of a sample's pairs that vary together: 0 within 5 / sqrt(n) if they are independent.
double correlation(const Floats& a, const Floats& b) {
    const auto n = static_cast<double>(a.size());
    double sum_a = 0, sum_b = 0, sum_aa = 0, sum_bb = 0, sum_ab = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double x = static_cast<double>(a[i]);
        const double y = static_cast<double>(b[i]);
        sum_a += x;
        sum_b += y;
        sum_aa += x * x;
        sum_bb += y * y;
        sum_ab += x * y;
    }
    const double covariance = sum_ab / n - sum_a / n * sum_b / n;
    return covariance /
           std::sqrt((sum_aa / n - sum_a / n * sum_a / n) * (sum_bb / n - sum_b / n * sum_b / n));
}

Floats squares(Floats values) {
    for (float& value : values) value *= value;
    return values;
}

/// Chi-square of values within [0, 1) over equal bins.
template <typename Share>
double chiSquare(const Floats& values, std::size_t bins, Share share) {
    std::vector<double> counts(bins);
    for (const float value : values) {
        const auto bin = static_cast<std::size_t>(share(value) * static_cast<double>(bins));
        ++counts[std::min(bin, bins - 1)];
    }
    const double expected = static_cast<double>(values.size()) / static_cast<double>(bins);
    double sum = 0;
    for (const double count : counts) sum += (count - expected) * (count - expected) / expected;
    return sum;
}

double normalShare(float x) { return 0.5 * std::erfc(-static_cast<double>(x) / std::sqrt(2.0)); }
double identity(float x) { return static_cast<double>(x); }

/// Of 64 bins, 63 degrees of freedom: beyond it lies one sample in 10^9.
constexpr double kMaxChiSquare = 145;
/// Standard deviations beyond which a fixed seed shall not come.
constexpr double kSigmas = 5;
constexpr std::size_t kMany = 1'000'000;

TEST(HashOf, IsFnv1a) {
    EXPECT_EQ(hashOf(""), 0xcbf29ce484222325U);
    EXPECT_EQ(hashOf("a"), 0xaf63dc4c8601ec8cU);
    EXPECT_EQ(hashOf("foobar"), 0x85944171f73967e8U);
    EXPECT_EQ(hashOf("\xc3\xa4"), hashOf("ä"));
}

TEST(Philox, KnownAnswers) {
    // kat_vectors of Random123: philox4x32 10.
    const auto compute = random_loops::groupFunctions().front();
    const Group zeros = groupOf(compute, {}, 0);
    EXPECT_EQ(zeros[0][0], 0x6627e8d5U);
    EXPECT_EQ(zeros[1][0], 0xe169c58dU);
    EXPECT_EQ(zeros[2][0], 0xbc57ac4cU);
    constexpr std::uint32_t kOnes = 0xffffffffU;
    const Group ones = groupOf(compute, {kOnes, kOnes, kOnes, kOnes, kOnes}, kOnes);
    EXPECT_EQ(ones[0][0], 0x408f276dU);
    EXPECT_EQ(ones[1][0], 0x41c83b0eU);
    EXPECT_EQ(ones[2][0], 0xa20bc7c6U);
    const Group pi = groupOf(
        compute, {0x85a308d3U, 0x13198a2eU, 0x03707344U, 0xa4093822U, 0x299f31d0U}, 0x243f6a88U);
    EXPECT_EQ(pi[0][0], 0xd16cfe09U);
    EXPECT_EQ(pi[1][0], 0x94fdccebU);
    EXPECT_EQ(pi[2][0], 0x5001e420U);
}

TEST(Philox, IsThatOfItsInventors) {
    std::mt19937 random(4);
    const auto word = [&] { return static_cast<std::uint32_t>(random()); };
    for (int round = 0; round < 1000; ++round) {
        const Philox philox{word(), word(), word(), word(), word()};
        // The last ones run over the end of the counter's word.
        const std::uint32_t first = round % 10 == 0 ? 0xfffffff0U : word();
        Group expected{};
        for (std::uint32_t i = 0; i < random_loops::kGroup; ++i) {
            const auto words =
                r123::Philox4x32()({{first + i, philox.counter1, philox.counter2, philox.counter3}},
                                   {{philox.key0, philox.key1}});
            for (std::size_t k = 0; k < 3; ++k) expected[k][i] = words[k];
        }
        // For every generation of processors that this one can stand in for.
        for (const auto compute : random_loops::groupFunctions())
            ASSERT_EQ(groupOf(compute, philox, first), expected);
    }
}

TEST(Draw, AgreesWithWordsOfThatElement) {
    const RandomKey key{0x0123456789abcdefU, Purpose::Ultrasound, 0xfedcba9876543210U,
                        0x00a1b2c3d4e5f607U};
    const Drawn drawn = drawAll(key, 1000, 3);
    const auto words = r123::Philox4x32()({{1002U, 0xd4e5f607U, 0x02a1b2c3U, 0x76543210U}},
                                          {{0x89abcdefU, 0x01234567U ^ 0xfedcba98U}});
    const double radius = std::sqrt(-2 * std::log((words[0] + 0.5) / 0x1p32));
    const double turn = 2 * std::acos(-1.0) * words[1] / 0x1p32;
    EXPECT_NEAR(drawn.normal[2], radius * std::cos(turn), 2e-6);
    EXPECT_NEAR(drawn.other[2], radius * std::sin(turn), 2e-6);
    EXPECT_EQ(drawn.uniform[2], static_cast<float>((words[2] >> 8U) / 0x1p24));
}

TEST(Draw, EveryBitOfTheKeyMatters) {
    const RandomKey base{11, Purpose::Range, hashOf("l1"), 5};
    std::vector<Drawn> seen{drawAll(base, 0, 4)};
    const auto add = [&](const RandomKey& key, std::uint32_t first) {
        const Drawn drawn = drawAll(key, first, 4);
        EXPECT_EQ(std::find(seen.begin(), seen.end(), drawn), seen.end());
        seen.push_back(drawn);
    };
    for (unsigned bit = 0; bit < 64; ++bit) {
        const std::uint64_t flip = std::uint64_t{1} << bit;
        RandomKey key = base;
        key.seed ^= flip;
        add(key, 0);
        key = base;
        key.sensor ^= flip;
        // The upper halves of seed and sensor's hash share a word.
        if (bit < 32) {
            add(key, 0);
        } else {
            EXPECT_NE(drawAll(key, 0, 4), seen.front());
        }
        key = base;
        key.frame ^= flip;
        if (bit < 56) add(key, 0);
        if (bit >= 2 && bit < 32) add(base, std::uint32_t{1} << bit);
    }
    RandomKey key = base;
    key.purpose = Purpose::Ultrasound;
    add(key, 0);
}

TEST(Draw, AnyPartIsThatOfTheWhole) {
    const RandomKey key{3, Purpose::Range, hashOf("front"), 77};
    const std::size_t count = 3 * random_loops::kBlock + 17;
    const Drawn whole = drawAll(key, 0, count);
    std::mt19937 random(5);
    for (int round = 0; round < 300; ++round) {
        const std::size_t first = random() % count;
        const std::size_t size = random() % (count - first + 1);
        const Drawn part = drawAll(key, static_cast<std::uint32_t>(first), size);
        const auto agrees = [&](const Floats& all, const Floats& some) {
            return std::equal(some.begin(), some.end(),
                              all.begin() + static_cast<std::ptrdiff_t>(first));
        };
        ASSERT_TRUE(agrees(whole.normal, part.normal)) << first << ' ' << size;
        ASSERT_TRUE(agrees(whole.other, part.other)) << first << ' ' << size;
        ASSERT_TRUE(agrees(whole.uniform, part.uniform)) << first << ' ' << size;
    }
    draw(key, 0, {});
}

TEST(Draw, WhatIsNotWantedChangesNothing) {
    const RandomKey key{9, Purpose::Range, hashOf("x"), 0};
    const std::size_t count = 1081;
    const Drawn all = drawAll(key, 0, count);
    for (unsigned wanted = 1; wanted < 8; ++wanted) {
        Drawn drawn;
        if ((wanted & 1U) != 0) drawn.normal.resize(count);
        if ((wanted & 2U) != 0) drawn.other.resize(count);
        if ((wanted & 4U) != 0) drawn.uniform.resize(count);
        draw(key, 0, {drawn.normal, drawn.other, drawn.uniform});
        EXPECT_TRUE(drawn.normal.empty() || drawn.normal == all.normal) << wanted;
        EXPECT_TRUE(drawn.other.empty() || drawn.other == all.other) << wanted;
        EXPECT_TRUE(drawn.uniform.empty() || drawn.uniform == all.uniform) << wanted;
    }
}

[[gnu::noinline]] void drawPlainly(const Philox& philox, std::uint32_t first, std::size_t count,
                                   const Targets& targets) {
    random_loops::drawBlock(philox, first, count, targets, random_loops::groupFunctions().back());
}

TEST(Draw, IsTheSameForAnyProcessor) {
    const RandomKey key{21, Purpose::Range, 0x1234, 9};
    const Philox philox{9, 1U << 24U, 0x1234, 21, 0};
    for (const std::size_t count : {1U, 2U, 7U, 8U, 15U, 16U, 17U, 63U, 64U, 65U, 255U, 256U}) {
        const Drawn chosen = drawAll(key, 100, count);
        Drawn plain{Floats(count), Floats(count), Floats(count)};
        drawPlainly(philox, 100, count,
                    {plain.normal.data(), plain.other.data(), plain.uniform.data()});
        EXPECT_EQ(chosen, plain) << count;
    }
}

TEST(Draw, BitsAreFixed) {
    // Files of readings depend on these bits, which no compiler or processor may change.
    const Drawn drawn = drawAll({1, Purpose::Range, hashOf("l1"), 0}, 0, 100'000);
    const auto digest = [](const Floats& values) {
        std::string bytes;
        bytes.reserve(values.size() * 4);
        for (const float value : values) {
            const auto bits = std::bit_cast<std::uint32_t>(value);
            for (unsigned i = 0; i < 4; ++i) bytes += static_cast<char>(bits >> (8 * i) & 0xffU);
        }
        return hashOf(bytes);
    };
    EXPECT_EQ(digest(drawn.normal), 3059242973856572851U);
    EXPECT_EQ(digest(drawn.other), 8274822274549809785U);
    EXPECT_EQ(digest(drawn.uniform), 11609454494615826719U);
}

TEST(Draw, NormalsAreNormal) {
    const Drawn drawn = drawAll({2, Purpose::Range, hashOf("l1"), 3}, 0, kMany);
    const auto n = static_cast<double>(kMany);
    for (const Floats* values : {&drawn.normal, &drawn.other}) {
        double sum = 0, sum2 = 0, sum3 = 0, sum4 = 0;
        for (const float value : *values) {
            const auto x = static_cast<double>(value);
            sum += x;
            sum2 += x * x;
            sum3 += x * x * x;
            sum4 += x * x * x * x;
        }
        // Moments 1 to 4 of the normal distribution and the variances of their estimates.
        EXPECT_NEAR(sum / n, 0, kSigmas / std::sqrt(n));
        EXPECT_NEAR(sum2 / n, 1, kSigmas * std::sqrt(2 / n));
        EXPECT_NEAR(sum3 / n, 0, kSigmas * std::sqrt(15 / n));
        EXPECT_NEAR(sum4 / n, 3, kSigmas * std::sqrt(96 / n));
        EXPECT_LT(chiSquare(*values, 64, normalShare), kMaxChiSquare);
        const auto is_beyond = [](float limit) {
            return [limit](float x) { return std::abs(x) > limit; };
        };
        const auto beyond3 = std::count_if(values->begin(), values->end(), is_beyond(3));
        EXPECT_NEAR(static_cast<double>(beyond3), 2699.8, kSigmas * 52);
        const auto beyond4 = std::count_if(values->begin(), values->end(), is_beyond(4));
        EXPECT_NEAR(static_cast<double>(beyond4), 63.3, kSigmas * 8);
        EXPECT_EQ(std::count_if(values->begin(), values->end(), is_beyond(6.67F)), 0);
    }
}

TEST(Draw, UniformsAreUniform) {
    const Drawn drawn = drawAll({2, Purpose::Range, hashOf("l1"), 4}, 0, kMany);
    EXPECT_LT(chiSquare(drawn.uniform, 64, identity), kMaxChiSquare);
    EXPECT_GE(*std::min_element(drawn.uniform.begin(), drawn.uniform.end()), 0);
    EXPECT_LT(*std::max_element(drawn.uniform.begin(), drawn.uniform.end()), 1);
    // The lowest bits, too.
    Floats low = drawn.uniform;
    for (float& value : low) value = value * 0x1p18F - std::floor(value * 0x1p18F);
    EXPECT_LT(chiSquare(low, 64, identity), kMaxChiSquare);
}

TEST(Draw, AllAreIndependent) {
    const RandomKey key{2, Purpose::Range, hashOf("l1"), 5};
    const Drawn drawn = drawAll(key, 0, kMany);
    const double most = kSigmas / std::sqrt(static_cast<double>(kMany));
    EXPECT_LT(std::abs(correlation(drawn.normal, drawn.other)), most);
    EXPECT_LT(std::abs(correlation(drawn.normal, drawn.uniform)), most);
    EXPECT_LT(std::abs(correlation(drawn.other, drawn.uniform)), most);
    EXPECT_LT(std::abs(correlation(squares(drawn.normal), squares(drawn.other))), most);
    EXPECT_LT(std::abs(correlation(squares(drawn.normal), drawn.uniform)), most);
    EXPECT_LT(std::abs(correlation(squares(drawn.other), drawn.uniform)), most);
    // Neighbours of any kind: the next element, frame, sensor, seed, purpose.
    const auto expect_other = [&](const RandomKey& other_key, std::uint32_t first) {
        const Drawn other = drawAll(other_key, first, kMany);
        EXPECT_LT(std::abs(correlation(drawn.normal, other.normal)), most);
        EXPECT_LT(std::abs(correlation(drawn.uniform, other.uniform)), most);
        EXPECT_LT(std::abs(correlation(squares(drawn.normal), squares(other.normal))), most);
    };
    expect_other(key, 1);
    expect_other({2, Purpose::Range, hashOf("l1"), 6}, 0);
    expect_other({2, Purpose::Range, hashOf("l2"), 5}, 0);
    expect_other({3, Purpose::Range, hashOf("l1"), 5}, 0);
    expect_other({2, Purpose::Ultrasound, hashOf("l1"), 5}, 0);
}

}  // namespace random_test

}  // namespace ispace
