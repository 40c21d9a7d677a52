// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_writer.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/glob.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace {

namespace {

/// Characters that JSON text holds unescaped: ASCII without quotes, backslashes and control
/// characters.
bool isPlain(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x20 && byte < 0x80 && c != '"' && c != '\\';
}

/// Writes a character that needs escaping or validation. \return its length in bytes
std::size_t appendSpecial(std::string& out, std::string_view text) {
    const std::size_t length = utf8Length(text);
    const char c = text.front();
    if (length == 0) {
        out += "\xef\xbf\xbd";
    } else if (c == '"' || c == '\\') {
        out += '\\';
        out += c;
    } else if (c == '\n') {
        out += "\\n";
    } else if (c == '\t') {
        out += "\\t";
    } else if (static_cast<unsigned char>(c) < 0x20) {
        std::array<char, 8> escape;
        std::snprintf(escape.data(), escape.size(), "\\u%04x", static_cast<unsigned>(c));
        out += escape.data();
    } else {
        out += text.substr(0, length);
    }
    return length == 0 ? 1 : length;
}

void appendQuoted(std::string& out, std::string_view text) {
    if (std::all_of(text.begin(), text.end(), isPlain)) {
        (out += '"').append(text) += '"';
        return;
    }
    out += '"';
    while (!text.empty()) {
        std::size_t plain = 0;
        while (plain < text.size() && isPlain(text[plain])) ++plain;
        out += text.substr(0, plain);
        text.remove_prefix(plain);
        if (!text.empty()) text.remove_prefix(appendSpecial(out, text));
    }
    out += '"';
}

}  // namespace

void JsonWriter::separate() {
    if (comma_) text_ += ',';
    comma_ = true;
}

JsonWriter& JsonWriter::beginObject() {
    separate();
    text_ += '{';
    comma_ = false;
    return *this;
}

JsonWriter& JsonWriter::endObject() {
    text_ += '}';
    comma_ = true;
    return *this;
}

JsonWriter& JsonWriter::beginArray() {
    separate();
    text_ += '[';
    comma_ = false;
    return *this;
}

JsonWriter& JsonWriter::endArray() {
    text_ += ']';
    comma_ = true;
    return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
    separate();
    appendQuoted(text_, name);
    text_ += ':';
    comma_ = false;
    return *this;
}

JsonWriter& JsonWriter::value(std::string_view text) {
    separate();
    appendQuoted(text_, text);
    return *this;
}

JsonWriter& JsonWriter::value(double number) {
    if (!std::isfinite(number)) return null();
    separate();
    appendDouble(text_, number);
    return *this;
}

JsonWriter& JsonWriter::value(float number) {
    if (!std::isfinite(number)) return null();
    separate();
    appendFloat(text_, number);
    return *this;
}

JsonWriter& JsonWriter::value(std::int64_t number) {
    separate();
    std::array<char, 24> digits;
    text_.append(digits.data(),
                 std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr);
    return *this;
}

JsonWriter& JsonWriter::value(bool flag) {
    separate();
    text_ += flag ? "true" : "false";
    return *this;
}

JsonWriter& JsonWriter::null() {
    separate();
    text_ += "null";
    return *this;
}

namespace {

using nlohmann::json;

std::string textOf(const json* value) {
    if (value == nullptr) return "missing";
    if (value->is_object()) return "an object";
    if (value->is_array()) return "a list";
    if (value->is_number_float()) return formatDouble(value->get<double>());
    return printable(value->dump());
}

/// "1e-6", the short form used in options.
std::string exponentText(double tolerance) {
    std::string text = formatDouble(roundSignificant(tolerance, 2));
    if (const std::size_t zero = text.find("e-0"); zero != std::string::npos)
        text.erase(zero + 2, 1);
    return text;
}

class Comparison {
  public:
    Comparison(Tolerance tolerance, std::span<const std::string> ignored)
        : tolerance_(tolerance), ignored_(ignored.begin(), ignored.end()) {}

