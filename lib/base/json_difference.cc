// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_difference.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/glob.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace {

namespace {

using nlohmann::json;

std::string textOf(const json* value) {
    if (value == nullptr) return "missing";
    if (value->is_object()) return "an object";
    if (value->is_array()) return "a list";
    if (value->is_number_float()) return formatDouble(value->get<double>());
    return printable(value->dump());
}

/// "1e-6", as people write it in options.
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

    /// Compares the values of a line; null stands for one that is missing. \param label "line 3: "
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

/// One value, or one a line.
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

/// Files of bare numbers or words are text.
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
