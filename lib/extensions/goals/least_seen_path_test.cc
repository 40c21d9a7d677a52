// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/goals/least_seen_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "env/level.h"
#include "support/test_scenes.h"

namespace ispace::goals {
namespace least_seen_path_test {

/// A corridor of 12 by 2 m with a zone of 1 m at either end.
const std::string kCorridor =
    "ispace size=12,2,3\nzone id=a path=-6,-1;-5,-1;-5,1;-6,1\nzone id=b path=5,-1;6,-1;6,1;5,1\n";

Coverage measuredFor(const Scene& scene, double cell = 0.2) {
    RayScenes worlds(scene.environment);
    return measureCoverage(scene, worlds, {.cells = CellSize{cell}});
}

LeastSeenPath wayIn(const std::string& lines, const std::string& between = "a,b", int times = 1) {
    const Scene scene = sceneOf(lines);
    return findLeastSeenPath(scene, measuredFor(scene), parseWay(between), times);
}

double sumOf(const LeastSeenPath& way, bool is_seen) {
    double sum = 0;
    for (const LeastSeenPath::Piece& piece : way.pieces)
        if (piece.is_seen == is_seen) sum += distance(piece.from, piece.to);
    return sum;
}

TEST(LeastSeenPath, ParsesTwoZones) {
    EXPECT_EQ(parseWay("a,b").from, "a");
    EXPECT_EQ(parseWay("a,b").to, "b");
    for (const char* text : {"", "a", "a,", ",b", "a,b,c"})
        EXPECT_THROW(parseWay(text), UsageError) << text;
}

TEST(LeastSeenPath, IsUnseenWithoutSensors) {
    const LeastSeenPath way = wayIn(kCorridor);
    EXPECT_TRUE(way.exists);
    EXPECT_EQ(way.seen, 0);
    EXPECT_NEAR(way.length, 11, 1e-4) << "between inner points of the zones";
}

TEST(LeastSeenPath, IsAllOfTheWayBetweenZonesInFullSight) {
    const LeastSeenPath way = wayIn(kCorridor + "laser id=l at=0,0 range=20 fov=360\n");
    EXPECT_NEAR(way.seen.value(), 10, 1e-9);
    EXPECT_NEAR(sumOf(way, true), 10, 1e-9);
}

TEST(LeastSeenPath, KeepsToTheWallFarthestFromASensor) {
    // The circle of 2.5 m about a point 1.5 m from the north wall cuts it 2 m to either side.
    const LeastSeenPath way = wayIn(kCorridor + "laser id=l at=0,-0.5 range=2.5 fov=360\n");
    EXPECT_NEAR(way.seen.value(), 4, 1e-3);
    EXPECT_NEAR(sumOf(way, true), *way.seen, 1e-9);
    EXPECT_NEAR(sumOf(way, true) + sumOf(way, false), way.length, 1e-9);
    for (const LeastSeenPath::Piece& piece : way.pieces)
        if (piece.is_seen) {
            EXPECT_NEAR(piece.from.y, 1, 1e-3);
        }
}

TEST(LeastSeenPath, PassesASensorThatDoesNotReachAcross) {
    const LeastSeenPath way = wayIn(kCorridor + "laser id=l at=0,-0.5 range=1.4 fov=360\n");
    EXPECT_EQ(way.seen, 0);
}

TEST(LeastSeenPath, CrossesTheShadowsOfPillars) {
    // The sensor in the west sees between the pillars; in their shadows the way is free.
    const std::string room = kCorridor + "laser id=l at=-5.9,0 range=20 fov=360\n";
    const double open = wayIn(room).seen.value();
    const LeastSeenPath way = wayIn(room + "pillar id=p at=-2,0.5 size=1,1,3\n");
    EXPECT_NEAR(open, 10, 1e-9);
    EXPECT_LT(way.seen.value(), 4);
    EXPECT_GT(way.seen.value(), 2);
}

TEST(LeastSeenPath, CountsSightByAsManySensorsAsAreAskedFor) {
    const std::string room = kCorridor +
                             "laser id=l at=0,-0.5 range=2.5 fov=360\n"
                             "laser id=m at=3,-0.5 range=2.5 fov=360\n";
    EXPECT_NEAR(wayIn(room, "a,b", 1).seen.value(), 7, 1e-3);
    // The north wall cuts 1 m of what both see.
    EXPECT_NEAR(wayIn(room, "a,b", 2).seen.value(), 1, 1e-3);
}

TEST(LeastSeenPath, EndsWhereZonesTouchOrOverlap) {
    const std::string zones =
        "ispace size=12,2,3\nzone id=a path=-6,-1;0,-1;0,1;-6,1\nzone id=b "
        "path=0,-1;6,-1;6,1;0,1\nzone id=c path=-1,-1;6,-1;6,1;-1,1\n"
        "laser id=l at=0,0 range=20 fov=360\n";
    EXPECT_EQ(wayIn(zones, "a,b").seen, 0);
    EXPECT_EQ(wayIn(zones, "a,c").seen, 0);
    EXPECT_EQ(wayIn(zones, "a,a").seen, 0);
}

TEST(LeastSeenPath, TellsOfZonesThatNoWayJoins) {
    const LeastSeenPath way = wayIn(kCorridor + "pillar id=p at=0,0 size=0.2,2,3\n");
    EXPECT_FALSE(way.exists);
    EXPECT_FALSE(way.seen);
    EXPECT_TRUE(way.pieces.empty());
}

TEST(LeastSeenPath, RejectsUnknownAndCoveredZones) {
    EXPECT_THROW(wayIn(kCorridor, "a,c"), UsageError);
    EXPECT_THROW(wayIn(kCorridor + "zone id=o at=40,0 size=1,1\n", "a,o"), UsageError);
    EXPECT_THROW(wayIn(kCorridor + "pillar id=p at=5.5,0 size=1,2,3\n"), UsageError);
}

/// Finds the way over a lattice whose points see those up to `kReach` steps away.
class LatticePath {
  public:
    LatticePath(const Scene& scene, const Coverage& coverage, double step)
        : scene_(scene), coverage_(coverage), step_(step) {
        const Box2& box = scene.environment.limits();
        columns_ = static_cast<int>(box.width() / step) + 1;
        rows_ = static_cast<int>(box.depth() / step) + 1;
        const auto level = scene.environment.level(coverage.target.height);
        for (int i = 0; i < columns_ * rows_; ++i) {
            free_.push_back(level->isFree(at(i)));
            seen_.push_back(isSeen(at(i)));
        }
    }

