// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of laser protocols: a run without a server, and a session's dialogue with it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "extensions/wire/wire_session.h"
#include "support/test_layout.h"

namespace ispace::testing {

/// A world that is stepped by the test; clocks of devices show simulated time, `offset` later.
class LaserHost : public wire::WireHost {
  public:
    LaserHost(const std::string& room, const std::string& layout, SimTime step)
        : scene_(testing::scene(room, layout)), world_(scene_, step) {}

    [[nodiscard]] World& world() override { return world_; }
    [[nodiscard]] bool isReplay() const override { return is_replay; }
    [[nodiscard]] bool isPaused() const override { return true; }
    Change change(std::span<const std::string> /*assignments*/) override { return Change::Refused; }
    std::optional<std::int64_t> hold(std::string_view robot) override {
        if (held_.count(std::string(robot)) > 0) return std::nullopt;
        return held_[std::string(robot)] = ++holds_;
    }
    [[nodiscard]] bool holds(std::string_view robot, std::int64_t hold) override {
        const auto found = held_.find(std::string(robot));
        return found != held_.end() && found->second == hold;
    }
    void release(std::string_view robot, std::int64_t hold) override {
        if (!holds(robot, hold)) return;
        held_.erase(std::string(robot));
        world_.command(*world_.robotNamed(robot), {Verb::Stop, 0});
    }
    [[nodiscard]] std::chrono::nanoseconds clock() const override { return world_.time() + offset; }

    bool is_replay = false;
    std::chrono::nanoseconds offset{};

  private:
    Scene scene_;
    World world_;
    std::map<std::string, std::int64_t> held_;
    std::int64_t holds_ = 0;
};

/// Returns the session's answer to these bytes, given in pieces of `piece` bytes.
inline std::string answered(wire::WireSession& session, std::string_view bytes,
                            std::size_t piece = std::string_view::npos) {
    std::string out;
    for (std::size_t i = 0; i < bytes.size() && !session.closing();) {
        const std::string_view part = bytes.substr(i, piece);
        session.receive(part);
        out += session.take();
        i += part.size();
    }
    return out;
}

/// Returns the bytes that the session sends during so many steps.
inline std::string stepped(LaserHost& host, wire::WireSession& session, int steps,
                           std::size_t unsent = 0) {
    std::string out;
    for (int i = 0; i < steps; ++i) {
        host.world().step();
        session.stepped(unsent);
        out += session.take();
    }
    return out;
}

}  // namespace ispace::testing
