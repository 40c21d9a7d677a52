// SPDX-License-Identifier: GPL-3.0-or-later
// Scripts of `simrun --script`: commands in the order of time, for robots and people that exist.
#include "fuzz.h"
#include "fuzz_room.h"
#include "sim/simulation.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    FuzzRoom room(
        "robot id=r1 at=0,0\nhuman id=h1 at=2,2 tag=42\nzone id=z1 at=-1,1 size=1,1\n"
        "lamp id=l1 at=1,1\nswitch id=b1 at=0,2\nwall id=w from=-2,-3 to=-2,3\ninside at=-3,0\n"
        "zone id=z2 at=-3,0 size=1,1\ndoor id=d1 wall=w offset=3 locked=yes access=42\n"
        "curtain id=c1 from=1,-3 to=1,3\n");
    World& world = room.world();
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
