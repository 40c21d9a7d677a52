// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/number.h"

#include <gtest/gtest.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>

namespace ispace {

namespace number_test {

TEST(ParseDouble, TakesWholeNumbersOnly) {
    EXPECT_EQ(parseDouble("1.5"), 1.5);
    EXPECT_EQ(parseDouble("+1.5"), 1.5);
    EXPECT_EQ(parseDouble("-.5"), -0.5);
    EXPECT_EQ(parseDouble("1e3"), 1000);
    for (const char* bad : {"", " 1", "1 ", "1m", "1,5", "--1", "+-1", "-+1", "++1", "0x10", ".",
                            "e5", "nan", "NaN", "inf", "-inf", "infinity", "1e999", "-1e999"})
        EXPECT_FALSE(parseDouble(bad)) << bad;
}

TEST(ParseScaled, RoundsOnce) {
    EXPECT_EQ(parseScaled("30.1", -2), 0.301);
    EXPECT_EQ(parseScaled("97.4", -2), 0.974);
    EXPECT_EQ(parseScaled("1e3", -3), 1);
    EXPECT_EQ(parseScaled("-2E-1", 1), -2);
    EXPECT_EQ(parseScaled("5", 0), 5);
    for (const char* bad :
         {"", "e5", "1e", "1e5x", "nan", "1e999", "1e99999999999999999999", "1e1e1"})
        EXPECT_FALSE(parseScaled(bad, -2)) << bad;
    EXPECT_FALSE(parseScaled("1", 400));
}

TEST(ParseInteger, TakesWholeIntegersOnly) {
    EXPECT_EQ(parseInteger("42"), 42);
    EXPECT_EQ(parseInteger("+42"), 42);
    EXPECT_EQ(parseInteger("-9223372036854775808"), std::numeric_limits<std::int64_t>::min());
    for (const char* bad : {"", "1.0", "1e3", "+-1", "++1", "9223372036854775808", " 1", "0x1"})
        EXPECT_FALSE(parseInteger(bad)) << bad;
}

TEST(FormatDouble, WritesPlainNumbersPlainly) {
    EXPECT_EQ(formatDouble(0), "0");
    EXPECT_EQ(formatDouble(-0.0), "0");
    EXPECT_EQ(formatDouble(0.1), "0.1");
    EXPECT_EQ(formatDouble(-2.5), "-2.5");
    EXPECT_EQ(formatDouble(100000000), "100000000");
    EXPECT_EQ(formatDouble(1e-5), "0.00001");
    EXPECT_EQ(formatDouble(1e-6), "1e-06");
    EXPECT_EQ(formatDouble(1e15), "1e+15");
    EXPECT_EQ(formatDouble(1.0 / 3), "0.3333333333333333");
}

/// A random double of any magnitude, from its bits.
double anyFinite(std::mt19937_64& random) {
    double value = 0;
    do {
        const std::uint64_t bits = random();
        std::memcpy(&value, &bits, sizeof value);
    } while (!std::isfinite(value));
    return value;
}

TEST(FormatDouble, RoundTripsOverAllMagnitudes) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 50000; ++i) {
        const double value = anyFinite(random);
        EXPECT_EQ(parseDouble(formatDouble(value)), value);
    }
    std::uniform_real_distribution<double> exponent(-8, 18);
    for (int i = 0; i < 50000; ++i) {
        const double value = std::pow(10, exponent(random));
        const std::string text = formatDouble(value);
        EXPECT_EQ(parseDouble(text), value) << text;
        // Shortest: no text with one digit fewer reads back.
        std::array<char, 64> fewer{};
        const auto digits = text.find('e') == std::string::npos
                                ? text.size() - (text.find('.') != std::string::npos)
                                : text.find('e') - (text.find('.') != std::string::npos);
        if (value < 1 || digits < 3 || text.ends_with('0')) continue;
        std::snprintf(fewer.data(), fewer.size(), "%.*e", static_cast<int>(digits) - 2, value);
        EXPECT_NE(parseDouble(fewer.data()), value) << text;
    }
    for (const double edge : {std::numeric_limits<double>::max(), 5e-324,
                              std::numeric_limits<double>::min(), 1e15, 1e-5, 9.999999999999999e14})
        EXPECT_EQ(parseDouble(formatDouble(edge)), edge);
}

/// Numbers with few decimals are written another way than others: the digits are the same.
TEST(Number, FewDecimalsAreShortestToo) {
    std::mt19937_64 random(3);
    const auto shortest = [](double value) {
        std::array<char, 64> buffer;
        const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                       std::chars_format::fixed);
        return std::string(buffer.data(), end.ptr);
    };
    for (int i = 0; i < 200'000; ++i) {
        const auto bits = static_cast<std::int64_t>(random());
        const double whole = static_cast<double>(bits >> (i % 60));
        for (const double unit : {1.0, 10.0, 100.0, 1000.0, 10000.0, 8.0}) {
            for (const double value : {whole / unit, std::nextafter(whole / unit, 0)}) {
                if (value == 0 || std::fabs(value) < 1e-5 || std::fabs(value) >= 1e15) continue;
                ASSERT_EQ(formatDouble(value), shortest(value));
            }
        }
    }
}

