// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/runs/run_report.h"

#include <gtest/gtest.h>

#include "report/coverage_report.h"
#include "support/test_scenes.h"

namespace ispace::runs {
namespace run_report_test {

/// A robot drives for `end` seconds at 1 m/s past a laser that sees 1 m around (0, 0).
RunCoverage runOf(int end) {
    std::string robots = "t,id,x,y,heading_deg\n";
    for (int i = 0; i <= 50 * end; ++i)
        robots += std::to_string(i / 50.0) + ",r1," + std::to_string(-3 + i / 50.0) + ",0,0\n";
    RunReader reader(robots, "");
    RunCoverage run =
        measureRun(sceneOf("ispace size=8,6\nlaser at=0,0 range=1 fov=360\nrobot id=r1 at=-3,0\n"),
                   reader, {});
    run.name = "drive";
    return run;
}

std::string textOf(const RunCoverage& run) { return RunSection(run).text(); }

TEST(RunReport, HasTextAndJson) {
    const RunCoverage run = runOf(6);
    const std::string text = RunSection(run).text();
    EXPECT_NE(text.find("run drive, t=0.00 to 6.00 s"), std::string::npos) << text;
    EXPECT_NE(text.find("robot r1"), std::string::npos);
    EXPECT_NE(text.find("where sight was lost:"), std::string::npos);
    const std::string json = coverageJson({}, {std::make_shared<RunSection>(run)});
    EXPECT_NE(
        json.find(
            R"("run":{"record":"drive","begin":0,"end":6,"members":[{"id":"r1","kind":"robot")"),
        std::string::npos)
        << json;
    EXPECT_EQ(coverageJson({}).find("\"run\""), std::string::npos);
}

TEST(RunReport, TargetsThatWereGivenUp) {
    RunReader reader("t,id,x,y,heading_deg\n0,r1,0,0,0\n1,r1,0,0,0\n2,r1,0,0,0\n", "",
                     "t,kind,id,other,x,y,value,text\n0.5,unreached,r1,,9,2,,\n"
                     "1.5,unreached,r1,,9,2,,\n1.5,unreached,r1,upper,1,2,,\"no way, none\"\n"
                     "2,unreached,r1,sofa,,,,\n");
    const RunCoverage run =
        measureRun(sceneOf("ispace size=8,6\nrobot id=r1 at=0,0\n"), reader, {});
    ASSERT_EQ(run.unreached.size(), 3U);
    EXPECT_EQ(run.unreached[0].times, 2U);
    const std::string text = RunSection(run).text();
    for (const char* row : {"to (9.00, 2.00)", "2 times", "to upper (1.00, 2.00)", "to sofa"})
        EXPECT_NE(text.find(row), std::string::npos) << row << '\n' << text;
    const std::string json = coverageJson({}, {std::make_shared<RunSection>(run)});
    EXPECT_NE(json.find(R"("unreached":[{"id":"r1","place":[9,2],"first":1,"times":2})"),
              std::string::npos)
        << json;
    EXPECT_EQ(textOf(runOf(1)).find("given up"), std::string::npos);
}

TEST(RunReport, Collisions) {
    RunReader reader("t,id,x,y,heading_deg\n0,r1,0,0,0\n1,r1,1,0.5,0\n2,r1,1,0,0\n", "",
                     "t,kind,id,other,x,y,value,text\n1,collision,r1,side,,,,\n"
                     "2,collision,r1,side,,,,\n2,collision,r1,h1,,,,\n");
    const RunCoverage run =
        measureRun(sceneOf("ispace size=8,6\nrobot id=r1 at=0,0\n"), reader, {});
    ASSERT_EQ(run.contacts.size(), 2U);
    EXPECT_EQ(run.contacts[0].at, (Point2{1, 0.5}));
    const std::string text = RunSection(run).text();
    for (const char* row : {"collisions:", "r1 ran into side", "at (1.00, 0.50)", "t=1.00",
                            "2 times", "r1 ran into h1"})
        EXPECT_NE(text.find(row), std::string::npos) << row << '\n' << text;
    const std::string json = coverageJson({}, {std::make_shared<RunSection>(run)});
    EXPECT_NE(
        json.find(R"("contacts":[{"id":"r1","other":"side","place":[1,0.5],"first":1,"times":2})"),
        std::string::npos)
        << json;
    const std::vector<PageText> told =
        RunSection(run).page({PageSubject::Of::Site, CoverageReport()}).sight;
    ASSERT_FALSE(told.empty());
    EXPECT_EQ(told.back().text, "Movers collided: r1 into side, r1 into h1.");
    EXPECT_EQ(textOf(runOf(1)).find("collisions"), std::string::npos);
}

TEST(RunReport, OfAMoment) {
    EXPECT_NE(textOf(runOf(0)).find("t=0.00 to 0.00 s"), std::string::npos);
}

}  // namespace run_report_test
}  // namespace ispace::runs
