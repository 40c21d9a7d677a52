// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/sim_time.h"

#include <cstdint>

#include "base/number.h"

namespace ispace {

namespace {

constexpr std::int64_t kMost = kLongestTime.count();
constexpr std::uint64_t kSecond = 1'000'000'000, kMillisecond = 1'000'000;

/// Powers of ten from nanoseconds to the unit at the end of `text`, which is cut off.
int takeUnit(std::string_view& text) {
    struct Unit {
        std::string_view name;
        int exponent;
    };
    constexpr Unit kUnits[] = {{"ms", 6}, {"us", 3}, {"ns", 0}, {"s", 9}};
    for (const Unit& unit : kUnits) {
        if (!text.ends_with(unit.name)) continue;
        text.remove_suffix(unit.name.size());
        return unit.exponent;
    }
    return 9;
}

/// The number times 10^exponent, half rounded up, digit by digit: a double cannot hold every
/// nanosecond of a hundred years.
/// \pre the text is a number, not negative, and the result is far below 2^63
std::int64_t scaledInteger(std::string_view text, int exponent) {
    const auto mark = text.find_first_of("eE");
    std::int64_t power = exponent - 1;
    if (mark != std::string_view::npos) power += parseInteger(text.substr(mark + 1)).value_or(0);
    std::string_view mantissa = text.substr(0, mark);
    if (mantissa.starts_with('+')) mantissa.remove_prefix(1);
    const auto point = mantissa.find('.');
    power += static_cast<std::int64_t>(point == std::string_view::npos ? mantissa.size() : point);

    std::int64_t total = 0;
    for (const char c : mantissa) {
        if (c == '.') continue;
        const int digit = c - '0';
        if (power >= 0)
            total = total * 10 + digit;
        else if (power == -1)
            total += digit >= 5 ? 1 : 0;
        --power;
    }
    for (; power >= 0 && total > 0; --power) total *= 10;
    return total;
}

/// `value` in decimal, at least `width` digits.
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

double seconds(SimTime time) {
    constexpr std::uint64_t kExactInDouble = std::uint64_t{1} << 53;
    // One rounding, in the division; beyond, the conversion would be a second one.
    if (magnitude(time) <= kExactInDouble)
        return static_cast<double>(time.count()) / static_cast<double>(kSecond);
    return parseDouble(formatSimTime(time)).value_or(0);
}

std::optional<SimTime> parseSimTime(std::string_view text) {
    const int exponent = takeUnit(text);
    const auto rough = parseScaled(text, exponent);
    if (!rough || text.starts_with('-') || *rough > 2.0 * static_cast<double>(kMost))
        return std::nullopt;
    const std::int64_t nanoseconds = scaledInteger(text, exponent);
    if (nanoseconds > kMost) return std::nullopt;
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