    /// Compares the values of a line; null stands for a missing value. \param label "line 3: "
    void compareLines(std::string label, const json* expected, const json* actual) {
        label_ = std::move(label);
        compare("", expected, actual);
    }

    std::vector<std::string> differences;

  private:
    void compare(const std::string& path, const json* expected, const json* actual) {
        if (expected != nullptr && actual != nullptr) {
            if (expected->is_object() && actual->is_object())
                return compareKeys(path, *expected, *actual);
            if (expected->is_array() && actual->is_array())
                return compareItems(path, *expected, *actual);
            if (*expected == *actual) return;
        }
        std::string tolerance;
        if (expected != nullptr && actual != nullptr && expected->is_number() &&
            actual->is_number()) {
            const auto a = expected->get<double>(), b = actual->get<double>();
            const double most =
                tolerance_.absolute + tolerance_.relative * std::max(std::abs(a), std::abs(b));
            if (std::abs(a - b) <= most) return;
            tolerance = " (±" + exponentText(most) + ")";
        }
        differences.push_back(label_ + (path.empty() ? "" : path + ": ") + textOf(expected) +
                              " → " + textOf(actual) + tolerance);
    }

    void compareKeys(const std::string& path, const json& expected, const json& actual) {
        const auto compare_key = [&](const std::string& key) {
            const std::string inner = (path.empty() ? "" : path + ".") + printable(key);
            if (isIgnored(key) || isIgnored(inner)) return;
            const auto a = expected.find(key), b = actual.find(key);
            compare(inner, a == expected.end() ? nullptr : &*a, b == actual.end() ? nullptr : &*b);
        };
        for (const auto& [key, value] : expected.items()) compare_key(key);
        for (const auto& [key, value] : actual.items())
            if (!expected.contains(key)) compare_key(key);
    }

    void compareItems(const std::string& path, const json& expected, const json& actual) {
        for (std::size_t i = 0; i < std::max(expected.size(), actual.size()); ++i) {
            const std::string inner = (path.empty() ? "" : path + ".") + std::to_string(i);
            if (isIgnored(inner)) continue;
            compare(inner, i < expected.size() ? &expected[i] : nullptr,
                    i < actual.size() ? &actual[i] : nullptr);
        }
    }

    [[nodiscard]] bool isIgnored(const std::string& name) const {
        return std::any_of(ignored_.begin(), ignored_.end(),
                           [&name](const Glob& glob) { return glob.matches(name); });
    }

    std::string label_;
    Tolerance tolerance_;
    std::vector<Glob> ignored_;
};

/// Parses one value, or one value a line.
std::optional<std::vector<json>> valuesOf(std::string_view text) {
    const auto parse = [](std::string_view part) { return json::parse(part, nullptr, false); };
    if (json whole = parse(text); !whole.is_discarded()) return std::vector<json>{std::move(whole)};
    std::vector<json> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        json line = parse(text.substr(0, end));
        if (line.is_discarded()) return std::nullopt;
        lines.push_back(std::move(line));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

/// Files of bare numbers or words count as text.
bool isStructured(const std::vector<json>& values) {
    return std::all_of(values.begin(), values.end(),
                       [](const json& value) { return value.is_structured(); });
}

}  // namespace

std::optional<std::vector<std::string>> jsonDifferences(std::string_view expected,
                                                        std::string_view actual,
                                                        Tolerance tolerance,
                                                        std::span<const std::string> ignored) {
    const auto a = valuesOf(expected), b = valuesOf(actual);
    if (!a || !b || a->empty() || b->empty() || !isStructured(*a) || !isStructured(*b))
        return std::nullopt;
    Comparison comparison(tolerance, ignored);
    const bool is_one = a->size() == 1 && b->size() == 1;
    for (std::size_t i = 0; i < std::max(a->size(), b->size()); ++i)
        comparison.compareLines(is_one ? "" : "line " + std::to_string(i + 1) + ": ",
                                i < a->size() ? &(*a)[i] : nullptr,
                                i < b->size() ? &(*b)[i] : nullptr);
    return std::move(comparison.differences);
}

}  // namespace ispace
