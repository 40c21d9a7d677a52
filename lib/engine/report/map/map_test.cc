// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/map/map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/error.h"
#include "support/test_map.h"
#include "support/test_pdf.h"

namespace ispace {
namespace map_test {

TEST(Map, ShowsFloorWallsAndObjectsWhereTheyAre) {
    // Upper right quarter seen; 100 px/m or a little less.
    const PlanPixels pixels(
        mapOf("ispace size=8,8\ncube at=-3,-3 size=1,1,1\ncube at=-3,0,2 size=1,1,1\n"
              "laser at=0.01,0.01 heading=45 fov=90 range=20\n"),
        8);
    EXPECT_EQ(pixels.width, 1200);
    ASSERT_GT(pixels.scale, 90);
    EXPECT_EQ(pixels.at(3, 3), pixelOf(sequentialColor(1, 1)));
    EXPECT_EQ(pixels.at(2, 1), pixelOf(sequentialColor(1, 1)));
    EXPECT_EQ(pixels.at(3, -3), pixelOf(palette::kFloor));
    EXPECT_EQ(pixels.at(-1, 3), pixelOf(palette::kFloor));
    EXPECT_EQ(pixels.at(-3, -3), pixelOf(palette::kSolid));
    EXPECT_NE(pixels.at(-3, 0), pixelOf(palette::kSolid));
    EXPECT_NE(pixels.at(-3, 0), pixelOf(palette::kFloor));
    EXPECT_EQ(pixels.at(0.01, 0.01), pixelOf(seriesColor(0)));
    EXPECT_EQ(pixels.Image::at(5, 5), 0xFFFFFFU);
}

TEST(Map, FloorShowsThroughWhatStandsAboveOrBelow) {
    const PlanPixels pixels(
        mapOf("ispace size=8,8\ncube at=2,2,2 size=1,1,1\ncube at=-2,2,2 size=1,1,1\n"
              "laser at=0.01,0.01 heading=45 fov=90 range=20\n"),
        8);
    EXPECT_NE(pixels.at(2, 2), pixels.at(-2, 2));
    EXPECT_NE(pixels.at(2, 2), pixelOf(sequentialColor(1, 1)));
}

TEST(Map, EqualScenesGiveEqualBytes) {
    for (const PictureFormat format :
         {PictureFormat::Png, PictureFormat::Svg, PictureFormat::Pdf}) {
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
    for (const MapColor color : {MapColor::Redundancy, MapColor::Sensor}) {
        for (const FanStyle fans : {FanStyle::Contours, FanStyle::Beams}) {
            const std::string svg =
                mapOf(kOffice, {PictureFormat::Svg, 1200, "a <b> & \"c\"", color, fans});
            EXPECT_TRUE(isWellFormed(svg));
            EXPECT_LT(svg.size(), 300000U);
            EXPECT_NE(svg.find("width=\"1200px\""), std::string::npos);
        }
    }
}

TEST(Map, SvgHasLayersWithTheRecordsIds) {
    const std::string svg = mapOf(
        "fence id=f closed=yes path=0,0;8,0;8,8;0,8\nwindow id=high wall=f offset=1 size=1\n"
        "door id=way wall=f offset=3 size=1 open=yes\ndesk id=d at=4,4\nlaser id=l at=2,2\n",
        {PictureFormat::Svg, 800, ""});
    std::size_t at = 0;
    for (const std::string part :
         {"label=\"floor\"", "label=\"coverage\"", "label=\"fields of view\"", "label=\"objects\"",
          "<g id=\"d\">", "label=\"walls\"", "<g id=\"f\">", "label=\"doors &amp; windows\"",
          "<g id=\"way\">", "label=\"sensors\"", "<g id=\"l\">", "label=\"labels\"",
          "label=\"frame\"", "label=\"legend\""}) {
        at = svg.find(part, at);
        ASSERT_NE(at, std::string::npos) << part;
    }
    EXPECT_EQ(svg.find("<g id=\"high\">"), std::string::npos);  // a wall at 0.15 m
    EXPECT_NE(svg.find(">door</text>"), std::string::npos);
}

TEST(Map, SvgHoldsTitleIdsAndMetricsAsText) {
    const std::string svg =
        mapOf("ispace size=8,8\nlaser id=left-one at=0,0 heading=45 fov=90 range=20\n",
              {PictureFormat::Svg, 1200, "a <b> & \"c\""});
    for (const std::string text :
         {"a &lt;b&gt; &amp; &quot;c&quot;", "left-one", "1 laser", "no sensor", "75.00%", "2 m",
          "Coverage 25.00% (cells 25.00%) · 16.00 m² of 64.00 m² · 1 laser"})
        EXPECT_NE(svg.find(">" + text + "</text>"), std::string::npos) << text;
}

TEST(Map, HostileNamesAreOnlyText) {
    const Scene scene = sceneOf(kOffice);
    Coverage coverage = coverageOf(scene);
    coverage.sensors[0].id = "</text><script>&\"'\x01\x1b\n\xff";
    coverage.sensors[1].id = std::string(1000, 'W');
    coverage.sensors[1].model = std::string(1000, 'M');
    coverage.report.zones[0].id = "]]>\xF0\x9F\x98";
    for (const int width : {200, 400, 1200}) {
        const std::string svg = drawCoverageMap(
            scene, coverage, {PictureFormat::Svg, width, "\x02<!--" + std::string(500, 'x')});
        EXPECT_TRUE(isWellFormed(svg));
        EXPECT_EQ(svg.find("<script"), std::string::npos);
        EXPECT_EQ(svg.find("<!--"), std::string::npos);
        for (const char c : svg) ASSERT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20);
        decodePng(drawCoverageMap(scene, coverage, {PictureFormat::Png, width, "\x02"}));
    }
}

TEST(Map, HeadShowsAsManyMetricsAsFit) {
    const std::string wide = mapOf(kOffice, {PictureFormat::Svg, 1200, "office"});
    EXPECT_NE(wide.find("· 4 lasers</text>"), std::string::npos);
    const std::string narrow = mapOf(kOffice, {PictureFormat::Svg, 250, "office"});
    EXPECT_EQ(narrow.find("· 4 lasers</text>"), std::string::npos);
    EXPECT_NE(narrow.find(">Coverage "), std::string::npos);
    const std::size_t begin = narrow.find(">Coverage ");
    const std::string line = narrow.substr(begin, narrow.find('<', begin) - begin);
    EXPECT_EQ(line.find("…"), std::string::npos) << line;
}

TEST(Map, PdfIsAPdfWithoutDate) {
    const std::string pdf = mapOf(kOffice, {PictureFormat::Pdf, 1200, "office"});
    EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
    EXPECT_EQ(pdf.find("Date"), std::string::npos);
}

TEST(Map, PdfIsToScaleOnA4OrA3WhateverTheWidth) {
    const double points = 72 / 25.4, small = std::sqrt(0.5);
    const auto page_of = [](const std::string& room, int width) {
        const std::string pdf = objectsOf(
            mapOf(room + "\nlaser at=0,0 heading=30\n", {PictureFormat::Pdf, width, "a room"}));
        const std::string name = "/MediaBox [ 0 0 ";
        const char* text = pdf.c_str() + pdf.find(name) + name.size();
        char* end = nullptr;
        const double across = std::strtod(text, &end);
        return Vec2{across, std::strtod(end, nullptr)};
    };
    // Beside the legend 9.5 m take 190 mm of A4 at 1:50; A3 has no room for 380 mm.
    const Vec2 lying = page_of("ispace size=9.5,6.5", 1200);
    EXPECT_LE(lying.x, small * 400 * points);
    EXPECT_LE(lying.y, small * 277 * points);
    EXPECT_NEAR(lying.x - page_of("ispace size=9,6.5", 1200).x, 10 * points, 0.01);
    for (const std::string room : {"ispace size=50,1", "ispace size=1,50", "ispace size=5,5",
                                   "ispace size=0.01,0.01", "ispace size=9000,7000"}) {
        const Vec2 page = page_of(room, 1200);
        EXPECT_EQ(page, page_of(room, 300));
        EXPECT_LE(std::max(page.x, page.y), 400 * points + 0.01) << room;
        EXPECT_LE(std::min(page.x, page.y), 277 * points + 0.01) << room;
    }
}

TEST(Map, KeepsTheWidthThatIsAskedForAtAnyAspect) {
    for (const std::string room : {"ispace size=50,1", "ispace size=1,50", "ispace size=5,5",
                                   "ispace size=0.01,0.01", "ispace size=9000,7000"}) {
        for (const int width : {200, 400, 1200}) {
            const Image pixels = decodePng(
                mapOf(room + "\nlaser at=0,0 heading=30\n", {PictureFormat::Png, width, "a room"}));
            EXPECT_EQ(pixels.width, width);
            EXPECT_LT(pixels.height, 4 * width) << room;
            EXPECT_GT(pixels.height, width / 5) << room;
        }
    }
}

TEST(Map, RefusesWidthsItCannotLayOut) {
    EXPECT_THROW(mapOf("ispace", {PictureFormat::Png, 0, ""}), UsageError);
    EXPECT_THROW(mapOf("ispace", {PictureFormat::Svg, 199, ""}), UsageError);
    EXPECT_THROW(mapOf("ispace", {PictureFormat::Svg, 1'000'000, ""}), UsageError);
}

TEST(Map, DrawsTheWidestToo) {
    const std::string svg = mapOf(kOffice, {PictureFormat::Svg, 12000, "office"});
    EXPECT_NE(svg.find("width=\"12000px\""), std::string::npos);
    EXPECT_EQ(decodePng(mapOf("ispace size=60,1\nlaser at=0,0\n", {.width = 6000})).width, 6000);
    EXPECT_EQ(decodePng(mapOf(kOffice, {.width = 200})).width, 200);
}

TEST(Map, TextIsNeverBelowTenPixels) {
    for (const int width : {200, 400, 1200}) {
        const std::string svg = mapOf(
            kOffice, {PictureFormat::Svg, width, "office", MapColor::Sensor, FanStyle::Beams});
        const std::string name = "font-size=\"";
        for (std::size_t at = svg.find(name); at != std::string::npos; at = svg.find(name, at + 1))
            ASSERT_GE(std::stod(svg.substr(at + name.size())), 10);
    }
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

    const MapOptions options;
    const std::vector<LegendBlock> blocks = legendBlocks({scene, coverage, options});
    EXPECT_EQ(blocks[2].title, "100 lasers");
    ASSERT_EQ(blocks[2].items.size(), 9U);
    EXPECT_EQ(blocks[2].items.back().text, "… and 92 more");
}

TEST(Map, SensorsFarOutsideDoNoHarm) {
    const Image pixels =
        decodePng(mapOf("ispace size=8,6\nlaser at=1e5,0 range=1e6 heading=180\n"
                        "laser at=0,0,3 range=1e6\n"));
    EXPECT_EQ(pixels.width, 1200);
}

}  // namespace map_test
}  // namespace ispace
