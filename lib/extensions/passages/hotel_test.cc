// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/number.h"
#include "extensions/passages/passages_test.h"
#include "site/storeys.h"

namespace ispace::passages {
namespace hotel_test {

using testing::optionsOf;
using testing::poseOf;
using testing::step;

/// The hotel with two lifts that bear two of the four robots each.
SiteScene hotel() {
    StoreyedDocument document = readBuilding(
        readAll(testing::sourcePath("tests/data/hotel.building.yaml")), "hotel.building.yaml", {});
    for (StoreyPassage& passage : document.passages) passage.capacity = 130;
    const std::vector<Document> layouts = layoutsOf(
        testing::layoutDocument("robot id=l1/tiny1 mass=60 at=4,-4\nrobot id=l1/tiny2 mass=60 "
                                "at=20,-4\nrobot id=l2/clean mass=60 at=11,-4\nrobot "
                                "id=l3/deliver mass=60 at=2,-7\n"),
        document);
    return makeSiteScene(std::move(document), layouts, testing::devices());
}

/// What an hour in the hotel comes to.
struct HotelHour {
    std::string ways;
    int done = 0, others = 0;
    std::size_t most_riders = 0;
};

/// Lets each robot go to one point after another for an hour of simulated time.
HotelHour anHour(bool& is_sound) {
    const SiteScene building = hotel();
    BuildingRun run(building, optionsOf(std::chrono::milliseconds(50)));
    const std::vector<std::string> robots = {"l1/tiny1", "l1/tiny2", "l2/clean", "l3/deliver"};
    const std::vector<Point2> points = {{2, -7.5}, {8, -7.5}, {14, -7.5}, {21, -7.5}, {11, -4}};
    std::vector<std::size_t> trips(robots.size());
    HotelHour hour;
    const auto send = [&](std::size_t k) {
        const std::size_t n = trips[k]++;
        const RoomPoint goal{(n + k + 1) % 3, points[(2 * n + k) % points.size()]};
        is_sound = is_sound && run.travel(robots[k], {{goal}}).refusal.empty();
    };
    for (std::size_t k = 0; k < robots.size(); ++k) send(k);
    while (seconds(run.world(0).time()) < 3600) {
        step(run);
        for (const TripEnd& end : run.tripEnds()) {
            ++(end.outcome == Outcome::Done ? hour.done : hour.others);
            hour.ways += end.mover + ' ' + std::to_string(end.time.count()) + '\n';
            send(static_cast<std::size_t>(std::find(robots.begin(), robots.end(), end.mover) -
                                          robots.begin()));
        }
        for (const std::size_t cabin : {3U, 4U}) {
            const World& world = run.world(cabin);
            hour.most_riders = std::max(hour.most_riders, world.movers().size());
            is_sound = is_sound && world.collisions().empty();
        }
        if (run.world(0).steps() % 100 != 0) continue;
        for (const std::string& id : robots) {
            const Pose2 pose = poseOf(run, id);
            hour.ways += std::to_string(run.roomOf(id).value()) + ' ' +
                         formatDouble(pose.position.x) + ' ' + formatDouble(pose.position.y) + '\n';
        }
    }
    return hour;
}

TEST(BuildingRun, FourRobotsGoAboutAHotelForAnHour) {
    bool is_sound = true;
    const HotelHour hour = anHour(is_sound);
    EXPECT_TRUE(is_sound);
    EXPECT_EQ(hour.most_riders, 2U);
    EXPECT_EQ(hour.others, 0);
    EXPECT_GT(hour.done, 100);
    EXPECT_TRUE(hour.ways == anHour(is_sound).ways);
}

}  // namespace hotel_test
}  // namespace ispace::passages
