// SPDX-License-Identifier: GPL-3.0-or-later
// Days of people in scripts of `simrun --script`: activities of people that exist, begun and run.
#include "extensions/days/activity.h"
#include "fuzz.h"
#include "fuzz_room.h"
#include "sim/simulation.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    FuzzRoom room(
        "human id=h1 at=2,2 tag=42\nzone id=z1 at=-1,1 size=1,1\n"
        "lamp id=l1 at=1,1\nswitch id=b1 at=0,2\nwall id=w from=-2,-3 to=-2,3\ninside at=-3,0\n"
        "zone id=z2 at=-3,0 size=1,1\ndoor id=d1 wall=w offset=3 locked=yes access=42\n"
        "curtain id=c1 from=1,-3 to=1,3\n");
    World& world = room.world();
    days::DayPlan plan = days::readDayPlan(bytes, "run.txt", world);
    for (const days::DayLine& line : plan.lines) {
        require(world.personNamed(line.person).has_value(), "a day of an unknown person");
        require(!line.actions.empty() && !line.name.empty(), "an activity without action or name");
    }
    Simulation simulation(world, {}, {Clock::Kind::Step, 1}, {});
    simulation.follow(std::make_shared<days::ActivityDirector>(std::move(plan)));
    constexpr int kSteps = 3;
    simulation.allow(kSteps);
    simulation.run({}, std::chrono::hours(1));
}
