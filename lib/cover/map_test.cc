// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/error.h"
#include "cover/map_parts.h"
#include "cover/test_scenes.h"
#include "draw/image.h"

namespace ispace {
namespace {

std::uint32_t pixelOf(Color color) {
    const auto part = [](double share) {
        return static_cast<std::uint32_t>(std::lround(share * 255));
    };
    return part(color.red) << 16 | part(color.green) << 8 | part(color.blue);
}

const char* const kOffice =
    "fence path=0,0;8,0;8,6;3,6;3,5;0,5 closed=yes\ninside at=1,1\n"
    "fence id=shaft path=6,4;7,4;7,5;6,5 closed=yes\n"
    "desk at=2,3 heading=30 size=1.2,0.8,0.7\ncube at=4,2 size=0.5,0.5,0.5\n"
    "zone id=z path=1,1;2,1;2,2\n"
    "laser id=a at=0.1,2.5\nlaser id=b at=7.9,3 heading=180 range=4\n"
    "laser id=c at=3.5,5.9 heading=-90 fov=240\n"
    "laser id=d at=7,0.3,1.5 heading=120 fov=90 tilt=-20\n";

std::string mapOf(const std::string& lines, MapOptions options = {}) {
    const Scene scene = sceneOf(lines);
    return drawCoverageMap(scene, coverageOf(scene), options);
}

/// A page without title keeps the plan beside the legend, its corner at the margin.
constexpr int kMargin = 30;

TEST(Map, ShowsFloorWallsAndObjectsWhereTheyAre) {
    // 8 m x 8 m, upper right quarter seen; 100 px/m or a little more.
    const Image pixels =
        decodePng(mapOf("ispace size=8,8\ncube at=-3,-3 size=1,1,1\ncube at=-3,0,2 size=1,1,1\n"
                        "laser at=0.01,0.01 heading=45 fov=90 range=20\n"));
    EXPECT_EQ(pixels.width, 1200);
    int right = kMargin;  // of the plan, found on the wall's own line
    while (pixels.at(right + 1, kMargin) == pixelOf(map_colors::kWall)) ++right;
    const double scale = (right - kMargin) / 8.0;
    ASSERT_GT(scale, 90);
    const auto at = [&](double x, double y) {
        return pixels.at(static_cast<int>(kMargin + (x + 4) * scale),
                         static_cast<int>(kMargin + (4 - y) * scale));
    };
    EXPECT_EQ(at(3, 3), pixelOf(sequentialColor(1, 1)));
    EXPECT_EQ(at(2, 1), pixelOf(sequentialColor(1, 1)));
    EXPECT_EQ(at(3, -3), pixelOf(map_colors::kUncovered));
    EXPECT_EQ(at(-1, 3), pixelOf(map_colors::kUncovered));
    EXPECT_EQ(at(-3, -3), pixelOf(map_colors::kSolid));
    EXPECT_NE(at(-3, 0), pixelOf(map_colors::kSolid));
    EXPECT_NE(at(-3, 0), pixelOf(map_colors::kUncovered));
    EXPECT_EQ(at(0.01, 0.01), pixelOf(seriesColor(0)));
    EXPECT_EQ(pixels.at(5, 5), 0xFFFFFFU);
}

TEST(Map, RedundancyDarkensTheFloor) {
    const Image pixels =
        decodePng(mapOf("ispace size=8,8\nlaser at=0,-3.99 heading=90 range=20\n"
                        "laser at=-0.01,0 heading=0 range=20\n"));
    int right = kMargin;
    while (pixels.at(right + 1, kMargin) == pixelOf(map_colors::kWall)) ++right;
    const int quarter = (right - kMargin) / 4;
    EXPECT_EQ(pixels.at(kMargin + quarter, kMargin + quarter), pixelOf(sequentialColor(1, 2)));
    EXPECT_EQ(pixels.at(kMargin + 3 * quarter, kMargin + quarter), pixelOf(sequentialColor(2, 2)));
}

TEST(Map, CellsLeaveNoSeams) {
    const Image pixels = decodePng(mapOf("ispace size=8,8\nlaser at=0,0 fov=360 range=20\n"));
    int right = kMargin;
    while (pixels.at(right + 1, kMargin) == pixelOf(map_colors::kWall)) ++right;
    // A diagonal through many cells, away from marks, rims and walls.
    for (int i = 40; i < (right - kMargin) / 2 - 60; ++i)
        ASSERT_EQ(pixels.at(kMargin + i, kMargin + i), pixelOf(sequentialColor(1, 1))) << i;
}

TEST(Map, EqualScenesGiveEqualBytes) {
    for (const MapFormat format : {MapFormat::Png, MapFormat::Svg, MapFormat::Pdf}) {
        const MapOptions options{format, 900, "office.glb"};
        const std::string first = mapOf(kOffice, options);
        EXPECT_GT(first.size(), 10000U);
        EXPECT_TRUE(first == mapOf(kOffice, options));
    }
}

/// Elements open and close in order, attributes are quoted: enough to catch a broken writer.
bool isWellFormed(const std::string& xml) {
    std::vector<std::string> open;
    bool any = false;
    for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at)) {
        const std::size_t end = xml.find('>', at);
        if (end == std::string::npos) return false;
        const std::string tag = xml.substr(at + 1, end - at - 1);
        at = end;
        if (tag[0] == '?' || tag[0] == '!') continue;
        if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return false;
        const std::string name = tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" \n/", 1));
        if (tag[0] == '/') {
            if (open.empty() || open.back() != name) return false;
            open.pop_back();
        } else if (tag.back() != '/') {
            open.push_back(tag.substr(0, tag.find_first_of(" \n")));
        }
        any = true;
    }
    return any && open.empty();
}

