// SPDX-License-Identifier: GPL-3.0-or-later
// Robots driven at random, people and autonomous movers: at no step does one overlap a wall or
// another. Judged by brute force over buckets, independent of the tested code. ISPACE_CROWD=10000
// in the environment sets their number, for ten simulated minutes.
#include "crowd.h"
#include "support/test_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

#include "base/file.h"
#include "io/importers.h"
#include "scene/placement_schemas.h"

namespace ispace {

namespace {

constexpr double kTouch = 1e-8;
constexpr std::size_t kRobots = 500;

/// Lines by square buckets wider than any robot.
class Lines {
  public:
    Lines(const Slice& band, double radius) : size_(4 * radius) {
        band.forEachLine([&](const Segment2& line) {
            const double steps = std::ceil(distance(line.a, line.b) / size_ * 4) + 1;
            for (double k = 0; k <= steps; ++k) {
                const auto [column, row] = bucket(line.a + k / steps * (line.b - line.a));
                for (int dx = -1; dx <= 1; ++dx)
                    for (int dy = -1; dy <= 1; ++dy) add({column + dx, row + dy}, line);
            }
        });
    }
    /// Distance to the nearest line, if it is less than `size_`.
    [[nodiscard]] double nearest(Point2 p) const {
        double least = size_;
        const auto found = buckets_.find(bucket(p));
        if (found == buckets_.end()) return least;
        for (const auto& [a, b] : found->second) {
            const Vec2 along = b - a;
            const double square = dot(along, along);
            const double t = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0;
            least = std::min(least, distance(p, a + t * along));
        }
        return least;
    }

  private:
    using Bucket = std::pair<int, int>;
    [[nodiscard]] Bucket bucket(Point2 p) const {
        return {static_cast<int>(std::floor(p.x / size_)),
                static_cast<int>(std::floor(p.y / size_))};
    }
    void add(const Bucket& bucket, const Segment2& line) {
        std::vector<Segment2>& lines = buckets_[bucket];
        if (lines.empty() || !(lines.back() == line)) lines.push_back(line);
    }

    double size_;
    std::map<Bucket, std::vector<Segment2>> buckets_;
};

/// Distance of the nearest two movers, by sweeping all in the order of x.
double leastGap(const World& world) {
    struct Disc {
        Point2 place;
        double radius;
    };
    std::vector<Disc> discs;
    double widest = 0;
    for (std::size_t i = 0; i < world.movers().size(); ++i) {
        discs.push_back({world.status(i).pose.position, world.movers()[i].model.radius});
        widest = std::max(widest, discs.back().radius);
    }
    std::sort(discs.begin(), discs.end(),
              [](const Disc& a, const Disc& b) { return lexLess(a.place, b.place); });
    double least = widest;
    for (std::size_t i = 0; i < discs.size(); ++i)
        for (std::size_t j = i + 1;
             j < discs.size() && discs[j].place.x - discs[i].place.x < 2 * widest + least; ++j)
            least = std::min(least, distance(discs[i].place, discs[j].place) - discs[i].radius -
                                        discs[j].radius);
    return least;
}

/// Lines of each height among the movers.
std::map<double, Lines> linesOf(const World& world, const Environment& environment) {
    std::map<double, double> widest;
    for (const Mover& mover : world.movers())
        widest[mover.model.height] = std::max(widest[mover.model.height], mover.model.radius);
    std::map<double, Lines> lines;
    for (const auto& [height, radius] : widest)
        lines.emplace(height, Lines(environment.band(0, height), radius));
    return lines;
}

/// Lets them go. Returns the number of collisions.
std::size_t drive(const Scene& scene, SimTime step, SimTime until) {
    World world(scene, step);
    const std::map<double, Lines> lines = linesOf(world, scene.environment);
    std::size_t collisions = 0;
    while (world.time() < until) {
        testing::stumble(world, 1);
        world.step();
        collisions += world.collisions().size();
        for (std::size_t i = 0; i < world.movers().size(); ++i) {
            const Mover& mover = world.movers()[i];
            const Point2 p = world.status(i).pose.position;
            if (lines.at(mover.model.height).nearest(p) < mover.model.radius - kTouch) {
                ADD_FAILURE() << mover.id << " in a wall at " << p.x << ", " << p.y;
                return collisions;
            }
        }
        if (leastGap(world) < -kTouch) {
            ADD_FAILURE() << "two overlap at step " << world.steps();
            return collisions;
        }
    }
    return collisions;
}

Scene sceneOf(const std::string& file) {
    const Document document = parseDocument(readAll(file), file, ImportOptions(), sceneSchemas());
    return makeScene(document, nullptr, DeviceCatalogue());
}

void driveIn(const std::string& file, double radius) {
    Scene scene = sceneOf(file);
    RobotModel model;
    model.radius = radius;
    scene.robots = testing::crowd(scene.environment, model, kRobots, 0.005, 1);
    ASSERT_EQ(scene.robots.size(), kRobots);
    const std::size_t collisions =
        drive(scene, std::chrono::milliseconds(5), std::chrono::minutes(1));
    EXPECT_GT(collisions, kRobots);  // otherwise the test avoids no collision
}

TEST(Crowd, RobotsAndPeopleNeverOverlap) {
    const char* const wanted = std::getenv("ISPACE_CROWD");
    const std::size_t count = wanted == nullptr ? 200 : std::stoul(wanted);
    // Half as much floor again for each: a hall with pillars.
    const double side = std::sqrt(static_cast<double>(count)) * 1.1;
    std::string text = "#env 1\nispace size=" + std::to_string(side) + "," + std::to_string(side);
    for (double x = 5 - side / 2; x < side / 2 - 2; x += 5)
        for (double y = 5 - side / 2; y < side / 2 - 2; y += 5)
            text += "\npillar at=" + std::to_string(x) + "," + std::to_string(y) + " size=0.5,0.5";
    const Document document = readRecordText(text + "\n", "hall.env", sceneSchemas());
    Scene scene = makeScene(document, nullptr, DeviceCatalogue());
    RobotModel model;
    model.radius = 0.2;
    scene.robots = testing::crowd(scene.environment, model, count / 2, 0.02, 1);
    testing::addPeople(scene, count / 2, 0.02, 2);
    ASSERT_EQ(scene.robots.size() + scene.people.size(), count / 2 * 2);
    // Every other one goes by itself.
    for (std::size_t i = 0; i < count / 2; i += 2)
        scene.robots[i].course.wander = scene.people[i].course.wander = true;
    const std::size_t collisions =
        drive(scene, std::chrono::milliseconds(20),
              wanted == nullptr ? std::chrono::minutes(1) : std::chrono::minutes(10));
    EXPECT_GT(collisions, count);
}

TEST(Crowd, NeverOverlapsInAFurnishedRoom) {
    driveIn(testing::sourcePath("share/scenes/crowded.env"), 0.06);
}

TEST(Crowd, NeverOverlapsOnARobotsMap) {
    const char* const folder = std::getenv("ISPACE_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "ISPACE_TEST_DATA names no folder of real maps";
    driveIn(folder + std::string("/turtlebot3.yaml"), 0.05);
}

}  // namespace

}  // namespace ispace
