// SPDX-License-Identifier: GPL-3.0-or-later
// SCIP 2.0 as bytes: numbers, check characters, lines, requests. Source: Hokuyo Automatic,
// "Communication Protocol Specification for SCIP 2.0 Standard", C-42-03320.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/sensor/laser.h"
#include "server/device/wire_session.h"

namespace ispace {

/// What a laser says of itself in SCIP 2.0, and how its ranges become numbers. Steps of a turn
/// count counter-clockwise; `front` is that of bearing 0, the first beam is step `first`.
///
/// Figures of the models are those that devices report, as public logs of `PP` have them:
/// urg_library's and MRPT's documentation, Hokuyo's SCIP 2.0 specification (URG-04LX). A laser
/// without a model of Hokuyo's is described by its own keys.
struct ScipModel {
    std::string name, product;
    int min_mm = 0, max_mm = 0;
    int turn = 0;  ///< steps of 360 degrees
    int first = 0, last = 0, front = 0;
    int rpm = 0;
    /// Numbers in place of a distance: nothing in range; nearer than min_mm; steps without beam.
    int none = 0, near = 0, unused = 0;
    bool has_intensity = false;
    bool has_echoes = false;  ///< knows HD, HE, ND and NE

    /// What keeps a laser from being one of these ("360 degrees are no whole number of steps"), or
    /// "".
    static std::string refusal(const Laser& laser);
    /// \pre there is no refusal
    static ScipModel of(const Laser& laser);

    /// Millimetres, or the number in place of them; `range` in metres, +infinity for none.
    [[nodiscard]] int number(float range) const;
    /// Of the steps [start, end], merged `cluster` at a time to the least of them that is a
    /// distance. \param ranges of the beams
    [[nodiscard]] std::vector<int> numbers(const std::vector<float>& ranges, int start, int end,
                                           int cluster) const;
    [[nodiscard]] bool isDistance(int number) const { return number >= min_mm && number <= max_mm; }
};

/// The check character of a line's content.
char scipCheck(std::string_view content);

/// Appends the low 6 * characters bits of the value, six in each character, the greatest first.
void appendScipNumber(std::string& out, std::uint32_t value, int characters);

/// Appends a line with its check character: "00P\n". Of "KEY:value" lines a semicolon stands
/// between them that the check leaves out.
void appendScipLine(std::string& out, std::string_view content);
void appendScipField(std::string& out, std::string_view key, std::string_view value);
/// Appends encoded values in lines of 64 characters, each with its check character.
void appendScipData(std::string& out, std::string_view values);

/// Takes requests out of a stream of bytes. A request ends with LF, CR or both; empty ones are
/// left out.
class ScipLines {
  public:
    /// The longest request that is one; of a longer one only so much is kept.
    static constexpr std::size_t kLongest = 64;

    void append(std::string_view bytes) { bytes_ += bytes; }
    /// The next request, without its end; nothing until more bytes come.
    std::optional<std::string> next();
    /// Bytes kept.
    [[nodiscard]] std::size_t size() const { return line_.size() + bytes_.size(); }

  private:
    std::string line_;   // up to kLongest + 1 bytes of the one that has not ended
    std::string bytes_;  // not looked at yet
};

/// A request in its parts: "MD", "0044072501000", ";text" with its semicolon.
struct ScipRequest {
    std::string_view command, parameters, text;
    /// "0G" or "0H" if the text is none, "0F" if all is too long; else "".
    std::string_view fault;

    /// The commands of two letters, "SCIP2.0" and "%SL". \pre the line outlives it
    static ScipRequest of(std::string_view line);
};

/// What MD, MS, ME, GD, GS and GE ask for.
struct ScipSweep {
    int start = 0, end = 0, cluster = 1;
    int interval = 0;  ///< scans left out between two
    int count = 0;     ///< scans; 0: until told otherwise
};

/// Reads the parameters of a sweep; of GD and its kin there is neither interval nor count.
/// \param last greatest step \param status "00", or what is wrong with them
ScipSweep parseScipSweep(std::string_view parameters, bool streams, int last, std::string& status);

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