TEST(Map, SvgIsWellFormedAndSmall) {
    const std::string svg = mapOf(kOffice, {MapFormat::Svg, 1200, "a <b> & \"c\""});
    EXPECT_TRUE(isWellFormed(svg));
    EXPECT_LT(svg.size(), 300000U);
    EXPECT_NE(svg.find("width=\"1200px\""), std::string::npos);
}

TEST(Map, PdfIsAPdfWithoutDate) {
    const std::string pdf = mapOf(kOffice, {MapFormat::Pdf, 1200, "office"});
    EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
    EXPECT_EQ(pdf.find("Date"), std::string::npos);
}

TEST(Map, KeepsTheWidthThatIsAskedForAtAnyAspect) {
    for (const std::string room : {"ispace size=50,1", "ispace size=1,50", "ispace size=5,5",
                                   "ispace size=0.01,0.01", "ispace size=9000,7000"}) {
        for (const int width : {200, 400, 1200}) {
            const Image pixels = decodePng(
                mapOf(room + "\nlaser at=0,0 heading=30\n", {MapFormat::Png, width, "a room"}));
            EXPECT_EQ(pixels.width, width);
            EXPECT_LT(pixels.height, 4 * width) << room;
            EXPECT_GT(pixels.height, width / 5) << room;
        }
    }
}

TEST(Map, RefusesWidthsItCannotLayOut) {
    EXPECT_THROW(mapOf("ispace", {MapFormat::Png, 0, ""}), UsageError);
    EXPECT_THROW(mapOf("ispace", {MapFormat::Svg, 1'000'000, ""}), UsageError);
}

TEST(Map, ManySensorsDoNotStretchThePage) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> place(-9, 9);
    std::string lines = "ispace size=20,20\n";
    for (int i = 0; i < 100; ++i)
        lines += "laser at=" + std::to_string(place(random)) + "," + std::to_string(place(random)) +
                 " heading=" + std::to_string(40 * place(random)) + "\n";
    const Scene scene = sceneOf(lines);
    const Coverage coverage = coverageOf(scene);
    const Image many = decodePng(drawCoverageMap(scene, coverage, {}));
    const Image none = decodePng(mapOf("ispace size=20,20\n"));
    EXPECT_EQ(many.height, none.height);

    std::vector<LegendBlock> blocks = legendBlocks(scene, coverage);
    EXPECT_EQ(blocks[2].title, "100 sensors");
    ASSERT_EQ(blocks[2].items.size(), 9U);
    EXPECT_EQ(blocks[2].items.back().text, "… and 92 more");
}

TEST(Map, SensorsFarOutsideDoNoHarm) {
    const Image pixels =
        decodePng(mapOf("ispace size=8,6\nlaser at=1e5,0 range=1e6 heading=180\n"
                        "laser at=0,0,3 range=1e6\n"));
    EXPECT_EQ(pixels.width, 1200);
}

TEST(MapLegend, NamesWhatThePictureShows) {
    const Scene scene = sceneOf(kOffice);
    const std::vector<LegendBlock> blocks = legendBlocks(scene, coverageOf(scene));
    ASSERT_EQ(blocks.size(), 4U);
    EXPECT_EQ(blocks[0].items[2].text, "Indoor area");
    EXPECT_EQ(blocks[0].items[2].value, "44.0 m²");
    std::vector<std::string> plan;
    for (const LegendItem& item : blocks[3].items) plan.push_back(item.text);
    EXPECT_EQ(plan, (std::vector<std::string>{"wall", "object at 0.15 m", "object above or below",
                                              "not indoor", "zone"}));
    EXPECT_EQ(blocks[2].items[1].text, "b");
    EXPECT_EQ(blocks[2].items[1].value, "laser");
}

TEST(MapLegend, SharesOfTheClassesAreThoseOfTheReport) {
    const Scene scene = sceneOf("ispace size=8,8");
    Coverage coverage = coverageOf(scene);
    coverage.report.redundancy = {0.25, 0.5, 0.25, 0};
    const std::vector<LegendItem> few = legendBlocks(scene, coverage)[1].items;
    ASSERT_EQ(few.size(), 3U);
    EXPECT_EQ(few[0].value, "25.0%");
    EXPECT_EQ(few[1].text, "1 sensor");
    EXPECT_EQ(few[2].text, "2 sensors");
    coverage.report.redundancy.assign(21, 0.0);
    coverage.report.redundancy[1] = 0.125;
    coverage.report.redundancy[4] = 0.125;
    coverage.report.redundancy[20] = 0.75;
    const std::vector<LegendItem> many = legendBlocks(scene, coverage)[1].items;
    ASSERT_EQ(many.size(), 6U);  // width 4: 1-4 ... 17-20
    EXPECT_EQ(many[1].text, "1–4 sensors");
    EXPECT_EQ(many[1].value, "25.0%");
    EXPECT_EQ(many[5].text, "17–20 sensors");
    EXPECT_EQ(many[5].value, "75.0%");
}

}  // namespace
}  // namespace ispace
