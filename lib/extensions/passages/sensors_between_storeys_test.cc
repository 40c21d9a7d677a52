// SPDX-License-Identifier: GPL-3.0-or-later
// Sensors of other storeys that a run moves, deletes and adds.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "extensions/passages/building_run.h"
#include "extensions/passages/passages_test.h"

namespace ispace::passages {
namespace sensors_between_storeys_test {

using testing::buildingOf;
using testing::optionsOf;

constexpr const char* kAtrium =
    "- storey: {id: ground, height: 3, records: &room [{fence: {id: f, path: [[0, 0], [12, 0], "
    "[12, 8], [0, 8]], closed: yes}}]}\n"
    "- storey: {id: upper, z: 3, height: 3, records: *room}\n"
    "- shaft: {id: atrium, storeys: 'ground,upper', path: [[4, 2], [8, 2], [8, 6], [4, 6]]}\n";

/// Looks straight down from 5 m above the ground.
std::string eyeAt(const std::string& at) {
    return "camera id=upper/c at=" + at + ",2 tilt=-90 fov=60 pixels=64,64\n";
}

/// Replaces the sensors of the upper storey, as a client does.
void replaceSensors(BuildingRun& run, const SiteScene& building, const std::string& layout) {
    World& world = run.rooms()[1].simulation->world();
    std::vector<Record> records;
    for (const Record& record : world.scene().records)
        if (record.keyword() != "camera") records.push_back(record);
    for (const Record& record : testing::layoutDocument(layout).records) records.push_back(record);
    world.change(makeScene(std::move(records), world.scene(), building.devices));
}

TEST(SensorsBetweenStoreys, CountInEventsAsTheyStand) {
    const SiteScene building = buildingOf("human id=ground/h at=6,4\n" + eyeAt("6,4"), kAtrium);
    BuildingRun run(building, optionsOf());
    EventLog& events = run.rooms().front().simulation->events();
    events.want({EventKind::Seen, EventKind::Lost});
    const auto events_after = [&](int steps) {
        const std::int64_t before = events.next();
        for (int i = 0; i < steps; ++i) testing::step(run);
        std::vector<EventKind> kinds;
        for (std::int64_t i = before; i < events.next(); ++i) kinds.push_back(events.at(i).kind);
        return kinds;
    };
    using Kinds = std::vector<EventKind>;
    EXPECT_EQ(events_after(30), Kinds{EventKind::Seen});
    EXPECT_EQ(events_after(30), Kinds{});
    // In a corner it sees no floor below.
    replaceSensors(run, building, eyeAt("1,1"));
    EXPECT_EQ(events_after(30), Kinds{EventKind::Lost});
    replaceSensors(run, building, eyeAt("6.2,4"));
    EXPECT_EQ(events_after(30), Kinds{EventKind::Seen});
    replaceSensors(run, building, "");
    EXPECT_EQ(events_after(30), Kinds{EventKind::Lost});
    // The start has it.
    run.restart();
    EXPECT_EQ(events_after(30), Kinds{EventKind::Seen});
}

}  // namespace sensors_between_storeys_test
}  // namespace ispace::passages
