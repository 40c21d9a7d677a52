// SPDX-License-Identifier: GPL-3.0-or-later
// Robots driven at random through a furnished room.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <random>

#include "base/file.h"
#include "base/number.h"
#include "geom/predicates.h"
#include "sim/collision.h"
#include "sim/world.h"
#include "support/test_layout.h"
#include "support/test_paths.h"

namespace ispace {
namespace world_random_test {

using std::chrono::milliseconds;

/// Radius of a person of 1.7 m.
constexpr double kPerson = 0.255;

/// A row of free places for people.
std::vector<Point2> peopleIn(const Obstacles& obstacles) {
    std::vector<Point2> places;
    for (double x = -4; x <= 4; x += 1)
        if (!obstacles.overlap({x, 0.5}, kPerson)) places.push_back({x, 0.5});
    return places;
}

/// The furnished room with people, and robots of different sizes at random free places, some with a
/// laser.
Scene crowdedRoom(std::size_t count, unsigned seed) {
    const std::string text = readAll(testing::sourcePath("share/scenes/crowded.env"));
    const Document document = readRecordText(text, "crowded.env", sceneSchemas());
    const Scene empty = makeScene(document, nullptr, testing::devices());
    const Obstacles obstacles(empty.environment.band(0, 0.5));
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-4.8, 4.8), radius(0.1, 0.25), any(-180, 180);
    const std::vector<Point2> people = peopleIn(obstacles);
    std::vector<std::pair<Point2, double>> placed;
    std::string layout;
    for (const Point2& p : people) {
        layout += "human at=" + formatDouble(p.x) + "," + formatDouble(p.y) + "\n";
        placed.emplace_back(p, kPerson);
    }
    while (placed.size() < count + people.size()) {
        const Point2 p{place(random), place(random)};
        const double r = radius(random);
        if (obstacles.overlap(p, r)) continue;
        if (std::any_of(placed.begin(), placed.end(), [&](const auto& other) {
                return distance(p, other.first) < r + other.second;
            }))
            continue;
        const std::string id = "r" + std::to_string(placed.size());
        layout += "robot id=" + id + " at=" + formatDouble(p.x) + "," + formatDouble(p.y) +
                  " heading=" + formatDouble(any(random)) + " radius=" + formatDouble(r) +
                  " height=0." + std::to_string(2 + placed.size() % 3) + "\n";
        if (placed.size() % 4 == 0) layout += "laser on=" + id + " fov=180 step=10 rate=7\n";
        placed.emplace_back(p, r);
    }
    const Document robots = testing::layoutDocument(layout);
    return makeScene(document, &robots, testing::devices());
}

/// Gives some robots a command of any kind.
void drive(World& world, std::mt19937_64& random) {
    std::uniform_real_distribution<double> share(0, 1);
    for (std::size_t i = 0; i < world.robots().size(); ++i) {
        if (share(random) > (world.status(i).stall ? 0.2 : 0.01)) continue;
        switch (static_cast<int>(share(random) * 8)) {
            case 0:
                world.command(i, {Verb::Speed, 3.2 * share(random) - 1.6});
                break;
            case 1:
                world.command(i, {Verb::Rotspeed, 600 * share(random) - 300});
                break;
            case 2:
                world.command(i, {Verb::Left, 180 * share(random)});
                break;
            case 3:
                world.command(i, {Verb::Right, 180 * share(random)});
                break;
            case 4:
                world.command(i, {Verb::Stop, 0});
                break;
            case 5:
                world.command(i, {Verb::Backward, 2 * share(random)});
                break;
            default:
                world.command(i, {Verb::Forward, 4 * share(random)});
        }
    }
}

/// By brute force; every solid and sheet at every robot's height.
void expectNoOverlap(const World& world, const std::vector<Slice>& bands,
                     const std::vector<Point2>& people) {
    for (std::size_t i = 0; i < world.robots().size(); ++i) {
        const Point2 p = world.status(i).pose.position;
        const double radius = world.robots()[i].model.radius;
        double nearest = 1e9;
        bands[i].forEachLine(
            [&](const Segment2& line) { nearest = std::min(nearest, distance(p, line)); });
        ASSERT_GE(nearest, radius - 2e-9) << i << " at " << world.steps();
        for (const Polygon& solid : bands[i].solids) ASSERT_EQ(locate(solid, p), Side::Outside);
        for (const Point2& person : people)
            ASSERT_GE(distance(p, person), radius + kPerson - 2e-9) << i << " at " << world.steps();
        for (std::size_t j = 0; j < i; ++j) {
            ASSERT_GE(distance(p, world.status(j).pose.position),
                      radius + world.robots()[j].model.radius - 2e-9)
                << i << ' ' << j << " at " << world.steps();
        }
    }
}

TEST(WorldRandom, NothingEverOverlaps) {
    const Scene room = crowdedRoom(60, 1);
    std::vector<Slice> bands;
    for (const PlacedRobot& robot : room.robots)
        bands.push_back(room.environment.band(0, robot.model.height));
    std::vector<Point2> people;
    for (const PlacedRecord& placed : room.placed)
        if (room.records[placed.record].keyword() == "human")
            people.push_back(placed.pose.position.onFloor());
    ASSERT_GE(people.size(), 3U);
    for (const SimTime step : {milliseconds(20), milliseconds(250)}) {
        World world(room, step);
        std::mt19937_64 random(7);
        std::size_t with_things = 0, with_robots = 0, with_people = 0, done = 0;
        while (world.time() < std::chrono::seconds(20)) {
            drive(world, random);
            world.step();
            for (const Collision& collision : world.collisions()) {
                const bool person = collision.into.starts_with("human");
                with_people += person;
                ++(collision.other && !person ? with_robots : with_things);
            }
            for (const CommandEnd& end : world.ends()) done += end.outcome == Outcome::Done;
            ASSERT_NO_FATAL_FAILURE(expectNoOverlap(world, bands, people));
        }
        EXPECT_GT(with_things, 5U);
        EXPECT_GT(with_robots, 5U);
        EXPECT_GT(with_people, 1U);
        EXPECT_GT(done, 5U);
    }
}

/// All that can be seen of a run.
std::vector<double> trace(const Scene& room, int threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    World world(room, milliseconds(20));
    std::mt19937_64 random(3);
    std::vector<double> seen;
    for (int i = 0; i < 400; ++i) {
        drive(world, random);
        world.step();
        for (std::size_t r = 0; r < world.robots().size(); ++r) {
            const RobotStatus status = world.status(r);
            seen.insert(seen.end(), {status.pose.position.x, status.pose.position.y,
                                     status.pose.heading.degrees(), status.speed, status.accel,
                                     status.stall ? 1.0 : 0.0});
        }
        for (const CommandEnd& end : world.ends()) seen.push_back(end.id);
        for (const std::size_t laser : world.latestReadings()) {
            const auto& ranges = world.reading(laser).scan().ranges;
            seen.insert(seen.end(), ranges.begin(), ranges.end());
        }
    }
    return seen;
}

TEST(WorldRandom, IsTheSameForAnyNumberOfThreads) {
    const Scene room = crowdedRoom(40, 2);
    const std::vector<double> alone = trace(room, 1);
    EXPECT_EQ(alone, trace(room, 1));
    EXPECT_EQ(alone, trace(room, 2));
}

}  // namespace world_random_test
}  // namespace ispace
