// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/number.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
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

template <typename Number, std::size_t kCount>
constexpr std::array<Number, kCount> powersOf(Number base) {
    std::array<Number, kCount> powers{};
    Number power = 1;
    for (Number& each : powers) {
        each = power;
        power *= base;
    }
    return powers;
}

constexpr auto kFives = powersOf<std::uint64_t, 22>(5);
constexpr auto kTens = powersOf<std::uint64_t, 18>(10);
constexpr auto kTenths = powersOf<double, 18>(0.1);

/// Integer nearest to a value in 0 .. 2^51; halves round to even.
double nearest(double value) {
    constexpr double kWholeFrom = 1ULL << 52U;  // doubles from here on are integers
    return (value + kWholeFrom) - kWholeFrom;
}

/// Writes eight digits: those of two halves, of their halves, and of these, all in one word.
void putEight(char* to, std::uint32_t number) {
    static_assert(std::endian::native == std::endian::little);
    constexpr std::uint64_t kLow = 0x0000000F'0000000F, kPairs = 0x000F000F'000F000F;
    const std::uint64_t halves = number / 10'000 | std::uint64_t{number % 10'000} << 32U;
    const std::uint64_t hundreds = ((halves * 10'486) >> 20U) & (kLow | kLow << 4U);
    const std::uint64_t pairs = hundreds | (halves - 100 * hundreds) << 16U;
    const std::uint64_t tens = ((pairs * 103) >> 10U) & kPairs;
    const std::uint64_t digits = (tens | (pairs - 10 * tens) << 8U) + 0x30303030'30303030;
    std::memcpy(to, &digits, sizeof digits);
}

/// Writes 16 digits. \pre number < 10^16
void putSixteen(char* to, std::uint64_t number) {
    putEight(to, static_cast<std::uint32_t>(number / kTens[8]));
    putEight(to + 8, static_cast<std::uint32_t>(number % kTens[8]));
}

/// Writes number / 10^decimals with all decimals. \pre number < 10^17, decimals < 22
char* writeScaled(char* to, std::uint64_t number, int decimals) {
    constexpr int kBlock = 16, kHalf = 8;  // decimals written at once
    if (decimals > kBlock) {
        std::memcpy(to, "0.00000", 8);
        to += 2 + decimals - kBlock;
        to[-1] = static_cast<char>('0' + number / kTens[kBlock]);
        putSixteen(to, number % kTens[kBlock]);
        return to + kBlock;
    }
    const std::uint64_t unit = kTens[static_cast<std::size_t>(decimals)];
    // By a product of doubles, faster than a quotient of integers, and off by one at most.
    const double quotient = static_cast<double>(static_cast<std::int64_t>(number)) *
                            kTenths[static_cast<std::size_t>(decimals)];
    auto whole = static_cast<std::uint64_t>(static_cast<std::int64_t>(quotient));
    if (whole * unit > number) --whole;
    if (number - whole * unit >= unit) ++whole;
    if (whole < 10)
        *to++ = static_cast<char>('0' + whole);
    else
        to = writeInteger(to, whole);
    if (decimals == 0) return to;
    *to++ = '.';
    const std::uint64_t rest = number - whole * unit;
    if (decimals <= kHalf)
        putEight(to, static_cast<std::uint32_t>(rest *
                                                kTens[static_cast<std::size_t>(kHalf - decimals)]));
    else
        putSixteen(to, rest * kTens[static_cast<std::size_t>(kBlock - decimals)]);
    return to + decimals;
}

template <typename Float>
char* writeByLibrary(char* to, Float value) {
    std::array<char, kBuffer> buffer;
    const std::string_view text = shortest(value, buffer);
    return to + text.copy(to, text.size());
}

/// Writes number / 10^decimals without trailing zeros.
char* writeStripped(char* to, std::uint64_t number, int decimals) {
    for (; decimals > 0 && number % 10 == 0; --decimals) number /= 10;
    return writeScaled(to, number, decimals);
}

/// Writes the shortest text that reads back as the same value, of these the nearest to it (the
/// output of G. L. Steele, J. L. White, How to print floating-point numbers accurately, 1990).
///
/// It is the multiple of 10^-d nearest to the value, with the least d for which it is nearer to the
/// value than half way to a neighbour. Distances are compared as integers, exactly: a mantissa
/// times 5^d, which `Wide` holds, is the value times 10^d 2^shift. The library writes numbers out
/// of range and powers of two with many decimals, whose neighbours are at unequal distances.
template <typename Wide, typename Float, typename Bits>
char* writeShortest(char* to, Float value, Bits bits) {
    constexpr int kMantissaBits = std::numeric_limits<Float>::digits - 1;
    constexpr int kBias = std::numeric_limits<Float>::max_exponent - 1 + kMantissaBits;
    constexpr int kMinExponent = -16 - kMantissaBits,
                  kMaxExponent = std::min(-2, 48 - kMantissaBits);
    const Bits fraction = bits & ((Bits{1} << kMantissaBits) - 1);
    // Of two, of the mantissa's last bit.
    const int exponent = static_cast<int>((bits << 1U) >> (kMantissaBits + 1U)) - kBias;
    *to = value == 0 ? '0' : '-';
    if (value == 0) return to + 1;
    if (exponent < kMinExponent || exponent > kMaxExponent) return writeByLibrary(to, value);
    char* const first = value < 0 ? to + 1 : to;
    // Enough to distinguish neighbours: the least with 10^d 2^exponent >= 1.
    int decimals = ((-exponent * 1233) >> 12) + 1;
    // Settings and devices have whole millimetres and less; only one of these is that near.
    constexpr int kFew = 3;
    const double size = std::fabs(static_cast<double>(value)), few = nearest(size * 1000);
    if (decimals > kFew && static_cast<Float>(few / 1000) == static_cast<Float>(size))
        return writeStripped(first, static_cast<std::uint64_t>(static_cast<std::int64_t>(few)),
                             kFew);

    const std::uint64_t five = kFives[static_cast<std::size_t>(decimals)];
    const int shift = -exponent - decimals;
    const Wide half = Wide{1} << (shift - 1);
    const Wide sum = Wide{fraction | (Bits{1} << kMantissaBits)} * five + half;
    const auto whole = static_cast<std::uint64_t>(sum >> shift);
    // By which the value exceeds the multiple.
    const auto more =
        static_cast<std::int64_t>((sum & (2 * half - 1))) - static_cast<std::int64_t>(half);
    if (fraction == 0 || -more == static_cast<std::int64_t>(half)) return writeByLibrary(to, value);
    // Near enough, with `off` more in units of the last decimal.
    const auto is_near = [&](std::uint64_t off) {
        const std::uint64_t room = (five - 1) / 2;
        return (off << shift) + static_cast<std::uint64_t>(more) + room <= 2 * room;
    };
    // Half of all numbers have a digit less, unpredictably: without a branch.
    const std::uint64_t tens = (whole + (more < 0 ? 4 : 5)) / 10;
    const bool is_shorter = is_near(whole - 10 * tens);
    std::uint64_t number = whole ^ ((whole ^ tens) & (std::uint64_t{0} - is_shorter));
    int digits = is_shorter;
    // Few have two. No multiple farther away than this is near enough.
    constexpr std::uint64_t kReach = 5;
    for (std::uint64_t unit = 100; digits < decimals && (whole + kReach) % unit <= 2 * kReach;
         unit *= 10) {
        const std::uint64_t multiple = (whole + kReach) / unit;
        if (!is_near(whole - multiple * unit)) break;
        number = multiple;
        ++digits;
    }
    decimals -= digits;
    return writeScaled(first, number, decimals);
}

}  // namespace

