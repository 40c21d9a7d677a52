// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds over all poses beside a million random layouts, and beside the fewest guards.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "extensions/proofs/gallery/gallery.h"
#include "extensions/proofs/poses/pose_search.h"
#include "extensions/proofs/test_pose_floors.h"
#include "geom/arrangement.h"
#include "geom/predicates.h"
#include "support/test_problems.h"

namespace ispace::proofs::poses {
namespace any_layout_test {

constexpr double kPi = std::numbers::pi;

/// Views from random poses, as bits of the points of a grid: a point is seen if it is within range
/// and field, and the segment to it crosses no wall.
class RandomViews {
  public:
    RandomViews(const Region& region, const Sector& sector, std::size_t poses) : sector_(sector) {
        constexpr int kSteps = 40;
        const Box2 box = bounds(region.outline);
        region.forEachEdge([this](const Segment2& edge) { walls_.push_back(edge); });
        for (int i = 0; i < kSteps * kSteps; ++i) {
            const Point2 p = box.low + Vec2{box.width() * (i % kSteps + 0.5) / kSteps,
                                            box.depth() * (i / kSteps + 0.5) / kSteps};
            if (region.locate(p) == Side::Inside) points_.push_back(p);
        }
        while (poses_.size() < poses) {
            const Point2 p{box.low.x + box.width() * draw(), box.low.y + box.depth() * draw()};
            const Angle heading = Angle::radians(2 * kPi * draw());
            if (region.locate(p) == Side::Inside) poses_.push_back({p, heading});
        }
        for (const Pose2& pose : poses_) addView(pose);
    }

    struct Layout {
        int points = 0;  // that it sees
        std::array<std::size_t, 4> poses{};
    };
    /// Draws layouts of these poses, and returns those that see the most points.
    std::vector<Layout> bestOf(std::size_t layouts, std::size_t sensors, int times) {
        constexpr std::size_t kBest = 40;
        std::vector<Layout> best;
        const auto is_better = [](const Layout& a, const Layout& b) { return a.points > b.points; };
        int least = 0;
        for (std::size_t i = 0; i < layouts; ++i) {
            Layout layout;
            for (std::size_t k = 0; k < sensors; ++k) layout.poses[k] = random_() % poses_.size();
            layout.points = seenBy({layout.poses.data(), sensors}, times);
            if (layout.points <= least) continue;
            best.push_back(layout);
            if (best.size() < 2 * kBest) continue;
            std::sort(best.begin(), best.end(), is_better);
            best.resize(kBest);
            least = best.back().points;
        }
        std::sort(best.begin(), best.end(), is_better);
        best.resize(std::min(best.size(), kBest));
        return best;
    }
    [[nodiscard]] const Pose2& pose(std::size_t i) const { return poses_[i]; }

  private:
    using Words = std::vector<std::uint64_t>;

    double draw() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }

    void addView(const Pose2& pose) {
        Words words((points_.size() + 63) / 64);
        for (std::size_t i = 0; i < points_.size(); ++i)
            if (sees(pose, points_[i])) words[i / 64] |= std::uint64_t{1} << i % 64;
        views_.push_back(std::move(words));
    }
    [[nodiscard]] bool sees(const Pose2& pose, Point2 p) const {
        const Vec2 way = p - pose.position;
        if (length(way) > sector_.range) return false;
        const double turn =
            std::atan2(way.y, way.x) - pose.heading.radians() - sector_.first + 4 * kPi;
        if (!sector_.isRound() && std::fmod(turn, 2 * kPi) > sector_.field) return false;
        return std::none_of(walls_.begin(), walls_.end(), [&](const Segment2& wall) {
            return !areBeside(pose.position, p, wall) &&
                   !areBeside(wall.a, wall.b, {pose.position, p});
        });
    }
    /// True if both ends of a segment are on one side of a line.
    static bool areBeside(Point2 a, Point2 b, const Segment2& segment) {
        const Turn first = orientation(a, b, segment.a);
        return first != Turn::Straight && first == orientation(a, b, segment.b);
    }
    /// Counts the points that at least `times` of some views hold.
    [[nodiscard]] int seenBy(std::span<const std::size_t> views, int times) const {
        int points = 0;
        for (std::size_t i = 0; i < views_.front().size(); ++i) {
            std::array<std::uint64_t, 4> at_least{};  // seen once, twice ...
            for (const std::size_t view : views) {
                const std::uint64_t word = views_[view][i];
                for (std::size_t k = 3; k > 0; --k) at_least[k] |= at_least[k - 1] & word;
                at_least[0] |= word;
            }
            points += std::popcount(at_least[static_cast<std::size_t>(times - 1)]);
        }
        return points;
    }

