// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a Server. Private to lib/engine/server.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <list>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "server/acceptor.h"
#include "server/bridge.h"
#include "server/client_connection.h"
#include "server/server.h"
#include "server/server_state.h"

namespace ispace {

/// All members belong to the server's thread; `serving` may be read by any.
struct Server::Data {
    Data(Simulation& the_simulation, const Endpoint& endpoint, const ServerLimits& the_limits,
         Worlds* joined)
        : simulation(the_simulation),
          limits(the_limits),
          state(the_simulation, the_limits),
          acceptor(io, endpoint,
                   [this](asio::ip::tcp::socket socket) { welcome(std::move(socket)); }) {
        if (joined != nullptr) join(*joined);
        for (ServerState* const each : states())
            each->startBackground([this] { asio::post(io, [] {}); },
                                  [this] { return isStopped(); });
    }
    ~Data() {
        for (ServerState* const each : states()) each->stopBackground();
        closeAll();
    }

    void join(Worlds& joined);
    /// Returns the states of all worlds.
    [[nodiscard]] const std::vector<ServerState*>& states() const { return state.rooms().states; }
    bool collect();
    bool hasUpdates();

    void welcome(asio::ip::tcp::socket socket);
    bool makeRoom();
    void stepped();
    [[nodiscard]] bool rolesHoldWorld() const;
    [[nodiscard]] std::optional<WallTime> awaitedReader() const;
    [[nodiscard]] WallTime nextTurn() const;
    [[nodiscard]] std::chrono::nanoseconds turn() const;
    void serveClients();
    void sleepUntil(WallTime time);
    void relieve();
    void sweep();
    [[nodiscard]] bool isStopped();
    bool await();
    void finishRecord();
    void finishBridges();
    void end();
    void closeAll();

    Simulation& simulation;
    ServerLimits limits;
    ServerState state;                                // of the world, or of the first one
    std::list<ServerState> others;                    // of further rooms
    ServedRooms rooms;                                // with them
    std::vector<std::unique_ptr<RoleService>> roles;  // of extensions
    bool has_news = false;                            // between steps, not sent to all clients yet
    WallTime next_news{};
    asio::io_context io{1};  // one thread runs it
    Acceptor acceptor;
    asio::steady_timer alarm{io};
    asio::posix::stream_descriptor stopper{io};
    std::optional<WallTime> alarm_time;
    std::vector<std::shared_ptr<ClientConnection>> connections;  // in order of arrival
    std::atomic<std::size_t> serving = 0;
    std::vector<std::unique_ptr<Bridge>> bridges;
};

}  // namespace ispace
