// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/proofs/poses/multiple_bound.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <numbers>
#include <random>
#include <vector>

#include "extensions/proofs/poses/pose_search.h"
#include "extensions/proofs/poses/sum_bound.h"
#include "extensions/proofs/test_pose_floors.h"
#include "support/test_problems.h"

namespace ispace::proofs::poses {
namespace multiple_bound_test {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kCells = 2000;

/// Draws poses in boxes, and computes the area that several of them see.
class SeveralPoses {
  public:
    SeveralPoses(const Region& region, const Sector& sector)
        : region_(region), areas_(region, sector) {}

    /// Returns the area that at least `times` poses see, one in each box; 0 if one has no floor.
    double areaIn(std::span<const PoseBox> boxes, int times) {
        std::vector<Pose2> poses;
        for (const PoseBox& box : boxes) {
            Point2 p;
            int tries = 0;
            do {
                if (++tries > 50) return 0;
                p = {draw(box.at.low.x, box.at.high.x), draw(box.at.low.y, box.at.high.y)};
            } while (region_.locate(p) != Side::Inside);
            poses.push_back({p, Angle::radians(draw(box.from, box.from + box.span))});
        }
        return areas_.of(poses, times);
    }
    /// The best of random layouts.
    double bestOf(std::size_t sensors, int times, int tries) {
        const std::vector<PoseBox> boxes(sensors, {bounds(region_.outline), 0, 2 * kPi});
        double best = 0;
        for (int i = 0; i < tries; ++i) best = std::max(best, areaIn(boxes, times));
        return best;
    }
    double draw(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }

