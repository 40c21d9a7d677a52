// SPDX-License-Identifier: GPL-3.0-or-later
// Writes JSON, and compares two texts of it. Equal values give equal bytes, in any locale.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/golden.h"

namespace ispace {

/// Writes compact JSON (RFC 8259) into a string: keys in the order given, doubles in the shortest
/// form that reads back as the same double, so equal values give equal bytes. Nesting is the
/// caller's: it is not checked, nor are keys twice. Amortised O(1) a byte.
///
///     JsonWriter json;
///     json.beginObject().key("schema").value("x/1").key("area").value(1.5).endObject();
class JsonWriter {
  public:
    JsonWriter& beginObject();
    JsonWriter& endObject();
    JsonWriter& beginArray();
    JsonWriter& endArray();
    JsonWriter& key(std::string_view name);
    /// Writes a string. Invalid UTF-8 becomes U+FFFD, so the result is always valid JSON.
    JsonWriter& value(std::string_view text);
    JsonWriter& value(const char* text) { return value(std::string_view(text)); }
    /// Writes a number; infinities and NaN become null, since JSON cannot express them.
    JsonWriter& value(double number);
    JsonWriter& value(float number);
    JsonWriter& value(std::int64_t number);
    JsonWriter& value(int number) { return value(static_cast<std::int64_t>(number)); }
    /// \pre less than 2^63
    JsonWriter& value(std::size_t number) { return value(static_cast<std::int64_t>(number)); }
    JsonWriter& value(bool flag);
    JsonWriter& null();
    /// Writes null without a value.
    template <typename T>
    JsonWriter& value(const std::optional<T>& maybe) {
        return maybe ? value(*maybe) : null();
    }
    /// Writes an array.
    template <typename T>
    JsonWriter& value(const std::vector<T>& list) {
        beginArray();
        for (const T& item : list) value(item);
        return endArray();
    }

    [[nodiscard]] const std::string& text() const { return text_; }
    /// Returns the text so far and removes it; later writes continue it.
    std::string take() { return std::exchange(text_, {}); }

  private:
    void separate();

    std::string text_;
    bool comma_ = false;
};

/// Finds the differences of two JSON texts, or of two texts of JSON lines, each as `coverage.exact:
/// 0.9168 → 0.8582 (±1e-6)`: the path of keys and indices, both values, and for numbers the
/// tolerance. Numbers agree within the tolerance; the order of keys and blanks between them are
/// ignored. Empty if the texts agree, nullopt if either is not JSON.
/// \param ignored globs: keys (`digest`) at any depth, or whole paths (`sensors.*.model`)
std::optional<std::vector<std::string>> jsonDifferences(std::string_view expected,
                                                        std::string_view actual,
                                                        Tolerance tolerance,
                                                        std::span<const std::string> ignored);

}  // namespace ispace
