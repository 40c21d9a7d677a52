// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/curve_chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "drawing/color.h"
#include "drawing/drawing.h"
#include "support/test_map.h"

namespace ispace {
namespace curve_test {

std::vector<CurvePoint> rising(int count) {
    std::vector<CurvePoint> points;
    for (int i = 1; i <= count; ++i)
        points.push_back(
            {i, 1 - std::exp(-0.3 * i), std::min(1.0, 1.1 - 1.1 * std::exp(-0.3 * i))});
    return points;
}

/// But for rounding, which mixing brings.
bool isNear(std::uint32_t a, std::uint32_t b) {
    for (const unsigned shift : {16U, 8U, 0U})
        if (std::abs(static_cast<int>(a >> shift & 0xFFU) - static_cast<int>(b >> shift & 0xFFU)) >
            2)
            return false;
    return true;
}

/// Row of the topmost pixel of this colour in a column, or -1.
int topOf(const Image& image, int column, Color color) {
    for (int row = 100; row < image.height; ++row)
        if (image.at(column, row) == pixelOf(color)) return row;
    return -1;
}

TEST(Curve, CsvHasALineAPoint) {
    EXPECT_EQ(curveCsv({{1, 0.25, 0.5}, {2, 0.7, 1}}),
              "sensors,value,bound\n1,0.25,0.5\n2,0.7,1\n");
    EXPECT_EQ(curveCsv({}), "sensors,value,bound\n");
}

TEST(Curve, TextIsAligned) {
    EXPECT_EQ(curveText({{1, 0.05, 0.06}, {10, 0.99999, 1}}),
              "sensors  coverage  at most\n"
              "      1     5.00%    6.00%\n"
              "     10   100.00%  100.00%\n");
}

TEST(Curve, LinesRiseAndTheBoundLiesAbove) {
    const Image image = decodePng(drawCurve(rising(8), "title", PictureFormat::Png, 1000));
    ASSERT_EQ(image.width, 1000);
    int before = image.height, compared = 0;
    for (int column = 250; column < 900; ++column) {
        const int value = topOf(image, column, seriesColor(3));
        const int bound = topOf(image, column, seriesColor(0));
        if (value < 0) continue;                  // blended everywhere
        EXPECT_LE(value, before + 10) << column;  // dots are thicker than the line
        before = value;
        if (bound < 0) continue;  // between dashes
        EXPECT_LT(bound, value) << column;
        ++compared;
    }
    EXPECT_GT(compared, 50);
}

TEST(Curve, GapIsShaded) {
    const std::vector<CurvePoint> wide = {{1, 0.1, 0.9}, {2, 0.1, 0.9}, {3, 0.1, 0.9}};
    const auto shaded = [](const std::vector<CurvePoint>& points) {
        const Image image = decodePng(drawCurve(points, "", PictureFormat::Png, 600));
        const Color blue = Color::rgb(0x0072B2);
        return std::count_if(image.pixels.begin(), image.pixels.end(), [&](std::uint32_t pixel) {
            return isNear(pixel, pixelOf(tint(blue, 0.14)));
        });
    };
    EXPECT_GT(shaded(wide), 20000);
    EXPECT_LT(shaded({{1, 0.5, 0.5}, {2, 0.7, 0.7}, {3, 0.9, 0.9}}), 50);
}

/// True if this text stands alone somewhere in the picture.
bool shows(const std::string& svg, const std::string& text) {
    return svg.find(">" + text + "<") != std::string::npos;
}

TEST(Curve, TicksAreRoundAndReachOverAll) {
    const std::string eight = drawCurve(rising(8), "my room", PictureFormat::Svg, 800);
    for (const char* const text : {"my room", "0%", "20%", "100%", "0", "1", "8", "sensors"})
        EXPECT_TRUE(shows(eight, text)) << text;
    EXPECT_TRUE(shows(eight, "25.9%"));  // the figure of the first
    const std::string forty = drawCurve(rising(40), "", PictureFormat::Svg, 800);
    EXPECT_TRUE(shows(forty, "40"));
    EXPECT_FALSE(shows(forty, "39"));
    EXPECT_FALSE(shows(forty, "25.9%"));  // no room
    const std::string low = drawCurve({{0, 0, 0}, {5, 0.015, 0.0175}}, "", PictureFormat::Svg, 800);
    EXPECT_TRUE(shows(low, "2.0%"));
    EXPECT_FALSE(shows(low, "2.5%"));
    const std::string late = drawCurve({{30, 0.5, 1}, {31, 0.6, 1}}, "", PictureFormat::Svg, 800);
    EXPECT_TRUE(shows(late, "30"));
    EXPECT_FALSE(shows(late, "29"));
    EXPECT_FALSE(shows(late, "0"));
}

TEST(Curve, OnePointAndNone) {
    const Image one = decodePng(drawCurve({{3, 0.5, 0.8}}, "t", PictureFormat::Png, 2000));
    const auto count = [&one](Color color) {
        return std::count(one.pixels.begin(), one.pixels.end(), pixelOf(color));
    };
    EXPECT_GT(count(seriesColor(3)), 10);
    EXPECT_GT(count(seriesColor(0)), 5);
    EXPECT_FALSE(drawCurve({}, "", PictureFormat::Png, 200).empty());
    EXPECT_FALSE(drawCurve({{0, 0, 0}}, "", PictureFormat::Pdf, 12000).empty());
}

TEST(Curve, OrderDoesNotMatterAndBytesAreTheSame) {
    std::vector<CurvePoint> back = rising(5);
    std::reverse(back.begin(), back.end());
    for (const PictureFormat format : {PictureFormat::Png, PictureFormat::Svg, PictureFormat::Pdf})
        EXPECT_EQ(drawCurve(rising(5), "t", format, 500), drawCurve(back, "t", format, 500));
    EXPECT_TRUE(drawCurve(rising(5), "t", PictureFormat::Pdf, 500).starts_with("%PDF"));
}

TEST(Curve, WidthHasLimits) {
    EXPECT_THROW(drawCurve(rising(2), "", PictureFormat::Png, 199), UsageError);
    EXPECT_THROW(drawCurve(rising(2), "", PictureFormat::Png, 12001), UsageError);
}

}  // namespace curve_test
}  // namespace ispace
