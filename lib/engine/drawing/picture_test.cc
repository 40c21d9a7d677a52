// SPDX-License-Identifier: GPL-3.0-or-later
#include "drawing/drawing.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "base/error.h"
#include "support/test_pdf.h"

namespace ispace {
namespace picture_test {

/// A decoded PNG.
struct Pixels : Image {
    explicit Pixels(const std::string& png) : Image(decodePng(png)) {}

    [[nodiscard]] int countOf(std::uint32_t rgb) const {
        return static_cast<int>(std::count(pixels.begin(), pixels.end(), rgb));
    }
};

constexpr Color kRed = Color::rgb(0xFF0000);
constexpr Color kBlue = Color::rgb(0x0000FF);
const Polygon kSquare = {{2, 2}, {8, 2}, {8, 8}, {2, 8}};
const Polygon kHole = {{4, 4}, {4, 6}, {6, 6}, {6, 4}};
const std::array<Polygon, 2> kRing = {kSquare, kHole};

TEST(Picture, StartsWhiteInTheWantedSize) {
    Picture picture(30, 20);
    const Pixels pixels(picture.write(PictureFormat::Png));
    EXPECT_EQ(pixels.width, 30);
    EXPECT_EQ(pixels.height, 20);
    EXPECT_EQ(pixels.countOf(0xFFFFFF), 600);
}

TEST(Picture, RefusesSizesItCannotDraw) {
    EXPECT_THROW(Picture(0, 10), UsageError);
    EXPECT_THROW(Picture(10, -1), UsageError);
    EXPECT_THROW(Picture(10, 1e9), UsageError);
    EXPECT_THROW(Picture(std::nan(""), 10), UsageError);
}

TEST(Picture, FillsPolygonsInPageUnits) {
    Picture picture(10, 10);
    picture.area(Polygon{{1, 2}, {4, 2}, {4, 7}, {1, 7}}, {kRed});
    const Pixels pixels(picture.write(PictureFormat::Png));
    EXPECT_EQ(pixels.countOf(0xFF0000), 15);
    EXPECT_EQ(pixels.at(1, 2), 0xFF0000U);
    EXPECT_EQ(pixels.at(4, 7), 0xFFFFFFU);
}

TEST(Picture, HolesStayFreeWhateverTheirOrientation) {
    for (const bool reversed : {false, true}) {
        std::array<Polygon, 2> region{kSquare, kHole};
        if (reversed) std::reverse(region[1].begin(), region[1].end());
        Picture picture(10, 10);
        picture.area(region, {kBlue});
        const Pixels pixels(picture.write(PictureFormat::Png));
        EXPECT_EQ(pixels.countOf(0x0000FF), 36 - 4);
        EXPECT_EQ(pixels.at(5, 5), 0xFFFFFFU);
    }
}

TEST(Picture, CurvesThatMeetLeaveNoSeam) {
    Picture picture(10, 10);
    const std::array<Polygon, 2> halves = {Polygon{{0, 0}, {4.5, 0}, {4.5, 10}, {0, 10}},
                                           Polygon{{4.5, 0}, {10, 0}, {10, 10}, {4.5, 10}}};
    picture.area(halves, {kRed});
    EXPECT_EQ(Pixels(picture.write(PictureFormat::Png)).countOf(0xFF0000), 100);
}

TEST(Picture, ViewTakesMetresWithYUp) {
    Picture picture(100, 100);
    picture.pushView({10, {0, 0}, {20, 80}});
    EXPECT_EQ(picture.toPage({1, 2}), (Point2{30, 60}));
    picture.area(Polygon{{0, 0}, {1, 0}, {1, 2}, {0, 2}}, {kRed});
    picture.pop();
    EXPECT_EQ(picture.toPage({1, 2}), (Point2{1, 2}));
    const Pixels pixels(picture.write(PictureFormat::Png));
    EXPECT_EQ(pixels.countOf(0xFF0000), 200);
    EXPECT_EQ(pixels.at(20, 60), 0xFF0000U);
    EXPECT_EQ(pixels.at(20, 80), 0xFFFFFFU);
}

TEST(Picture, LineWidthsArePageUnitsInAnyView) {
    Picture picture(100, 100);
    picture.pushView({1000, {0, 0}, {0, 100}});
    picture.line({-1, 0.05}, {1, 0.05}, {kRed, 4});
    picture.pop();
    const Pixels pixels(picture.write(PictureFormat::Png));
    EXPECT_EQ(pixels.countOf(0xFF0000), 400);
    EXPECT_EQ(pixels.at(50, 48), 0xFF0000U);
    EXPECT_EQ(pixels.at(50, 52), 0xFFFFFFU);
}

TEST(Picture, ClipsAddUpAndEndWithPop) {
    Picture picture(10, 10);
    picture.pushClip(kRing);
    picture.pushClip(Polygon{{0, 0}, {5, 0}, {5, 10}, {0, 10}});
    picture.area(Polygon{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {kRed});
    picture.pop();
    picture.pop();
    picture.area(Polygon{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {kBlue});
    const Pixels pixels(picture.write(PictureFormat::Png));
    EXPECT_EQ(pixels.countOf(0xFF0000), 18 - 2);
    EXPECT_EQ(pixels.at(0, 0), 0x0000FFU);
}

TEST(Picture, AlphaMixesWithWhatLiesBelow) {
    Picture picture(10, 10);
    picture.area(kSquare, {kRed.faded(0.5)});
    const std::uint32_t pixel = Pixels(picture.write(PictureFormat::Png)).at(5, 5);
    EXPECT_EQ(pixel >> 16, 0xFFU);
    EXPECT_NEAR(pixel & 0xFFU, 0x80, 1);
}

TEST(Picture, DashesLeaveGaps) {
    Picture picture(100, 10);
    picture.line({0, 5}, {100, 5}, {kRed, 2, {10, 10}});
    const Pixels pixels(picture.write(PictureFormat::Png));
    EXPECT_EQ(pixels.at(5, 5), 0xFF0000U);
    EXPECT_EQ(pixels.at(15, 5), 0xFFFFFFU);
    EXPECT_EQ(pixels.at(25, 5), 0xFF0000U);
}

TEST(Picture, SectorsTurnCounterClockwiseAsSeen) {
    for (const bool world : {false, true}) {
        Picture picture(100, 100);
        if (world) picture.pushView({10, {0, 0}, {50, 50}});
        picture.sector(world ? Point2{0, 0} : Point2{50, 50}, world ? 4 : 40, Angle::degrees(0),
                       Angle::degrees(90), {kRed});
        if (world) picture.pop();
        const Pixels pixels(picture.write(PictureFormat::Png));
        EXPECT_EQ(pixels.at(70, 30), 0xFF0000U);
        EXPECT_EQ(pixels.at(70, 70), 0xFFFFFFU);
        EXPECT_EQ(pixels.at(30, 30), 0xFFFFFFU);
        EXPECT_NEAR(pixels.countOf(0xFF0000), std::acos(-1.0) * 400, 80);
    }
}

TEST(Picture, CirclesAndArcs) {
    Picture picture(100, 100);
    picture.circle({30, 30}, 20, {kRed});
    picture.circle({30, 30}, 25, {Stroke{kBlue, 2}});
    picture.sector({70, 70}, 20, Angle::degrees(90), Angle::degrees(180), {Stroke{kBlue, 4}});
    const Pixels pixels(picture.write(PictureFormat::Png));
    EXPECT_EQ(pixels.at(30, 30), 0xFF0000U);
    EXPECT_EQ(pixels.at(30, 5), 0x0000FFU);
    EXPECT_EQ(pixels.at(55, 55), 0x0000FFU);
    EXPECT_EQ(pixels.at(84, 84), 0xFFFFFFU);
}

TEST(Picture, PlacesFarOffThePageDoNoHarm) {
    Picture picture(20, 20);
    picture.pushView({1e6, {0, 0}, {10, 10}});
    picture.area(Polygon{{-1e12, -1e12}, {1e12, -1e12}, {1e12, 1e12}, {-1e12, 1e12}}, {kRed});
    picture.pop();
    EXPECT_EQ(Pixels(picture.write(PictureFormat::Png)).countOf(0xFF0000), 400);
}

TEST(Picture, EmptyThingsDrawNothing) {
    Picture picture(10, 10);
    picture.area(Polygon{}, {kRed});
    picture.area(std::span<const Polygon>(), {kRed});
    picture.area(Polygon{}, {Stroke{kRed, 1}});
    picture.lines(std::span<const Segment2>(), {Stroke{kRed, 1}});
    picture.lines(Polygon{}, {Stroke{kRed, 1}});
    picture.pushLayer("empty");
    picture.pop();
    picture.text({5, 5}, "", {});
    EXPECT_EQ(Pixels(picture.write(PictureFormat::Png)).countOf(0xFFFFFF), 100);
}

TEST(Picture, ImagesHaveSharpPixelsOfAnySize) {
    const Image image{2, 2, {0xFF0000, 0x00FF00, 0x0000FF, 0x123456}};
    Picture picture(20, 20);
    picture.image({3, 4}, image, 4, 2);
    picture.image({0, 0}, Image{}, 1, 1);
    const Pixels pixels(picture.write(PictureFormat::Png));
    for (const std::uint32_t color : image.pixels) EXPECT_EQ(pixels.countOf(color), 8);
    EXPECT_EQ(pixels.countOf(0xFFFFFF), 400 - 32);
    EXPECT_EQ(pixels.at(3, 4), 0xFF0000U);
    EXPECT_EQ(pixels.at(7, 4), 0x00FF00U);
    EXPECT_EQ(pixels.at(6, 6), 0x0000FFU);
    EXPECT_EQ(pixels.at(10, 7), 0x123456U);

    Picture world(20, 20);
    world.pushView({10, {0, 0}, {10, 10}});
    world.image({0, 0.5}, Image{1, 1, {0xFF0000}}, 0.5, 0.2);
    world.pop();
    const Pixels seen(world.write(PictureFormat::Png));
    EXPECT_EQ(seen.countOf(0xFF0000), 10);
    EXPECT_EQ(seen.at(10, 5), 0xFF0000U);
    EXPECT_EQ(seen.at(14, 6), 0xFF0000U);
}

TEST(Picture, TextIsAlignedAtItsAnchor) {
    const auto ink_left_of = [](Align align) {
        Picture picture(200, 40);
        picture.text({100, 30}, "HHHH", {20, true, align, Color::rgb(0x000000)});
        const Pixels pixels(picture.write(PictureFormat::Png));
        int left = 0, all = 0;
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 200; ++x)
                if (pixels.at(x, y) < 0x808080) {
                    ++all;
                    left += x < 100 ? 1 : 0;
                }
        EXPECT_GT(all, 100);
        return static_cast<double>(left) / all;
    };
    EXPECT_LT(ink_left_of(Align::Left), 0.05);
    EXPECT_NEAR(ink_left_of(Align::Center), 0.5, 0.05);
    EXPECT_GT(ink_left_of(Align::Right), 0.95);
}

TEST(Picture, HaloSurroundsText) {
    Picture picture(100, 40);
    picture.area(Polygon{{0, 0}, {100, 0}, {100, 40}, {0, 40}}, {kRed});
    TextStyle style{20, true, Align::Center, Color::rgb(0x000000)};
    style.halo = Color::rgb(0xFFFFFF);
    picture.text({50, 28}, "I", style);
    const Pixels pixels(picture.write(PictureFormat::Png));
    EXPECT_GT(pixels.countOf(0xFFFFFF), 20);
    EXPECT_EQ(pixels.at(5, 5), 0xFF0000U);
}

/// A picture of everything.
std::string sample(PictureFormat format, PageUnit unit = PageUnit::Pixel) {
    Picture picture(200, 100, unit);
    picture.describe("a <title>", "Words about it.");
    picture.pushView({10, {0, 0}, {10, 90}});
    picture.pushLayer("areas of all kinds");
    picture.pushClip(kSquare);
    picture.pushGroup("a/b", "its \"title\"");
    picture.area(kRing, {kBlue.faded(0.4), Hatch{kRed}, Stroke{kRed, 2, {3, 1}}});
    picture.pop();
    picture.pop();
    picture.pushGroup("layer-areas", "");
    picture.circle({5, 5}, 1, {kRed});
    picture.sector({5, 5}, 1, Angle::degrees(0), Angle::degrees(200), {kRed});
    picture.image({6, 6}, Image{1, 1, {0x123456}}, 0.5, 0.5);
    picture.pop();
    picture.pop();
    picture.pop();
    picture.text({100, 50}, "7.5 m² <&> \x01\xFF",
                 {12, false, Align::Left, kRed, Color{1, 1, 1, 1}});
    return picture.write(format);
}

TEST(Picture, EqualCallsGiveEqualBytes) {
    for (const PictureFormat format :
         {PictureFormat::Png, PictureFormat::Svg, PictureFormat::Pdf}) {
        const std::string first = sample(format);
        EXPECT_FALSE(first.empty());
        EXPECT_EQ(first, sample(format));
        EXPECT_EQ(first.find("20"
                             "26-"),
                  std::string::npos);
    }
}

TEST(Picture, FormatsAreWhatTheySay) {
    EXPECT_EQ(sample(PictureFormat::Png).substr(1, 3), "PNG");
    EXPECT_EQ(sample(PictureFormat::Pdf).substr(0, 5), "%PDF-");
    EXPECT_EQ(sample(PictureFormat::Pdf).find("/CreationDate"), std::string::npos);
    const std::string svg = sample(PictureFormat::Svg);
    EXPECT_EQ(svg.substr(0, 5), "<?xml");
    EXPECT_NE(svg.find("width=\"200px\""), std::string::npos);
    EXPECT_NE(svg.find("</svg>"), std::string::npos);
}

TEST(Picture, PaperIsToScaleInSvgAndPdf) {
    const std::string svg = sample(PictureFormat::Svg, PageUnit::Millimetre);
    EXPECT_NE(svg.find("width=\"200mm\" height=\"100mm\" viewBox=\"0 0 200 100\""),
              std::string::npos);
    const std::string pdf = objectsOf(sample(PictureFormat::Pdf, PageUnit::Millimetre));
    EXPECT_NE(pdf.find("/MediaBox [ 0 0 566.92"), std::string::npos);  // 200 mm in points
}

TEST(Picture, SvgHasLayersGroupsAndClips) {
    const std::string svg = sample(PictureFormat::Svg);
    for (const char* part :
         {"<title>a &lt;title&gt;</title>", "<desc>Words about it.</desc>",
          "<g id=\"layer-areas\" inkscape:groupmode=\"layer\" "
          "inkscape:label=\"areas of all kinds\">",
          "<g id=\"a_b\"><title>its &quot;title&quot;</title>", "<g id=\"layer-areas_2\">",
          "<clipPath id=\"clip-1\"><path clip-rule=\"evenodd\" d=\"M30,70L",
          "stroke-dasharray=\"3 1\"", "<g clip-path=\"url(#clip-1)\">",
          "<circle cx=\"60\" cy=\"40\" r=\"10\"", "d=\"M60,40L70,40A10,10 0 1 0 50.603,43.42Z\"",
          "href=\"data:image/png;base64,iVBOR"})
        EXPECT_NE(svg.find(part), std::string::npos) << part;
    EXPECT_EQ(std::count(svg.begin(), svg.end(), '<'), std::count(svg.begin(), svg.end(), '>'));
}

TEST(Picture, SvgHoldsItsText) {
    const std::string svg = sample(PictureFormat::Svg);
    EXPECT_NE(svg.find(">7.5 m² &lt;&amp;&gt; ?"
                       "?</text>"),
              std::string::npos);
    EXPECT_NE(svg.find("fill=\"#ff0000\""), std::string::npos);
    EXPECT_NE(svg.find("stroke=\"#ffffff\""), std::string::npos);  // halo
    EXPECT_NE(svg.find("paint-order=\"stroke\""), std::string::npos);
    EXPECT_EQ(svg.find("glyph"), std::string::npos);
}

TEST(Picture, HatchFillsItsShareOfTheCurvesAlone) {
    Picture picture(200, 200);
    const std::array<Polygon, 2> curves = {Polygon{{20, 20}, {180, 20}, {180, 180}, {20, 180}},
                                           Polygon{{80, 80}, {120, 80}, {120, 120}, {80, 120}}};
    picture.area(curves, {Hatch{kRed, 10, 4, 0, Angle::degrees(0)}});
    const Pixels pixels(picture.write(PictureFormat::Png));
    EXPECT_EQ(pixels.countOf(0xFF0000), (160 * 160 - 40 * 40) * 4 / 10);
    EXPECT_EQ(pixels.at(50, 30), 0xFF0000U);  // a line through the origin, and each 10 px
    EXPECT_EQ(pixels.at(50, 35), 0xFFFFFFU);
    EXPECT_EQ(pixels.at(100, 100), 0xFFFFFFU);
    EXPECT_EQ(pixels.at(10, 30), 0xFFFFFFU);
}

TEST(Picture, HatchesFitTogetherByTheirOffset) {
    Picture picture(100, 100);
    picture.pushView({10, {0, 0}, {50, 50}});  // lengths of a hatch are the page's in any view
    const Polygon all = {{-9, -9}, {9, -9}, {9, 9}, {-9, 9}};
    picture.area(std::span(&all, 1), {Hatch{kRed, 12, 6, 0}});
    picture.area(std::span(&all, 1), {Hatch{kBlue, 12, 6, 6}});
    picture.pop();
    const Pixels pixels(picture.write(PictureFormat::Png));
    // 45 degrees as seen: the same colour along a way up and right, the other one beside.
    EXPECT_EQ(pixels.at(31, 28), 0x0000FFU);
    EXPECT_EQ(pixels.at(51, 8), 0x0000FFU);
    EXPECT_EQ(pixels.at(35, 32), 0xFF0000U);
    EXPECT_EQ(pixels.at(55, 12), 0xFF0000U);
    EXPECT_NEAR(pixels.countOf(0xFF0000), pixels.countOf(0x0000FF), 500);
    EXPECT_GT(pixels.countOf(0xFF0000), 3000);
    EXPECT_LT(pixels.countOf(0xFFFFFF), 20);
}

TEST(Picture, ClipsAndStrokesTakeManyCurves) {
    Picture picture(20, 10);
    const std::array<Polygon, 2> curves = {kSquare, kHole};
    picture.pushClip(std::span(curves));
    picture.area(Polygon{{0, 0}, {20, 0}, {20, 10}, {0, 10}}, {kRed});
    picture.pop();
    EXPECT_EQ(Pixels(picture.write(PictureFormat::Png)).countOf(0xFF0000), 36 - 4);
    Picture lines(10, 10);
    lines.area(std::span(curves), {Stroke{kRed, 2}});
    const Pixels pixels(lines.write(PictureFormat::Png));
    EXPECT_EQ(pixels.at(1, 5), 0xFF0000U);
    EXPECT_EQ(pixels.at(4, 5), 0xFF0000U);
}

/// One shape of each kind at random positions of a page of 300 x 300.
void drawAnything(Picture& picture, std::mt19937& random) {
    std::uniform_real_distribution<double> place(-20, 320), share(0, 1);
    const auto point = [&] { return Point2{place(random), place(random)}; };
    const Polygon triangle = {point(), point(), point()};
    const Color color{share(random), share(random), share(random), 0.3 + 0.7 * share(random)};
    picture.area(triangle, {color.faded(0.2), Stroke{color, 8 * share(random), {9, 4}}});
    picture.pushClip(triangle);
    picture.circle(point(), 60 * share(random), {color, Stroke{color, 20 * share(random)}});
    picture.pop();
    picture.area(Polygon{point(), point(), point()}, {Hatch{color, 7, 2}});
    picture.lines({point(), point(), point()}, {Stroke{color, 30 * share(random)}});
    picture.sector(point(), 40, Angle::degrees(20), Angle::degrees(200), {color});
    picture.image(point(), Image{2, 1, {0x0000FF, 0xFF0000}}, 9.5, 30);
    picture.text(point(), "gÅ", {40 * share(random), true, Align::Center, color, palette::kWhite});
}

TEST(Picture, IsTheSameDrawnInBands) {
    Picture few(300, 300), many(300, 300);
    std::mt19937 random(3), again(3);
    // Few points make one band: these show nowhere, each line in one row.
    for (int row = 0; row < 300; ++row) {
        std::vector<Point2> line;
        for (int i = 0; i < 100; ++i) line.push_back({3.0 * i, row + 0.5});
        many.lines(line, {Stroke{palette::kInk.faded(0)}});
    }
    for (int i = 0; i < 60; ++i) {
        drawAnything(few, random);
        drawAnything(many, again);
    }
    const Image drawn = rasterOf(few);
    for (const std::size_t threads : {1U, 2U, 3U, 8U}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_EQ(rasterOf(many).pixels, drawn.pixels) << threads << " threads";
    }
}

TEST(Image, RefusesWhatIsNoWholePng) {
    const std::string png = sample(PictureFormat::Png);
    EXPECT_EQ(decodePng(png).width, 200);
    EXPECT_THROW(decodePng(""), FormatError);
    EXPECT_THROW(decodePng("P5 1 1 255 x"), FormatError);
    EXPECT_THROW(decodePng(png.substr(0, png.size() / 2)), FormatError);
}

TEST(Color, PaletteRepeatsAndItsColoursDiffer) {
    for (std::size_t i = 0; i < kSeriesColors; ++i) {
        EXPECT_EQ(seriesColor(i), seriesColor(i + kSeriesColors));
        for (std::size_t j = 0; j < i; ++j) EXPECT_NE(seriesColor(i), seriesColor(j));
    }
}

/// Colours as seen without one kind of cones (Viénot, Brettel, Mollon 1999), linear parts.
std::array<double, 3> seenWithout(bool red_cones, Color color) {
    const auto linear = [](double part) { return std::pow(part, 2.2); };
    const double r = linear(color.red), g = linear(color.green), b = linear(color.blue);
    if (red_cones) return {0.11238 * r + 0.88762 * g, 0.11238 * r + 0.88762 * g, b};
    return {0.29275 * r + 0.70725 * g, 0.29275 * r + 0.70725 * g, b};
}

TEST(Color, SeriesIsToldApartByTheColourBlindAndOnWhite) {
    for (std::size_t i = 0; i < kSeriesColors; ++i) {
        EXPECT_LT(lightness(seriesColor(i)), 0.72) << i;
        for (std::size_t j = 0; j < i; ++j) {
            for (const bool red_cones : {false, true}) {
                const auto a = seenWithout(red_cones, seriesColor(i));
                const auto b = seenWithout(red_cones, seriesColor(j));
                EXPECT_GT(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]), 0.1) << i << " " << j;
            }
        }
    }
}

TEST(Color, TintsMixWithWhite) {
    EXPECT_EQ(tint(kRed, 1), kRed);
    EXPECT_EQ(tint(kRed, 0), Color::rgb(0xFFFFFF));
    EXPECT_NEAR(tint(kRed, 0.25).green, 0.75, 1e-12);
}

TEST(Color, SequentialSchemeDarkensWithEachLevel) {
    for (int levels = 1; levels <= 9; ++levels) {
        for (int level = 2; level <= levels; ++level)
            EXPECT_LT(lightness(sequentialColor(level, levels)),
                      lightness(sequentialColor(level - 1, levels)) - 0.03)
                << level << " of " << levels;
        EXPECT_EQ(sequentialColor(levels + 3, levels), sequentialColor(levels, levels));
        EXPECT_LT(lightness(sequentialColor(1, levels)), 0.85);  // in grey as well
    }
}

}  // namespace picture_test
}  // namespace ispace
