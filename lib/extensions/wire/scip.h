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

#include "extensions/wire/wire_session.h"
#include "scene/sensor/laser.h"

namespace ispace::wire {

/// Description of a laser in SCIP 2.0, and conversion of its ranges to numbers. Steps of a turn
/// count counter-clockwise; `front` is the step of bearing 0, `first` that of the first beam.
///
/// Figures of the models are those reported by devices, from public logs of `PP`: urg_library's and
/// MRPT's documentation, Hokuyo's SCIP 2.0 specification (URG-04LX). A laser without a Hokuyo model
/// is described by its own keys.
struct ScipModel {
    std::string name, product;
    int min_mm = 0, max_mm = 0;
    int turn = 0;  ///< steps per 360 degrees
    int first = 0, last = 0, front = 0;
    int rpm = 0;
    /// Codes sent instead of a distance: no return; nearer than min_mm; steps without beam.
    int none = 0, near = 0, unused = 0;
    bool has_intensity = false;
    bool has_echoes = false;  ///< supports HD, HE, ND and NE

    /// Reason why a laser cannot be served by SCIP ("360 degrees are no whole number of steps"), or
    /// "".
    static std::string refusal(const Laser& laser);
    /// \pre refusal() is ""
    static ScipModel of(const Laser& laser);

    /// Converts a range in metres (+infinity: no return) to millimetres, or to a code.
    [[nodiscard]] int number(float range) const;
    /// Numbers of the steps [start, end], merged in clusters to their least distance. \param ranges
    /// of the beams
    [[nodiscard]] std::vector<int> numbers(const std::vector<float>& ranges, int start, int end,
                                           int cluster) const;
    [[nodiscard]] bool isDistance(int number) const { return number >= min_mm && number <= max_mm; }
};

/// Computes the check character of a line's content.
char scipCheck(std::string_view content);

/// Appends the low 6 * characters bits of the value, six per character, most significant first.
void appendScipNumber(std::string& out, std::uint32_t value, int characters);

/// Appends a line with its check character: "00P\n". In "KEY:value" lines a semicolon precedes the
/// check character, which does not cover it.
void appendScipLine(std::string& out, std::string_view content);
void appendScipField(std::string& out, std::string_view key, std::string_view value);
/// Appends encoded values in lines of 64 characters, each with its check character.
void appendScipData(std::string& out, std::string_view values);

/// Extracts requests from a byte stream. A request ends with LF, CR or both; empty requests are
/// skipped.
class ScipLines {
  public:
    /// Maximum length of a request; longer ones are truncated.
    static constexpr std::size_t kMaxLength = 64;

    void append(std::string_view bytes) { bytes_ += bytes; }
    /// Returns the next request without its end; empty until it is complete.
    std::optional<std::string> next();
    /// Number of buffered bytes.
    [[nodiscard]] std::size_t size() const { return line_.size() + bytes_.size(); }

  private:
    std::string line_;   // up to kMaxLength + 1 bytes of an unfinished request
    std::string bytes_;  // unread input
};

/// A request in its parts: "MD", "0044072501000", ";text" with its semicolon.
struct ScipRequest {
    std::string_view command, parameters, text;
    /// "0G" or "0H" if the text is invalid, "0F" if the request is too long; else "".
    std::string_view fault;

    /// Parses two-letter commands, "SCIP2.0" and "%SL". \pre the line outlives the result
    static ScipRequest of(std::string_view line);
};

/// Parameters of MD, MS, ME, GD, GS and GE.
struct ScipSweep {
    int start = 0, end = 0, cluster = 1;
    int interval = 0;  ///< scans skipped after each one sent
    int count = 0;     ///< scans; 0: until stopped
};

/// Parses the parameters of a sweep; GD and GS have neither interval nor count. \param last
/// greatest step \param status "00", or the error
ScipSweep parseScipSweep(std::string_view parameters, bool streams, int last, std::string& status);

/// A laser that speaks SCIP 2.0 as Hokuyo's do over Ethernet, for programs that use urg_library,
/// MRPT's CHokuyoURG, ROS' urg_node or ARIA's urg2.0.
///
/// Supports BM, QT, RS, RT, RB, TM, CR, HS, SS, VV, PP, II, %ST, %SL, MD, MS, ME, GD, GS, GE and
/// SCIP2.0, and for models with multi-echo HD, HE, ND and NE; other commands are answered 0E. Each
/// beam has one echo, with intensity 1000, or 0 without a return, since the world has no
/// intensities. Ranges below the laser's minimum are reported as no return. Each connection has a
/// separate laser state, initially off.
class ScipSession : public WireSession {
  public:
    /// \pre refusalOfScip() is ""
    ScipSession(WireHost& host, std::string id);

    void receive(std::string_view bytes) override;
    void stepped(std::size_t unsent) override;

    [[nodiscard]] bool isEngaged() const override { return stream_.on; }

  private:
    /// Parameters of a stream: values of three or two characters, with or without intensities.
    struct Stream {
        std::string command, parameters, text;  ///< "MD", "0044072501000", ";text"
        ScipSweep sweep;
        std::int64_t next = 0;  ///< period of the next scan
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
    std::size_t sensor_ = 0;     // index in the world, valid for:
    std::int64_t changes_ = -1;  // change count of the world
    Stream stream_;
    bool laser_on_ = false, asleep_ = false, time_mode_ = false;
    bool sensitive_ = false, rebooting_ = false;
    std::string bit_rate_ = "115200";
};

extern const WireProtocol kScip;

}  // namespace ispace::wire
