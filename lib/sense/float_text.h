// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace ispace {

/// Rounds to nine decimals, which removes the rounding errors of sums and tangents.
double nineDecimals(double value);

/// Characters that any number below needs, with a separator.
constexpr std::size_t kNumberRoom = 24;
/// Characters behind a number that may be overwritten.
constexpr std::size_t kNumberSlack = 32;

/// Writes formatFloat(value) to `to` and returns the end; faster than that for everyday values.
/// \pre value is finite, `to` has room for kNumberRoom + kNumberSlack characters
char* writeFloat(char* to, float value);

/// The same for formatDouble(nineDecimals(value)).
char* writeNineDecimals(char* to, double value);

/// The same for a whole number.
char* writeInteger(char* to, std::size_t value);

/// Appends to a string, which is enlarged once for many numbers and cut to size at the end.
class TextTail {
  public:
    /// \pre at most `room` characters are written
    TextTail(std::string& text, std::size_t room) : text_(text) {
        const std::size_t used = text.size();
        text.resize(used + room + kNumberSlack);
        end_ = text.data() + used;
    }
    ~TextTail() { text_.resize(static_cast<std::size_t>(end_ - text_.data())); }
    TextTail(const TextTail&) = delete;
    TextTail& operator=(const TextTail&) = delete;

    void put(char c) { *end_++ = c; }
    void put(std::string_view text) { end_ += text.copy(end_, text.size()); }
    void put(float value) { end_ = writeFloat(end_, value); }
    void putNineDecimals(double value) { end_ = writeNineDecimals(end_, value); }
    void put(std::size_t value) { end_ = writeInteger(end_, value); }

  private:
    std::string& text_;
    char* end_;
};

}  // namespace ispace
