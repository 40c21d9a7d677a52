// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "extensions/cad/cad.h"
#include "extensions/cad/curves.h"
#include "extensions/cad/tests/test_dxf.h"
#include "geom/predicates.h"
#include "support/test_import.h"

namespace ispace::cad {
namespace dxf_spline_test {

constexpr double kHalfRoot = std::numbers::sqrt2 / 2;

Document read(const std::string& dxf, const ImportOptions& options = {}) {
    return readDxf(dxf, "plan.dxf", options, sceneSchemas());
}
std::string errorOf(const std::string& dxf) {
    return errorsOf([&] { read(dxf); });
}
double areaOf(const std::string& dxf) { return environmentOf(read(dxf)).indoor().area(); }

/// A whole circle, exact as a rational spline.
std::string circle(double r) {
    const double s = kHalfRoot;
    return spline("W", 2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4},
                  {{r, 0}, {r, r}, {0, r}, {-r, r}, {-r, 0}, {-r, -r}, {0, -r}, {r, -r}, {r, 0}},
                  {1, s, 1, s, 1, s, 1, s, 1});
}

TEST(DxfSpline, RationalCircle) {
    // Pieces lie inside, by half a millimetre at most.
    EXPECT_NEAR(areaOf(drawing(circle(2000))), 4 * std::numbers::pi, 0.007);
    EXPECT_LT(areaOf(drawing(circle(2000))), 4 * std::numbers::pi);
    const Document document = read(drawing(circle(2000)));
    EXPECT_EQ(countOf(document, "fence"), 1U);
    EXPECT_TRUE(document.records.front().flag("closed"));
}

TEST(DxfSpline, Cubic) {
    // A Bézier curve over a base line: y = 3000 * 3 t (1 - t), x = 4000 * t (as control points).
    const std::string arch = spline("W", 3, {0, 0, 0, 0, 1, 1, 1, 1},
                                    {{0, 0}, {4000.0 / 3, 3000}, {8000.0 / 3, 3000}, {4000, 0}});
    EXPECT_NEAR(areaOf(drawing(arch + line("W", 0, 0, 4000, 0))), 4 * 9.0 / 6, 0.005);
    // The same curve in two spans, by inserting a knot.
    const std::string two =
        spline("W", 3, {0, 0, 0, 0, 0.5, 1, 1, 1, 1},
               {{0, 0}, {2000.0 / 3, 1500}, {2000, 3000}, {10000.0 / 3, 1500}, {4000, 0}});
    EXPECT_NEAR(areaOf(drawing(two + line("W", 0, 0, 4000, 0))), 4 * 9.0 / 6, 0.005);
    // Of degree 1 it is a polyline.
    EXPECT_NEAR(areaOf(drawing(
                    spline("W", 1, {0, 0, 1, 2, 3, 3}, {{0, 0}, {4000, 0}, {4000, 3000}, {0, 0}}))),
                6, 1e-9);
}

TEST(DxfSpline, InBlocksAndMirrored) {
    const std::string blocks = block("ARCH", 0, 0, circle(1000));
    EXPECT_NEAR(areaOf(drawing(insert("ARCH", "W", 5000, 0, group(41, -2) + group(42, 3)), blocks)),
                6 * std::numbers::pi, 0.02);
}

TEST(DxfSpline, StaysWithinAMillimetre) {
    const SplineCurve curve{3,
                            {0, 0, 0, 0, 0.1, 0.5, 0.5, 1, 1, 1, 1},
                            {{0, 0}, {1, 9}, {3, -8}, {4, 0.01}, {9, 2}, {9.5, 9}, {0, 3}},
                            {1, 2, 0.3, 1, 5, 1, 1}};
    ASSERT_EQ(splineFault(curve), "");
    const Polygon coarse = splinePoints(curve, 1'000'000);
    // The same curve a hundred times as large has its points ten times as dense.
    SplineCurve large = curve;
    for (Point2& p : large.controls) p = {100 * p.x, 100 * p.y};
    double worst = 0;
    for (const Point2 fine : splinePoints(large, 1'000'000)) {
        double nearest = 1e9;
        for (std::size_t i = 1; i < coarse.size(); ++i)
            nearest = std::min(nearest, distance(Point2{fine.x / 100, fine.y / 100},
                                                 Segment2{coarse[i - 1], coarse[i]}));
        worst = std::max(worst, nearest);
    }
    EXPECT_LE(worst, kCurveSagitta);
    EXPECT_GT(worst, kCurveSagitta / 20);
    EXPECT_LE(splinePoints(curve, 5).size(), 10U);
}

TEST(DxfSpline, FitPointsDrawItAndNoPointsDoNot) {
    const std::string fit = group(0, "SPLINE") + group(8, "W") + group(71, "3") + group(74, "0");
    EXPECT_NE(notesOf(read(drawing(fit + rectangle("W", 0, 0, 4000, 3000))))
                  .find("entities left out: SPLINE without points (1)"),
              std::string::npos);
}

TEST(DxfSpline, RefusesBadNumbers) {
    const auto error_of = [](int degree, std::initializer_list<double> knots,
                             std::initializer_list<double> weights = {}) {
        return errorOf(drawing(spline("W", degree, knots, {{0, 0}, {1, 0}, {1, 1}}, weights)));
    };
    const std::string place = "plan.dxf:16:1: error: SPLINE: ";
    EXPECT_EQ(error_of(0, {0, 1}), place + "degree 0, wanted 1 to 15\n");
    EXPECT_EQ(error_of(99, {0, 1}), place + "degree 99, wanted 1 to 15\n");
    EXPECT_EQ(error_of(3, {0, 0, 1, 1}), place + "3 control points, wanted 4 or more\n");
    EXPECT_EQ(error_of(2, {0, 0, 0, 1, 1}), place + "5 knots, wanted 6\n");
    EXPECT_EQ(error_of(2, {0, 0, 0, 1, 0, 1}), place + "knots that go back\n");
    EXPECT_EQ(error_of(2, {1, 1, 1, 1, 1, 1}), place + "knots that are all the same\n");
    EXPECT_EQ(error_of(2, {0, 0, 0, 1, 1, 1}, {1, 1}), place + "2 weights, wanted 3\n");
    EXPECT_EQ(error_of(2, {0, 0, 0, 1, 1, 1}, {1, 0, 1}), place + "a weight that is not above 0\n");
}

TEST(DxfSpline, SurvivesDamage) {
    surviveDamage(drawing(circle(2000)), [](const std::string& bytes) {
        ImportOptions options;
        options.units = "mm";
        options.max_work.max = 5000;
        read(bytes, options);
    });
}

}  // namespace dxf_spline_test
}  // namespace ispace::cad
