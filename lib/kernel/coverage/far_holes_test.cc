// SPDX-License-Identifier: GPL-3.0-or-later
// An overlay without the holes beyond all views, beside one with all of them.
#include "coverage/far_holes.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "base/number.h"
#include "coverage/metrics.h"
#include "env/level.h"
#include "geom/arrangement.h"
#include "support/test_scenes.h"

namespace ispace {
namespace far_holes_test {

struct UnseenFloor {
    std::vector<Region> pieces;
    std::vector<double> areas;
    double seen = 0;        ///< free floor, m2
    std::size_t edges = 0;  ///< of the overlay
};

UnseenFloor unseenIn(const Scene& scene, const Coverage& coverage, bool all_holes) {
    const auto level = scene.environment.level(0.15);
    const std::vector<Segment2>& sheets = level->slice().sheets;
    FarHoles far(scene.environment.indoor(), level->freeFloor(), sheets);
    std::vector<Curve> curves = far.curvesWithout(coverage.sets);
    if (all_holes) curves = floorCurvesOf(scene.environment, level->freeFloor()).free;
    std::vector<Layer> layers;
    for (const CoveredSet& set : coverage.sets) layers.push_back({.curves = *set.region});
    layers.push_back(markLayer(curves, kFreeMark));
    const Overlay overlay(layers, sheets);
    UnseenFloor unseen;
    unseen.pieces = overlay.regions(
        [](const LayerLabel& label) { return label.count == 0 && (label.marks & kFreeMark) != 0; });
    unseen.areas = overlay.areasOf(unseen.pieces);
    unseen.seen = overlay.area(
        [](const LayerLabel& label) { return label.count > 0 && (label.marks & kFreeMark) != 0; });
    unseen.edges = overlay.edges().size();
    if (!all_holes) far.cutOut(unseen.pieces, unseen.areas);
    return unseen;
}

/// Expects the same unseen floor from both, and returns the share of edges left without far holes.
double expectSame(const Scene& scene, const std::string& name) {
    const Coverage coverage = coverageOf(scene, 10, 10);
    const UnseenFloor full = unseenIn(scene, coverage, true);
    const UnseenFloor less = unseenIn(scene, coverage, false);
    EXPECT_EQ(full.pieces.size(), less.pieces.size()) << name;
    constexpr double kRounding = 1e-6;
    EXPECT_NEAR(full.seen, less.seen, kRounding) << name;
    for (std::size_t i = 0; i < std::min(full.pieces.size(), less.pieces.size()); ++i) {
        EXPECT_EQ(full.pieces[i].outline, less.pieces[i].outline) << name << ' ' << i;
        EXPECT_EQ(full.pieces[i].holes.size(), less.pieces[i].holes.size()) << name << ' ' << i;
        EXPECT_NEAR(full.areas[i], less.areas[i], kRounding) << name << ' ' << i;
        EXPECT_NEAR(totalArea({&less.pieces[i], 1}), less.areas[i], 1e-2) << name << ' ' << i;
    }
    return static_cast<double>(less.edges) / static_cast<double>(full.edges);
}

/// Things in steps of half a metre: some touch at sides and corners, stand on walls, and enclose
/// floor together.
std::string clutter(unsigned seed, int things) {
    std::mt19937_64 random(seed);
    const auto step = [&random](int most) {
        return 0.5 * std::uniform_int_distribution<int>(0, most)(random);
    };
    std::string text =
        "ispace size=12,12\nfence path=-2,-6;-2,1\nfence path=1,1;1,5;4,5\n"
        "fence closed=yes path=2,-4;5,-4;5,-1;2,-1\n";
    for (int i = 0; i < things; ++i) {
        const double x = step(24) - 6, y = step(24) - 6;
        text += i % 3 == 0 ? "cylinder size=0.3,0.3,1 at=" : "cube size=0.5,0.5,1 at=";
        text += formatDouble(x) + "," + formatDouble(y) + "\n";
    }
    for (int i = 0; i < 2; ++i)
        text += "laser fov=200 range=1.5 at=" + formatDouble(step(20) - 4.9) + "," +
                formatDouble(step(20) - 4.9) + "\n";
    return text;
}

TEST(FarHoles, OverlayWithoutThemIsTheSame) {
    constexpr unsigned kScenes = 60;
    for (unsigned seed = 0; seed < kScenes; ++seed)
        expectSame(sceneOf(clutter(seed, 10 + 4 * static_cast<int>(seed))), std::to_string(seed));
}

TEST(FarHoles, MostOfAFurnishedHallIsFar) {
    std::string text = "ispace size=20,20\nlaser range=2\n";
    for (int i = 0; i < 15; ++i)
        for (int k = 0; k < 15; ++k)
            text += "chair at=" + std::to_string(i - 7) + "," + std::to_string(k - 7) + "\n";
    EXPECT_LT(expectSame(sceneOf(text), "hall"), 0.2);
}

TEST(FarHoles, RingKeepsTheFloorInIt) {
    // A ring of four boxes with a free square in the middle, two chambers that only it separates,
    // and a box in a corner.
    const double share = expectSame(
        sceneOf(
            "ispace size=8,8\n"
            "cube size=2,0.5,1 at=0,1\ncube size=2,0.5,1 at=0,-1\n"
            "cube size=0.5,2.5,1 at=1,0\ncube size=0.5,2.5,1 at=-1,0\n"
            "fence path=-4,0;-1.25,0\nfence path=1.25,0;4,0\ncube size=0.5,0.5,1 at=3.75,3.75\n"),
        "ring");
    EXPECT_EQ(share, 1);
}

TEST(FarHoles, NoSensor) {
    EXPECT_LT(expectSame(sceneOf("ispace size=5,5\nchair at=1,1\n"), ""), 1);
}

}  // namespace far_holes_test
}  // namespace ispace
