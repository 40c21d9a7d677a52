// SPDX-License-Identifier: GPL-3.0-or-later
// Times as text, without doubles: digits are added up as whole nanoseconds, with 15 more decimals
// that only round.
#include "sim/sim_time.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/number.h"

namespace ispace {

namespace {

constexpr std::int64_t kMax = kMaxTime.count();
constexpr int kNanoseconds = 9;  // powers of ten in a second
constexpr std::uint64_t kSecond = 1'000'000'000, kMillisecond = 1'000'000;

/// Removes the unit at the end of `text` and returns it; seconds without one.
std::optional<UnitSuffix> takeUnit(std::string_view& text) {
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const auto first = std::find_if_not(text.rbegin(), text.rend(), is_letter).base();
    const std::string_view name = text.substr(static_cast<std::size_t>(first - text.begin()));
    text.remove_suffix(name.size());
    for (const UnitSuffix& unit : suffixesOf(Unit::Time))
        if (name.empty() || name == unit.name) return unit;
    return std::nullopt;
}

constexpr std::int64_t powerOfTen(int exponent) {
    std::int64_t power = 1;
    for (; exponent > 0; --exponent) power *= 10;
    return power;
}

/// Computes the number times factor times 10^exponent, half rounded up, digit by digit: a double
/// cannot hold every nanosecond of a hundred years.
/// \pre the text is a number, not negative, and the result is far below 2^63
std::int64_t scaledInteger(std::string_view text, int exponent, std::int64_t factor) {
    const auto mark = text.find_first_of("eE");
    std::int64_t power = exponent - 1;
    if (mark != std::string_view::npos) power += parseInteger(text.substr(mark + 1)).value_or(0);
    std::string_view mantissa = text.substr(0, mark);
    if (mantissa.starts_with('+')) mantissa.remove_prefix(1);
    const auto point = mantissa.find('.');
    power += static_cast<std::int64_t>(point == std::string_view::npos ? mantissa.size() : point);

    constexpr int kDigits = 15;  // of a fraction; further digits are cut off
    std::int64_t total = 0, fraction = 0;
    for (const char c : mantissa) {
        if (c == '.') continue;
        const std::int64_t digit = factor * (c - '0');
        if (power >= 0)
            total = total * 10 + digit;
        else if (power >= -kDigits)
            fraction += digit * powerOfTen(kDigits + static_cast<int>(power));
        --power;
    }
    for (; power >= 0 && total > 0; --power) total *= 10;
    constexpr std::int64_t kOne = powerOfTen(kDigits);
    return total + (fraction + kOne / 2) / kOne;
}

/// Converts `value` to decimal, with at least `width` digits.
std::string padded(std::uint64_t value, std::size_t width) {
    std::string digits = std::to_string(value);
    if (digits.size() < width) digits.insert(0, width - digits.size(), '0');
    return digits;
}

std::uint64_t magnitude(SimTime time) {
    const auto count = static_cast<std::uint64_t>(time.count());
    return time.count() < 0 ? 0 - count : count;
}

}  // namespace

SimTime simSeconds(double seconds) {
    constexpr double kNanoseconds = 1e9;
    return SimTime(static_cast<SimTime::rep>(std::llround(seconds * kNanoseconds)));
}

double seconds(SimTime time) {
    constexpr std::uint64_t kExactInDouble = std::uint64_t{1} << 53;
    // Rounds once, in the division; larger times also round in the conversion.
    if (magnitude(time) <= kExactInDouble)
        return static_cast<double>(time.count()) / static_cast<double>(kSecond);
    return parseDouble(formatSimTime(time)).value_or(0);
}

std::optional<SimTime> parseSimTime(std::string_view text) {
    const auto unit = takeUnit(text);
    if (!unit || text.starts_with('-')) return std::nullopt;
    const int exponent = unit->exponent + kNanoseconds;
    const auto rough = parseScaled(text, exponent);
    if (!rough || *rough * unit->factor > 2.0 * static_cast<double>(kMax)) return std::nullopt;
    const auto nanoseconds = scaledInteger(text, exponent, static_cast<std::int64_t>(unit->factor));
    if (nanoseconds > kMax) return std::nullopt;
    return SimTime(nanoseconds);
}

std::string formatSimTime(SimTime time) {
    const std::uint64_t size = magnitude(time);
    std::string text = time.count() < 0 ? "-" : "";
    text += std::to_string(size / kSecond);
    if (size % kSecond == 0) return text;
    text += '.';
    text += padded(size % kSecond, 9);
    text.erase(text.find_last_not_of('0') + 1);
    return text;
}

std::string formatMilliseconds(SimTime time) {
    const std::uint64_t rounded = (magnitude(time) + kMillisecond / 2) / kMillisecond;
    std::string text = time.count() < 0 && rounded > 0 ? "-" : "";
    text += std::to_string(rounded / 1000);
    text += '.';
    text += padded(rounded % 1000, 3);
    return text;
}

}  // namespace ispace
