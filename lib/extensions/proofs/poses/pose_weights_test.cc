// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "extensions/proofs/poses/box_sums.h"
#include "extensions/proofs/poses/inner_bound.h"
#include "extensions/proofs/poses/multiple_bound.h"
#include "extensions/proofs/poses/pose_search.h"
#include "extensions/proofs/poses/sum_bound.h"
#include "extensions/proofs/test_pose_floors.h"
#include "geom/overlay/overlay.h"
#include "support/test_problems.h"

namespace ispace::proofs::poses {
namespace pose_weights_test {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kCells = 1500;

Polygon rectangleOf(double left, double low, double right, double high) {
    return {{left, low}, {right, low}, {right, high}, {left, high}};
}

FloorWeighting weighting() {
    return {.elsewhere = 1,
            .pieces = {{rectangleOf(1, 1, 4.3, 3.7), 3},
                       {{{6.05, 0}, {10, 0.3}, {8.5, 4}}, 0.25},
                       {rectangleOf(-1, 4.1, 12, 4.6), 0},
                       {rectangleOf(4.5, 1, 5.1, 2), 3}}};
}

double weightedParts(const PoseFloor& floor, const std::vector<std::uint8_t>& parts) {
    return floor.weightOf([&](std::size_t first, std::size_t count) {
        return std::accumulate(&parts[first], &parts[first] + count, std::uint64_t{0});
    });
}

/// Area by weight of floor in some of the outlines.
class WeightedAreas {
  public:
    WeightedAreas(const Region& region, FloorWeighting weighting)
        : region_(region), weighting_(std::move(weighting)) {}

    [[nodiscard]] double of(const std::vector<Polygon>& views, int times) const {
        std::vector<Layer> layers;
        for (std::size_t i = 0; i < weighting_.pieces.size(); ++i)
            layers.push_back({.curves = {curveOf(weighting_.pieces[i].outline)},
                              .counts = false,
                              .marks = std::uint64_t{2} << i});
        std::vector<Curve> floor;
        for (const Polygon& curve : curvesOf(region_)) floor.push_back(curveOf(curve));
        layers.push_back({.curves = floor, .counts = false, .marks = 1});
        for (const Polygon& view : views) layers.push_back({.curves = {curveOf(view)}});
        double sum = 0;
        Overlay(layers).addAreas([&](const LayerLabel& label, double area) {
            if (label.count < times || (label.marks & 1U) == 0) return;
            double weight = weighting_.elsewhere;
            for (std::size_t i = 0; i < weighting_.pieces.size(); ++i)
                if ((label.marks >> (i + 1) & 1U) != 0) weight = weighting_.pieces[i].weight;
            sum += weight * area;
        });
        return sum;
    }