    Sector sector_;
    std::vector<Segment2> walls_;
    std::vector<Point2> points_;
    std::vector<Pose2> poses_;
    std::vector<Words> views_;
    std::mt19937_64 random_{11};
};

PoseBound boundedIn(const Region& region, const Sector& sector, const PoseSearchOptions& options,
                    int rounds) {
    const PoseFloor floor({&region, 1}, 3000);
    StopWhen stop(afterAsking(rounds));
    return boundOverPoses(floor, sector, options, stop);
}

Region corridor() { return {{{0, 0}, {7, 0}, {7, 5}, {5, 5}, {5, 2}, {0, 2}}, {}}; }

TEST(AnyLayout, NoneOfAMillionExceedsTheBound) {
    constexpr std::size_t kLayouts = 1'000'000, kEach = kLayouts / 8;
    for (const auto& [region, sector] :
         {std::pair(corridor(), Sector{3, 4, -2}), {roomsWithPillar(), Sector{4, 2, 0.5}}}) {
        RandomViews views(region, sector, 800);
        const SeenAreas areas(region, sector);
        for (const auto& [sensors, times] : {std::pair(2, 1), {3, 1}, {4, 1}, {3, 2}}) {
            double best = 0;
            const auto count = static_cast<std::size_t>(sensors);
            for (const auto& layout : views.bestOf(kEach, count, times)) {
                std::vector<Pose2> poses;
                for (std::size_t i = 0; i < count; ++i)
                    poses.push_back(views.pose(layout.poses[i]));
                best = std::max(best, areas.of(poses, times));
            }
            EXPECT_GT(best, 0);
            const PoseSearchOptions options{.sensors = sensors, .times = times, .gap = 0};
            EXPECT_GE(boundedIn(region, sector, options, 25).bound, best)
                << sensors << ' ' << times;
        }
    }
}

/// A room, and the fewest guards that see it all.
struct SmallGallery {
    Polygon outline;
    std::size_t guards;
};
std::vector<SmallGallery> smallGalleries() {
    return {{{{0, 0}, {6, 0}, {8, 3}, {5, 6}, {0, 5}}, 1},                          // convex
            {{{0, 0}, {6, 0}, {6, 2}, {2, 2}, {2, 6}, {0, 6}}, 1},                  // L
            {{{0, 0}, {9, 0}, {9, 2}, {6, 2}, {6, 6}, {4, 6}, {4, 2}, {0, 2}}, 1},  // T
            {{{3, 0}, {4, 2}, {6, 3}, {4, 4}, {3, 6}, {2, 4}, {0, 3}, {2, 2}}, 1},  // star
            {{{0, 0}, {8, 0}, {8, 6}, {6, 6}, {6, 2}, {2, 2}, {2, 6}, {0, 6}}, 2},  // U
            {{{0, 0}, {7, 0}, {6.5, 6}, {6, 1}, {1, 1}, {0.5, 6}}, 2},              // comb
            {{{0, 0}, {6, 0}, {6, 2}, {3, 2}, {3, 4}, {9, 4}, {9, 6}, {1, 6}, {1, 2}, {0, 2}}, 2}};
}

TEST(AnyLayout, AgreesWithTheFewestGuards) {
    for (const auto& [outline, guards] : smallGalleries()) {
        const Region region{outline, {}};
        const double area = region.area();
        SilentProgress silent;
        const GalleryCover cover = guardGallery({&region, 1}, silent);
        ASSERT_TRUE(cover.isProven());
        EXPECT_EQ(cover.guards.size(), guards) << area;
        const Sector around{20, 2 * kPi, 0};
        std::vector<Polygon> views;
        for (const Point2 p : cover.guards)
            views.push_back(SeenAreas(region, around).viewFrom({p, {}}));
        EXPECT_LE(totalArea(difference(region, views)), 1e-6 * area);
        // As many see all of the floor: no bound is below it, and no more is to be seen.
        const PoseSearchOptions all{.sensors = static_cast<int>(guards), .gap = 0};
        const double most = boundedIn(region, around, all, 20).bound;
        EXPECT_GE(most, area - 1e-9);
        EXPECT_LE(most, area * 1.01);  // cells of walls are rounded up
        if (guards == 1) continue;
        // One fewer does not: the bound of coverage proves that of the number.
        const PoseSearchOptions fewer{.sensors = static_cast<int>(guards) - 1, .gap = 0};
        EXPECT_LT(boundedIn(region, around, fewer, 40).bound, 0.99 * area) << area;
    }
}

/// Mountains on a flat floor.
Region mountains(std::mt19937_64& random) {
    const auto draw = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
    Polygon outline{{0, 0}, {9, 0}};
    for (int x = 9; x >= 0; --x)
        outline.push_back({x - 0.4 * draw() * (x > 0 ? 1 : 0), x % 2 == 0 ? 1 : 1 + 3 * draw()});
    return {outline, {}};
}

TEST(AnyLayout, OneThatSeesAllNeedsNoOther) {
    std::mt19937_64 random(5);
    int singles = 0, proofs = 0;
    for (int i = 0; i < 20; ++i) {
        const Region region = mountains(random);
        SilentProgress silent;
        const GalleryCover cover = guardGallery({&region, 1}, silent);
        ASSERT_TRUE(cover.isProven());
        const Sector around{30, 2 * kPi, 0};
        const double most = boundedIn(region, around, {.sensors = 1, .gap = 0}, 25).bound;
        if (most < region.area() - 1e-9) {
            EXPECT_GT(cover.guards.size(), 1U) << i;
            ++proofs;
        }
        singles += cover.guards.size() == 1 ? 1 : 0;
    }
    EXPECT_GT(singles, 0);
    EXPECT_GT(proofs, 3);
}

}  // namespace any_layout_test
}  // namespace ispace::proofs::poses
