// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/test_map.h"

namespace ispace {
namespace map_legend_test {

TEST(MapLegend, NamesWhatThePictureShows) {
    const Scene scene = sceneOf(kOffice);
    const Coverage coverage = coverageOf(scene);
    const MapOptions options;
    const std::vector<LegendBlock> blocks = legendBlocks({scene, coverage, options});
    ASSERT_EQ(blocks.size(), 6U);
    EXPECT_EQ(blocks[0].items[2].text, "Indoor area");
    EXPECT_EQ(blocks[0].items[2].value, "44.00 m²");
    std::vector<std::string> plan;
    for (const LegendItem& item : blocks[5].items) plan.push_back(item.text);
    EXPECT_EQ(plan, (std::vector<std::string>{"wall", "object at 0.15 m", "object above or below",
                                              "not indoor", "zone"}));
    EXPECT_EQ(blocks[2].title, "4 lasers");
    EXPECT_EQ(blocks[2].items[1].text, "b");
    EXPECT_EQ(blocks[2].items[1].value, "laser");
}

TEST(MapLegend, SharesOfTheClassesAreThoseOfTheReport) {
    const Scene scene = sceneOf("ispace size=8,8");
    Coverage coverage = coverageOf(scene);
    const MapOptions options;
    coverage.report.redundancy_exact.reset();
    coverage.report.redundancy = {0.25, 0.5, 0.25, 0};
    const std::vector<LegendItem> few = legendBlocks({scene, coverage, options})[1].items;
    ASSERT_EQ(few.size(), 3U);
    EXPECT_EQ(few[0].value, "25.00%");
    EXPECT_EQ(few[1].text, "1 sensor");
    EXPECT_EQ(few[2].text, "2 sensors");
    coverage.report.redundancy.assign(21, 0.0);
    coverage.report.redundancy[1] = 0.125;
    coverage.report.redundancy[4] = 0.125;
    coverage.report.redundancy[20] = 0.75;
    const std::vector<LegendItem> many = legendBlocks({scene, coverage, options})[1].items;
    ASSERT_EQ(many.size(), 6U);  // width 4: 1-4 ... 17-20
    EXPECT_EQ(many[1].text, "1–4 sensors");
    EXPECT_EQ(many[1].value, "25.00%");
    EXPECT_EQ(many[5].text, "17–20 sensors");
    EXPECT_EQ(many[5].value, "75.00%");
}

TEST(MapLegend, ExactMetricsStandBesideThoseByCells) {
    const Scene scene = sceneOf("ispace size=8,8\nlaser at=0,0 fov=90 range=3\n");
    Coverage coverage = coverageOf(scene);
    const MapOptions options;
    coverage.report.coverage = {0.577, 0.578};
    coverage.report.redundancy = {0.4, 0.6};
    coverage.report.redundancy_exact = {0.41, 0.59};
    std::vector<LegendBlock> blocks = legendBlocks({scene, coverage, options});
    EXPECT_EQ(blocks[0].columns, (std::array<std::string, 2>{"exact", "cells"}));
    EXPECT_EQ(blocks[0].items[0].value, "57.80%");
    EXPECT_EQ(blocks[0].items[0].second, "57.70%");
    EXPECT_EQ(blocks[1].items[0].value, "41.00%");
    EXPECT_EQ(blocks[1].items[0].second, "40.00%");
    EXPECT_EQ(mainMetrics({scene, coverage, options})[0], "Coverage 57.80% (cells 57.70%)");

    coverage.report.coverage.exact.reset();
    blocks = legendBlocks({scene, coverage, options});
    EXPECT_EQ(blocks[0].title, "Figures by cells");
    EXPECT_EQ(blocks[0].columns[0], "");
    EXPECT_EQ(blocks[0].items[0].value, "57.70%");
    EXPECT_EQ(mainMetrics({scene, coverage, options})[0], "Coverage 57.70% by cells");
}

TEST(MapLegend, NamesTheKindsOfSensors) {
    const Scene scene = sceneOf(
        "ispace size=8,8 height=3\nlaser id=l at=0,0\n"
        "ranger id=r at=0,0,2 tilt=-60\n"
        "ultrasound id=u1 at=1,1,2.9 tilt=-90\n"
        "ultrasound id=u2 at=2,1,2.9 tilt=-90\n");
    const Coverage coverage = coverageOf(scene);
    const MapOptions options{.color = MapColor::Sensor};
    const MapPicture map{scene, coverage, options};
    const std::vector<LegendBlock> blocks = legendBlocks(map);
    EXPECT_EQ(blocks[1].items.size(), 3U);  // none, one, more
    EXPECT_EQ(blocks[2].title, "1 laser, 1 ranger, 2 receivers");
    ASSERT_EQ(blocks[2].items.size(), 4U);
    EXPECT_EQ(blocks[2].items[1].mark.sign, SensorSign::Square);
    EXPECT_EQ(blocks[2].items[1].value, "ranger");
    EXPECT_EQ(blocks[2].items[3].mark.sign, SensorSign::Triangle);
    // Patches in the colours of the floor; all receivers make one set.
    EXPECT_EQ(blocks[2].items[1].color, floorColor(map, 1));
    EXPECT_EQ(blocks[2].items[2].color, floorColor(map, 2));
    EXPECT_EQ(blocks[2].items[3].color, floorColor(map, 2));
}

TEST(MapLegend, ListsTheSpotsThatAreMarked) {
    const Scene scene = sceneOf("ispace size=10,10\n");
    Coverage coverage = coverageOf(scene);
    const MapOptions options;
    MapPicture map{scene, coverage, options};
    const auto titles = [&map] {
        std::vector<std::string> result;
        for (const LegendBlock& block : legendBlocks(map)) result.push_back(block.title);
        return result;
    };
    coverage.report.unseen = {{{1.23, -4.56}, 12.34}, {{0, 0}, 2}, {{1, 1}, 0.2}};
    EXPECT_EQ(markedSpots(map), 2U);  // the third is too small for a room of 100 m2
    ASSERT_EQ(titles()[3], "Largest unseen spots");
    const LegendBlock block = legendBlocks(map)[3];
    ASSERT_EQ(block.items.size(), 2U);
    EXPECT_EQ(block.items[0].text, "12.34 m²");
    EXPECT_EQ(block.items[0].value, "at 1.23, -4.56");
    EXPECT_EQ(block.items[0].number, "1");
    coverage.report.unseen.assign(9, {{0, 0}, 5});
    EXPECT_EQ(markedSpots(map), 5U);
    map.terse = true;
    EXPECT_EQ(markedSpots(map), 3U);
    coverage.report.unseen.clear();
    for (const std::string& title : titles()) EXPECT_NE(title, "Largest unseen spots");
}

TEST(MapLegend, ListsZonesWithTheirCoverage) {
    const Scene scene = sceneOf(kOffice);
    Coverage coverage = coverageOf(scene);
    const MapOptions options;
    coverage.report.unseen.clear();
    coverage.report.zones.assign(1, {"z", 0.5, {0.25, 0.5}});
    LegendBlock block = legendBlocks({scene, coverage, options})[3];
    EXPECT_EQ(block.title, "Zones");
    EXPECT_EQ(block.items[0].text, "z");
    EXPECT_EQ(block.items[0].value, "50.00%");
    EXPECT_EQ(block.items[0].second, "25.00%");
    coverage.report.zones.assign(50, {"z", 0.5, {0.25, 0.5}});
    block = legendBlocks({scene, coverage, options})[3];
    ASSERT_EQ(block.items.size(), 7U);
    EXPECT_EQ(block.items[6].text, "… and 44 more");
}

TEST(MapLegend, ComparisonsAddUp) {
    const Scene scene = sceneOf("ispace size=8,8\nlaser at=0,0 fov=90 range=3\n");
    Coverage coverage = coverageOf(scene);
    const Coverage other = coverage;
    coverage.report.coverage = {0.5, 0.5};  // of 64 m2
    Comparison comparison;
    comparison.name = "old.3dm";
    comparison.coverage = {0.25, 0.25};
    comparison.gained = {20.0, 20.0};
    comparison.lost = {4.0, 4.0};
    coverage.report.comparison = comparison;
    const MapOptions options;
    const MapPicture map{scene, coverage, options, &other};
    const std::vector<LegendItem> items = legendBlocks(map)[1].items;
    ASSERT_EQ(items.size(), 4U);
    EXPECT_EQ(items[0].value, "12.00 m²");
    EXPECT_EQ(items[1].value, "20.00 m²");
    EXPECT_EQ(items[2].value, "4.00 m²");
    EXPECT_EQ(items[3].value, "28.00 m²");
    const std::vector<LegendItem> sensors = legendBlocks(map)[2].items;
    EXPECT_EQ(sensors.back().text, "old.3dm");
    EXPECT_EQ(sensors.back().value, "1 laser");
    EXPECT_TRUE(sensors.back().mark.hollow);
    EXPECT_EQ(mainMetrics(map),
              (std::vector<std::string>{"Coverage 50.00% (cells 50.00%)", "gained 20.00 m²",
                                        "lost 4.00 m²", "old.3dm 25.00%"}));
}

TEST(MapLegend, NarrowPagesShowWhatMattersMost) {
    const Scene scene = sceneOf(kOffice);
    const Coverage coverage = coverageOf(scene);
    const MapOptions options;
    MapPicture map{scene, coverage, options};
    std::size_t all = 0, few = 0;
    for (const LegendBlock& block : legendBlocks(map)) all += block.items.size();
    map.terse = true;
    for (const LegendBlock& block : legendBlocks(map)) few += block.items.size();
    EXPECT_LT(few, all);
    EXPECT_EQ(legendBlocks(map)[0].items[0].text, "Coverage");
}

TEST(MapContents, TellsWallsFromWhatIsOpenAtTheHeight) {
    const std::string room = "fence id=f closed=yes path=0,0;4,0;4,4;0,4\n";
    const auto contents = [](const std::string& lines) {
        const Scene scene = sceneOf(lines);
        return contentsOf(scene, coverageOf(scene));
    };
    EXPECT_TRUE(contents(room).walls);
    EXPECT_FALSE(contents(room).openings);
    EXPECT_TRUE(contents(room + "door wall=f offset=1 size=1 open=yes\n").openings) << "a lintel";
    EXPECT_TRUE(contents(room + "fence path=1,1;2,2 height=0.1\n").openings) << "below";
}

}  // namespace map_legend_test
}  // namespace ispace
