// SPDX-License-Identifier: GPL-3.0-or-later
// For the tests of lib/extensions/locks: a flat with a locked door, and a run of it with the
// service.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "extensions/locks/lock_role.h"
#include "extensions/locks/locks_test.h"
#include "record/edit.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "server/session.h"
#include "sim/simulation.h"

namespace ispace::locks {

using Rows = std::vector<std::string>;

/// A hall and an office, with a door between them, and a way round by a lobby if `lobby` is open.
inline std::string flat(const std::string& door, const std::string& lobby = "") {
    return "#env 1\nfence id=f path=0,0;10,0;10,6;0,6 closed=yes\nwall id=w from=5,0 to=5,6\n"
           "wall id=v from=0,4 to=10,4\ndoor id=d wall=w offset=2 " +
           door + "\ndoor id=a wall=v offset=2 " + lobby + "\ndoor id=b wall=v offset=8 " + lobby +
           "\ndoor id=c wall=w offset=5 " + lobby +
           "\ninside at=1,1\ninside at=9,1\ninside at=1,5\ninside at=9,5\n"
           "zone id=hall at=2.5,2 size=5,4\nzone id=office at=7.5,2 size=5,4\n";
}

inline Scene sceneOf(const std::string& room, const std::string& people) {
    testing::addLocksOnce();
    const Document placed = readRecordText("#3dm 1\n" + people, "room.3dm", sceneSchemas());
    return makeScene(readRecordText(room, "room.env", sceneSchemas()), &placed, shippedDevices());
}

inline const std::string kPeople = "human id=ann at=1,2 tag=42\nhuman id=bob at=2,1 tag=7\n";

inline const Record& recordOf(const Scene& scene, std::string_view id) {
    for (std::size_t i = 0; i < scene.ids.size(); ++i)
        if (scene.ids[i] == id) return scene.records[i];
    throw std::logic_error("no such record");
}

/// A run with the service, in which changes are made as the server does.
class LockRole : public ::testing::Test {
  protected:
    LockRole()
        : scene_(sceneOf(
              flat("locked=yes access=42,43 strength=20 drive=l") + "lamp id=l at=1,1\n",
              kPeople + "robot id=r at=3,2 mass=40\nrobot id=askew at=3,0.5 heading=45 mass=40\n")),
          world_(scene_, std::chrono::milliseconds(100)),
          simulation_(world_, {}, {Clock::Kind::Step, 1}, {}),
          state_(simulation_),
          room_{"", &simulation_},
          service_(makeLocks({&room_, 1}, 1)) {
        state_.addRoleService(*service_);
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            while (simulation_.isChangeDue()) {
                changes_.push_back(simulation_.takeScriptedChange());
                try {
                    change(changes_.back());
                } catch (const FormatError&) {
                    changes_.back() += " is refused";
                }
            }
            simulation_.allow(1);
            simulation_.run(std::chrono::steady_clock::now(), std::chrono::seconds(10));
            service_->stepped();
        }
    }
    void change(const std::string& request) {
        world_.change(makeScene(editedRecords(world_.scene(), parseEdits(request),
                                              [](const std::string&) { return std::nullopt; }),
                                world_.scene(), shippedDevices()));
    }
    static std::string ask(Session& session, const std::string& line) {
        session.request(line);
        return session.take();
    }

    Scene scene_;
    World world_;
    Simulation simulation_;
    ServerState state_;
    RunRoom room_;
    std::unique_ptr<RoleService> service_;
    Rows changes_;
};

}  // namespace ispace::locks