  private:
    const Region& region_;
    SeenAreas areas_;
    std::mt19937 random_{5};
};

PoseBound boundOf(const Region& region, const Sector& sector, const PoseSearchOptions& options,
                  int rounds) {
    const PoseFloor floor({&region, 1}, kCells);
    StopWhen stop(afterAsking(rounds));
    return boundOverPoses(floor, sector, options, stop);
}

Region hall() { return {{{0, 0}, {9, 0}, {9, 7}, {0, 7}}, {}}; }

TEST(MultipleBound, SectorsThatShareADiscHaveTheirClosedForm) {
    // At one point, with headings spread evenly, n fields of k/n of a turn see each direction k
    // times; no layout sees more than the sum of the sectors over k.
    const double disc = 4 * kPi;
    for (const auto& [sensors, times] : {std::pair(3, 2), {4, 2}, {4, 3}, {2, 2}}) {
        const Sector sector{2, 2 * kPi * times / sensors, 0};
        const PoseBound found =
            boundOf(hall(), sector, {.sensors = sensors, .times = times, .found = disc}, 60);
        EXPECT_NEAR(found.bound, disc, 1e-9) << sensors << ' ' << times;
        EXPECT_TRUE(found.is_complete);
        EXPECT_GE(boundOf(hall(), sector, {.sensors = sensors, .times = times}, 20).bound,
                  disc - 1e-9);
    }
}

TEST(MultipleBound, AsManySensorsAsTimesSeeNoMoreThanOne) {
    const Region region = roomsWithPillar();
    const Sector sector{3, 2, 0};
    const double best = SeveralPoses(region, sector).bestOf(1, 1, 200);
    const PoseSearchOptions alone{.sensors = 1, .found = best, .gap = 0.05};
    const double one = boundOf(region, sector, alone, 40).bound;
    for (const int sensors : {2, 3}) {
        const PoseBound found =
            boundOf(region, sector, {.sensors = sensors, .times = sensors, .gap = 0.05}, 8);
        EXPECT_GE(found.bound, best);
        EXPECT_LE(found.bound, one * 1.05);
    }
}

TEST(MultipleBound, NeverBelowRandomLayouts) {
    for (const Region& region : {roomsWithPillar(), hall()})
        for (const Sector& sector : {Sector{3, 2, -1}, Sector{2.5, 4, 0}, Sector{20, 2 * kPi, 0}})
            for (const auto& [sensors, times] : {std::pair(2, 2), {3, 2}, {4, 2}, {4, 3}}) {
                const double best = SeveralPoses(region, sector)
                                        .bestOf(static_cast<std::size_t>(sensors), times, 200);
                for (const int rounds : {0, 12}) {
                    // Without a layout to begin with, of which the bound would be the larger one.
                    const PoseBound found =
                        boundOf(region, sector, {.sensors = sensors, .times = times}, rounds);
                    EXPECT_GE(found.bound, best) << sensors << ' ' << times << ' ' << rounds;
                    EXPECT_LE(found.bound, region.area() * 1.01);
                }
            }
}

/// Divides boxes at random; returns those with views.
std::vector<BoxId> dividedBoxes(PoseBoxes& boxes, SeveralPoses& poses, int halvings) {
    std::vector<BoxId> whole = {0};
    for (int i = 0; i < halvings; ++i) {
        const auto which =
            static_cast<std::size_t>(poses.draw(0, static_cast<double>(whole.size()) - 1e-9));
        const BoxId id = whole[which];
        boxes.splitWithViews({id});
        whole.erase(whole.begin() + static_cast<std::ptrdiff_t>(which));
        for (BoxId half = boxes[id].child; half < boxes[id].child + 2; ++half)
            if (!boxes[half].isBlind()) whole.push_back(half);
    }
    return whole;
}

/// The least bound of what boxes see together, over all subsets that are known by their areas.
double leastUnion(const PoseBoxes& boxes, const std::vector<BoxId>& ids, Grain grain) {
    double least = 0;
    for (const BoxId id : ids) least += boxes[id].most;
    for (unsigned chosen = 0; chosen < 1U << ids.size(); ++chosen) {
        std::vector<BoxId> known, others;
        for (std::size_t i = 0; i < ids.size(); ++i)
            ((chosen >> i & 1U) != 0 ? known : others).push_back(ids[i]);
        least = std::min(least, boxes.unionOf(known, others, grain));
    }
    return least;
}

/// Sensors that count once see what their boxes see together, in the cells that suffice.
void expectUnion(const PoseFloor& floor, const PoseBoxes& boxes, const std::vector<BoxId>& ids) {
    constexpr double kRounding = 1e-6;  // allowances
    const MultipleBound bound(floor, boxes, ids.size(), 1);
    const double fine = leastUnion(boxes, ids, Grain::Fine);
    const double large = leastUnion(boxes, ids, Grain::Large);
    EXPECT_LE(fine, large + kRounding);
    EXPECT_NEAR(bound.of(ids, 0), boxes.areWithinCells(Grain::Fine, ids) ? fine : large, kRounding);
    if (!(large > bound.ofSingles(ids) * 0.5) || large >= bound.ofSingles(ids)) return;
    const double close = bound.of(ids, large / 1.001);
    EXPECT_GE(close, fine - kRounding);
    EXPECT_LE(close, std::max(fine, large / 1.001) + kRounding);
}

TEST(MultipleBound, PosesInTheBoxesSeeNoMore) {
    const Region region = roomsWithPillar();
    const PoseFloor floor({&region, 1}, kCells);
    for (const Sector& sector : {Sector{3, 2, -1}, Sector{4, 5, 0}, Sector{20, 2 * kPi, 0}}) {
        PoseBoxes boxes(floor, sector);
        SeveralPoses poses(region, sector);
        const std::vector<BoxId> whole = dividedBoxes(boxes, poses, 300);
        double least_ratio = 1;
        int lowered = 0;
        for (int i = 0; i < 120; ++i) {
            const auto sensors = static_cast<std::size_t>(2 + i % 3);
            std::vector<BoxId> ids;
            std::vector<PoseBox> own;
            while (ids.size() < sensors) {
                // Often the same box, so that views overlap.
                ids.push_back(!ids.empty() && poses.draw(0, 1) < 0.5
                                  ? ids.back()
                                  : whole[static_cast<std::size_t>(
                                        poses.draw(0, static_cast<double>(whole.size()) - 1e-9))]);
                own.push_back(boxes[ids.back()].box);
            }
            expectUnion(floor, boxes, ids);
            for (std::size_t times = 1; times <= sensors; ++times) {
                const MultipleBound bound(floor, boxes, sensors, times);
                const double most = bound.of(ids, 0);
                EXPECT_LE(most, bound.ofSingles(ids));
                if (bound.ofSingles(ids) > 0)
                    least_ratio = std::min(least_ratio, most / bound.ofSingles(ids));
                std::vector<SumBound::Bounded> sum = {{ids, most}};
                for (int k = 0; k < 4; ++k) SumBound(floor, boxes, times).lower(sum, 0);
                if (sum.front().bound < most) ++lowered;
                for (int k = 0; k < 3; ++k)
                    EXPECT_GE(sum.front().bound + 1e-9, poses.areaIn(own, static_cast<int>(times)))
                        << sensors << ' ' << times;
            }
        }
        EXPECT_LT(least_ratio, 0.5);  // views count, not their areas alone
        EXPECT_GT(lowered, 20);       // by the parts of boxes
    }
}

TEST(MultipleBound, TheSameForAnyNumberOfThreads) {
    const auto run = [](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return boundOf(roomsWithPillar(), {2.5, 3, 0},
                       {.sensors = 3, .times = 2, .found = 5, .gap = 0.02}, 30);
    };
    const PoseBound one = run(1), four = run(4);
    EXPECT_EQ(one.bound, four.bound);
    EXPECT_EQ(one.boxes, four.boxes);
    EXPECT_EQ(one.tuples, four.tuples);
}

}  // namespace multiple_bound_test
}  // namespace ispace::proofs::poses