double nineDecimals(double value) {
    constexpr double kUnits = 1e9, kMaxExact = 1e6;
    return std::fabs(value) < kMaxExact ? std::round(value * kUnits) / kUnits : value;
}

std::string formatDouble(double value) {
    std::string text;
    appendDouble(text, value);
    return text;
}

void appendDouble(std::string& out, double value) {
    std::array<char, kBuffer> buffer;
    const char* const end = writeDouble(buffer.data(), value);
    // Not by iterators, for which the library is slower.
    out.append(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
}

std::string formatFloat(float value) {
    std::string text;
    appendFloat(text, value);
    return text;
}

void appendFloat(std::string& out, float value) {
    std::array<char, kBuffer> buffer;
    const char* const end = writeFloat(buffer.data(), value);
    out.append(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
}

char* writeDouble(char* to, double value) {
    return writeShortest<unsigned __int128>(to, value, std::bit_cast<std::uint64_t>(value));
}

char* writeFloat(char* to, float value) {
    return writeShortest<std::uint64_t>(to, value, std::bit_cast<std::uint32_t>(value));
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
    if (value < 0) *to++ = '-';
    return writeStripped(to, static_cast<std::uint64_t>(units), kDecimals);
}

char* writeInteger(char* to, std::size_t value) {
    return std::to_chars(to, to + kNumberRoom, value).ptr;
}

}  // namespace ispace
