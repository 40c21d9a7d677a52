// SPDX-License-Identifier: GPL-3.0-or-later
// CoLa, the command language of SICK's sensors, as telegrams: A in ASCII, B in bytes.
// Sources: SICK, "Telegram Listing: Ranging sensors LMS1xx, LMS5xx, TiM2xx, ..." (8014631); drivers
// that speak it: libLMS1xx (github.com/clearpathrobotics/LMS1xx), sick_tim
// (github.com/uos/sick_tim), sick_scan_xd (github.com/SICKAG/sick_scan_xd, whose test/emulator has
// recorded telegrams), MRPT's CLMS100Eth.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "extensions/wire/wire_session.h"
#include "scene/sensor/laser.h"

namespace ispace::wire {

/// The content of a telegram, "sRN LMDscandata", and the dialect it came in.
struct ColaTelegram {
    std::string content;
    bool is_binary = false;
    friend bool operator==(const ColaTelegram&, const ColaTelegram&) = default;
};

/// Extracts telegrams from a byte stream. A starts with 02 and ends with 03; B has four 02, the
/// length, the content, and the exclusive or of its bytes. Other bytes are skipped.
class ColaTelegrams {
  public:
    static constexpr std::size_t kMaxLength = 1024;

    void append(std::string_view bytes) { bytes_ += bytes; }
    /// Returns the next telegram; empty until it is complete.
    std::optional<ColaTelegram> next();
    /// Number of buffered bytes.
    [[nodiscard]] std::size_t size() const { return bytes_.size(); }

  private:
    enum class Found { None, Telegram, Nothing };
    Found takeText(ColaTelegram& telegram);
    Found takeBinary(ColaTelegram& telegram);

    std::string bytes_;
};

/// Returns the framed telegram with this content.
std::string colaFrame(std::string_view content, bool is_binary);

/// Writes a telegram's content, field by field.
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
    /// A text preceded by its length.
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
    /// \param arguments text after the name and a blank
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

/// Scan figures of a laser in CoLa: ten-thousandths of a degree, counter-clockwise; 90 degrees are
/// straight ahead.
struct ColaFigures {
    std::string name;                ///< "LMS111"
    std::int32_t start = 0;          ///< first beam
    std::int32_t stop = 0;           ///< last beam
    std::int32_t step = 0;           ///< between neighbouring beams
    std::uint32_t frequency = 0;     ///< hundredths of a hertz
    std::uint32_t measurements = 0;  ///< hundreds of beams a second
    float scale = 1;                 ///< millimetres per unit of distance

    /// \pre the laser does not sweep
    static ColaFigures of(const Laser& laser);
    /// Converts a range in metres to CoLa units; 0 for no return.
    [[nodiscard]] std::uint32_t number(float range) const;
};

/// A laser that speaks CoLa A and B as SICK's LMS1xx and TiM5xx do, for programs that use
/// libLMS1xx, sick_tim, sick_scan_xd or MRPT's CLMS100Eth.
///
/// It measures from the start, and sends scans once LMDscandata is switched on; each telegram is
/// answered in its dialect. LMPoutputRange cuts the sector of scan telegrams to whole beams. Rates
/// and angles are those of the record: requests to set others are answered as by a device that does
/// not support them. Remissions are 200 for a return and 0 without one, since the world has no
/// remissions. Dates count from 1970, as on a device whose clock was never set.
class ColaSession : public WireSession {
  public:
    /// \pre refusalOfCola() is ""
    ColaSession(WireHost& host, std::string id);

    void receive(std::string_view bytes) override;
    void stepped(std::size_t unsent) override;

    [[nodiscard]] bool isEngaged() const override { return streams_; }

  private:
    /// Content of scan telegrams, set by LMDscandatacfg.
    struct Content {
        bool remission = false, wide_remission = false, time = false;
        std::int64_t every = 1;  ///< sends every n-th scan
    };

    [[nodiscard]] const Laser& laser() const;
    bool follow();
    void answer(const ColaTelegram& telegram);
    void read(std::string_view name, std::string_view echo, bool is_binary);
    void set(std::string_view name, std::string_view arguments, bool is_binary);
    void call(std::string_view name, std::string_view arguments, bool is_binary);
    void listenTo(std::string_view name, std::string_view arguments, bool is_binary);
    void refuse(std::uint32_t code, bool is_binary);
    void takeContent(std::string_view arguments, bool is_binary);
    bool takeSector(std::string_view arguments, bool is_binary);
    [[nodiscard]] std::uint32_t scanSettings(std::string_view arguments, bool is_binary) const;
    void state(bool is_binary);
    [[nodiscard]] std::string scan(std::string_view kind, bool is_binary);
    void appendField(ColaWriter& out) const;
    void appendChannel(ColaWriter& out, std::string_view name, bool wide) const;
    void appendDate(ColaWriter& out) const;

    WireHost* host_;
    std::string id_;
    ColaTelegrams telegrams_;
    /// The first and the last beam of scan telegrams, by LMPoutputRange; at first all.
    struct Sector {
        std::int64_t first = 0, last = std::numeric_limits<std::int32_t>::max();
    };
    [[nodiscard]] std::int32_t angleOf(std::int64_t beam) const;
    ColaFigures figures_;
    Sector sector_;
    std::size_t sensor_ = 0;     // index in the world, valid for:
    std::int64_t changes_ = -1;  // change count of the world
    Content content_;
    bool measures_ = true, streams_ = false, binary_stream_ = false;
    std::int64_t next_ = 0;  // period of the next scan to send
    std::uint32_t sent_ = 0;
};

extern const WireProtocol kCola;

}  // namespace ispace::wire
