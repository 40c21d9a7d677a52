// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/server: the server of the Simulator TCP Protocol (ispace-protocol(7)), and the seam
// for other protocols (bridge.h). Uses sim and below; Asio inside.
//
// One thread steps the world, answers requests and calls bridges in turn, some 2 ms each, so no
// request sees half a step. Heavy sensors and changes of the world are computed by up to two
// further threads for each world. With a clock that is not real, and in a replay or a paused world,
// the world waits for them: the sequence of steps and readings then does not depend on the speed of
// the machine. With a real clock the world runs on.
//
// Clients are untrusted. Lines, replies and connections are bounded by ServerLimits, pictures under
// way by sim/run_limits.h; a client that exceeds a limit is answered by an error line or
// disconnected, and the others go on. Transport is not encrypted.
//
//     Simulation simulation(world, {}, clock, std::nullopt);
//     Server server(simulation, parseEndpoint("127.0.0.1:0"));
//     announce(server.address());  // "127.0.0.1:40123": the system has chosen the port
//     server.run();                // until SHUTDOWN, stop() or the end of the simulation
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/file.h"
#include "server/client_role.h"
#include "server/network.h"
#include "sim/simulation.h"
#include "sim/world_editor.h"
#include "sim/worlds.h"

namespace ispace {

/// Limit on a request's frequency: `rate` a second in the long run, `burst` at once. Time is that
/// of the wall (steady clock), not of the simulation.
struct RateLimit {
    double rate = 0;
    double burst = 0;
};

/// Limits that keep one client from harming the others. Times are wall time.
struct ServerLimits {
    std::size_t clients = 256;  ///< further clients are answered ERR 429 and closed
    std::size_t line = 4096;    ///< bytes of a request without its end; else ERR 413
    /// Bytes of replies that a client may leave unread before its requests have to wait.
    std::size_t pending = std::size_t{1} << 18;
    /// Unread bytes of all clients together: replies and outdated scans. Above it, the slowest
    /// clients that hold more than an equal share are closed.
    std::size_t unread = std::size_t{1} << 27;
    /// Time that a closing connection has to read its output.
    std::chrono::nanoseconds patience = std::chrono::seconds(10);
    /// A connection without a role ends this long after its last request (or its start). When the
    /// server is full, it makes room for a new one `roleless_grace` after that request.
    std::chrono::nanoseconds roleless = std::chrono::seconds(60);
    std::chrono::nanoseconds roleless_grace = std::chrono::seconds(1);
    /// PAUSE, and RESUME while running: per client, and for all clients together.
    RateLimit pauses = {100, 100}, all_pauses = {200, 200};
    /// Rate left to each client after the common limit is used up.
    RateLimit spare_pauses = {1, 1};
    bool shutdown = true;  ///< clients may end the run
    bool changes = true;   ///< clients may change the world, if there is a `source`
    /// Reads the files that LOAD and records of clients name; null: the world cannot be changed.
    std::shared_ptr<const SceneSource> source;
    /// Token required to change the world and to end the run; "": none required.
    std::string token;
    bool token_first = false;  ///< every role requires it
    /// Wrong tokens of one address, and of all addresses without a right one; beyond it ERR 429.
    RateLimit wrong_tokens = {10, 10};
    /// A robot or person stops when its client has been silent this long; 0: never.
    std::chrono::nanoseconds watchdog{};
    /// Networks that may use device ports and DDS, besides this machine. The protocol's own port
    /// is not filtered: there the token decides.
    std::vector<Network> allowed;
    /// Unless the clock is real, the world waits until clients have read what they subscribed to
    /// over TCP and WebSockets: for each at most as long as the watchdog, else `patience`.
    bool waits_for_readers = false;
    bool wall_clock = false;  ///< clocks of devices show wall time instead of simulated time
};

/// Data that slow readers were not sent, since newer data took its place. Counts of the whole run.
struct ReaderLosses {
    std::int64_t readings = 0;  ///< of streams of the protocol
    std::int64_t messages = 0;  ///< of topics, over Foxglove and rosbridge
};

class Bridge;
struct BridgeHost;

/// Runs a simulation and serves it to many clients. One thread does both in turn, so the world does
/// not change while a request is answered; sensors are computed on all cores.
///
/// Writes never block: a slow reader receives the newest scan once it reads, and its requests wait
/// while it leaves replies unread. The unread bytes of all clients are bounded, and so is the time
/// in which a connection must choose a role.
///
/// A reading is formatted once for all its readers. Members are not thread-safe unless they say so.
class Server {
  public:
    /// Starts listening; clients are answered once run() is called. \param joined serves these
    /// worlds, which the simulation leads; may be null. Both outlive the server.
    /// \throws std::system_error naming the endpoint
    Server(Simulation& simulation, const Endpoint& endpoint, const ServerLimits& limits = {},
           Worlds* joined = nullptr);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// "127.0.0.1:40123"
    [[nodiscard]] std::string address() const;
    [[nodiscard]] std::uint16_t port() const;
    /// Returns what bridges are made with, see server/bridge.h.
    [[nodiscard]] BridgeHost host();
    /// Adds a further way into the run and out of it. Call before run(). \returns the bridge
    template <class B>
    B& add(std::unique_ptr<B> bridge) {
        B& added = *bridge;
        keep(std::move(bridge));
        return added;
    }
    /// Returns the number of readings and messages that slow readers have lost so far, by the kind
    /// of their port.
    [[nodiscard]] ReaderLosses readerLosses() const;
    /// Adds roles of extensions to the protocol, as far as the scenes ask for them. Call at most
    /// once, before run(). \returns notes on clients that the world waits for
    /// \throws FormatError as MakeRoleService
    std::vector<std::string> serveRoles(std::span<const MakeRoleService> services);
    /// Returns a function that computes frames of a record in the picture thread.
    /// \param room of the joined worlds
    [[nodiscard]] FrameTaker frameTaker(std::size_t room = 0);
    /// True while background threads compute pictures or a change of the world. The destructor
    /// waits for them.
    [[nodiscard]] bool isBusy() const;
    /// Number of clients served now; callable from any thread.
    [[nodiscard]] std::size_t clients() const;

    /// Runs until the simulation is finished, waits for frames of the record and requested
    /// pictures, then sends pending output for at most half a second and closes. Once stopOn() ends
    /// the run, it does not wait for pictures. Call once.
    void run();
    /// Finishes the simulation. Callable from any thread, and before run(), which then returns at
    /// once.
    void stop();
    /// Calls stop() once `descriptor` is readable, as that of StopSignals. It is duplicated and not
    /// read. Call once, before run(). \throws std::system_error without a free descriptor
    void stopOn(int descriptor);

  private:
    void keep(std::unique_ptr<Bridge> bridge);

    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
