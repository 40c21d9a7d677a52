// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "cover/test_map.h"

namespace ispace {
namespace {

TriedPose tried(double x, double y, double heading, double value, bool chosen = false,
                double tilt = 0) {
    return {"l1",
            {{x, y, kScanHeight}, Angle::degrees(heading), Angle::degrees(tilt), {}},
            value,
            chosen};
}

Color bestColor() { return triedColor(1); }
Color worstColor() { return triedColor(0); }

PlanPixels traceMap(const std::string& lines, std::vector<TriedPose> trace) {
    MapOptions options;
    options.trace = std::move(trace);
    return {mapOf(lines, options), 8};
}

TEST(MapTrace, PlacesHaveTheirBestValueAndHeading) {
    const std::vector<TriedPlace> places =
        placesTried({tried(1, 1, 0, 0.2), tried(2, 1, 10, 0.1, true), tried(1, 1, 90, 0.4, true),
                     tried(1, 1, 180, 0.4), tried(1, 2, 5, 0.1), tried(3, 3, 5, 0.3, false, -90)});
    ASSERT_EQ(places.size(), 4U);
    EXPECT_EQ(places[0].place, (Point2{2, 1}));  // the worst first, of equals the first tried
    EXPECT_TRUE(places[0].is_chosen);
    EXPECT_EQ(places[1].place, (Point2{1, 2}));
    EXPECT_FALSE(places[1].is_chosen);
    EXPECT_FALSE(places[2].heading);  // straight down
    EXPECT_EQ(places[3].place, (Point2{1, 1}));
    EXPECT_EQ(places[3].value, 0.4);
    EXPECT_NEAR(places[3].heading.value().degrees(), 90, 1e-9);
    EXPECT_TRUE(places[3].is_chosen);
    EXPECT_TRUE(placesTried({}).empty());
}

TEST(MapTrace, ColorsDarkenWithEachStep) {
    for (int i = 1; i <= 20; ++i)
        EXPECT_LT(lightness(triedColor(i / 20.0)) + 0.015, lightness(triedColor((i - 1) / 20.0)));
    EXPECT_EQ(triedColor(-1), triedColor(0));
    EXPECT_EQ(triedColor(2), triedColor(1));
}

TEST(MapTrace, DotsTicksAndRingsStandAtTheirPlaces) {
    const PlanPixels pixels =
        traceMap("ispace size=8,8\n", {tried(-2, 2, 0, 0.1), tried(2, 2, 0, 0.2),
                                       tried(2, 2, 90, 0.5), tried(2, -2, 0, 0.1, true)});
    EXPECT_TRUE(isNear(pixels.at(-2, 2), worstColor()));
    EXPECT_TRUE(isNear(pixels.at(2, 2), bestColor()));
    EXPECT_TRUE(isNear(pixels.at(2, -2), worstColor()));
    // Ticks: the best heading's, one and a half radii away.
    const double away = 1.6 * 0.26 * 17 / pixels.scale;
    EXPECT_TRUE(isNear(pixels.at(2, 2 + away), bestColor()));
    EXPECT_FALSE(isNear(pixels.at(2 + away, 2), bestColor()));
    EXPECT_TRUE(isNear(pixels.at(-2 + away, 2), worstColor()));
    EXPECT_EQ(pixels.at(-3, -1), pixelOf(palette::kFloor));
    // The ring of the chosen one only.
    const double ring = 0.68 * 17 / pixels.scale;
    EXPECT_TRUE(isNear(pixels.at(2, -2 + ring), palette::kInk));
    EXPECT_FALSE(isNear(pixels.at(-2, 2 + ring), palette::kInk));
}

TEST(MapTrace, SensorsLieOnTopAndTheBestOnTheOthers) {
    const PlanPixels pixels = traceMap("ispace size=8,8\nlaser at=0,0 range=1\n",
                                       {tried(0, 0, 0, 0.3, true), tried(2, 2, 0, 0.5),
                                        tried(2.02, 2, 0, 0.1), tried(100, 0, 0, 0.2)});
    EXPECT_EQ(pixels.at(0, 0), pixelOf(seriesColor(0)));
    EXPECT_TRUE(isNear(pixels.at(2.02, 2), bestColor()));
}

TEST(MapTrace, ManyDotsAreSmall) {
    std::vector<TriedPose> trace;
    for (int i = 0; i < 100; ++i)
        for (int j = 0; j < 100; ++j)
            trace.push_back(
                tried(-4 + (i + 0.5) * 8 / 100, -4 + (j + 0.5) * 8 / 100, 0, i < 50 ? 0.1 : 0.2));
    const PlanPixels pixels = traceMap("ispace size=8,8\n", trace);
    // Between dots the floor still shows.
    EXPECT_GT(pixels.shareOf(palette::kFloor, -2, 0, 40), 0.04);
    EXPECT_GT(pixels.shareOf(worstColor(), -2, 0, 40), 0.04);
    EXPECT_GT(pixels.shareOf(bestColor(), 2, 0, 40), 0.04);
    EXPECT_EQ(pixels.shareOf(bestColor(), -2, 0, 40), 0);
    MapOptions options;
    options.trace = std::move(trace);
    options.format = PictureFormat::Svg;
    EXPECT_LT(mapOf("ispace size=8,8\n", options).size(), 2'000'000U);
}

/// The legend's block about what was tried.
const LegendBlock* blockOf(const std::vector<LegendBlock>& blocks) {
    const auto block = std::find_if(blocks.begin(), blocks.end(),
                                    [](const auto& b) { return b.title == "Places tried"; });
    return block == blocks.end() ? nullptr : &*block;
}

TEST(MapTrace, LegendTellsTheEndsOfTheScale) {
    const Scene scene = sceneOf("ispace size=8,8\n");
    const Coverage coverage = coverageOf(scene);
    MapOptions options;
    EXPECT_EQ(blockOf(legendBlocks({scene, coverage, options})), nullptr);
    options.trace = {tried(0, 0, 0, 0.1), tried(0, 0, 90, 0.25), tried(1, 0, 0, 0.5, true)};
    std::vector<LegendBlock> blocks = legendBlocks({scene, coverage, options});
    ASSERT_NE(blockOf(blocks), nullptr);
    const std::vector<LegendItem>& items = blockOf(blocks)->items;
    ASSERT_EQ(items.size(), 4U);
    EXPECT_EQ(items[0].sign, LegendItem::Sign::Scale);
    EXPECT_EQ(items[0].value, "25.0% – 50.0%");  // of the best at each place
    EXPECT_EQ(items[1].text, "chosen");
    EXPECT_EQ(items[1].value, "1");
    EXPECT_EQ(items[2].text, "Candidates");
    EXPECT_EQ(items[2].value, "3");
    EXPECT_EQ(items[3].value, "2");
    options.trace = {tried(0, 0, 0, 0.5)};
    blocks = legendBlocks({scene, coverage, options});
    EXPECT_EQ(blockOf(blocks)->items[0].value, "50.0%");
    EXPECT_EQ(blockOf(blocks)->items.size(), 3U);
}

TEST(MapTrace, AllFormatsAndTheSameBytes) {
    MapOptions options;
    options.trace = {tried(-2, 2, 0, 0.1), tried(2, 2, 0, 0.2, true)};
    for (const PictureFormat format :
         {PictureFormat::Png, PictureFormat::Svg, PictureFormat::Pdf}) {
        options.format = format;
        const std::string picture = mapOf("ispace size=8,8\n", options);
        EXPECT_EQ(picture, mapOf("ispace size=8,8\n", options));
        MapOptions without = options;
        without.trace.clear();
        EXPECT_NE(picture, mapOf("ispace size=8,8\n", without));
    }
}

}  // namespace
}  // namespace ispace
