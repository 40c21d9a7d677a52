// SPDX-License-Identifier: GPL-3.0-or-later
// lib/server: the Simulator TCP Protocol, its server, and the transport of device ports. Uses wire
// and below; Asio inside. Private to lib/server, since it includes Asio.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/device/wire_session.h"
#include "server/network.h"
#include "sim/simulation.h"
#include "sim/world_editor.h"

namespace ispace {

/// A TCP endpoint; port 0 lets the system choose.
struct Endpoint {
    std::string address = "127.0.0.1";
    std::uint16_t port = 0;
    bool is_loopback = true;  ///< other machines cannot connect
};
/// ADDR:PORT with a numeric address (127.0.0.1, [::1], 0.0.0.0) or localhost. \throws UsageError
Endpoint parseEndpoint(const std::string& text);

/// How often something may be asked for: `rate` a second in the long run, `burst` at once.
struct RateLimit {
    double rate = 0;
    double burst = 0;
};

/// Limits that keep one client from harming the others.
struct ServerLimits {
    std::size_t clients = 256;  ///< the next one is answered ERR 429 and closed
    std::size_t line = 4096;    ///< bytes of a request without its end; else ERR 413
    /// Replies in bytes that a client may leave unread before its requests have to wait.
    std::size_t pending = std::size_t{1} << 18;
    /// What all clients together may leave unread, in bytes: replies and scans that are no longer
    /// the newest. Beyond it the slowest of those that hold more than an equal share have to go.
    std::size_t unread = std::size_t{1} << 27;
    /// How long a connection that is to end may take to read what it was sent.
    std::chrono::nanoseconds patience = std::chrono::seconds(10);
    /// A connection without a role ends this long after its last request (or its begin), and makes
    /// room for a new one as soon as `roleless_grace` after it when all places are taken.
    std::chrono::nanoseconds roleless = std::chrono::seconds(60);
    std::chrono::nanoseconds roleless_grace = std::chrono::seconds(1);
    /// PAUSE, and RESUME while running: for one client, and for all together.
    RateLimit pauses = {100, 100}, all_pauses = {200, 200};
    /// What each client still may ask for once all together have used up theirs.
    RateLimit spare_pauses = {1, 1};
    bool shutdown = true;  ///< clients may end the run
    bool changes = true;   ///< they may change the world, if there is a `source`
    std::shared_ptr<const SceneSource> source;
    /// What changes of the world and the end of the run need clients to know; "": nothing.
    std::string token;
    bool token_first = false;  ///< every role needs it
    RateLimit wrong_tokens = {10, 10};
    /// A robot or person stops when its client has been silent for so long; 0: never.
    std::chrono::nanoseconds watchdog{};
    /// Who may use device ports, besides this machine.
    std::vector<Network> allowed;
    bool wall_clock = false;  ///< clocks of devices show wall time, not that of the world
};

/// Runs a simulation and serves it to many clients. One thread does both in turn, so the world
/// never changes while a request is answered; sensors are read on all cores.
///
/// Writing never blocks: a slow reader gets the newest scan once it reads, and its requests wait
/// while it leaves replies unread. What all clients together leave unread is bounded, and so is the
/// time a connection may take to choose a role.
class Server {
  public:
    /// Listens at once. \throws std::system_error naming the endpoint
    Server(Simulation& simulation, const Endpoint& endpoint, const ServerLimits& limits = {});
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// "127.0.0.1:40123"
    [[nodiscard]] std::string address() const;
    [[nodiscard]] std::uint16_t port() const;
    /// Shows the running world to browsers, too, at an endpoint of its own. Call at most once,
    /// before run(). \param title of the page \returns "http://127.0.0.1:40124/"
    /// \throws std::system_error naming the endpoint
    std::string serveWeb(const Endpoint& endpoint, const std::string& title);
    /// Puts a robot or sensor behind the port of a real device, at an endpoint of its own. Call it
    /// before run(). \returns "127.0.0.1:10940"
    /// \throws UsageError if the world has no such device, std::system_error naming the endpoint
    std::string serveDevice(const WireProtocol& protocol, const std::string& id,
                            const Endpoint& endpoint);
    /// Has frames for a record made in the thread of pictures.
    [[nodiscard]] FrameTaker frameTaker();
    /// True if other threads are still at pictures, or at a change of the world, which the
    /// destructor waits for.
    [[nodiscard]] bool isBusy() const;
    /// Number of clients served now; callable from any thread.
    [[nodiscard]] std::size_t clients() const;

    /// Runs until the simulation is finished, waits for frames of the record and for pictures that
    /// clients have asked for, then sends what is pending for at most half a second and closes.
    /// Once stopOn() ends it, it waits for no picture. Call once.
    void run();
    /// Finishes the simulation. Callable from any thread, and before run(), which then returns at
    /// once.
    void stop();
    /// The same as soon as `descriptor` is readable. It must stay open during run() and is not
    /// read.
    void stopOn(int descriptor);

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Listens at an endpoint and hands over whoever connects, ready to be used without blocking.
class Acceptor {
  public:
    using Welcome = std::function<void(boost::asio::ip::tcp::socket)>;

    /// \throws std::system_error naming the endpoint
    Acceptor(boost::asio::io_context& io, const Endpoint& endpoint, Welcome welcome);

    /// "127.0.0.1", "[::1]"
    [[nodiscard]] std::string host() const;
    /// "127.0.0.1:40123", "[::1]:40123"
    [[nodiscard]] std::string address() const { return host() + ":" + std::to_string(port()); }
    [[nodiscard]] std::uint16_t port() const { return local_.port(); }
    void close();

  private:
    void accept();

    boost::asio::ip::tcp::acceptor acceptor_;
    boost::asio::steady_timer pause_;
    boost::asio::ip::tcp::endpoint local_;
    Welcome welcome_;
};

}  // namespace ispace
