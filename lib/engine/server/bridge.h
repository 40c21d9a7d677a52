// SPDX-License-Identifier: GPL-3.0-or-later
// The seam between a server and other protocols that carry its run: the page, topics of ROS, a
// broker of MQTT, the ports of real devices. A server holds its bridges and gives each its turn; it
// knows no bridge by name.
//
// Order of calls: open (the constructor), then stepped() and serve() in turn, then for bridges that
// keep the last step lastStepped() and finish(), then end(), busy() for at most half a second, and
// closeAll().
#pragma once

#include <functional>
#include <optional>

#include "sim/simulation.h"

namespace boost::asio {
class io_context;
}

namespace ispace {

class ServerState;
struct ServerLimits;

/// What a server shares with its bridges. All of it outlives them.
struct BridgeHost {
    boost::asio::io_context& io;  ///< one thread runs it, which also steps the world
    const ServerLimits& limits;
    ServerState& state;  ///< of the world, or of the first one, which leads to the others
    /// Ends the server's sleep, so that it calls Bridge::serve(). Callable from any thread.
    std::function<void()> wake;
};

/// A further way into a run and out of it. All functions are called in the thread of the world,
/// none of them may wait: a bridge reads and writes by handlers of BridgeHost::io, or in threads of
/// its own that post to it.
///
///     class Lamp final : public Bridge {        // a line for each step
///         void stepped() override { port_.send(state_.simulation().world().time()); }
///         ...
///     };
///     server.add(std::make_unique<Lamp>(server.host(), endpoint));
class Bridge {
  public:
    Bridge() = default;
    Bridge(const Bridge&) = delete;
    Bridge& operator=(const Bridge&) = delete;
    virtual ~Bridge() = default;

    /// Called after each step or change of the world.
    virtual void stepped() = 0;
    /// Called between steps, at least each two milliseconds while clients are busy: carries out
    /// requests and sends answers. \param has_made background work has ended since the last call
    virtual void serve(bool has_made) = 0;
    /// Returns true if a client awaits its turn to change the world.
    [[nodiscard]] virtual bool waitsToChange() const = 0;
    /// Returns true if it reads pictures and depth frames, for which each step of a clock that is
    /// not real may have to wait.
    [[nodiscard]] virtual bool takesFrames() const { return true; }
    /// Returns the time since which its latest reader is awaited, among those since `earliest`.
    [[nodiscard]] virtual std::optional<WallTime> awaitedSince(WallTime /*earliest*/) const {
        return std::nullopt;
    }
    /// Returns the time of the next call of serve() that it asks for; empty: it has handlers.
    [[nodiscard]] virtual std::optional<WallTime> nextTurn() const { return std::nullopt; }

    /// Returns true if it keeps the last step with all frames: the server then waits for them.
    [[nodiscard]] virtual bool keepsLastStep() const { return false; }
    /// Called for that step instead of stepped(), and again when more of its frames have come.
    virtual void lastStepped() {}
    /// Called once that step is complete, or its frames were given up.
    virtual void finish() {}

    /// Ends: closes ports, and tells clients so.
    virtual void end() = 0;
    /// Returns true while output of the end is still to be sent.
    [[nodiscard]] virtual bool busy() = 0;
    /// Closes all connections at once.
    virtual void closeAll() = 0;
};

}  // namespace ispace
