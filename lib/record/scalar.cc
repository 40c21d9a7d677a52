// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/scalar.h"

#include <algorithm>
#include <charconv>
#include <numbers>
#include <optional>
#include <span>

#include "base/number.h"
#include "base/utf8.h"

namespace ispace {

namespace {

struct Suffix {
    std::string_view name;
    int exponent;            // power of ten to the unit's first name
    bool is_radian = false;  // the one suffix that is no power of ten
};

constexpr Suffix kLength[] = {{"m", 0}, {"km", 3}, {"cm", -2}, {"mm", -3}};
constexpr Suffix kAngle[] = {{"deg", 0}, {"rad", 0, true}};
constexpr Suffix kArea[] = {{"m2", 0}};
constexpr Suffix kTime[] = {{"s", 0}, {"ms", -3}, {"us", -6}};
constexpr Suffix kFrequency[] = {{"Hz", 0}};

std::span<const Suffix> suffixesOf(Unit unit) {
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

std::string wantedSuffixes(std::span<const Suffix> suffixes) {
    if (suffixes.empty()) return "a number without unit";
    std::string names;
    for (std::size_t i = 0; i < suffixes.size(); ++i) {
        if (i > 0) names += i + 1 == suffixes.size() ? " or " : ", ";
        names += suffixes[i].name;
    }
    return names;
}

bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// Length of the number, with sign, that `text` begins with; 0 if there is none.
std::size_t numberLength(std::string_view text) {
    std::size_t begin = 0;
    if (text.starts_with('+') || text.starts_with('-')) begin = 1;
    if (begin == text.size() || !(isDigit(text[begin]) || text[begin] == '.')) return 0;
    double ignored = 0;
    const auto result = std::from_chars(text.data() + begin, text.data() + text.size(), ignored);
    if (result.ec == std::errc::invalid_argument) return 0;
    return static_cast<std::size_t>(result.ptr - text.data());
}

/// NaN and infinity, as .env, C and YAML spell them, have their own messages.
void refuseNonFinite(const KeySpec& key, std::string_view text) {
    std::string_view bare = text;
    if (bare.starts_with('+') || bare.starts_with('-')) bare.remove_prefix(1);
    if (bare.starts_with('.')) bare.remove_prefix(1);
    constexpr std::size_t kLongest = 8;
    if (bare.size() > kLongest) return;
    std::string lower(bare);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (lower == "nan") refuseValue(key, "NaN (not a number) is given, a number is wanted");
    if (lower == "inf" || lower == "infinity")
        refuseValue(key, excerpt(text) + " is infinite, a finite number is wanted");
}

double parseShareOf(const KeySpec& key, std::string_view text) {
    const auto share = parseShare(text);
    if (share) return *share;
    const bool bare = !text.ends_with('%');
    const auto number = parseDouble(bare ? text : text.substr(0, text.size() - 1));
    if (!number) refuseValue(key, excerpt(text) + " is not a share, write 95% or 0.95");
    if (*number < 0) refuseValue(key, excerpt(text) + " is below 0, write 95% or 0.95");
    refuseValue(key,
                excerpt(text) + (bare ? " is above 1" : " is above 100%") + ", write 95% or 0.95");
}

}  // namespace

void refuseValue(const KeySpec& key, const std::string& what) {
    Diagnostic diagnostic;
    diagnostic.message = '`' + key.name + "`: " + what;
    throw FormatError(std::move(diagnostic));
}

bool isWord(std::string_view text) {
    constexpr std::string_view kSigns = "_-./+:@";
    return !text.empty() && std::all_of(text.begin(), text.end(), [&](char c) {
        return isLetter(c) || isDigit(c) || kSigns.find(c) != std::string_view::npos;
    });
}

double parseNumber(const KeySpec& key, std::string_view text) {
    if (text.empty()) refuseValue(key, "a number is missing");
    refuseNonFinite(key, text);
    if (key.unit == Unit::Share) return parseShareOf(key, text);
    const std::size_t length = numberLength(text);
    const std::string_view suffix = text.substr(length);
    if (length == 0 || !(suffix.empty() || isLetter(suffix.front())))
        refuseValue(key, excerpt(text) + " is not a number");
    const std::span<const Suffix> suffixes = suffixesOf(key.unit);
    const auto unit = std::find_if(suffixes.begin(), suffixes.end(),
                                   [&](const Suffix& s) { return s.name == suffix; });
    if (!suffix.empty() && unit == suffixes.end())
        refuseValue(key, excerpt(text) + " has the unit " + excerpt(suffix) + ", wanted " +
                             wantedSuffixes(suffixes));
    const std::string_view digits = text.substr(0, length);
    std::optional<double> number;
    if (suffix.empty()) {
        number = parseDouble(digits);
    } else {
        number = parseScaled(digits, unit->exponent);
        if (number && unit->is_radian) number = *number * (180 / std::numbers::pi);
    }
    if (!number) refuseValue(key, excerpt(text) + " is beyond the range of numbers");
    return *number;
}

void appendNumber(std::string& out, const KeySpec& key, double number) {
    if (key.unit == Unit::Share)
        out += formatPercent(number);
    else
        appendDouble(out, number);
}

std::string formatNumber(const KeySpec& key, double number) {
    std::string out;
    appendNumber(out, key, number);
    return out;
}

}  // namespace ispace
