// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of the server: sessions without a transport.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <list>
#include <optional>
#include <string>
#include <string_view>

#include "server/server_state.h"
#include "server/session.h"
#include "support/test_world.h"

namespace ispace::testing {

constexpr std::chrono::nanoseconds kLong = std::chrono::hours(1);

/// A server without a transport: its state and its sessions.
struct Talk {
    explicit Talk(Clock clock = {Clock::Kind::Step, 1}, std::optional<SimTime> until = {},
                  const std::string& script = "", const ServerLimits& limits = {})
        : room(clock, until, script), state(room.simulation, limits) {
        room.simulation.onStep([this] {
            for (Session& client : clients) client.stepped();
        });
    }
    Session& client(std::string_view role = "") {
        Session& added = clients.emplace_back(state);
        if (!role.empty()) {
            EXPECT_TRUE(ask(added, role).starts_with("OK "));
        }
        return added;
    }
    static std::string ask(Session& client, std::string_view request) {
        client.request(request);
        return client.take();
    }
    /// Runs the steps that are allowed.
    void run() {
        room.simulation.run(WallTime{}, kLong);
        for (Session& client : clients)
            if (client.waiting()) client.stepped();
    }
    void step(std::int64_t count) {
        room.simulation.allow(count);
        run();
    }
    std::string scan(std::size_t laser, bool stream, bool binary) {
        return scanText(room.world.sensors()[laser], room.world.reading(laser),
                        {.stream = stream, .binary = binary});
    }

    TestWorld room;
    ServerState state;
    std::list<Session> clients;
};

inline std::string streamed(Session& client) {
    const auto scan = client.takeScan();
    return scan ? *scan : "";
}

}  // namespace ispace::testing
