// SPDX-License-Identifier: GPL-3.0-or-later
// CoLa, the command language of SICK's sensors, as telegrams: A in ASCII, B in bytes.
// Sources: SICK, "Telegram Listing: Ranging sensors LMS1xx, LMS5xx, TiM2xx, ..." (8014631); drivers
// that speak it: libLMS1xx (github.com/clearpathrobotics/LMS1xx), sick_tim
// (github.com/uos/sick_tim), sick_scan_xd (github.com/SICKAG/sick_scan_xd, whose test/emulator has
// recorded telegrams), MRPT's CLMS100Eth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ispace {

/// The content of a telegram, "sRN LMDscandata", and the dialect it came in.
struct ColaTelegram {
    std::string content;
    bool is_binary = false;
    friend bool operator==(const ColaTelegram&, const ColaTelegram&) = default;
};

/// Takes telegrams out of a stream of bytes. A begins with 02 and ends with 03; B has four 02, the
/// length, the content, and the exclusive or of its bytes. What is neither is left out.
class ColaTelegrams {
  public:
    static constexpr std::size_t kLongest = 1024;

    void append(std::string_view bytes) { bytes_ += bytes; }
    /// Nothing until more bytes come.
    std::optional<ColaTelegram> next();
    /// Bytes kept.
    [[nodiscard]] std::size_t size() const { return bytes_.size(); }

  private:
    enum class Found { None, Telegram, Nothing };
    Found takeText(ColaTelegram& telegram);
    Found takeBinary(ColaTelegram& telegram);

    std::string bytes_;
};

/// The telegram with this content, ready to be sent.
std::string colaFrame(std::string_view content, bool is_binary);

/// Writes a telegram's content, number by number.
class ColaWriter {
  public:
    /// \param begin "sRA LMDscandata"
    ColaWriter(std::string_view begin, bool is_binary) : content_(begin), is_binary_(is_binary) {
        if (is_binary_) content_ += ' ';
    }
    ColaWriter& u8(std::uint32_t value) { return number(value, 1); }
    ColaWriter& u16(std::uint32_t value) { return number(value, 2); }
    ColaWriter& u32(std::uint32_t value) { return number(value, 4); }
    ColaWriter& i32(std::int32_t value) { return u32(static_cast<std::uint32_t>(value)); }
    ColaWriter& f32(float value);
    /// A name of known length: "DIST1".
    ColaWriter& name(std::string_view text);
    /// A text with its length before it.
    ColaWriter& text(std::string_view text);
    /// \returns the telegram
    [[nodiscard]] std::string frame() const { return colaFrame(content_, is_binary_); }

  private:
    ColaWriter& number(std::uint32_t value, int bytes);

    std::string content_;
    bool is_binary_;
};

/// Reads the arguments of a request: hexadecimal, or decimal with a sign.
class ColaReader {
  public:
    /// \param arguments what stands behind the name and a blank
    ColaReader(std::string_view arguments, bool is_binary)
        : rest_(arguments), is_binary_(is_binary) {}
    std::optional<std::int64_t> u8() { return number(1); }
    std::optional<std::int64_t> u16() { return number(2); }
    std::optional<std::int64_t> u32() { return number(4); }
    std::optional<std::int64_t> i32();

  private:
    std::optional<std::int64_t> number(std::size_t bytes);

    std::string_view rest_;
    bool is_binary_;
};

}  // namespace ispace
