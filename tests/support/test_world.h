// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of lib/engine/sim: a small world with a robot that carries a laser, a bare robot, and a
// standing laser.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "sim/simulation.h"
#include "support/test_layout.h"

namespace ispace::testing {

/// Steps of 0.1 s, each of which reads every laser. l1 looks at a wall 7 m away: the middle one of
/// its three beams meets it at 7 m, the others beyond their range. `more` records may follow.
struct TestWorld {
    explicit TestWorld(Clock clock = {Clock::Kind::Step, 1}, std::optional<SimTime> until = {},
                       const std::string& script = "", const std::string& more = "")
        : scene(testing::scene("ispace size=8,6\n",
                               "robot id=r1 model=pioneer-2dx at=0,0\n"
                               "robot id=r2 at=2,1.5 heading=90 accel=1 speed=0.5\n"
                               "laser id=l1 at=-3,-2 fov=4 step=2 range=0.1,7.002\n"
                               "laser id=l2 on=r1 at=0.1,0,0.5 fov=1 range=20 rate=2.5\n" +
                                   more)),
          world(scene, std::chrono::milliseconds(100)),
          simulation(world, readScript(script, "run.txt", world), clock, until) {}

    Scene scene;
    World world;
    Simulation simulation;
};

}  // namespace ispace::testing
