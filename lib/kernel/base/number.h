// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as text, independent of the locale: whole texts parse or fail, values are written in the
// shortest form that reads back as the same bits. Pure functions, thread-safe.
//
// Written doubles of 17 digits take 26 ns by writeDouble(), ranges of a laser 16 ns by writeFloat()
// (docs/performance.md); the format functions allocate a string besides.
//
//     const auto width = parseDouble("1.50");   // 1.5; nullopt for "1.50 m", "nan", "0x1"
//     const std::string text = formatDouble(0.1 + 0.2);  // 0.30000000000000004
//     const auto share = parseShare("95%");     // 0.95
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ispace {

/// Parses the whole text as a finite number: no blanks, trailing junk, locale, NaN or infinity. A
/// leading '+' is allowed. Values beyond the range of double, too large or too small, return
/// nullopt. Rounded to the nearest double.
std::optional<double> parseDouble(std::string_view text);

/// Parses the number times 10^exponent, rounded once: ("30.1", -2) is the double nearest to 0.301.
std::optional<double> parseScaled(std::string_view text, int exponent);

/// Parses the whole text as a decimal integer; a leading '+' is allowed. Beyond 64 bits: nullopt.
std::optional<std::int64_t> parseInteger(std::string_view text);

/// Shortest decimal text that reads back as the same double; plain notation from 1e-5 up to 1e15,
/// otherwise with exponent; -0 is "0".
/// \pre value is finite
std::string formatDouble(double value);
/// Appends formatDouble(value); for long lists.
void appendDouble(std::string& out, double value);

/// Shortest text that reads back as the same float.
std::string formatFloat(float value);
/// Appends formatFloat(value); for long lists.
void appendFloat(std::string& out, float value);

/// Text with a fixed number of decimals; minus zero is written without sign.
std::string formatFixed(double value, int decimals);

/// Rounds a computed value to `digits` significant digits, for reports. Sums of areas and shares
/// carry relative rounding errors of some 1e-15, which would show as meaningless digits:
/// 16.819200000000002 becomes 16.8192. Monotonic; infinities and NaN are returned unchanged.
double roundSignificant(double value, int digits = 12);

/// Size of memory in powers of 1024: "812 bytes", "19.5 MB", "8 GB".
std::string formatBytes(std::size_t bytes);

/// Shortest percentage that parseShare reads back as the same fraction: 0.974 is "97.4%".
/// \pre fraction is finite
std::string formatPercent(double fraction);

/// Parses a share: "95%" and "0.95" are equal. A number above 1 without a per cent sign is rejected
/// (it could be either), and so are values outside 0..1.
std::optional<double> parseShare(std::string_view text);

/// Quantity of a number in a file or an option. The number may carry a suffix; without one it is in
/// the first unit named.
enum class Unit {
    None,
    Length,     ///< m; also km, cm, mm
    Angle,      ///< deg; also rad
    Area,       ///< m2
    Time,       ///< s; also ms, us, ns, min, h
    Frequency,  ///< Hz
    Share,      ///< fraction 0..1; text "95%" or "0.95"; rejects a bare number above 1
};

/// A unit is `factor` times 10^exponent of the first. The exponent is applied to the text of
/// "30.1cm" before it is rounded to a double.
struct UnitSuffix {
    std::string_view name;
    int exponent = 0;
    double factor = 1;  ///< an integer except for angles
};

/// Suffixes of a unit, the first unit first; empty for None and Share.
std::span<const UnitSuffix> suffixesOf(Unit unit);

/// "m, km, cm or mm"
std::string suffixNames(Unit unit);

/// Rounds to nine decimals, which removes the rounding errors of sums and tangents.
double nineDecimals(double value);

/// Most characters of a number written below, with a separator.
constexpr std::size_t kNumberRoom = 24;
/// Characters after a number that may be overwritten.
constexpr std::size_t kNumberSlack = 32;

/// Writes formatFloat(value) to `to` and returns the end; faster than formatFloat for common
/// values.
/// \pre value is finite, `to` has room for kNumberRoom + kNumberSlack characters
char* writeFloat(char* to, float value);

/// Writes formatDouble(value) in the same way.
char* writeDouble(char* to, double value);

/// Writes formatDouble(nineDecimals(value)) in the same way.
char* writeNineDecimals(char* to, double value);

/// Writes an integer in the same way.
char* writeInteger(char* to, std::size_t value);

/// Appends to a string, which is enlarged once for many numbers and truncated at the end.
///
///     TextTail tail(line, ranges.size() * kNumberRoom);
///     for (const float range : ranges) { tail.put(range); tail.put(' '); }
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
    /// Puts the first `size` characters of a text kept from earlier, of which kNumberSlack exist.
    void putKept(const char* text, std::size_t size) {
        std::memcpy(end_, text, kNumberSlack);
        end_ += size;
    }
    void put(float value) { end_ = writeFloat(end_, value); }
    void putNineDecimals(double value) { end_ = writeNineDecimals(end_, value); }
    void put(std::size_t value) { end_ = writeInteger(end_, value); }

  private:
    std::string& text_;
    char* end_;
};

}  // namespace ispace
