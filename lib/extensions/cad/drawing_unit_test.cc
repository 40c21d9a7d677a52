// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan/drawing_unit.h"

#include <gtest/gtest.h>

#include <string>

#include "base/number.h"
#include "extensions/cad/cad.h"
#include "extensions/cad/tests/test_dxf.h"
#include "support/test_import.h"

namespace ispace::cad {
namespace drawing_unit_test {

constexpr double kInch = 1 / 0.0254;

Document read(const std::string& dxf, const ImportOptions& options = {}) {
    return readDxf(dxf, "plan.dxf", options, sceneSchemas());
}
double areaOf(const std::string& dxf, const ImportOptions& options = {}) {
    return environmentOf(read(dxf, options)).indoor().area();
}

/// Two rooms of 8 m x 6 m in sum, and `doors` doors of 0.8 m, all `scale` times as large.
std::string flat(double scale, int doors = 1) {
    const auto scaled = [scale](double x0, double y0, double x1, double y1) {
        return line("0", scale * x0, scale * y0, scale * x1, scale * y1);
    };
    std::string text = rectangle("0", 0, 0, 8 * scale, 6 * scale);
    double y = 0;
    for (int i = 0; i < doors; ++i, y += 2.8) {
        text += scaled(4, y, 4, y + 2);
        text += scaled(4, y + 2, 3.2, y + 2);  // the leaf
        text += arc("0", 4 * scale, (y + 2) * scale, 0.8 * scale, 90, 180);
    }
    return text + scaled(4, y, 4, 6);
}

TEST(DrawingUnit, DoorsDecideWithoutAUnit) {
    for (const auto& [name, scale] : {std::pair{"m", 1.0},
                                      {"cm", 100.0},
                                      {"mm", 1000.0},
                                      {"inch", kInch},
                                      {"foot", kInch / 12}}) {
        const Document document = read(drawing(flat(scale), "", 0));
        EXPECT_NEAR(environmentOf(document).indoor().area(), 48, 1e-3) << name;
        EXPECT_NE(warningsOf(document).find(
                      "the drawing does not say its unit ($INSUNITS): it is read in " +
                      std::string(name) +
                      ", in which doors are 0.80 m wide and the plan 8.0 m wide; --units takes "
                      "another"),
                  std::string::npos)
            << warningsOf(document);
    }
}

TEST(DrawingUnit, WallsDecideWithoutDoors) {
    const std::string walls = rectangle("0", 0, 0, 800, 600) + rectangle("0", 24, 24, 776, 576);
    const Document document = read(drawing(walls, "", 0));
    EXPECT_NEAR(environmentOf(document).indoor().area(), 7.52 * 5.52, 1e-6);
    EXPECT_NE(warningsOf(document).find("read in cm, in which walls are 0.24 m thick"),
              std::string::npos);
    // A rectangle may have any size.
    EXPECT_NE(errorsOf([&] { read(drawing(rectangle("0", 0, 0, 8, 6), "", 0)); })
                  .find("the drawing does not say its unit ($INSUNITS); most likely is m, in which "
                        "the plan is 8.0 m wide, then foot, in which the plan is 2.4 m wide: say "
                        "its unit, for example with --units m, or how wide it is, with --width-is "
                        "8.00"),
              std::string::npos);
}

TEST(DrawingUnit, AStatedUnitIsOverruledBySureSignsAlone) {
    // Templates state inches: 8 m of millimetres would be 203 m.
    const Document document = read(drawing(flat(1000, 2), "", 1));
    EXPECT_NEAR(environmentOf(document).indoor().area(), 48, 1e-6);
    EXPECT_NE(warningsOf(document).find("the drawing states inch ($INSUNITS), but is read in mm"),
              std::string::npos);
    // One door may be a washbasin, unless the size is impossible.
    EXPECT_GT(areaOf(drawing(flat(1000, 1), "", 1)), 10'000);
    EXPECT_NEAR(areaOf(drawing(flat(1, 1), "", 4)), 48, 1e-6);
    EXPECT_EQ(warningsOf(read(drawing(flat(1000, 2), "", 4))), "");
    ImportOptions inch;
    inch.units = "inch";
    EXPECT_GT(areaOf(drawing(flat(1000, 2), "", 1), inch), 10'000);
}

TEST(DrawingUnit, AReadingServesAllUnits) {
    std::size_t readings = 0;
    const auto read_at = [&](double metres) {
        ++readings;
        LayerSorter::Sorted sorted;
        for (const double d : {0.0, 0.3})
            sorted.walls.push_back({{{metres * d, metres * d},
                                     {metres * (9000 - d), metres * d},
                                     {metres * (9000 - d), metres * (6000 - d)},
                                     {metres * d, metres * (6000 - d)}},
                                    true});
        return sorted;
    };
    EXPECT_EQ(rankedUnits(read_at, Budget(0), nullptr, usualUnits()).front().extent, 9);
    EXPECT_EQ(readings, 1U);
}

// Lines from one point to all sides, of which each has the others beside it, are too many to
// compare; units are told apart by the extent alone, in less work than the drawing is granted.
TEST(DrawingUnit, AFanIsMeasuredByItsExtent) {
    const auto fan = [](double metres) {
        LayerSorter::Sorted sorted;
        for (int i = 0; i < 4000; ++i)
            sorted.walls.push_back(
                {{{0, 0}, {8 * metres, 0.0005 * metres * static_cast<double>(i)}}, false});
        return sorted;
    };
    Budget work(0, {2000});
    const std::vector<UnitEvidence> ranking = rankedUnits(fan, work, nullptr, usualUnits());
    ASSERT_EQ(ranking.size(), 2U);  // m and foot
    for (const UnitEvidence& evidence : ranking) {
        EXPECT_TRUE(evidence.is_large);
        EXPECT_EQ(evidence.walls, 0);
    }
}

TEST(DrawingUnit, AWrongUnitHasOneAdvice) {
    // A flat drawn in inches that is read in centimetres by --units: 0.3 m wide.
    ImportOptions mm;
    mm.units = "mm";
    const Document document = read(drawing(flat(1 / 0.0254 * 1, 2), "", 0), mm);
    EXPECT_NE(warningsOf(document).find(
                  "is its unit right? It is read in mm; most likely is inch, in which doors are "
                  "0.80 m wide and the plan 8.0 m wide"),
              std::string::npos)
        << warningsOf(document);
    EXPECT_NE(warningsOf(document).find("say its unit, for example with --units inch"),
              std::string::npos);
}

TEST(DrawingUnit, ListsTheCodesThatAreRead) {
    EXPECT_NE(errorsOf([&] { read(drawing(rectangle("0", 0, 0, 8, 6), "", 3)); })
                  .find("$INSUNITS is 3, wanted 1 (inch), 2 (foot), 4 (mm), 5 (cm), 6 (m), 7 (km), "
                        "10 (yard), 14 (dm) or 21 (US survey foot)"),
              std::string::npos);
    constexpr double kFeet = 3937.0 / 1200;
    EXPECT_NEAR(areaOf(drawing(rectangle("0", 0, 0, 8 * kFeet, 6 * kFeet), "", 21)), 48, 1e-4);
}

TEST(DrawingUnit, ScalesOfPaper) {
    // The flat of OfSvg in centimetres, at a scale on a page.
    const auto page = [](double scale, const std::string& unit) {
        const double cm = (unit == "mm" ? 10 : kInch / 100) / scale;
        const std::string w = formatDouble(900 * cm), h = formatDouble(700 * cm);
        return "<svg width='" + w + unit + "' height='" + h + unit + "' viewBox='0 0 " + w + ' ' +
               h + "'><g transform='scale(" + formatDouble(cm) +
               ")'><path d='M0 0H800V600H0Z M400 0V200 M400 280V600 M400 200H320'/>"
               "<path d='M320 200A80 80 0 0 0 400 280'/></g></svg>";
    };
    for (const auto& [scale, unit] : {std::pair{20.0, "mm"},
                                      {50.0, "mm"},
                                      {100.0, "mm"},
                                      {200.0, "mm"},
                                      {48.0, "in"},
                                      {96.0, "in"}}) {
        const Document document = readSvg(page(scale, unit), "plan.svg", {}, sceneSchemas());
        EXPECT_NEAR(environmentOf(document).indoor().area(), 48, 1e-3) << scale;
        EXPECT_NE(warningsOf(document).find("it is read at the scale of 1:" + formatDouble(scale) +
                                            ", in which doors are 0.80 m wide"),
                  std::string::npos)
            << warningsOf(document);
    }
    // A rectangle may have any scale.
    EXPECT_NE(errorsOf([] {
                  readSvg(
                      "<svg width='297mm' height='210mm' viewBox='0 0 297 210'><rect x='20' "
                      "y='20' width='160' height='120'/></svg>",
                      "plan.svg", {}, sceneSchemas());
              }).find("; most likely is 1:50, in which the plan is 8.0 m wide, then 1:100"),
              std::string::npos);
}

TEST(DrawingUnit, OfSvg) {
    const std::string body =
        "<path d='M0 0H800V600H0Z M400 0V200 M400 280V600 M400 200H320'/>"
        "<path d='M320 200A80 80 0 0 0 400 280'/></svg>";
    const Document document =
        readSvg("<svg viewBox='0 0 900 700'>" + body, "plan.svg", {}, sceneSchemas());
    EXPECT_NEAR(environmentOf(document).indoor().area(), 48, 1e-6);
    EXPECT_NE(warningsOf(document).find("the drawing has no scale: its unit is read as 1 cm, in "
                                        "which doors are 0.80 m wide"),
              std::string::npos);
}

}  // namespace drawing_unit_test
}  // namespace ispace::cad
