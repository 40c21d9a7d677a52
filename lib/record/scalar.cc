// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/scalar.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>

#include "base/number.h"
#include "base/unit.h"
#include "base/utf8.h"

namespace ispace {

namespace {

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
    const std::span<const UnitSuffix> suffixes = suffixesOf(key.unit);
    const auto unit = std::find_if(suffixes.begin(), suffixes.end(),
                                   [&](const UnitSuffix& s) { return s.name == suffix; });
    if (!suffix.empty() && unit == suffixes.end())
        refuseValue(key, excerpt(text) + " has the unit " + excerpt(suffix) + ", wanted " +
                             (suffixes.empty() ? "a number without unit" : suffixNames(key.unit)));
    const std::string_view digits = text.substr(0, length);
    std::optional<double> number =
        suffix.empty() ? parseDouble(digits) : parseScaled(digits, unit->exponent);
    if (number && !suffix.empty()) *number *= unit->factor;
    if (number && !std::isfinite(*number)) number.reset();
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
