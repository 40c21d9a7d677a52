// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/number.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

namespace ispace {
namespace float_text_test {

std::string written(float value) {
    std::array<char, kNumberRoom + kNumberSlack> buffer;
    return {buffer.data(), writeFloat(buffer.data(), value)};
}

std::string written(double value) { return formatDouble(value); }

/// The shortest text by the library, in the same notation.
template <typename Float>
std::string byLibrary(Float value) {
    const Float size = std::fabs(value);
    const bool is_plain =
        size == 0 || (size >= static_cast<Float>(1e-5) && size < static_cast<Float>(1e15));
    std::array<char, 64> buffer;
    const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + Float(0),
                      is_plain ? std::chars_format::fixed : std::chars_format::scientific);
    return {buffer.data(), end.ptr};
}

TEST(FloatText, SomeNumbers) {
    EXPECT_EQ(written(0.0F), "0");
    EXPECT_EQ(written(-0.0F), "0");
    EXPECT_EQ(written(0.1F), "0.1");
    EXPECT_EQ(written(-4.095F), "-4.095");
    EXPECT_EQ(written(30.0F), "30");
    EXPECT_EQ(written(-12.0F), "-12");
    EXPECT_EQ(written(1.0F / 3), "0.33333334");
    EXPECT_EQ(written(8388607.5F), "8388607.5");
    EXPECT_EQ(written(0.0012F), "0.0012");
    EXPECT_EQ(written(1e30F), "1e+30");
}

TEST(FloatText, WholeMillimetresAndTheirNeighbours) {
    for (int k = -100'000; k <= 100'000; ++k) {
        const float value = static_cast<float>(k) / 1000;
        ASSERT_EQ(written(value), byLibrary(value));
        const float next = std::nextafter(value, 1e9F);
        ASSERT_EQ(written(next), byLibrary(next));
    }
}

TEST(FloatText, AnyFloat) {
    std::mt19937 random(5);
    for (int i = 0; i < 2'000'000; ++i) {
        const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        if (!std::isfinite(value)) continue;
        ASSERT_EQ(written(value), byLibrary(value)) << i;
    }
}

TEST(FloatText, FloatsOfEachSize) {
    std::mt19937 random(6);
    for (int exponent = -16; exponent <= 26; ++exponent) {
        const float power = std::ldexp(1.0F, exponent);
        for (const float edge : {power, std::nextafter(power, 0.0F), std::nextafter(power, 1e9F)})
            ASSERT_EQ(written(edge), byLibrary(edge));
        std::uniform_real_distribution<float> in_binade(power, 2 * power);
        for (int i = 0; i < 30'000; ++i) {
            const float value = in_binade(random);
            ASSERT_EQ(written(value), byLibrary(value)) << i;
        }
    }
}

TEST(FloatText, AnyDouble) {
    std::mt19937_64 random(8);
    for (int i = 0; i < 2'000'000; ++i) {
        const auto value = std::bit_cast<double>(random());
        if (!std::isfinite(value)) continue;
        ASSERT_EQ(written(value), byLibrary(value)) << i;
    }
}

TEST(FloatText, DoublesOfEachSize) {
    std::mt19937_64 random(10);
    for (int exponent = -19; exponent <= 55; ++exponent) {
        const double power = std::ldexp(1.0, exponent);
        for (const double edge : {power, std::nextafter(power, 0.0), std::nextafter(power, 1e300)})
            ASSERT_EQ(written(-edge), byLibrary(-edge));
        std::uniform_real_distribution<double> in_binade(power, 2 * power);
        for (int i = 0; i < 20'000; ++i) {
            const double value = in_binade(random);
            ASSERT_EQ(written(value), byLibrary(value)) << i;
            // Of each number of digits.
            const double few = roundSignificant(value, 1 + i % 17);
            ASSERT_EQ(written(few), byLibrary(few)) << i;
            // Half way between two decimals, and beside it.
            const double half = std::ldexp(std::floor(value * 1024) + 0.5, -10);
            ASSERT_EQ(written(half), byLibrary(half)) << i;
        }
    }
}

TEST(FloatText, FewDigits) {
    std::mt19937 random(7);
    for (int i = 0; i < 500'000; ++i) {
        const double digits = static_cast<double>(random() % 100'000);
        const auto value =
            static_cast<float>(digits * std::pow(10, -static_cast<int>(random() % 9)));
        ASSERT_EQ(written(value), byLibrary(value)) << i;
    }
}

TEST(FloatText, NineDecimals) {
    EXPECT_EQ(nineDecimals(0.1 + 0.2), 0.3);
    EXPECT_EQ(nineDecimals(-320.00000000000006), -320);
    EXPECT_EQ(nineDecimals(1.0 / 3), 0.333333333);
    EXPECT_EQ(nineDecimals(1e300), 1e300);
}

TEST(FloatText, WritesNineDecimals) {
    std::mt19937_64 random(9);
    const auto check = [](double value) {
        std::array<char, kNumberRoom + kNumberSlack> buffer;
        const std::string text(buffer.data(), writeNineDecimals(buffer.data(), value));
        ASSERT_EQ(text, formatDouble(nineDecimals(value)));
    };
    for (const double value : {0.0, -0.0, 1e-9, -4e-10, 9.999e-6, 1e-5, 0.25, -12.5,
                               999999.999999999, 1e6, 1234567.25, 1e15, -1e300, 0.1 + 0.2})
        check(value);
    for (int i = 0; i < 300'000; ++i) {
        const double unit = std::pow(10, -static_cast<int>(random() % 12));
        check(static_cast<double>(static_cast<std::int64_t>(random() % 2'000'000'000'000) -
                                  1'000'000'000'000) *
              unit);
    }
}

TEST(FloatText, TailWritesWhereTheTextEndsAndCutsTheRest) {
    std::string text = "x=";
    {
        TextTail tail(text, 4 * kNumberRoom);
        tail.put(1.25F);
        tail.put(',');
        tail.put(std::size_t{1234567});
        tail.put(" end");
    }
    EXPECT_EQ(text, "x=1.25,1234567 end");
    { const TextTail tail(text, 100); }
    EXPECT_EQ(text, "x=1.25,1234567 end");
}

}  // namespace float_text_test
}  // namespace ispace
