// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/coverage_report.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cctype>

#include "base/message.h"
#include "env/level.h"
#include "report/coverage_formats.h"
#include "support/test_map.h"
#include "support/test_scenes.h"

namespace ispace {
namespace coverage_report_test {

CoverageReport sampleReport() {
    CoverageReport report;
    report.digest = "sha256:0a";
    report.limits = {{-1, 0}, {3, 2.5}};
    report.grid = {report.limits, 4, 5};
    report.height = 0.15;
    report.indoor_area = 10;
    report.free_area = 9.25;
    SensorMetrics first{.id = "l1", .model = "urg-04lx", .slice_area = 3.5};
    first.area = {.grid = 3.25, .exact = 3.375};
    first.marginal = {.grid = 1.25, .exact = 1.5};
    first.overlap = {.grid = 2, .exact = 1.875};
    SensorMetrics second{.id = "t", .model = "", .kind = &Ranger::kKind};
    second.area.grid = 12;
    second.marginal.grid = 0;
    second.overlap.grid = 12;
    report.sensors = {first, second};
    report.total_effective_area.grid = 8;
    report.overlap.grid = 2;
    report.coverage = {.grid = 0.8, .exact = 0.8125};
    report.free_coverage.grid = 0.875;
    report.redundancy = {0.2, 0.8, 0};
    report.zones = {{.id = "door", .area = 1.5, .coverage = {.grid = 0.5, .exact = 0.25}},
                    {.id = "far", .area = 0, .coverage = {.grid = 0, .exact = 0}}};
    report.pieces = 2;
    report.largest_piece = 0.75;
    report.unseen = {{{1, 2}, 1.5}, {{0.5, 0.25}, 0.5}};
    return report;
}

TEST(CoverageJson, HasTheKeysInTheirOrder) {
    EXPECT_EQ(
        coverageJson(sampleReport()),
        R"({"schema":"ispace-coverage/1","tool":"coverage","version":")" + std::string(version()) +
            R"(","digest":"sha256:0a","rooms":[{"id":"","digest":"sha256:0a","limits":[-1,0,3,2.5],)"
            R"("grid":[4,5],"indoor_area":10,"free_area":9.25,)"
            R"("total_effective_area":{"grid":8,"exact":null},"outside_area":null,)"
            R"("coverage":{"grid":0.8,"exact":0.8125},"free_coverage":{"grid":0.875,"exact":null}}],)"
            R"("limits":[-1,0,3,2.5],)"
            R"("grid":[4,5],"height":0.15,"plane":0,"indoor_area":10,"free_area":9.25,"sensors":[)"
            R"({"id":"l1","model":"urg-04lx","slice_area":3.5,"exact_area":3.375,)"
            R"("marginal_area":1.25,"kind":"laser","area":{"grid":3.25,"exact":3.375},)"
            R"("marginal":{"grid":1.25,"exact":1.5},"overlap":{"grid":2,"exact":1.875},"outside_area":null},)"
            R"({"id":"t","model":null,"slice_area":null,"exact_area":null,"marginal_area":0,)"
            R"("kind":"ranger","area":{"grid":12,"exact":null},"marginal":{"grid":0,"exact":null},)"
            R"("overlap":{"grid":12,"exact":null},"outside_area":null}],)"
            R"("total_effective_area":{"grid":8,"exact":null},"outside_area":null,)"
            R"("overlap_area":{"grid":2,"exact":null},)"
            R"("coverage":{"grid":0.8,"exact":0.8125},)"
            R"("free_coverage":{"grid":0.875,"exact":null},"redundancy":[0.2,0.8,0],)"
            R"("redundancy_exact":null,"zones":[)"
            R"({"id":"door","area":1.5,"coverage":{"grid":0.5,"exact":0.25}},)"
            R"({"id":"far","area":0,"coverage":{"grid":0,"exact":0}}],)"
            R"("pieces":{"count":2,"largest_share":0.75},)"
            R"("unseen":[{"x":1,"y":2,"area":1.5},{"x":0.5,"y":0.25,"area":0.5}],)"
            R"("exact_missing":null})"
            "\n");
}

TEST(CoverageJson, TellsOfAComparison) {
    CoverageReport report = sampleReport();
    report.comparison = Comparison{.name = "old.3dm", .coverage = {.grid = 0.5, .exact = {}}};
    report.comparison->gained.grid = 3;
    report.comparison->lost.grid = 0;
    EXPECT_NE(coverageJson(report).find(
                  R"(,"comparison":{"with":"old.3dm","coverage":{"grid":0.5,"exact":null},)"
                  R"("gained_area":{"grid":3,"exact":null},"lost_area":{"grid":0,"exact":null}}})"),
              std::string::npos);
}

TEST(CoverageText, IsAlignedWithUnitsAndPerCentSigns) {
    EXPECT_EQ(coverageText(sampleReport()), R"(environment  sha256:0a
limits       x -1.00 to 3.00 m, y 0.00 to 2.50 m
grid         4 x 5 cells of 1 m x 0.5 m
indoor area  10.00 m2
free floor   9.25 m2 at 0.15 m

                              by cells   exact  difference
total effective area           8.00 m2       -           -
seen by several                2.00 m2       -           -
coverage                        80.00%  81.25%      -1.25%
free coverage                   87.50%       -           -
seen by no sensor               20.00%       -           -
seen by 1 sensor                80.00%       -           -
zone door                       50.00%  25.00%     +25.00%
zone far              outside the room

sensor  model     slice area  by cells    exact  difference  marginal    exact  difference   overlap
l1      urg-04lx     3.50 m2   3.25 m2  3.38 m2    -0.12 m2   1.25 m2  1.50 m2    -0.25 m2   1.88 m2
t       ranger             -  12.00 m2        -           -   0.00 m2        -           -  12.00 m2

covered floor is in 2 pieces, the largest has 75.00% of it
largest spots of free floor that no sensor sees:
   1.50 m2  around  (1.00, 2.00)
   0.50 m2  around  (0.50, 0.25)
)");
}

TEST(CoverageText, SpotsOfNoSizeAreNotListed) {
    CoverageReport report = sampleReport();
    report.unseen = {{{1, 2}, 0.012}, {{0.5, 0.25}, 0.004}, {{2, 2}, 0.001}};
    EXPECT_NE(
        coverageText(report).find("sees:\n   0.01 m2  around  (1.00, 2.00)\n   and 2 smaller\n"),
        std::string::npos)
        << coverageText(report);
    report.unseen = {{{1, 2}, 0.004}};
    EXPECT_NE(coverageText(report).find("\nno spot of free floor of 0.01 m2 or more is unseen\n"),
              std::string::npos)
        << coverageText(report);
}

TEST(CoverageText, ALargestPieceIsNotAllOfTheFloor) {
    CoverageReport report = sampleReport();
    report.largest_piece = 0.99998;
    EXPECT_NE(coverageText(report).find("in 2 pieces, the largest has more than 99.99% of it\n"),
              std::string::npos);
}

TEST(CoverageText, SaysWhyExactMetricsAreMissing) {
    CoverageReport report = sampleReport();
    report.exact_missing = "what t sees is not known";
    EXPECT_NE(
        coverageText(report).find("\nno exact figures of all together: what t sees is not known\n"),
        std::string::npos);
    EXPECT_NE(coverageJson(report).find(R"("exact_missing":"what t sees is not known")"),
              std::string::npos);
}

TEST(CoverageText, ManySensorsShareARow) {
    CoverageReport report = sampleReport();
    report.redundancy.assign(21, 0.05);
    report.redundancy[20] = 0;
    report.redundancy_exact = report.redundancy;
    (*report.redundancy_exact)[20] = 0.001;
    const std::string text = coverageText(report);
    EXPECT_NE(text.find("\nseen by 6 sensors"), std::string::npos);
    EXPECT_NE(text.find("\nseen by 7 to 20 sensors"), std::string::npos) << text;
    EXPECT_NE(text.find("65.00%  65.10%"), std::string::npos) << text;
    EXPECT_EQ(text.find("seen by 8"), std::string::npos);
}

TEST(CoverageText, SaysSoWhereNoSensorIsPlaced) {
    CoverageReport report = sampleReport();
    report.sensors.clear();
    EXPECT_NE(coverageText(report).find("\nno sensor that covers floor is placed\n"),
              std::string::npos);
}

TEST(CoverageJson, MetricsHaveNoDigitsThatRoundingMade) {
    const Scene scene =
        sceneOf("ispace size=6,4\nlaser id=l1 at=-1,0.3 range=3 fov=123\nlaser at=1.1,0 fov=77\n");
    const std::string json = coverageJson(coverageOf(scene).report);
    std::size_t digits = 0, most = 0;
    for (const char c : json.substr(json.find("limits"))) {
        const bool is_digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
        if (is_digit && (digits > 0 || c != '0')) ++digits;
        if (!is_digit && c != '.') digits = 0;
        most = std::max(most, digits);
    }
    EXPECT_EQ(most, 12U) << json;
}

TEST(CoverageReport, WhatHoldsNoCentreOfACellIsNotKnownByCells) {
    const Scene scene = sceneOf(
        "ispace size=6,4\nzone id=gap at=0,0 size=0.02,0.03\nzone id=yard at=9,9 size=1,1\n"
        "laser at=1,1 fov=360\n");
    const CoverageReport report = coverageOf(scene, 60, 40).report;
    EXPECT_FALSE(report.zones[0].coverage.grid);
    EXPECT_NEAR(report.zones[0].coverage.exact.value_or(0), 1, 1e-6);
    EXPECT_FALSE(report.zones[1].coverage.grid);
    const std::string json = coverageJson(report);
    EXPECT_NE(json.find(R"("coverage":{"grid":null,"exact":)"), std::string::npos) << json;
    const std::string text = coverageText(report);
    const std::string row = text.substr(text.find("zone gap"));
    EXPECT_NE(row.substr(0, row.find('\n')).find(" -   100.00%"), std::string::npos) << text;
}

TEST(CoverageReport, NoIndoorCellIsNoShareAtAll) {
    // The only centre lies in the notch.
    const CoverageReport report =
        coverageOf(sceneOf("fence path=0,0;4,0;4,1;1,1;1,4;0,4 closed=yes\ninside at=0.5,0.5\n"
                           "laser at=0.5,0.5 fov=360\n"),
                   1, 1)
            .report;
    EXPECT_FALSE(report.coverage.grid);
    EXPECT_FALSE(report.free_coverage.grid);
    EXPECT_NE(coverageJson(report).find(R"("redundancy":null)"), std::string::npos);
    EXPECT_NE(coverageText(report).find("seen by no sensor            -  "), std::string::npos)
        << coverageText(report);
}

TEST(CoverageProducts, SameForAnyNumberOfThreads) {
    std::string lines = kOffice;
    lines +=
        "laser at=1,1,0.6 fov=200\nlaser at=6,5,1.2 sweep=tilt sweep_span=30\n"
        "ranger at=7,5,1.5 tilt=-50 heading=-120\nranger at=1,4,2 tilt=-90\n";
    for (int i = 0; i < 5; ++i)
        lines += "ultrasound tilt=-90 at=" + std::to_string(i + 1) + ",2,2.4\n";
    const Scene scene = sceneOf(lines);
    const auto with_threads = [&scene](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const Coverage coverage = coverageOf(scene);
        return coverageJson(coverage.report) + coverageGeoJson(scene, coverage) +
               coverageCsv(coverage);
    };
    const std::string one = with_threads(1);
    for (int run = 0; run < 3; ++run) EXPECT_EQ(with_threads(4), one);
}

/// As many lines, round bodies and edges of free floor as are worth several threads.
TEST(CoverageProducts, SameForAnyNumberOfThreadsInALargeHall) {
    constexpr int kSide = 52;
    const auto size = std::to_string(3 * kSide);
    std::string lines = "ispace size=" + size + ',' + size + '\n';
    for (int i = 0; i < kSide * kSide; ++i) {
        const std::string at = std::to_string(3 * (i % kSide) - 3 * kSide / 2 + 1) + ',' +
                               std::to_string(3 * (i / kSide) - 3 * kSide / 2 + 1);
        lines += (i % 2 == 0 ? "table at=" : "desk heading=" + std::to_string(i % 90) + " at=") +
                 at + '\n';
    }
    lines += "laser at=0,0 fov=270\nlaser at=30,20 fov=180 heading=70 range=20\n";
    const auto with_threads = [&lines](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const Scene scene = sceneOf(lines);  // what is known of it is made anew
        const Coverage coverage = coverageOf(scene);
        EXPECT_GT(scene.environment.level(kScanHeight)->slice().straightLines().size(), 20'000U);
        EXPECT_FALSE(coverage.report.unseen.empty());
        return coverageJson(coverage.report) + coverageCsv(coverage);
    };
    const std::string one = with_threads(1);
    for (const std::size_t threads : {2U, 3U}) EXPECT_EQ(with_threads(threads), one);
}

}  // namespace coverage_report_test
}  // namespace ispace
