// SPDX-License-Identifier: GPL-3.0-or-later
// A small run with its server's state, for the fuzzers of clients' languages.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "fuzz.h"
#include "fuzz_room.h"
#include "server/server_state.h"

namespace ispace::fuzz {

/// Refuses files, and records that make a step take long.
class SmallScenes : public SceneSource {
  public:
    [[nodiscard]] const DeviceCatalogue& devices() const override { return devices_; }
    [[nodiscard]] Scene load(const std::string& /*environment*/,
                             const std::string& /*layout*/) const override {
        throw FormatError({"", 0, 0, "no file is read here"});
    }
    void loadFilesOf(Record& record) const override {
        if (!isSmall(record)) throw FormatError({"", 0, 0, "the record is too large"});
    }

  private:
    DeviceCatalogue devices_;
};

/// A robot with a laser, a person and one sensor of each kind, with the clock `step`.
class ServedRoom {
  public:
    ServedRoom() : state_(simulation_, limits()) {}
    [[nodiscard]] Simulation& simulation() { return simulation_; }
    [[nodiscard]] ServerState& state() { return state_; }

    /// Takes the steps that clients have asked for, a few at most. Calls `stepped` after each.
    template <typename Stepped>
    void run(Stepped stepped) {
        constexpr int kMaxSteps = 4;
        for (int i = 0; i < kMaxSteps && simulation_.owed() > 0; ++i) {
            simulation_.run({}, std::chrono::nanoseconds(0));
            stepped();
        }
    }

  private:
    static ServerLimits limits() {
        ServerLimits limits;
        limits.source = std::make_shared<const SmallScenes>();
        return limits;
    }

    FuzzRoom room_{
        "zone id=z1 at=0,0 size=2,2\n"
        "robot id=r1 at=0,0 sonar=0.1,0,0;0,0.1,90 sonar_range=3 bumpers=-30,30;150,210\n"
        "laser id=l1 on=r1 at=0.1,0,0.3 fov=4 step=2 range=3 rate=10\n"
        "laser id=l2 at=-3,-2 fov=4 step=2 range=8\n"
        "ranger id=d1 at=0,2,1 pixels=4,3 fov=60 range=0.3,7\n"
        "camera id=c1 at=0,-2,2 pixels=4,3\n"
        "human id=h1 at=2,2\n"
        "mat id=m1 at=1,0 size=1,1\n"
        "gate id=g1 at=1.5,0\n"};
    Simulation simulation_{room_.world(), {}, {Clock::Kind::Step, 1}, {}};
    ServerState state_;
};

}  // namespace ispace::fuzz
