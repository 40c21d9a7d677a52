// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/wire: protocols of real devices, for programs written for hardware. Sessions
// convert bytes to bytes, without transport. Uses sim and below.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "extensions/wire/picture_files.h"
#include "sim/world.h"

namespace ispace::wire {

/// A session's interface to the run. All calls happen between steps, in the thread that takes them.
class WireHost {
  public:
    WireHost() = default;
    virtual ~WireHost() = default;
    WireHost(const WireHost&) = delete;
    WireHost& operator=(const WireHost&) = delete;

    /// Read-only use, except commands for the robot that the session holds.
    [[nodiscard]] virtual World& world() = 0;
    /// Returns a number that grows with each change of the world, and when the robot or sensor has
    /// gone to another one.
    [[nodiscard]] virtual std::int64_t changes() { return world().changes(); }
    /// True if robots move as recorded and ignore commands.
    [[nodiscard]] virtual bool isReplay() const = 0;
    /// Called before an order to the robot's wheels. \returns false if it must wait, as in a lift
    virtual bool mayDrive(std::string_view /*robot*/) { return !isReplay(); }
    /// True while the world is paused, as always with the clock `step`.
    [[nodiscard]] virtual bool isPaused() const = 0;
    enum class Change {
        Done,
        Refused,  ///< clients may not change the world, or the change is invalid
        Later     ///< the world must run first: ask again after the next step
    };
    /// Applies all assignments of `SET ID.key=value` requests in one change.
    virtual Change change(std::span<const std::string> assignments) = 0;

    /// Reserves this robot. \returns the number of the hold; empty if another client, of any
    /// protocol, has it
    virtual std::optional<std::int64_t> hold(std::string_view robot) = 0;
    /// False once the world has removed it.
    [[nodiscard]] virtual bool holds(std::string_view robot, std::int64_t hold) = 0;
    /// Stops the robot and releases it.
    virtual void release(std::string_view robot, std::int64_t hold) = 0;

    /// Time shown by device clocks: since the start of the run, simulated or wall time.
    [[nodiscard]] virtual std::chrono::nanoseconds clock() const = 0;

    /// Runs slow work: in a background thread if there is one, while clients are served. Then calls
    /// `deliver` between steps, with the exception that was thrown or null, and afterwards
    /// stepped() of all sessions.
    virtual void runInBackground(std::function<void()> work,
                                 std::function<void(const std::exception_ptr& failure)> deliver);
    /// Shared by all sessions.
    [[nodiscard]] virtual PictureFiles& pictures() { return pictures_; }

  private:
    PictureFiles pictures_;
};

/// The device's side of one client's dialogue.
///
/// Output is sent in order and without gaps: one write per call if the system accepts all bytes.
/// While a client does not read, its requests stay unread and its session skips optional output
/// (see stepped()).
class WireSession {
  public:
    WireSession() = default;
    /// Called when the connection is gone: releases held robots.
    virtual ~WireSession() = default;
    WireSession(const WireSession&) = delete;
    WireSession& operator=(const WireSession&) = delete;

    /// Processes the client's next bytes, split arbitrarily. \pre !closing()
    virtual void receive(std::string_view bytes) = 0;
    /// Call after each step or change of the world. `unsent` bytes of earlier packets wait for a
    /// slow reader: if they are many, the session skips its new packet.
    virtual void stepped(std::size_t unsent) = 0;
    /// Call once the client has closed its sending side; it may still read.
    virtual void ended() { close(); }
    /// True while a change of the world that the client asked for waits for its turn.
    [[nodiscard]] virtual bool waitsToChange() const { return false; }
    /// Retries the change. \pre waitsToChange()
    virtual void proceed() {}
    /// True while the session sends unasked or holds a robot. Any other session yields a contested
    /// port unless it received a request recently.
    [[nodiscard]] virtual bool isEngaged() const = 0;
    /// True once the client has sent a valid request.
    [[nodiscard]] bool understood() const { return understood_; }
    /// True once no more input is read: the connection ends when all output is sent.
    [[nodiscard]] bool closing() const { return closing_; }
    /// Returns and clears the output, in order.
    std::string take() { return std::exchange(out_, {}); }

  protected:
    void send(std::string_view bytes) { out_ += bytes; }
    void close() { closing_ = true; }
    void setUnderstood() { understood_ = true; }

  private:
    std::string out_;
    bool closing_ = false, understood_ = false;
};

/// Unsent bytes of a slow reader above which scans are skipped: some ten of the largest.
inline constexpr std::size_t kMaxUnsentBytes = std::size_t{1} << 16;
/// Devices report lengths in millimetres.
inline constexpr double kMmPerMetre = 1000;

/// Registration of one protocol. A new protocol needs its session, such a row, and an entry in
/// wireProtocols().
struct WireProtocol {
    std::string_view name;    ///< of the option (--scip) and of the key in simrun's first line
    std::string_view device;  ///< kind of device: "ROBOT", "LASER", "CAMERA"
    std::string_view help;    ///< of the option
    std::uint16_t port = 0;   ///< default port of clients
    /// Clients served at once on a port; more are disconnected, as by the devices.
    std::size_t clients = 1;
    /// Reason why this robot or sensor cannot have such a port ("no laser `l9`"), or "".
    std::string (*refusal)(const World& world, std::string_view id) = nullptr;
    /// \pre refusal() is ""; the host outlives the session
    std::unique_ptr<WireSession> (*open)(WireHost& host, const std::string& id) = nullptr;
};

/// All protocols, in the order of the options.
std::span<const WireProtocol* const> wireProtocols();

// Helpers for refusal().

/// Returns "no laser `l9`, did you mean `l1`?" unless a sensor with this keyword has the id, else
/// "".
std::string refusalOfSensor(const World& world, std::string_view keyword, std::string_view id);
/// The same for robots.
std::string refusalOfRobot(const World& world, std::string_view id);

}  // namespace ispace::wire
