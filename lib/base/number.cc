// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/number.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <numbers>
#include <system_error>

namespace ispace {

namespace {

constexpr std::size_t kBuffer = 64;
constexpr double kPlainFrom = 1e-5, kPlainTo = 1e15;

template <typename Float>
std::string_view shortest(Float value, std::array<char, kBuffer>& buffer) {
    if (value == 0) value = 0;  // drops the sign of minus zero
    const Float size = std::fabs(value);
    const bool plain = size == 0 || (size >= static_cast<Float>(kPlainFrom) &&
                                     size < static_cast<Float>(kPlainTo));
    const auto format = plain ? std::chars_format::fixed : std::chars_format::scientific;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format).ptr;
    return {buffer.data(), static_cast<std::size_t>(end - buffer.data())};
}

/// Appends numbers of up to three decimals, as most lengths have, without searching for the
/// shortest digits: decimals of up to 15 digits read as distinct doubles. Skips other numbers.
bool appendThousandths(std::string& out, double value) {
    constexpr double kMaxThousandths = 1e12, kThousand = 1000;
    const double scaled = std::fabs(value) * kThousand;
    if (!(scaled < kMaxThousandths)) return false;
    const auto thousandths = static_cast<std::int64_t>(scaled);
    if (static_cast<double>(thousandths) / kThousand != std::fabs(value)) return false;
    std::array<char, kBuffer> buffer;
    char* end = buffer.data();
    if (value < 0) *end++ = '-';
    end = std::to_chars(end, buffer.data() + buffer.size(), thousandths / 1000).ptr;
    if (auto rest = static_cast<int>(thousandths % 1000); rest != 0) {
        *end++ = '.';
        for (int unit = 100; rest != 0; rest %= unit, unit /= 10)
            *end++ = static_cast<char>('0' + rest / unit);
    }
    out.append(buffer.data(), end);
    return true;
}

}  // namespace

std::optional<double> parseDouble(std::string_view text) {
    if (text.starts_with('+')) {
        text.remove_prefix(1);
        if (text.starts_with('-') || text.starts_with('+')) return std::nullopt;
    }
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<double> parseScaled(std::string_view text, int exponent) {
    // Scales the decimal text, since a product rounds twice: 30.1 / 100 is not 0.301.
    const auto mark = text.find_first_of("eE");
    const std::string_view mantissa = text.substr(0, mark);
    std::int64_t written = 0;
    if (mark != std::string_view::npos) {
        const auto power = parseInteger(text.substr(mark + 1));
        constexpr std::int64_t kFarBeyond = 1'000'000'000;
        if (!power || *power > kFarBeyond || *power < -kFarBeyond) return std::nullopt;
        written = *power;
    }
    if (!parseDouble(mantissa)) return std::nullopt;
    return parseDouble(std::string(mantissa) + 'e' + std::to_string(written + exponent));
}

std::optional<std::int64_t> parseInteger(std::string_view text) {
    if (text.starts_with('+')) {
        text.remove_prefix(1);
        if (text.starts_with('-')) return std::nullopt;
    }
    std::int64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
    return value;
}

std::string formatDouble(double value) {
    std::string text;
    appendDouble(text, value);
    return text;
}

void appendDouble(std::string& out, double value) {
    if (appendThousandths(out, value)) return;
    std::array<char, kBuffer> buffer;
    out += shortest(value, buffer);
}

std::string formatFloat(float value) {
    std::array<char, kBuffer> buffer;
    return std::string(shortest(value, buffer));
}

void appendFloat(std::string& out, float value) {
    std::array<char, kBuffer> buffer;
    out += shortest(value, buffer);
}

std::string formatFixed(double value, int decimals) {
    std::array<char, 512> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                   std::chars_format::fixed, decimals)
                         .ptr;
    std::string text(buffer.data(), end);
    if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos)
        text.erase(0, 1);
    return text;
}

double roundSignificant(double value, int digits) {
    if (!std::isfinite(value)) return value;
    std::array<char, kBuffer> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                   std::chars_format::scientific, digits - 1)
                         .ptr;
    std::from_chars(buffer.data(), end, value);
    return value;
}

std::string formatBytes(std::size_t bytes) {
    constexpr const char* kUnits[] = {" bytes", " kB", " MB", " GB", " TB"};
    auto number = static_cast<double>(bytes);
    std::size_t unit = 0;
    for (; number >= 1024 && unit + 1 < std::size(kUnits); ++unit) number /= 1024;
    std::string text = formatFixed(number, unit == 0 ? 0 : 1);
    if (text.ends_with(".0")) text.resize(text.size() - 2);
    return text + kUnits[unit];
}

