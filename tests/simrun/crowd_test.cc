// SPDX-License-Identifier: GPL-3.0-or-later
// 500 robots driven at random for a simulated minute: at no step does one overlap a wall or another
// robot. Judged by brute force over buckets, which shares nothing with what it tests.
#include "crowd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

#include "base/file.h"
#include "io/input.h"
#include "layout/schemas.h"

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

/// Least distance of two robots, by sweeping them in the order of x.
double leastGap(const World& world, double radius) {
    std::vector<Point2> places;
    places.reserve(world.robots().size());
    for (std::size_t i = 0; i < world.robots().size(); ++i)
        places.push_back(world.status(i).pose.position);
    std::sort(places.begin(), places.end(), lexLess);
    double least = 4 * radius;
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t j = i + 1; j < places.size() && places[j].x - places[i].x < least; ++j)
            least = std::min(least, distance(places[i], places[j]));
    return least - 2 * radius;
}

/// Drives for a minute. Returns the number of collisions.
std::size_t driveAMinute(const Scene& scene, double radius) {
    World world(scene, std::chrono::milliseconds(5));
    const Lines lines(scene.environment.band(0, scene.robots.front().model.height), radius);
    std::size_t collisions = 0;
    while (world.time() < std::chrono::minutes(1)) {
        testing::stumble(world, 1);
        world.step();
        collisions += world.collisions().size();
        for (std::size_t i = 0; i < scene.robots.size(); ++i) {
            const Point2 p = world.status(i).pose.position;
            if (lines.nearest(p) < radius - kTouch) {
                ADD_FAILURE() << scene.robots[i].id << " in a wall at " << p.x << ", " << p.y;
                return collisions;
            }
        }
        if (leastGap(world, radius) < -kTouch) {
            ADD_FAILURE() << "robots overlap at step " << world.steps();
            return collisions;
        }
    }
    return collisions;
}

void driveIn(const std::string& file, double radius) {
    const Document document = parseDocument(readAll(file), file, ImportOptions(), sceneSchemas());
    Scene scene = makeScene(document, nullptr, DeviceCatalogue());
    RobotModel model;
    model.radius = radius;
    scene.robots = testing::crowd(scene.environment, model, kRobots, 0.005, 1);
    ASSERT_EQ(scene.robots.size(), kRobots);
    const std::size_t collisions = driveAMinute(scene, radius);
    EXPECT_GT(collisions, kRobots);  // else there was nothing to avoid
}

TEST(Crowd, NeverOverlapsInAFurnishedRoom) {
    driveIn(ISPACE_SOURCE_DIR "/share/scenes/crowded.env", 0.06);
}

TEST(Crowd, NeverOverlapsOnARobotsMap) {
    const char* const folder = std::getenv("ISPACE_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "ISPACE_TEST_DATA names no folder of real maps";
    driveIn(folder + std::string("/turtlebot3.yaml"), 0.05);
}

}  // namespace

}  // namespace ispace
