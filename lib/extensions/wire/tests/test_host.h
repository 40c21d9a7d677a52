// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of device protocols: a run, and devices in it without a network.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "extensions/wire/wire_session.h"
#include "record/edit.h"
#include "sim/simulation.h"
#include "sim/world_editor.h"
#include "support/test_source.h"

namespace ispace::testing {

/// A world with steps of 10 ms by default.
class TestHost : public wire::WireHost {
  public:
    explicit TestHost(const std::string& layout, const std::string& room = "ispace size=8,6\n",
                      SimTime step = std::chrono::milliseconds(10))
        : scene_(scene(room, layout)),
          world_(scene_, step),
          simulation_(world_, {}, {Clock::Kind::Step, 1}, {}),
          editor_(simulation_, std::make_shared<TextSource>()) {}

    World& world() override { return world_; }
    [[nodiscard]] bool isReplay() const override { return is_replay; }
    [[nodiscard]] bool isPaused() const override { return true; }
    Change change(std::span<const std::string> assignments) override {
        if (changes_later-- > 0) return Change::Later;
        std::vector<Edit> edits;
        for (const std::string& one : assignments) edits.push_back(parseEdit(Edit::Kind::Set, one));
        try {
            editor_.edit(edits).carryOut();
        } catch (const FormatError&) {
            return Change::Refused;
        }
        return Change::Done;
    }
    std::optional<std::int64_t> hold(std::string_view robot) override {
        if (held_) return std::nullopt;
        held_ = robot;
        return 1;
    }
    bool holds(std::string_view robot, std::int64_t /*hold*/) override {
        return held_ == robot && world_.robotNamed(robot).has_value();
    }
    void release(std::string_view robot, std::int64_t /*hold*/) override {
        held_.reset();
        if (const auto index = world_.robotNamed(robot)) world_.command(*index, {Verb::Stop});
    }
    [[nodiscard]] std::chrono::nanoseconds clock() const override { return world_.time(); }

    [[nodiscard]] bool isHeld() const { return held_.has_value(); }
    /// Advances the time of a session.
    void run(wire::WireSession& session, double seconds) {
        const SimTime end = world_.time() + std::chrono::milliseconds(std::lround(seconds * 1000));
        while (world_.time() < end) {
            world_.step();
            session.stepped(0);
        }
    }

    bool is_replay = false;
    int changes_later = 0;  ///< number of changes that have to wait

  private:
    Scene scene_;
    World world_;
    Simulation simulation_;
    WorldEditor editor_;
    std::optional<std::string> held_;
};

}  // namespace ispace::testing
