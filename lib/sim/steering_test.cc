// SPDX-License-Identifier: GPL-3.0-or-later
// Tests free headings against their definition.
#include "sim/steering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "geom/predicates.h"

namespace ispace {

namespace {

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
    [[nodiscard]] Way look(const Segment2& /*way*/, double /*reach*/) const override {
        return Way::Unknown;
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
    [[nodiscard]] double most(Point2 p) const override {
        double least = kForever;
        for (const Segment2& wall : walls_) least = std::min(least, distance(p, wall));
        return least + 0.1;
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

}  // namespace

}  // namespace ispace
