// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of the dialogues about topics: a world with one client, without transport.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "extensions/ros/ros_dialogue.h"
#include "server/server_state.h"
#include "support/test_source.h"
#include "support/test_world.h"

namespace ispace::testing {

/// Returns the little-endian number at an offset.
template <typename Number>
Number numberAt(const std::string& bytes, std::size_t at) {
    Number number{};
    if (at + sizeof number <= bytes.size()) std::memcpy(&number, &bytes[at], sizeof number);
    return number;
}

/// A client of the world in steps of 0.1 s.
template <typename Dialogue>
class RosTalk {
  public:
    template <typename... Arguments>
    explicit RosTalk(const ServerLimits& limits, ros::RosScenery scenery,
                     const Arguments&... arguments)
        : state(room.simulation, limits),
          feed(state, std::move(scenery)),
          dialogue(std::make_unique<Dialogue>(state, feed, arguments...)) {}

    static ServerLimits limits() {
        ServerLimits limits;
        limits.source = std::make_shared<const TextSource>();
        return limits;
    }

    void send(const nlohmann::json& request) { dialogue->receive(request.dump(), true); }
    void stepped() {
        feed.stepped();
        dialogue->stepped();
    }
    void step(std::int64_t count = 1) {
        room.simulation.allow(count);
        for (std::int64_t i = 0; i < count; ++i) {
            room.simulation.run({}, std::chrono::nanoseconds(0));
            state.collect();
            stepped();
        }
    }
    /// Carries out pending changes, which wait for their turn.
    void settle() {
        for (int i = 0; i < 20000 && dialogue->waiting(); ++i) {
            state.collect();
            dialogue->proceed();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        EXPECT_FALSE(dialogue->waiting());
    }
    std::optional<std::string> next() {
        auto message = dialogue->next();
        if (!message) return std::nullopt;
        return message->head + (message->body ? *message->body : "") + message->tail;
    }
    void drain() {
        while (next()) continue;
    }
    /// Returns the next message of text; null without one.
    nlohmann::json text() {
        for (auto message = dialogue->next(); message; message = dialogue->next()) {
            if (!message->is_text) continue;
            return nlohmann::json::parse(message->head + (message->body ? *message->body : "") +
                                         message->tail);
        }
        return {};
    }
    /// Returns the next binary message with this first byte; "" without one.
    std::string binary(char first) {
        for (auto message = next(); message; message = next())
            if (message->starts_with(first)) return *message;
        return "";
    }

    TestWorld room;
    ServerState state;
    ros::RosFeed feed;
    std::unique_ptr<Dialogue> dialogue;
};

}  // namespace ispace::testing
