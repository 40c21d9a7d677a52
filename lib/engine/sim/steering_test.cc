// SPDX-License-Identifier: GPL-3.0-or-later
// Tests free headings against their definition.
#include "sim/steering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "geom/predicates.h"

namespace ispace {

namespace steering_test {

constexpr double kRadius = 0.25, kGap = 0.05, kHair = 1e-6;  // as steering has them

/// A mover among random walls, short and long, some of them points.
struct Maze {
    explicit Maze(unsigned seed) : random(seed) {
        const int walls = std::uniform_int_distribution(0, 250)(random);
        for (int i = 0; i < walls; ++i) {
            const Point2 a = point(4);
            const double size = i % 9 == 0 ? 0 : i % 3 == 0 ? 4 : 0.3;
            const Segment2 wall{a, a + (point(size) - Point2{})};
            // The mover stands, but may touch.
            if (distance(at, wall) < kRadius) continue;
            band.sheets.push_back(wall);
            band.sheet_owners.push_back(0);
        }
    }
    Point2 point(double most) {
        std::uniform_real_distribution along(-most, most);
        const double x = along(random);
        return {x, along(random)};
    }

    std::mt19937 random;
    Point2 at{0.3, -0.2};
    Slice band;
};

/// The time for which walls leave a direction free, by exact distances of segments.
double untilWall(const Maze& maze, Vec2 velocity, double most, double horizon) {
    for (double share = most; share >= 1.0 / 8; share /= 2) {
        const Segment2 way{maze.at, maze.at + share * horizon * velocity};
        const bool is_free = std::none_of(
            maze.band.sheets.begin(), maze.band.sheets.end(), [&](const Segment2& wall) {
                const double reach = std::min(kRadius + kGap, distance(maze.at, wall) - kHair);
                return distance(way, wall) < reach;
            });
        if (is_free) return share == most ? kForever : share * horizon;
    }
    return 0;
}

/// The walls of a maze, by the slowest index.
class MazeIndex : public ObstacleIndex {
  public:
    explicit MazeIndex(const std::vector<Segment2>& walls) : walls_(walls) {
        for (const Segment2& wall : walls) {
            const Vec2 along = wall.b - wall.a;
            const double square = dot(along, along);
            lines_.push_back({wall.a, along, square > 0 ? 1 / square : 0});
        }
    }
    [[nodiscard]] Outlook look(const Segment2& /*way*/, double /*reach*/) const override {
        return Outlook::Unknown;
    }
    void findIn(const Box2& /*box*/, std::vector<Segment2>& lines) const override {
        lines = walls_;
    }
    [[nodiscard]] std::optional<Some> near(Point2 p) const override {
        which_.clear();
        for (std::uint32_t i = 0; i < walls_.size(); ++i)
            if (distance(p, walls_[i]) < kNear) which_.push_back(i);
        return Some{lines_, which_};
    }
    [[nodiscard]] double least(Point2 p) const override { return nearest(p) - 0.1; }
    [[nodiscard]] double most(Point2 p) const override { return nearest(p) + 0.1; }
    [[nodiscard]] double nearest(Point2 p) const {
        double least = kForever;
        for (const Segment2& wall : walls_) least = std::min(least, distance(p, wall));
        return least;
    }

