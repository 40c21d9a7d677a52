// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "sensor/laser.h"
#include "wire/cola.h"
#include "wire/wire_session.h"

namespace ispace {

/// What a laser says of its scans in CoLa: ten-thousandths of a degree, counter-clockwise, where 90
/// degrees are straight ahead.
struct ColaFigures {
    std::string name;                ///< "LMS111"
    std::int32_t start = 0;          ///< first beam
    std::int32_t stop = 0;           ///< last beam
    std::int32_t step = 0;           ///< between two of them
    std::uint32_t frequency = 0;     ///< hundredths of a hertz
    std::uint32_t measurements = 0;  ///< hundreds of beams a second
    float scale = 1;                 ///< millimetres of a distance of 1

    /// \pre the laser does not sweep
    static ColaFigures of(const Laser& laser);
    /// 0 for no return; `range` in metres.
    [[nodiscard]] std::uint32_t number(float range) const;
};

/// A laser that speaks CoLa A and B as SICK's LMS1xx and TiM5xx do, for programs that use
/// libLMS1xx, sick_tim, sick_scan_xd or MRPT's CLMS100Eth.
///
/// It measures from the beginning, and sends scans once LMDscandata is switched on; each telegram
/// is answered in its dialect. Rates, angles and output ranges are those of the record: setting
/// others is answered as a device that cannot. Remissions are 200 for a return and 0 without one,
/// as the world knows none. Dates count from 1970, as those of a device whose clock was never set.
class ColaSession : public WireSession {
  public:
    /// \pre refusalOfCola() is ""
    ColaSession(WireHost& host, std::string id);

    void receive(std::string_view bytes) override;
    void stepped(std::size_t unsent) override;

    [[nodiscard]] bool isEngaged() const override { return streams_; }

  private:
    /// What LMDscandatacfg asks for.
    struct Content {
        bool remission = false, wide_remission = false, time = false;
        std::int64_t every = 1;  ///< scans
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
    [[nodiscard]] std::uint32_t scanSettings(std::string_view arguments, bool is_binary) const;
    void state(bool is_binary);
    [[nodiscard]] std::string scan(std::string_view kind, bool is_binary);
    void appendField(ColaWriter& out) const;
    void appendChannel(ColaWriter& out, std::string_view name, bool wide) const;
    void appendDate(ColaWriter& out) const;

    WireHost* host_;
    std::string id_;
    ColaTelegrams telegrams_;
    ColaFigures figures_;
    std::size_t sensor_ = 0;     // index in the world, as of:
    std::int64_t changes_ = -1;  // of the world
    Content content_;
    bool measures_ = true, streams_ = false, binary_stream_ = false;
    std::int64_t next_ = 0;  // period of the laser to be sent
    std::uint32_t sent_ = 0;
};

extern const WireProtocol kCola;

}  // namespace ispace
