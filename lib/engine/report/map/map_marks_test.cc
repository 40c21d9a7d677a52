// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "support/test_map.h"

namespace ispace {
namespace map_marks_test {

Image markImage(const SensorMark& mark) {
    Picture picture(200, 200);
    drawSensorMark(picture, {100, 100}, mark, 20);
    return decodePng(picture.write(PictureFormat::Png));
}

std::size_t count(const Image& image, Color color) {
    return static_cast<std::size_t>(
        std::count(image.pixels.begin(), image.pixels.end(), pixelOf(color)));
}

constexpr Color kRed = Color::rgb(0xFF0000);

TEST(MapMarks, KindsHaveTheirShapes) {
    const Image disc = markImage({SensorSign::Disc, {}, kRed});
    const Image square = markImage({SensorSign::Square, {}, kRed});
    const Image triangle = markImage({SensorSign::Triangle, {}, kRed});
    // Corners of the square, tip of the triangle.
    EXPECT_NE(disc.at(84, 84), pixelOf(kRed));
    EXPECT_EQ(square.at(84, 84), pixelOf(kRed));
    EXPECT_NE(triangle.at(84, 84), pixelOf(kRed));
    EXPECT_EQ(triangle.at(100, 78), pixelOf(kRed));
    EXPECT_NE(square.at(100, 78), pixelOf(kRed));
    for (const Image& image : {disc, square, triangle}) {
        EXPECT_EQ(image.at(100, 100), pixelOf(kRed));
        EXPECT_GT(count(image, kRed), 800U);
        EXPECT_LT(count(image, kRed), 1400U);
    }
}

TEST(MapMarks, ArrowsShowTheHeadingIfThereIsOne) {
    const Image none = markImage({SensorSign::Disc, {}, kRed});
    const Image up = markImage({SensorSign::Disc, Angle::degrees(90), kRed});
    EXPECT_EQ(up.at(100, 55), pixelOf(kRed));
    EXPECT_NE(none.at(100, 55), pixelOf(kRed));
    EXPECT_NE(up.at(145, 100), pixelOf(kRed));
    EXPECT_GT(count(up, kRed), count(none, kRed) + 100);
    const Image hollow = markImage({SensorSign::Disc, {}, kRed, true});
    EXPECT_EQ(hollow.at(100, 100), 0xFFFFFFU);
    EXPECT_EQ(hollow.at(100, 85), pixelOf(kRed));
}

TEST(MapMarks, WhoLooksStraightDownOrUpHasNoHeading) {
    const Scene scene = sceneOf(
        "ispace size=8,8 height=3\nlaser at=0,0 heading=30\n"
        "ranger at=0,0,2 heading=40 tilt=-90\n"
        "ranger at=0,0,2 heading=40 tilt=-70\n"
        "ultrasound at=1,1,2.9 heading=50 tilt=90\n");
    const Coverage coverage = coverageOf(scene);
    const MapOptions options;
    const MapPicture map{scene, coverage, options};
    EXPECT_NEAR(markOf(map, 0).heading.value().degrees(), 30, 1e-9);
    EXPECT_FALSE(markOf(map, 1).heading);
    EXPECT_NEAR(markOf(map, 2).heading.value().degrees(), 40, 1e-9);
    EXPECT_FALSE(markOf(map, 3).heading);
    EXPECT_EQ(markOf(map, 3).sign, SensorSign::Triangle);
}

TEST(MapMarks, SensorsAtOnePlaceAreBothSeen) {
    const PlanPixels pixels(
        mapOf("ispace size=8,8\nlaser at=0,0 range=1\nlaser at=0,0 heading=180 range=1\n"), 8);
    EXPECT_EQ(pixels.at(0, 0), pixelOf(seriesColor(1)));
    EXPECT_GT(pixels.shareOf(seriesColor(0), 0, 0, 7), 0.05);
}

TEST(MapMarks, OtherSensorsAreHollowAndGrey) {
    const Scene scene = sceneOf("ispace size=8,8\nlaser at=-2,0\n");
    const Scene other_scene = sceneOf("ispace size=8,8\nranger at=2,0,1\n");
    RayScenes worlds(scene.environment);
    Coverage coverage = measureCoverage(scene, worlds, {});
    const Coverage other = measureCoverage(other_scene, worlds, {});
    compare(coverage, other, scene.environment.indoor(), "old");
    const PlanPixels pixels(drawCoverageMap(scene, coverage, {}, &other), 8);
    EXPECT_EQ(pixels.at(-2, 0), pixelOf(palette::kInk));
    EXPECT_EQ(pixels.at(2, 0), 0xFFFFFFU);
    EXPECT_GT(pixels.shareOf(palette::kOtherSensor, 2, 0, 8), 0.1);
}

TEST(MapMarks, SpotsHaveSignsThatKeepOffSensors) {
    const Scene scene = sceneOf("ispace size=8,8\nlaser at=3,3 heading=0 range=0.5\n");
    Coverage coverage = coverageOf(scene);
    coverage.report.unseen = {{{-2, -2}, 9}, {{3, 3}, 8}};
    const PlanPixels pixels(drawCoverageMap(scene, coverage, {}), 8);
    const int radius = 11;  // of a sign
    EXPECT_GT(pixels.shareOf(palette::kWhite, -2, -2, radius), 0.3);
    EXPECT_GT(pixels.shareOf(palette::kInk, -2, -2, radius), 0.05);
    EXPECT_EQ(pixels.at(3, 3), pixelOf(seriesColor(0)));  // not covered by the second sign
}

/// Places (x, y) of all texts `wanted` in an SVG.
std::vector<Point2> placesOf(const std::string& svg, const std::string& wanted) {
    std::vector<Point2> places;
    for (std::size_t at = svg.find(">" + wanted + "</text>"); at != std::string::npos;
         at = svg.find(">" + wanted + "</text>", at + 1)) {
        const std::size_t begin = svg.rfind("<text", at);
        const std::string tag = svg.substr(begin, at - begin);
        if (tag.find("aria-hidden") != std::string::npos) continue;
        places.push_back({std::stod(tag.substr(tag.find(" x=\"") + 4)),
                          std::stod(tag.substr(tag.find(" y=\"") + 4))});
    }
    return places;
}

TEST(MapMarks, LabelsDoNotOverlap) {
    std::string lines = "ispace size=8,8\n";
    for (int i = 0; i < 30; ++i)
        lines += "laser id=laser" + std::to_string(i) + " at=" + std::to_string(-3.5 + 0.22 * i) +
                 "," + std::to_string(i % 3 * 0.2) + " range=1\n";
    const std::string svg = mapOf(lines, {PictureFormat::Svg, 800, ""});
    std::vector<Point2> labels;
    for (int i = 0; i < 30; ++i)
        for (const Point2& p : placesOf(svg, "laser" + std::to_string(i)))
            if (p.y < 700 && p.x < 560) labels.push_back(p);  // on the plan
    EXPECT_EQ(labels.size(), 30U);
    const double em = 800.0 / 1200 * 17,
                 width = textWidth("laser9", {em, true, Align::Left, {}, {}});
    for (std::size_t i = 0; i < labels.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_TRUE(std::abs(labels[i].x - labels[j].x) >= width ||
                        std::abs(labels[i].y - labels[j].y) >= em)
                << labels[i].x << "," << labels[i].y;
}

TEST(MapMarks, ZonesAreNamedWhereThereIsRoom) {
    const std::string svg = mapOf(
        "ispace size=8,8\nzone id=wide-enough at=-2,0 size=3,2\nzone id=much-too-narrow at=2,0 "
        "size=0.3,2\n",
        {PictureFormat::Svg, 800, ""});
    EXPECT_EQ(placesOf(svg, "wide-enough").size(), 2U);      // plan and legend
    EXPECT_EQ(placesOf(svg, "much-too-narrow").size(), 1U);  // legend
}

TEST(MapMarks, LabelsKeepOffTheHead) {
    // Behind the heading a label would lie above the plan.
    const std::string svg = mapOf("ispace size=8,8\nlaser id=up at=0,3.95 heading=-90\n",
                                  {PictureFormat::Svg, 1200, "head"});
    constexpr double kEm = 17;
    const double subtitle = placesOf(svg, "head").at(0).y + 1.5 * kEm;
    EXPECT_GT(placesOf(svg, "up").at(0).y - 0.8 * kEm, subtitle + 0.2 * kEm);
}

TEST(MapMarks, ZonesAreNamedInside) {
    // Names of rectangles begin at the lower left; of an L without that corner elsewhere.
    const std::string svg = mapOf(
        "ispace size=8,8\nzone id=low at=-3,-3 size=1,1\nzone id=high at=3,3 size=1,1\n"
        "zone id=ell path=0,-3;2,-3;2,2;-2,2;-2,1;0,1\n"
        "zone id=tip path=-3,-1;-0.2,-2.4;-0.2,0.4\n",
        {PictureFormat::Svg, 1200, ""});
    const auto first = [&svg](const std::string& name) { return placesOf(svg, name).at(0); };
    const Point2 low = first("low"), high = first("high");
    const double scale = (high.x - low.x) / 6;
    const auto begins = [&](const std::string& name) {
        const Point2 at = first(name);
        return Point2{-3.5 + (at.x - low.x) / scale, -3.5 - (at.y - low.y) / scale};
    };
    EXPECT_NEAR(scale, (low.y - high.y) / 6, 1e-2);
    EXPECT_NEAR(begins("ell").x, -2, 0.1);
    EXPECT_NEAR(begins("ell").y, 1.6, 0.3);
    // No corner of a triangle is wide enough.
    ASSERT_EQ(placesOf(svg, "tip").size(), 2U) << "plan and legend";
    EXPECT_NEAR(begins("tip").x, -1.5, 0.4);
    EXPECT_NEAR(begins("tip").y, -1.1, 0.3);
}

TEST(MapViews, BeamsAreThinnedWhereTheyEndTooNearEachOther) {
    // 0.05 degrees are 0.7 px at the wall: the picture shows lines, not a solid sector.
    const std::string laser = "ispace size=8,8\nlaser at=0,-3.9 heading=90 fov=60 range=20 step=";
    for (const std::string step : {"0.05", "1"}) {
        const PlanPixels pixels(mapOf(laser + step + "\n", {.fans = FanStyle::Beams}), 8);
        const std::uint32_t floor = pixelOf(sequentialColor(1, 1));
        int lines = 0, clear = 0, all = 0;
        bool was_line = false;
        for (double x = -3; x < 3; x += 1 / pixels.scale, ++all) {
            const bool is_line = pixels.at(x, 3.8) != floor;
            lines += is_line && !was_line ? 1 : 0;
            clear += is_line ? 0 : 1;
            was_line = is_line;
        }
        const double gap = 6 * pixels.scale / lines;
        EXPECT_GT(gap, 2) << step;
        EXPECT_LT(gap, step == "1" ? 18 : 8) << step;
        EXPECT_GT(clear, all / 6) << step;
    }
}

TEST(MapViews, BeamsEndAtWhatTheyMeetOrAtTheirRange) {
    const PlanPixels pixels(mapOf("ispace size=8,8\ncube at=2,0 size=1,1,1\n"
                                  "laser at=0,0 heading=0 fov=0 beams=1 range=3\n"
                                  "laser at=0,2 heading=0 fov=0 beams=1 range=3\n",
                                  {.fans = FanStyle::Beams}),
                            8);
    const auto line_at = [&pixels](double x, double y) {
        return pixels.at(x, y) != pixelOf(palette::kFloor);
    };
    EXPECT_TRUE(line_at(1.3, 0));
    EXPECT_FALSE(line_at(2.8, 0));
    EXPECT_TRUE(line_at(2.8, 2));
    EXPECT_FALSE(line_at(3.2, 2));
}

TEST(MapViews, SweepsAreDrawnAsContours) {
    const std::string lines = "ispace size=8,8\nlaser at=0,0,1 tilt=-30 sweep=heading\n";
    EXPECT_EQ(mapOf(lines, {.fans = FanStyle::Beams}), mapOf(lines));
}

TEST(MapViews, ContoursFollowTheView) {
    const PlanPixels pixels(mapOf("ispace size=8,8\nlaser at=0,0 heading=0 fov=360 range=3\n"), 8);
    // Vermilion: much red, little blue.
    const auto is_line = [](std::uint32_t pixel) {
        return (pixel >> 16 & 0xFFU) > 0xC0 && (pixel & 0xFFU) < 0x40;
    };
    for (int turn = 5; turn < 360; turn += 10) {
        const Vec2 way = unitVector(Angle::degrees(turn));
        int lines = 0;
        for (double away = 1; away < 3.9; away += 0.5 / pixels.scale) {
            if (!is_line(pixels.at(away * way.x, away * way.y))) continue;
            ++lines;
            EXPECT_NEAR(away, 3, 0.03) << turn;
        }
        EXPECT_GT(lines, 0) << turn;
    }
}

TEST(MapViews, DashesTellSensorsOfOneColourApart) {
    std::string lines = "ispace size=8,8\n";
    for (int i = 0; i < 10; ++i) lines += "laser at=0,0\n";
    const Scene scene = sceneOf(lines);
    const Coverage coverage = coverageOf(scene);
    for (const MapColor color : {MapColor::Redundancy, MapColor::Sensor}) {
        const MapOptions options{.color = color};
        const MapPicture map{scene, coverage, options};
        EXPECT_EQ(sensorColor(map, 0), sensorColor(map, kSeriesColors));
        EXPECT_NE(sensorStroke(map, 0).dashes, sensorStroke(map, kSeriesColors).dashes);
        EXPECT_EQ(sensorStroke(map, 0).dashes == sensorStroke(map, 1).dashes,
                  color == MapColor::Redundancy);
    }
}

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
    // The ring of the chosen one only, a line of two pixels.
    const double ring = 0.68 * 17 / pixels.scale;
    EXPECT_GT(pixels.shareOf(palette::kInk, 2, -2 + ring, 3), 0.05);
    EXPECT_EQ(pixels.shareOf(palette::kInk, -2, 2 + ring, 3), 0);
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
    EXPECT_EQ(items[0].value, "25.00% – 50.00%");  // of the best at each place
    EXPECT_EQ(items[1].text, "chosen");
    EXPECT_EQ(items[1].value, "1");
    EXPECT_EQ(items[2].text, "Candidates");
    EXPECT_EQ(items[2].value, "3");
    EXPECT_EQ(items[3].value, "2");
    options.trace = {tried(0, 0, 0, 0.5)};
    blocks = legendBlocks({scene, coverage, options});
    EXPECT_EQ(blockOf(blocks)->items[0].value, "50.00%");
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

}  // namespace map_marks_test
}  // namespace ispace
