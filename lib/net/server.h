// SPDX-License-Identifier: GPL-3.0-or-later
// lib/net: the Simulator TCP Protocol and its server. Uses sim and below; Asio inside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "net/limits.h"
#include "sim/simulation.h"

namespace ispace {

/// A TCP endpoint "127.0.0.1:0"; port 0: one the system gives.
struct Endpoint {
    std::string address = "127.0.0.1";
    std::uint16_t port = 0;
};
/// ADDR:PORT with a numeric loopback address (127.x.y.z, [::1]) or localhost.
/// \throws UsageError, also for an address beyond this machine
Endpoint parseEndpoint(const std::string& text);

/// Serves a simulation to many clients, and runs it: one thread does both in turn, so that a world
/// never changes while a client is answered; sensors are read on all cores.
///
/// Writing never waits: a client that does not read gets the newest scan when it does, and its
/// requests wait while it leaves replies unread. What clients together leave unread is bounded; so
/// is the time in which a connection takes a role.
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
    /// Those that are served now; may be asked from any thread.
    [[nodiscard]] std::size_t clients() const;

    /// Runs, once, until the simulation is finished; then sends what clients are still to get, for
    /// half a second at most, and closes.
    void run();
    /// Finishes the simulation, from any thread; also before run(), which then ends at once.
    void stop();
    /// The same as soon as there is something to be read from `descriptor`, which stays open while
    /// run() does its work, and is not read.
    void stopOn(int descriptor);

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
