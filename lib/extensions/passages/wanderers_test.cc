// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "extensions/passages/passages_test.h"

namespace ispace::passages {
namespace wanderers_test {

using testing::buildingOf;
using testing::optionsOf;
using testing::poseOf;
using testing::step;

TEST(BuildingTrip, PausesAtPointsAndBeginsAgain) {
    const SiteScene building = buildingOf("human id=ground/h at=6,4\n");
    BuildingRun run(building, optionsOf());
    const std::vector<RoomPoint> points = {{1, {9, 6}}, {0, {9, 4}}};
    ASSERT_EQ(run.travel("ground/h", {.points = points, .pause = 3, .loop = true}).refusal, "");
    // The seconds that it rests at each point, one after another.
    std::vector<std::pair<std::size_t, double>> rests;
    double since = 0;
    std::optional<std::size_t> at;
    while (rests.size() < 4 && seconds(run.world(0).time()) < 200) {
        step(run);
        ASSERT_TRUE(run.tripEnds().empty());
        const double now = seconds(run.world(0).time());
        const std::size_t room = run.roomOf("ground/h").value();
        const bool is_there =
            room < 2 && distance(poseOf(run, "ground/h").position, points[1 - room].at) < 0.02;
        if (is_there && !at) since = now;
        if (at && !is_there) rests.emplace_back(*at, now - since);
        at = is_there ? std::optional(room) : std::nullopt;
    }
    ASSERT_EQ(rests.size(), 4U);
    for (std::size_t i = 0; i < rests.size(); ++i) {
        EXPECT_EQ(rests[i].first, 1 - i % 2);
        EXPECT_GE(rests[i].second, 3);
        EXPECT_LT(rests[i].second, 5);
    }
    EXPECT_EQ(run.endTrip("ground/h", Outcome::Stopped), "");
}

/// A mover that wanders comes to all storeys, the same way each time.
TEST(Wanderers, WanderersGoToOtherStoreys) {
    const auto rooms = [](std::uint64_t seed) {
        const SiteScene building = buildingOf(
            "human id=ground/h at=6,4 walk=wander\nrobot id=upper/r at=6,4 walk=wander\n");
        BuildingRunOptions options = optionsOf(std::chrono::milliseconds(50));
        options.run.seed = seed;
        BuildingRun run(building, options);
        std::vector<std::vector<std::size_t>> storeys(2);
        double way = 0;
        Point2 last = poseOf(run, "ground/h").position;
        while (seconds(run.world(0).time()) < 900) {
            step(run);
            const std::array<std::size_t, 2> now = {*run.roomOf("ground/h"),
                                                    *run.roomOf("upper/r")};
            for (std::size_t i = 0; i < 2; ++i)
                if (now[i] < 2 && (storeys[i].empty() || storeys[i].back() != now[i]))
                    storeys[i].push_back(now[i]);
            const Point2 p = poseOf(run, "ground/h").position;
            if (now[0] < 2) way += distance(last, p);
            last = p;
        }
        for (const std::vector<std::size_t>& visited : storeys) EXPECT_GE(visited.size(), 3U);
        EXPECT_GT(way, 200) << "it goes on wandering behind the stairs";
        return std::pair(storeys, last);
    };
    const auto first = rooms(1);
    EXPECT_TRUE(first == rooms(1));
    EXPECT_FALSE(first == rooms(2));
}

TEST(Wanderers, ACommandEndsWandering) {
    const SiteScene building = buildingOf("robot id=ground/r at=6,4 walk=wander\n");
    BuildingRun run(building, optionsOf(std::chrono::milliseconds(50)));
    while (seconds(run.world(0).time()) < 5) step(run);
    World& world = run.rooms()[0].simulation->world();
    ASSERT_EQ(run.endTrip("ground/r", Outcome::Stopped), "");
    world.command(0, {Verb::Stop, 0});
    while (seconds(run.world(0).time()) < 8) step(run);
    const Point2 at = poseOf(run, "ground/r").position;
    while (seconds(run.world(0).time()) < 400) step(run);
    EXPECT_EQ(run.roomOf("ground/r"), 0U);
    EXPECT_EQ(poseOf(run, "ground/r").position, at);
}

}  // namespace wanderers_test
}  // namespace ispace::passages