  private:
    std::vector<Segment2> walls_;
    std::vector<Line> lines_;
    mutable std::vector<std::uint32_t> which_;
};

TEST(Steering, ChoosesTheNearestFreeHeadingOrTheBest) {
    constexpr std::array<double, 11> kTurns = {0, -15, 15, -30, 30, -50, 50, -75, 75, -100, 100};
    int straight = 0, aside = 0, none = 0;
    for (unsigned seed = 1; seed <= 400; ++seed) {
        Maze maze(seed);
        const Obstacles obstacles(maze.band);
        Mover mover;
        mover.model.radius = kRadius;
        const std::vector<Mover> movers{mover};
        std::vector<Motion> motions(1);
        motions[0].pose.position = maze.at;
        Traffic traffic(movers, settlingOrder(movers), 0.1);
        traffic.rebuild(motions);
        const Surroundings around{movers, motions, &traffic};
        Vicinity vicinity;
        const double speed = 0.4 + 0.2 * (seed % 6), horizon = 2;
        const MazeIndex index(maze.band.sheets);
        const ObstacleIndex* const used = seed % 3 == 0 ? nullptr : &index;
        const SteeringState helm{&around, &obstacles, &vicinity, 0, 0, {}, {}, used};
        const Steering steering(helm, speed, horizon);
        const Angle desired = Angle::degrees(seed * 37 % 360);
        const double needed = seed % 8 == 0 ? 0 : seed % 4 == 0 ? 0.6 : horizon;

        FreeHeading expected{desired, 0};
        double best = -kForever;
        for (const double turn : kTurns) {
            const Angle direction = desired + Angle::degrees(turn);
            const double time = std::min(horizon, untilWall(maze, speed * unitVector(direction),
                                                            turn == 0 ? 1 : 0.25, horizon));
            if (turn == 0) {
                EXPECT_EQ(steering.freeTime(direction), time) << "seed " << seed;
            }
            if (time >= needed) {
                expected = {direction, time};
                ++(turn == 0 ? straight : aside);
                best = kForever;
                break;
            }
            const double worth = time - std::abs(turn) / 120;
            if (worth > best && (time > 0 || turn == 0)) {
                expected = {direction, time};
                best = worth;
            }
        }
        if (best < kForever) ++none;
        const FreeHeading found = steering.choose(desired, needed);
        EXPECT_EQ(found.direction, expected.direction) << "seed " << seed;
        EXPECT_EQ(found.time, expected.time) << "seed " << seed;
    }
    // All cases occur.
    EXPECT_GT(straight, 20);
    EXPECT_GT(aside, 20);
    EXPECT_GT(none, 20);
}

/// A mover among walls and three others, with an index and a memory of its choices, and without.
struct Walk {
    explicit Walk(unsigned seed) : maze(seed), obstacles(maze.band), index(maze.band.sheets) {
        movers[0].model.radius = kRadius;
        for (std::size_t i = 0; i < movers.size(); ++i) {
            movers[i].id = "m" + std::to_string(i);
            motions[i].pose.position = {20, 20 + 5.0 * static_cast<double>(i)};
        }
        motions[0].pose.position = maze.at;
    }
    Point2& at() { return motions[0].pose.position; }
    /// Puts another mover near the first, or far away.
    void meet(std::size_t other, bool is_near) {
        std::uniform_real_distribution<double> offset(-3, 3);
        Motion& motion = motions[other];
        const double x = offset(maze.random), y = offset(maze.random);
        motion.pose.position = is_near ? at() + Vec2{x, y} : Point2{30, 0};
        motion.pose.heading = Angle::degrees(60 * offset(maze.random));
        motion.drive.speed = 0.3 * offset(maze.random);
    }