    double between(const Polygon& from, const Polygon& to) const {
        std::vector<double> cost(free_.size(), 1e9);
        using Open = std::pair<double, int>;
        std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
        const auto is_in = [&](const Polygon& zone, int i) {
            return locate(zone, at(i)) != Side::Outside;
        };
        for (int i = 0; i < columns_ * rows_; ++i)
            if (isOpen(i) && is_in(from, i)) {
                cost[index(i)] = 0;
                open.emplace(0, i);
            }
        while (!open.empty()) {
            const auto [sum, i] = open.top();
            open.pop();
            if (sum > cost[index(i)]) continue;
            if (is_in(to, i)) return sum;
            for (int dx = -kReach; dx <= kReach; ++dx)
                for (int dy = -kReach; dy <= kReach; ++dy) {
                    const int x = i % columns_ + dx, y = i / columns_ + dy;
                    if (x < 0 || y < 0 || x >= columns_ || y >= rows_) continue;
                    const double leg = exposed(i, dx, dy);
                    const int next = y * columns_ + x;
                    if (leg < 0 || sum + leg >= cost[index(next)]) continue;
                    cost[index(next)] = sum + leg;
                    open.emplace(sum + leg, next);
                }
        }
        return -1;
    }

  private:
    static constexpr int kReach = 3;

