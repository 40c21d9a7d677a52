// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace ispace {

/// The number with at most nine decimals that is nearest: without the dust of sums and tangents.
double nineDecimals(double value);

/// Room that any number below needs, with a separator.
constexpr std::size_t kNumberRoom = 24;
/// What may be overwritten behind a number.
constexpr std::size_t kNumberSlack = 32;

/// Writes formatFloat(value) to `to` and returns the end; faster for values of everyday size. There
/// are kNumberRoom + kNumberSlack characters at `to`. \pre value is finite
char* writeFloat(char* to, float value);

/// Writes formatDouble(nineDecimals(value)) in the same way. \pre value is finite
char* writeNineDecimals(char* to, double value);

/// The same of a whole number.
char* writeInteger(char* to, std::size_t value);

/// The end of a string, made long enough for many numbers at once; what is not used is cut off.
class TextTail {
  public:
    /// \pre no more than `room` characters are written
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