TEST(FormatFloat, RoundTripsAndIsShorterThanTheDouble) {
    EXPECT_EQ(formatFloat(0.1F), "0.1");
    EXPECT_EQ(formatFloat(-0.0F), "0");
    std::mt19937_64 random(2);
    for (int i = 0; i < 50000; ++i) {
        const auto value = static_cast<float>(anyFinite(random));
        if (!std::isfinite(value)) continue;
        std::string appended = "x";
        appendFloat(appended, value);
        EXPECT_EQ(appended, "x" + formatFloat(value));
        EXPECT_EQ(std::strtof(formatFloat(value).c_str(), nullptr), value);
    }
}

TEST(AppendDouble, AppendsWhatFormatDoubleGives) {
    std::mt19937_64 random(5);
    std::string appended = "x";
    appendDouble(appended, -0.0);
    EXPECT_EQ(appended, "x0");
    for (int i = 0; i < 1000; ++i) {
        const double value = anyFinite(random);
        appended = "x";
        appendDouble(appended, value);
        ASSERT_EQ(appended, "x" + formatDouble(value));
    }
}

TEST(FormatFixed, HasNoMinusZero) {
    EXPECT_EQ(formatFixed(1.25, 3), "1.250");
    EXPECT_EQ(formatFixed(-0.0001, 3), "0.000");
    EXPECT_EQ(formatFixed(-0.0, 0), "0");
    EXPECT_EQ(formatFixed(-0.5, 1), "-0.5");
    EXPECT_EQ(formatFixed(1e300, 1).size(), 303U);
}

TEST(FormatPercent, IsTheShortestThatReadsBack) {
    EXPECT_EQ(formatPercent(0.974), "97.4%");
    EXPECT_EQ(formatPercent(0), "0%");
    EXPECT_EQ(formatPercent(-0.0), "0%");
    EXPECT_EQ(formatPercent(1), "100%");
    EXPECT_EQ(formatPercent(0.5), "50%");
    EXPECT_EQ(formatPercent(0.57), "57%");
    EXPECT_EQ(formatPercent(0.001), "0.1%");
    EXPECT_EQ(formatPercent(0.00012), "0.012%");
    EXPECT_EQ(formatPercent(1e-300), "1e-298%");
    EXPECT_EQ(formatPercent(2.0 / 3), "66.66666666666666%");
    EXPECT_EQ(formatPercent(-0.25), "-25%");
}

TEST(FormatPercent, RoundTripsForEveryShare) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> share(0, 1), exponent(-320, 0);
    for (int i = 0; i < 50000; ++i) {
        for (const double value : {share(random), std::pow(10, exponent(random))})
            EXPECT_EQ(parseShare(formatPercent(value)), value) << formatPercent(value);
    }
    // The share of cells of a grid, as coverage reports it.
    for (int k = 0; k <= 9409; ++k) {
        EXPECT_EQ(parseShare(formatPercent(k / 9409.0)), k / 9409.0);
    }
}

TEST(ParseShare, WantsAFractionOrAPerCentSign) {
    EXPECT_EQ(parseShare("95%"), 0.95);
    EXPECT_EQ(parseShare("0.95"), 0.95);
    EXPECT_EQ(parseShare("100%"), 1);
    EXPECT_EQ(parseShare("1"), 1);
    EXPECT_EQ(parseShare("0"), 0);
    for (const char* bad : {"95", "", "%", "-1%", "101%", "1.0001", "-0.1", "nan%", "95 %", "95%%"})
        EXPECT_FALSE(parseShare(bad)) << bad;
}

TEST(RoundSignificant, DropsDigitsThatRoundingMade) {
    EXPECT_EQ(roundSignificant(16.819200000000002), 16.8192);
    EXPECT_EQ(roundSignificant(3.2399999999999998), 3.24);
    EXPECT_EQ(roundSignificant(0.1 + 0.2), 0.3);
    EXPECT_EQ(roundSignificant(-1e-7 / 3), -3.33333333333e-8);
    EXPECT_EQ(roundSignificant(0), 0);
    EXPECT_EQ(roundSignificant(0.5695, 3), 0.57);
    EXPECT_EQ(roundSignificant(1234.5, 1), 1000);
    EXPECT_EQ(roundSignificant(123456789012.0), 123456789012.0);
    EXPECT_EQ(roundSignificant(1.0 / 3), 0.333333333333);
    EXPECT_EQ(roundSignificant(std::numeric_limits<double>::max()), 1.79769313486e308);
    EXPECT_TRUE(std::isnan(roundSignificant(std::nan(""))));
    EXPECT_TRUE(std::isinf(roundSignificant(std::numeric_limits<double>::infinity())));
}

TEST(RoundSignificant, KeepsShortNumbersAndTheirOrder) {
    double before = 0;
    for (int k = 0; k <= 9409; ++k) {
        const double share = roundSignificant(k / 9409.0);
        EXPECT_EQ(roundSignificant(share), share) << k;
        EXPECT_NEAR(share, k / 9409.0, 1e-12);
        EXPECT_TRUE(share >= before) << k;
        before = share;
    }
    EXPECT_EQ(before, 1);
}

TEST(NumberTest, SizesForPeople) {
    EXPECT_EQ(formatBytes(0), "0 bytes");
    EXPECT_EQ(formatBytes(1023), "1023 bytes");
    EXPECT_EQ(formatBytes(10240), "10 kB");
    EXPECT_EQ(formatBytes(1536 * 1024), "1.5 MB");
    EXPECT_EQ(formatBytes(std::size_t{8} << 30U), "8 GB");
    EXPECT_EQ(formatBytes(std::size_t{5000} << 40U), "5000 TB");
}

}  // namespace number_test

}  // namespace ispace
