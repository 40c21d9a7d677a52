// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/golden.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/message.h"

namespace ispace {
namespace {

bool isWordByte(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           c == '.' || c == '+' || c == '-';
}

/// Returns the next word, or one byte outside words. A full stop that ends a word is not part of
/// it.
std::string_view nextToken(std::string_view text, std::size_t at) {
    std::size_t end = at;
    while (end < text.size() && isWordByte(text[end])) ++end;
    while (end > at + 1 && text[end - 1] == '.') --end;
    return text.substr(at, std::max<std::size_t>(end - at, 1));
}

std::optional<double> number(std::string_view word) {
    double value = 0;
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

bool agree(std::string_view a, std::string_view b, Tolerance tolerance) {
    if (a == b) return true;
    const auto x = number(a);
    const auto y = number(b);
    if (!x || !y) return false;
    const double largest = std::max(std::abs(*x), std::abs(*y));
    return std::abs(*x - *y) <= tolerance.absolute + tolerance.relative * largest;
}

std::string lineAround(std::string_view text, std::size_t at) {
    at = std::min(at, text.size());
    const std::size_t before = text.substr(0, at).rfind('\n');
    const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
    const std::size_t end = std::min(text.find('\n', at), text.size());
    // Long lines (JSON) are cut to the surroundings of the difference.
    const std::size_t from = at - begin > 60 ? at - 60 : begin;
    return printable(text.substr(from, std::min(end - from, std::size_t{140})));
}

bool isMagic(std::string_view line) {
    return line.starts_with("#env ") || line.starts_with("#3dm ") ||
           line.starts_with("# ispace yaml ");
}

}  // namespace

std::string withoutHistory(std::string_view text) {
    std::string result;
    const std::size_t first_end = std::min(text.find('\n'), text.size());
    if (isMagic(text.substr(0, first_end))) {
        const std::size_t rest = std::min(first_end + 1, text.size());
        result = text.substr(0, rest);
        text.remove_prefix(rest);
        while (text.starts_with("# ")) {
            text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
        }
    }
    constexpr std::string_view kKey = "\"history\":[";
    for (std::size_t at = text.find(kKey); at != std::string_view::npos; at = text.find(kKey)) {
        std::size_t end = at + kKey.size();
        bool quoted = false;
        while (end < text.size() && (quoted || text[end] != ']')) {
            if (text[end] == '\\') {
                ++end;
            } else if (text[end] == '"') {
                quoted = !quoted;
            }
            ++end;
        }
        result += text.substr(0, at + kKey.size());
        text.remove_prefix(std::min(end, text.size()));
    }
    return result += text;
}

std::string textDifference(std::string_view expected, std::string_view actual,
                           Tolerance tolerance) {
    std::size_t e = 0;
    std::size_t a = 0;
    std::size_t line = 1;
    while (e < expected.size() && a < actual.size()) {
        const std::string_view want = nextToken(expected, e);
        const std::string_view have = nextToken(actual, a);
        if (!agree(want, have, tolerance)) break;
        if (want == "\n") ++line;
        e += want.size();
        a += have.size();
    }
    if (e >= expected.size() && a >= actual.size()) return "";
    return "line " + std::to_string(line) + ":\n  expected: " + lineAround(expected, e) +
           "\n  actual:   " + lineAround(actual, a);
}

}  // namespace ispace
