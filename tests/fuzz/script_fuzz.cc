// SPDX-License-Identifier: GPL-3.0-or-later
// Scripts of `simrun --script`: commands in the order of time, for robots and people that exist.
#include "fuzz.h"
#include "sim/simulation.h"
#include "wire_host.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    RoomHost host("robot id=r1 at=0,0\nhuman id=h1 at=2,2\n");
    World& world = host.world();
    std::vector<TimedCommand> script = readScript(bytes, "run.txt", world);
    SimTime time{};
    for (const TimedCommand& timed : script) {
        require(timed.time >= time, "commands are not in the order of time");
        require(timed.robot < world.movers().size(), "a command for a mover that does not exist");
        time = timed.time;
    }
    Simulation simulation(world, std::move(script), {Clock::Kind::Step, 1}, {});
    constexpr int kSteps = 3;
    simulation.allow(kSteps);
    simulation.run({}, std::chrono::hours(1));
}