    static std::size_t index(int i) { return static_cast<std::size_t>(i); }
    [[nodiscard]] bool isOpen(int i) const { return free_[index(i)]; }
    [[nodiscard]] Point2 at(int i) const {
        const Point2 low = scene_.environment.limits().low;
        return low + Vec2{(i % columns_ + 0.5) * step_, (i / columns_ + 0.5) * step_};
    }
    [[nodiscard]] bool isSeen(Point2 p) const {
        return std::any_of(coverage_.sets.begin(), coverage_.sets.end(), [&](const auto& set) {
            const auto around = std::count_if(
                set.region->begin(), set.region->end(),
                [&](const Curve& curve) { return locate(chords(curve), p) != Side::Outside; });
            return around % 2 == 1;
        });
    }
    /// Returns the seen length of a leg, by its lattice points; -1 if it is blocked.
    [[nodiscard]] double exposed(int from, int dx, int dy) const {
        const int steps = std::max(std::abs(dx), std::abs(dy));
        if (steps == 0) return -1;
        double seen = 0;
        for (int k = 0; k <= steps; ++k) {
            const int i = from + static_cast<int>(std::lround(1.0 * k * dx / steps)) +
                          columns_ * static_cast<int>(std::lround(1.0 * k * dy / steps));
            if (!isOpen(i)) return -1;
            if (seen_[index(i)]) seen += k == 0 || k == steps ? 0.5 : 1;
        }
        return seen / steps * step_ * std::hypot(dx, dy);
    }

    const Scene& scene_;
    const Coverage& coverage_;
    double step_;
    int columns_ = 0, rows_ = 0;
    std::vector<bool> free_, seen_;
};

TEST(LeastSeenPath, AgreesWithALatticeInRandomRooms) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        std::mt19937_64 random(seed);
        const auto number = [&random](double low, double high) {
            return std::uniform_real_distribution(low, high)(random);
        };
        std::string lines =
            "ispace size=10,6,3\nzone id=a path=-5,-1;-4,-1;-4,1;-5,1\n"
            "zone id=b path=4,-3;5,-3;5,3;4,3\n";
        for (int i = 0; i < 4; ++i)
            lines += "pillar id=p" + std::to_string(i) +
                     " at=" + std::to_string(number(-3.5, 3.5)) + "," +
                     std::to_string(number(-2.4, 2.4)) +
                     " size=0.6,0.9,3 heading=" + std::to_string(number(0, 90)) + "\n";
        for (int i = 0; i < 3; ++i)
            lines += "laser id=l" + std::to_string(i) + " at=" + std::to_string(number(-3.5, 3.5)) +
                     "," + std::to_string(i == 0 ? -2.9 : 2.9) +
                     " range=" + std::to_string(number(2, 5)) + " fov=360\n";
        const Scene scene = sceneOf(lines);
        const Coverage coverage = measuredFor(scene);
        const LeastSeenPath way = findLeastSeenPath(scene, coverage, {"a", "b"});
        ASSERT_TRUE(way.seen) << lines;
        const double step = 0.05;
        const double lattice = LatticePath(scene, coverage, step)
                                   .between({{-5, -1}, {-4, -1}, {-4, 1}, {-5, 1}},
                                            {{4, -3}, {5, -3}, {5, 3}, {4, 3}});
        ASSERT_GE(lattice, 0);
        EXPECT_LE(*way.seen, lattice + 4 * step) << lines;
        EXPECT_GE(*way.seen, lattice / 1.03 - 8 * step) << lines;
        EXPECT_NEAR(sumOf(way, true), *way.seen, 1e-6) << lines;
    }
}

/// The default wall has no thickness; the way leads round its end.
TEST(LeastSeenPath, LeadsRoundWallsWithoutThickness) {
    const std::string room =
        "ispace size=8,6,3\nzone id=a path=-2,-1;-1,-1;-1,0;-2,0\n"
        "zone id=b path=1,-1;2,-1;2,0;1,0\n"
        "laser at=-3.9,2.9 range=30 fov=360\nlaser at=3.9,2.9 range=30 fov=360\n"
        "laser at=3.9,-2.9 range=30 fov=360\nlaser at=-3.9,-2.9 range=30 fov=360\n";
    const double round = 2 * std::hypot(1, 2.5);
    EXPECT_NEAR(wayIn(room + "wall from=0,-3 to=0,2.5\n").seen.value(), round, 1e-3);
    // Two that meet at their ends: not through the joint.
    EXPECT_NEAR(wayIn(room + "wall from=0,-3 to=0,-0.5\nwall from=0,-0.5 to=0,2.5\n").seen.value(),
                round, 1e-3);
    EXPECT_NEAR(wayIn(room).seen.value(), 2, 1e-3);
}

}  // namespace least_seen_path_test
}  // namespace ispace::goals
