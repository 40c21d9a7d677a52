// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/passages/building_script.h"

#include <gtest/gtest.h>

#include <string>

#include "extensions/passages/passages_test.h"

namespace ispace::passages {
namespace building_script_test {

using testing::buildingOf;
using testing::optionsOf;

/// Returns the findings of a script, or "" without any.
std::string scriptFindings(const BuildingRun& run, const std::string& text) {
    return testing::findings([&] { (void)BuildingScript(text, "s.txt", run); });
}

TEST(BuildingScript, FindsOrdersThatCannotBeCarriedOut) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\n");
    const BuildingRun run(building, optionsOf());
    const auto found = [&](const std::string& line) { return scriptFindings(run, line); };
    EXPECT_EQ(found("0 ground/r1 RIDE l1 upper\n1 ground/r1 GOTO upper/4,6\n"), "");
    EXPECT_NE(found("0 ground/r1 RIDE l9 upper\n").find("s.txt:1:18: error: no lift `l9`"),
              std::string::npos);
    EXPECT_NE(found("0 ground/r1 RIDE l1 attic\n").find("l1 does not stop at `attic`"),
              std::string::npos);
    EXPECT_EQ(found("0 ground/r1 PATH upper/4,6;ground/6,6 pause=2 loop=yes speed=0.4\n"), "");
    EXPECT_NE(found("0 ground/r1 PATH upper/4,6 loop=yes\n")
                  .find("s.txt:1:18: error: a trip with loop=yes has two points or more"),
              std::string::npos);
    EXPECT_NE(found("0 ground/r1 PATH upper/4,6;ground/6,6 pace=2\n").find("s.txt:1:39: error: "),
              std::string::npos);
    EXPECT_NE(found("\n0 ground/r1 SIDESPEED 1\n").find("s.txt:2:13: error: "), std::string::npos);
    EXPECT_NE(found("0 ground/r1 SPEED 500\n").find("s.txt:1:13: error: "), std::string::npos);
}

TEST(BuildingScript, MarksAnOrderThatIsRefusedInItsTime) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\n");
    BuildingRun run(building, optionsOf());
    Simulation& ground = *run.rooms()[0].simulation;
    ground.events().want(allEventKinds());
    BuildingScript script("0 ground/r1 GOTO ground/11.9,4\n", "s.txt", run);
    script.give(run);
    ASSERT_EQ(ground.events().next(), 2);
    EXPECT_EQ(ground.events().at(0).kind, EventKind::Unreached);
    EXPECT_EQ(ground.events().at(0).other, "ground");
    EXPECT_EQ(ground.events().at(0).place, (Point2{11.9, 4}));
    EXPECT_EQ(ground.events().at(1).other, "ground/r1");
    EXPECT_EQ(ground.events().at(1).text,
              "script: ground/r1 has no room at ground/11.9,4: ground/f stands there");
}

TEST(BuildingScript, ATripWithoutStairsIsToldAsUnreached) {
    std::string text = testing::kBuilding;
    text.erase(text.find("- lift"));
    const SiteScene building = buildingOf("human id=ground/h at=6,4\n", text);
    BuildingRun run(building, optionsOf());
    EventLog& events = run.rooms()[0].simulation->events();
    events.want({EventKind::Unreached});
    BuildingScript script("0 ground/h GOTO upper/6,4\n", "s.txt", run);
    script.give(run);
    const Event& event = events.at(0);
    EXPECT_EQ(event.kind, EventKind::Unreached);
    EXPECT_EQ(event.id, "ground/h");
    EXPECT_EQ(event.other, "upper");
    EXPECT_EQ(event.place, (Point2{6, 4}));
    EXPECT_EQ(event.text, "no way for ground/h to upper/6,4");
    // The trip of a record is an error of the run, and a finding.
    const SiteScene recorded = buildingOf("human id=ground/h at=6,4 trip=upper/6,4\n", text);
    const auto findings = BuildingRun::tripFindings(recorded);
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_EQ(findings[0].message, "no way for ground/h to upper/6,4");
    EXPECT_TRUE(
        BuildingRun::tripFindings(buildingOf("human id=ground/h at=6,4 trip=upper/6,4\n")).empty());
}

}  // namespace building_script_test
}  // namespace ispace::passages