std::string formatPercent(double fraction) {
    if (fraction == 0) return "0%";
    // The point moves in the decimal text, as parseShare moves it back: many fractions are not the
    // quotient of a double by 100.
    std::array<char, kBuffer> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), fraction,
                                   std::chars_format::scientific)
                         .ptr;
    const std::string_view text(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
    const auto mark = text.find('e');
    std::string digits(text.substr(0, mark));
    const bool negative = digits.front() == '-';
    std::erase_if(digits, [](char c) { return c == '-' || c == '.'; });
    const auto exponent = parseInteger(text.substr(mark + 1)).value_or(0) + 2;
    std::string out = negative ? "-" : "";
    constexpr std::int64_t kMinSize = -5, kMaxSize = 15;
    const auto count = static_cast<std::int64_t>(digits.size());
    if (exponent < kMinSize || exponent >= kMaxSize) {
        if (count > 1) digits.insert(1, 1, '.');
        return out + digits + 'e' + (exponent < 0 ? "-" : "+") +
               std::to_string(exponent < 0 ? -exponent : exponent) + '%';
    }
    if (exponent < 0) digits.insert(0, static_cast<std::size_t>(-exponent), '0');
    const auto whole = static_cast<std::size_t>(exponent < 0 ? 1 : exponent + 1);
    if (digits.size() < whole) digits.append(whole - digits.size(), '0');
    if (digits.size() > whole) digits.insert(whole, 1, '.');
    return out + digits + '%';
}

std::optional<double> parseShare(std::string_view text) {
    const bool percent = text.ends_with('%');
    if (percent) text.remove_suffix(1);
    const auto share = percent ? parseScaled(text, -2) : parseDouble(text);
    if (!share || *share < 0 || *share > 1) return std::nullopt;
    return share;
}

namespace {

constexpr UnitSuffix kLength[] = {{"m"}, {"km", 3}, {"cm", -2}, {"mm", -3}};
constexpr UnitSuffix kAngle[] = {{"deg"}, {"rad", 0, 180 / std::numbers::pi}};
constexpr UnitSuffix kArea[] = {{"m2"}};
constexpr UnitSuffix kTime[] = {{"s"},      {"ms", -3},    {"us", -6},
                                {"ns", -9}, {"min", 1, 6}, {"h", 2, 36}};
constexpr UnitSuffix kFrequency[] = {{"Hz"}};

}  // namespace

std::span<const UnitSuffix> suffixesOf(Unit unit) {
    switch (unit) {
        case Unit::Length:
            return kLength;
        case Unit::Angle:
            return kAngle;
        case Unit::Area:
            return kArea;
        case Unit::Time:
            return kTime;
        case Unit::Frequency:
            return kFrequency;
        case Unit::None:
        case Unit::Share:
            break;
    }
    return {};
}

std::string suffixNames(Unit unit) {
    const auto suffixes = suffixesOf(unit);
    std::string names;
    for (std::size_t i = 0; i < suffixes.size(); ++i) {
        if (i > 0) names += i + 1 == suffixes.size() ? " or " : ", ";
        names += suffixes[i].name;
    }
    return names;
}

namespace {

constexpr int kMantissaBits = 23, kExponentBias = 127;
constexpr std::uint32_t kSignBit = 0x80000000U, kMantissaMask = 0x7FFFFFU;
// Exponents of two for which the fast path works: 2^-13 up to 2^23.
constexpr int kMinExponent = -13, kEndExponent = 23;
// Most decimals in this range; a float times 10^12 is exact in double: 24 bits and the 28 of 5^12.
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

/// Properties shared by all floats of one exponent.
struct Binade {
    double half_ulp = 0;  ///< half the distance between neighbours
    int decimals = 0;     ///< enough to distinguish any two neighbours
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

/// Nearest integer in 0 .. 2^51; halves round to even.
double nearest(double value) {
    constexpr double kWholeFrom = 1ULL << 52U;  // doubles from here on are integers
    return (value + kWholeFrom) - kWholeFrom;
}

/// Writes number / 10^decimals with all digits. \pre number < 10^15, decimals < 16
char* writeScaled(char* to, std::uint64_t number, int decimals) {
    // Writes all digits right-aligned after zeros, then the two sides of the point as blocks.
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
    // The neighbours of a power of two are at unequal distances; the library converts these, and
    // very small or large values.
    if (exponent < kMinExponent || exponent >= kEndExponent || (bits & kMantissaMask) == 0)
        return writeShortest(to, value);

    // The shortest text is the multiple of 10^-d nearest to the value, with the least d for which
    // it is nearer to the value than half way to a neighbour. All numbers here are exact. If two
    // multiples are equally near, the library decides.
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
    // Devices measure whole millimetres; else a few decimals less than the most are enough.
    int found = binade.decimals > 3 ? try_decimals(3) : 0;
    if (found == 0) found = try_decimals(binade.decimals);
    while (found == 1 && decimals > 0) found = try_decimals(decimals - 1);
    if (found < 0 || decimals < 0) return writeShortest(to, value);

    *to = '-';
    to += bits >> 31U;
    return writeScaled(to, static_cast<std::uint64_t>(number), decimals);
}

char* writeNineDecimals(char* to, double value) {
    // Values large enough have exact digits; values below the least are written with exponent.
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
