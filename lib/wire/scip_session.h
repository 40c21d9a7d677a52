// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "wire/scip.h"
#include "wire/scip_model.h"
#include "wire/wire_session.h"

namespace ispace {

/// A laser that speaks SCIP 2.0 as Hokuyo's do over Ethernet, for programs that use urg_library,
/// MRPT's CHokuyoURG, ROS' urg_node or ARIA's urg2.0.
///
/// It knows BM, QT, RS, RT, RB, TM, CR, HS, SS, VV, PP, II, %ST, %SL, MD, MS, ME, GD, GS, GE and
/// SCIP2.0, and models with multi-echo HD, HE, ND and NE; anything else is answered 0E. Beams have
/// one echo, whose intensity is 1000, or 0 without a return, as the world knows no others. What
/// lies nearer than the laser's least range is told as no return. Each connection has a laser of
/// its own that is off at first.
class ScipSession : public WireSession {
  public:
    /// \pre refusalOfScip() is ""
    ScipSession(WireHost& host, std::string id);

    void receive(std::string_view bytes) override;
    void stepped(std::size_t unsent) override;

    [[nodiscard]] bool isEngaged() const override { return stream_.on; }

  private:
    /// What a stream of scans sends. Values of three characters, or two; with intensities.
    struct Stream {
        std::string command, parameters, text;  ///< "MD", "0044072501000", ";text"
        ScipSweep sweep;
        std::int64_t next = 0;  ///< period of the laser
        bool on = false;
        bool endless = false;
    };

    bool follow();
    void answer(const std::string& line);
    [[nodiscard]] std::string_view statusOf(const ScipRequest& request);
    [[nodiscard]] std::string_view timeMode(const ScipRequest& request);
    [[nodiscard]] std::string_view reboot();
    [[nodiscard]] std::string_view bitRate(std::string_view parameters);
    [[nodiscard]] std::string_view motor(std::string_view parameters) const;
    [[nodiscard]] std::string_view sensitivity(std::string_view parameters);
    [[nodiscard]] bool isSweep(const ScipRequest& request) const;
    void takeSweep(const ScipRequest& request, std::string_view line);
    void reply(std::string_view line, std::string_view status, std::string_view data = "");
    void rest();
    [[nodiscard]] std::string product() const;
    [[nodiscard]] std::string parameters() const;
    [[nodiscard]] std::string state() const;
    [[nodiscard]] std::string_view stateCode() const;
    [[nodiscard]] std::string timeLine(std::chrono::nanoseconds time) const;
    [[nodiscard]] std::string scan(std::string_view command, const ScipSweep& sweep) const;

    WireHost* host_;
    std::string id_;
    ScipLines lines_;
    ScipModel model_;
    std::size_t sensor_ = 0;     // index in the world, as of:
    std::int64_t changes_ = -1;  // of the world
    Stream stream_;
    bool laser_on_ = false, asleep_ = false, time_mode_ = false;
    bool sensitive_ = false, rebooting_ = false;
    std::string bit_rate_ = "115200";
};

extern const WireProtocol kScip;

}  // namespace ispace
