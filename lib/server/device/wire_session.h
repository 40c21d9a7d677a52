// SPDX-License-Identifier: GPL-3.0-or-later
// lib/server/device: the languages of real devices, for programs that know nothing of simulations.
// Bytes in, bytes out, no transport. Uses sim and below.
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

#include "server/device/picture_files.h"
#include "sim/world.h"

namespace ispace {

/// What a session sees of the run it is part of, and what it may do there. Everything happens
/// between steps, in the thread that takes them.
class WireHost {
  public:
    WireHost() = default;
    virtual ~WireHost() = default;
    WireHost(const WireHost&) = delete;
    WireHost& operator=(const WireHost&) = delete;

    /// To be read; commands are for the robot that the session holds.
    [[nodiscard]] virtual World& world() = 0;
    /// True if robots go as recorded, whatever they are told.
    [[nodiscard]] virtual bool isReplay() const = 0;
    /// True while the world waits to be told to go on, as always with the clock `step`.
    [[nodiscard]] virtual bool isPaused() const = 0;
    enum class Change {
        Done,
        Refused,  ///< clients may not change the world, or it cannot be like that
        Later     ///< changes leave the world time to go on: ask again after the next step
    };
    /// Changes the world as requests `SET ID.key=value` do, all at once.
    virtual Change change(std::span<const std::string> assignments) = 0;

    /// A number for the hold of this robot; nothing if another client, of any protocol, has it.
    virtual std::optional<std::int64_t> hold(std::string_view robot) = 0;
    /// False once the world has lost it.
    [[nodiscard]] virtual bool holds(std::string_view robot, std::int64_t hold) = 0;
    /// Frees the robot, and stops it.
    virtual void release(std::string_view robot, std::int64_t hold) = 0;

    /// What clocks of devices show: the time since the start of the run, simulated or of the wall.
    [[nodiscard]] virtual std::chrono::nanoseconds clock() const = 0;

    /// Does what takes long: now, or where there is another thread, in that while others are
    /// served. `deliver` is then called between steps, with what was thrown or null, and stepped()
    /// of all sessions after it.
    virtual void runInBackground(std::function<void()> work,
                                 std::function<void(const std::exception_ptr& failure)> deliver);
    /// Of all sessions together.
    [[nodiscard]] PictureFiles& pictures() { return pictures_; }

  private:
    PictureFiles pictures_;
};

/// The device's end of one client's dialogue.
///
/// What a session sends goes out in order, and whole: each call's bytes with one write if the
/// system takes them. A client that does not read keeps its session from sending what it may miss
/// (see stepped()), and its requests unread.
class WireSession {
  public:
    WireSession() = default;
    /// The connection is gone: frees what it holds.
    virtual ~WireSession() = default;
    WireSession(const WireSession&) = delete;
    WireSession& operator=(const WireSession&) = delete;

    /// The next bytes of the client, in whatever pieces they arrived. \pre !closing()
    virtual void receive(std::string_view bytes) = 0;
    /// Call it after each step or change of the world. `unsent` bytes of earlier packets wait for a
    /// slow reader: a session that has something newer to say leaves it out as a whole if they are
    /// many.
    virtual void stepped(std::size_t unsent) = 0;
    /// The client sends no more; it may still read.
    virtual void ended() { close(); }
    /// True while a change of the world that the client asked for waits for its turn.
    [[nodiscard]] virtual bool waitsToChange() const { return false; }
    /// Asks for it again. \pre waitsToChange()
    virtual void proceed() {}
    /// True while it does something lasting for its client: sends by itself, or holds a robot. Any
    /// other has no claim to a port that others want unless it has just been asked something.
    [[nodiscard]] virtual bool isEngaged() const = 0;
    /// True once the client has said something in the device's language.
    [[nodiscard]] bool understood() const { return understood_; }
    /// True once nothing more is read: the connection ends when all is sent.
    [[nodiscard]] bool closing() const { return closing_; }
    /// Takes what is to be sent, in order.
    std::string take() { return std::exchange(out_, {}); }

  protected:
    void send(std::string_view bytes) { out_ += bytes; }
    void close() { closing_ = true; }
    void setUnderstood() { understood_ = true; }

  private:
    std::string out_;
    bool closing_ = false, understood_ = false;
};

/// One language: what simrun needs to know of it. Who adds one writes its session and such a row,
/// and lists it in wireProtocols().
struct WireProtocol {
    std::string_view name;    ///< of the option (--scip) and of the key in simrun's first line
    std::string_view device;  ///< what it is a port of: "ROBOT", "LASER", "CAMERA"
    std::string_view help;    ///< of the option
    std::uint16_t port = 0;   ///< where programs look for such a device
    /// Served at once on a port; more are turned away, as the devices do.
    std::size_t clients = 1;
    /// Why this robot or sensor of the world cannot have such a port ("no laser `l9`"), or "".
    std::string (*refusal)(const World& world, std::string_view id) = nullptr;
    /// \pre the host outlives the session, and there is no refusal
    std::unique_ptr<WireSession> (*open)(WireHost& host, const std::string& id) = nullptr;
};

/// All of them, in the order of the options.
std::span<const WireProtocol* const> wireProtocols();

// For refusal().

/// "no laser `l9`, did you mean `l1`?" of the sensors with this keyword, or "" if it is one.
std::string refusalOfSensor(const World& world, std::string_view keyword, std::string_view id);
/// The same of robots.
std::string refusalOfRobot(const World& world, std::string_view id);

}  // namespace ispace