  private:
    const Region& region_;
    FloorWeighting weighting_;
};

TEST(PoseWeights, LayersHoldTheFloorOfTheirWeights) {
    const Region region = roomsWithPillar();
    const PoseFloor floor({&region, 1}, kCells, weighting());
    const double exact = WeightedAreas(region, weighting()).of({rectangleOf(-1, -1, 20, 20)}, 1);
    double weighed = 0;
    for (std::size_t i = 0; i < floor.triangles().size(); ++i) {
        const PoseFloor::Corners corners = floor.cornersOf(i);
        weighed += floor.weigh({corners.begin(), corners.end()});
    }
    EXPECT_NEAR(weighed, exact, 1e-6);
    EXPECT_GE(weightedParts(floor, floor.parts()), exact - 1e-6);
    EXPECT_LE(weightedParts(floor, floor.parts()), exact * 1.01);
    EXPECT_EQ(floor.mostWeight(), 3);
}

TEST(PoseWeights, LargeCellsHoldTheSameFloor) {
    const Region region = roomsWithPillar();
    const PoseFloor fine({&region, 1}, kCells, weighting());
    const PoseFloor& large = fine.in(Grain::Large);
    EXPECT_EQ(&fine.in(Grain::Fine), &fine);
    EXPECT_NEAR(large.side(), 4 * fine.side(), 0.01);
    EXPECT_EQ(large.mostWeight(), fine.mostWeight());
    // Both are rounded up; no large cell lacks floor of its fine ones.
    const double exact = weightedParts(fine, fine.parts());
    EXPECT_NEAR(weightedParts(large, large.parts()), exact, 0.02 * exact);
    const Sector sector{3, 2, -1};
    for (const double at : {1.0, 1.7, 2.9}) {
        const PoseBox box{{{at, at}, {at + 0.3, at + 0.2}}, at, 0.3};
        const double fat = weightedParts(large, outerBoundOf(large, sector, box).parts);
        const double core = weightedParts(large, innerBoundOf(large, sector, box));
        const double fine_fat = weightedParts(fine, outerBoundOf(fine, sector, box).parts);
        const double fine_core = weightedParts(fine, innerBoundOf(fine, sector, box));
        EXPECT_GE(fat, fine_fat * 0.99);
        EXPECT_LE(fat, fine_fat * 1.1);
        EXPECT_LE(core, fine_core * 1.01);
        EXPECT_GE(core, fine_core * 0.8);
    }
}

TEST(PoseWeights, ASectorThatFitsInAZoneHasItsClosedForm) {
    const Region region = {rectangleOf(0, 0, 9, 7), {}};
    const Sector sector{1, 2 * kPi / 3, 0};
    for (const double elsewhere : {0.0, 2.5}) {
        const PoseFloor floor({&region, 1}, kCells,
                              {.elsewhere = elsewhere, .pieces = {{rectangleOf(3, 2, 7, 5), 4}}});
        const double one = 4 * kPi / 3;
        for (const int sensors : {1, 2}) {
            StopWhen silent(afterAsking(400));
            const PoseBound found =
                boundOverPoses(floor, sector, {.sensors = sensors, .found = sensors * one}, silent);
            EXPECT_NEAR(found.bound, sensors * one, 1e-9) << elsewhere << ' ' << sensors;
            EXPECT_TRUE(found.is_complete);
            StopWhen stop(afterAsking(20));
            EXPECT_GE(boundOverPoses(floor, sector, {.sensors = sensors}, stop).bound,
                      sensors * one - 1e-9);
        }
    }
}

TEST(PoseWeights, FloorThatDoesNotCountAddsNone) {
    // All of the zone is seen from anywhere in the room.
    const Region region = {rectangleOf(0, 0, 9, 7), {}};
    const PoseFloor floor({&region, 1}, kCells,
                          {.elsewhere = 0, .pieces = {{rectangleOf(1.03, 1, 2, 2.37), 2}}});
    const double zone = 2 * 0.97 * 1.37;
    StopWhen stop(afterAsking(200));
    const PoseBound found =
        boundOverPoses(floor, {20, 2 * kPi, 0}, {.sensors = 2, .found = zone, .gap = 0.02}, stop);
    EXPECT_LE(found.bound, zone * 1.02);  // parts of cells are rounded up
    StopWhen soon(afterAsking(20));
    EXPECT_GE(boundOverPoses(floor, {20, 2 * kPi, 0}, {.sensors = 2}, soon).bound, zone);
    const PoseFloor none({&region, 1}, kCells, {.elsewhere = 0});
    EXPECT_EQ(boundOverPoses(none, {20, 2 * kPi, 0}, {.sensors = 2}, stop).bound, 0);
}

TEST(PoseWeights, AWeightOfAllFloorScalesTheBound) {
    const Region region = roomsWithPillar();
    const auto bound = [&](const FloorWeighting& weights) {
        const PoseFloor floor({&region, 1}, kCells, weights);
        StopWhen stop(afterAsking(30));
        return boundOverPoses(floor, {3, 2, 0}, {.sensors = 2}, stop).bound;
    };
    const double plain = bound({});
    EXPECT_NEAR(bound({.elsewhere = 2}), 2 * plain, 1e-9);
    EXPECT_EQ(bound({.elsewhere = 1, .pieces = {{rectangleOf(1, 1, 3, 3), 1}}}), plain);
}

TEST(PoseWeights, NeverBelowRandomLayouts) {
    const Region region = roomsWithPillar();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> x(0, 11), y(0, 5), turn(0, 360);
    FloorWeighting targets = weighting();
    targets.elsewhere = 0;
    for (const FloorWeighting& weights : {weighting(), targets})
        for (const auto& [sensors, times] : {std::pair(1, 1), {2, 1}, {3, 1}, {3, 2}}) {
            const Sector sector{2.5, sensors == 2 ? 4.0 : 2.0, 0};
            const WeightedAreas areas(region, weights);
            const SeenAreas seen(region, sector);
            double best = 0;
            for (int i = 0; i < 200; ++i) {
                std::vector<Polygon> views;
                while (views.size() < static_cast<std::size_t>(sensors)) {
                    const Point2 p{x(random), y(random)};
                    if (region.locate(p) != Side::Inside) continue;
                    views.push_back(seen.viewFrom({p, Angle::degrees(turn(random))}));
                }
                best = std::max(best, areas.of(views, times));
            }
            const PoseFloor floor({&region, 1}, kCells, weights);
            for (const int rounds : {0, 3, 40}) {
                StopWhen stop(afterAsking(rounds));
                // Without a layout to begin with, of which the bound would be the larger one.
                const PoseBound found =
                    boundOverPoses(floor, sector, {.sensors = sensors, .times = times}, stop);
                EXPECT_GE(found.bound, best) << sensors << ' ' << times << ' ' << rounds;
                EXPECT_LE(found.bound, (rounds == 40 ? 3 : 20) * best);
            }
        }
}

/// Divides boxes at random; returns those with views.
std::vector<BoxId> weighedBoxes(PoseBoxes& boxes, std::mt19937& random, int halvings) {
    std::vector<BoxId> whole = {0};
    for (int i = 0; i < halvings; ++i) {
        const std::size_t which = random() % whole.size();
        const BoxId id = whole[which];
        boxes.splitWithViews({id});
        whole.erase(whole.begin() + static_cast<std::ptrdiff_t>(which));
        for (BoxId half = boxes[id].child; half < boxes[id].child + 2; ++half)
            if (!boxes[half].isBlind()) whole.push_back(half);
    }
    return whole;
}

TEST(PoseWeights, PosesInTheBoxesSeeNoMore) {
    const Region region = roomsWithPillar();
    const WeightedAreas areas(region, weighting());
    const PoseFloor floor({&region, 1}, kCells, weighting());
    std::mt19937 random(8);
    const auto draw = [&random](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (const Sector& sector : {Sector{3, 2, -1}, Sector{20, 2 * kPi, 0}}) {
        const SeenAreas seen(region, sector);
        PoseBoxes boxes(floor, sector);
        const std::vector<BoxId> whole = weighedBoxes(boxes, random, 300);
        int compared = 0;
        for (int i = 0; i < 150; ++i) {
            const auto sensors = static_cast<std::size_t>(1 + i % 3);
            std::vector<BoxId> ids;
            std::vector<Polygon> views;
            for (int tries = 0; ids.size() < sensors && tries < 500; ++tries) {
                const BoxId id =
                    !ids.empty() && random() % 2 == 0 ? ids.back() : whole[random() % whole.size()];
                const PoseBox& box = boxes[id].box;
                const Point2 p{draw(box.at.low.x, box.at.high.x),
                               draw(box.at.low.y, box.at.high.y)};
                if (region.locate(p) != Side::Inside) continue;
                ids.push_back(id);
                views.push_back(
                    seen.viewFrom({p, Angle::radians(draw(box.from, box.from + box.span))}));
            }
            if (ids.size() < sensors) continue;
            ++compared;
            EXPECT_GE(boxes.unionOf({}, ids) + 1e-9, areas.of(views, 1)) << sensors;
            for (std::size_t times = 1; times <= sensors; ++times)
                EXPECT_GE(MultipleBound(floor, boxes, sensors, times).of(ids, 0) + 1e-9,
                          areas.of(views, static_cast<int>(times)))
                    << sensors << ' ' << times;
            EXPECT_GE(boxes.unionOf({ids.data(), 1}, {ids.begin() + 1, ids.end()}) + 1e-9,
                      areas.of(views, 1));
        }
        EXPECT_GT(compared, 100);
    }
}

/// Returns the tree of boxes with the views of the check, and their ids in its order.
std::vector<CheckedBox> checkedBoxes(const PoseBoxes& boxes, const BoxViews& views,
                                     std::vector<BoxId>& ids) {
    std::vector<CheckedBox> all;
    const auto add = [&](const auto& self, BoxId id) -> void {
        const std::size_t own = all.size();
        ids.push_back(id);
        all.push_back({.box = boxes[id].box});
        all[own].large_view = views.viewOf(all[own].box);
        all[own].large_core = views.coreOf(all[own].box);
        all[own].most = all[own].large_view.area;
        if (boxes[id].child == 0) return;
        self(self, boxes[id].child);
        all[own].second = static_cast<std::uint32_t>(all.size());
        self(self, boxes[id].child + 1);
    };
    add(add, 0);
    return all;
}

TEST(PoseWeights, SumsOverSensorsHoldWhatTheySee) {
    const Region region = roomsWithPillar();
    const WeightedAreas areas(region, weighting());
    const PoseFloor floor({&region, 1}, kCells, weighting());
    const Sector sector{3, 4, 0};
    const BoxViews views({&region, 1}, kCells / 16, sector, weighting());
    const SeenAreas seen(region, sector);
    std::mt19937 random(5);
    const auto draw = [&random](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    PoseBoxes boxes(floor, sector);
    std::vector<BoxId> whole = weighedBoxes(boxes, random, 400);
    std::vector<BoxId> ids;
    const std::vector<CheckedBox> checked = checkedBoxes(boxes, views, ids);
    std::erase_if(whole, [&boxes](BoxId id) { return !boxes.areSmall({&id, 1}); });
    int searched = 0, by_check = 0;  // bounds below those of single views
    for (int i = 0; i < 300; ++i) {
        const auto sensors = static_cast<std::size_t>(2 + i % 2);
        std::vector<BoxId> tuple;
        std::vector<std::uint32_t> rows;
        std::vector<Polygon> polygons;
        double singles = 0;
        while (tuple.size() < sensors) {
            const BoxId id =
                !tuple.empty() && random() % 2 == 0 ? tuple.back() : whole[random() % whole.size()];
            const PoseBox& box = boxes[id].box;
            const Point2 p{draw(box.at.low.x, box.at.high.x), draw(box.at.low.y, box.at.high.y)};
            if (region.locate(p) != Side::Inside) continue;
            tuple.push_back(id);
            rows.push_back(
                static_cast<std::uint32_t>(std::find(ids.begin(), ids.end(), id) - ids.begin()));
            polygons.push_back(
                seen.viewFrom({p, Angle::radians(draw(box.from, box.from + box.span))}));
            singles += boxes[id].most;
        }
        for (std::size_t times = 1; times <= 2; ++times) {
            const double area = areas.of(polygons, static_cast<int>(times));
            std::vector<SumBound::Bounded> bounded = {{tuple, singles}};
            SumBound sums(floor, boxes, times);
            for (int round = 0; round < 3; ++round) {
                sums.lower(bounded, 0);
                EXPECT_GE(bounded[0].bound + 1e-9, area) << sensors << ' ' << times;
            }
            if (bounded[0].bound < singles / static_cast<double>(times) * 0.99) ++searched;
            const double bound = BoxSums(views, checked, times).boundOf(rows, 0, 2);
            EXPECT_GE(bound + 1e-9, area) << sensors << ' ' << times;
            if (bound < singles / static_cast<double>(times) * 0.99) ++by_check;
        }
    }
    EXPECT_GT(searched, 300);
    EXPECT_GT(by_check, 300);
}

}  // namespace pose_weights_test
}  // namespace ispace::proofs::poses
