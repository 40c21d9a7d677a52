// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/float_text.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/number.h"

namespace ispace {

namespace {

constexpr int kMantissaBits = 23, kExponentBias = 127;
constexpr std::uint32_t kSignBit = 0x80000000U, kMantissaMask = 0x7FFFFFU;
// Exponents of two between which the short way works: 2^-13 up to 2^23.
constexpr int kMinExponent = -13, kEndExponent = 23;
// Most decimals then; a float times 10^12 is exact in double: 24 bits and the 28 of 5^12.
constexpr int kMaxDecimals = 12;

constexpr auto kPowers = [] {
    std::array<double, kMaxDecimals + 1> powers{};
    double power = 1;
    for (double& p : powers) {
        p = power;
        power *= 10;
    }
    return powers;
}();

/// What is common to all floats of one exponent.
struct Binade {
    double half_ulp = 0;  ///< half the distance between neighbours
    int decimals = 0;     ///< so many tell any two neighbours apart
};

constexpr auto kBinades = [] {
    std::array<Binade, kEndExponent - kMinExponent> binades{};
    double ulp = 1.0 / static_cast<double>(1ULL << (kMantissaBits - kMinExponent));
    for (Binade& binade : binades) {
        binade.half_ulp = ulp / 2;
        while (kPowers[static_cast<std::size_t>(binade.decimals)] * ulp < 1) ++binade.decimals;
        ulp *= 2;
    }
    return binades;
}();

constexpr auto kPairs = [] {
    std::array<char, 200> pairs{};
    for (std::size_t i = 0; i < 100; ++i) {
        pairs[2 * i] = static_cast<char>('0' + i / 10);
        pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
    }
    return pairs;
}();

/// Nearest whole number of 0 .. 2^51; halves go to the even one.
double nearest(double value) {
    constexpr double kWholeFrom = 1ULL << 52U;  // doubles from here on are whole numbers
    return (value + kWholeFrom) - kWholeFrom;
}

/// number / 10^decimals, all digits written out. \pre number < 10^15, decimals < 16
char* writeScaled(char* to, std::uint64_t number, int decimals) {
    // All digits right-aligned after zeros, then the two sides of the point as blocks.
    constexpr std::size_t kRoom = 32;
    std::array<char, kRoom + 16> digits;
    std::memset(digits.data(), '0', kRoom);
    char* at = digits.data() + kRoom;
    auto rest = number;
    while (rest >= 100) {
        at -= 2;
        std::memcpy(at, &kPairs[2 * (rest % 100)], 2);
        rest /= 100;
    }
    at -= 2;
    std::memcpy(at, &kPairs[2 * rest], 2);
    if (rest < 10) ++at;
    const char* const point = digits.data() + kRoom - decimals;
    const char* const first = at < point ? at : point - 1;
    std::memcpy(to, first, 16);
    to += point - first;
    if (decimals == 0) return to;
    *to++ = '.';
    std::memcpy(to, point, 16);
    return to + decimals;
}

char* writeShortest(char* to, float value) {
    const std::string text = formatFloat(value);
    return to + text.copy(to, text.size());
}

}  // namespace

double nineDecimals(double value) {
    constexpr double kUnits = 1e9, kMaxExact = 1e6;
    return std::fabs(value) < kMaxExact ? std::round(value * kUnits) / kUnits : value;
}

char* writeFloat(char* to, float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const int exponent =
        static_cast<int>((bits & ~kSignBit) >> static_cast<unsigned>(kMantissaBits)) -
        kExponentBias;
    // Neighbours of a power of two stand at unequal distances: left to the library, with all that
    // is very small or large.
    if (exponent < kMinExponent || exponent >= kEndExponent || (bits & kMantissaMask) == 0)
        return writeShortest(to, value);

    // The shortest text is the multiple of 10^-d nearest to the value, with the least d for which
    // it is nearer to the value than half way to a neighbour. All numbers here are exact. Nothing
    // is decided where two are equally near.
    const double size = std::fabs(static_cast<double>(value));
    const Binade& binade = kBinades[static_cast<std::size_t>(exponent - kMinExponent)];
    int decimals = -1;
    double number = 0;
    const auto try_decimals = [&](int d) {
        const double power = kPowers[static_cast<std::size_t>(d)];
        const double scaled = size * power, whole = nearest(scaled);
        const double off = std::fabs(scaled - whole), reach = binade.half_ulp * power;
        if (off == reach || off == 0.5) return -1;
        if (off > reach) return 0;
        decimals = d;
        number = whole;
        return 1;
    };
    // Devices measure whole millimetres; else few decimals less than the most are enough.
    int found = binade.decimals > 3 ? try_decimals(3) : 0;
    if (found == 0) found = try_decimals(binade.decimals);
    while (found == 1 && decimals > 0) found = try_decimals(decimals - 1);
    if (found < 0 || decimals < 0) return writeShortest(to, value);

    *to = '-';
    to += bits >> 31U;
    return writeScaled(to, static_cast<std::uint64_t>(number), decimals);
}

char* writeNineDecimals(char* to, double value) {
    // So many units that all digits are exact; fewer than the least are written with exponent.
    constexpr double kUnits = 1e9, kMin = 1e4, kEnd = 1e15;
    constexpr int kDecimals = 9;
    const double units = std::round(std::fabs(value) * kUnits);
    if (!(units >= kMin && units < kEnd)) {
        const std::string text = formatDouble(nineDecimals(value));
        return to + text.copy(to, text.size());
    }
    auto number = static_cast<std::uint64_t>(units);
    int decimals = kDecimals;
    for (; decimals > 0 && number % 10 == 0; --decimals) number /= 10;
    if (value < 0) *to++ = '-';
    return writeScaled(to, number, decimals);
}

char* writeInteger(char* to, std::size_t value) {
    return std::to_chars(to, to + kNumberRoom, value).ptr;
}

}  // namespace ispace