    Maze maze;
    Obstacles obstacles;
    MazeIndex index;
    std::vector<Mover> movers = std::vector<Mover>(4);
    std::vector<Motion> motions = std::vector<Motion>(4);
    SteeringMemory memory;
};

TEST(Steering, IndexAndMemoryChangeNoChoice) {
    constexpr double kSpeed = 1.2, kHorizon = 2, kStep = 0.1;
    int choices = 0, recalled = 0, walls = 0, none = 0;
    for (unsigned seed = 1; seed <= 120; ++seed) {
        Walk walk(seed % 3 == 0 ? 1000 + seed : seed);
        std::mt19937& random = walk.maze.random;
        std::uniform_real_distribution<double> turn(-180, 180), share(0, 1);
        Traffic traffic(walk.movers, settlingOrder(walk.movers), kStep);
        Angle desired = Angle::degrees(turn(random));
        for (int step = 0; step < 60; ++step) {
            for (std::size_t i = 1; i < walk.movers.size() && step % 4 == 0; ++i)
                walk.meet(i, seed % 2 == 0 && share(random) < 0.4);
            traffic.rebuild(walk.motions);
            const Surroundings around{walk.movers, walk.motions, &traffic};
            Vicinity vicinity;
            const double clearance =
                share(random) < 0.5 ? 0 : walk.index.nearest(walk.at()) - kRadius - kHair;
            const double needed = step % 9 == 0 ? 0.6 : step % 31 == 0 ? 0 : kHorizon;
            const SteeringState plain{&around, &walk.obstacles, &vicinity, 0, clearance, {}, {}};
            SteeringState indexed = plain;
            indexed.index = &walk.index;
            indexed.memory = &walk.memory;
            walk.memory.nearest = 0;
            const Steering quick(indexed, kSpeed, kHorizon);
            const FreeHeading found = quick.choose(desired, needed);
            const FreeHeading expected = Steering(plain, kSpeed, kHorizon).choose(desired, needed);
            ASSERT_EQ(found.direction, expected.direction) << seed << ' ' << step;
            ASSERT_EQ(found.time, expected.time) << seed << ' ' << step;
            EXPECT_LE(walk.memory.nearest, walk.index.nearest(walk.at()));
            ++choices;
            const Vec2 way = kHorizon * kSpeed * unitVector(desired);
            const FreeStrip& strip = walk.memory.strip;
            if (step > 0 && strip.begin != walk.at() &&
                strip.contains({walk.at(), walk.at() + way}))
                ++recalled;
            if (walk.memory.has_wall) ++walls;
            if (found.time < needed) ++none;
            desired = wrapped(found.direction);
            const double off = share(random);
            if (step % 20 == 19) {
                walk.at() = walk.maze.point(4);
                desired = Angle::degrees(turn(random));
            } else {
                // Along it, or nearly.
                const Angle bent =
                    off < 0.2 ? found.direction + Angle::degrees(off) : found.direction;
                walk.at() = walk.at() + kStep * kSpeed * unitVector(bent);
            }
            if (off > 0.9) desired = desired + Angle::degrees(turn(random) / 6);
        }
    }
    EXPECT_GT(choices, 7000);
    EXPECT_GT(recalled, 400);
    EXPECT_GT(walls, 1000);
    EXPECT_GT(none, 100);
}

TEST(Steering, AStripKeepsItsDistanceFromAllWalls) {
    int strips = 0;
    for (unsigned seed = 1; seed <= 300; ++seed) {
        Walk walk(seed);
        Traffic traffic(walk.movers, settlingOrder(walk.movers), 0.1);
        traffic.rebuild(walk.motions);
        const Surroundings around{walk.movers, walk.motions, &traffic};
        Vicinity vicinity;
        const SteeringState helm{&around, &walk.obstacles, &vicinity,   0, 0, {},
                                 {},      &walk.index,     &walk.memory};
        for (int heading = 0; heading < 360; heading += 24) {
            walk.memory = {};
            (void)Steering(helm, 1.2, 2).freeTime(Angle::degrees(heading));
            const FreeStrip& strip = walk.memory.strip;
            if (strip.length < 0) continue;
            ++strips;
            EXPECT_TRUE(strip.contains(walk.at()));
            EXPECT_GE(strip.length, 2.4 / 8);
            const Segment2 middle{strip.begin, strip.begin + strip.length * strip.along};
            for (const Segment2& wall : walk.maze.band.sheets)
                EXPECT_GE(distance(middle, wall), kRadius + kGap + strip.half_width)
                    << seed << ' ' << heading;
        }
    }
    EXPECT_GT(strips, 300);
}

TEST(FreeStrip, ContainsItsEndsAndLittleBeside) {
    const FreeStrip strip{{1, 2}, {0.6, 0.8}, 5, 1e-3};
    const auto at = [&](double ahead, double aside) {
        return strip.begin + ahead * strip.along + aside * perpendicular(strip.along);
    };
    EXPECT_TRUE(strip.contains(at(0, 0)));
    EXPECT_TRUE(strip.contains(at(5 - 1e-9, 0)));
    EXPECT_TRUE(strip.contains(at(2, 0.9e-3)));
    EXPECT_TRUE(strip.contains(at(2, -0.9e-3)));
    EXPECT_FALSE(strip.contains(at(-1e-3, 0)));
    EXPECT_FALSE(strip.contains(at(5.001, 0)));
    EXPECT_FALSE(strip.contains(at(2, 1.1e-3)));
    EXPECT_TRUE(strip.contains({at(1, 0), at(4, 0)}));
    EXPECT_FALSE(strip.contains({at(1, 0), at(6, 0)}));
    EXPECT_FALSE(FreeStrip().contains(Point2{}));
}

}  // namespace steering_test

}  // namespace ispace
