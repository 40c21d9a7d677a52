// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/requirement.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "cover/test_scenes.h"

namespace ispace {
namespace {

using Of = Requirement::Of;

TEST(ParseRequirement, KnowsAllForms) {
    EXPECT_EQ(parseRequirement("95%"), (Requirement{Of::Indoor, "", 0.95}));
    EXPECT_EQ(parseRequirement("0.95"), (Requirement{Of::Indoor, "", 0.95}));
    EXPECT_EQ(parseRequirement("free:50%"), (Requirement{Of::Free, "", 0.5}));
    EXPECT_EQ(parseRequirement("zone:door=100%"), (Requirement{Of::Zone, "door", 1}));
    EXPECT_EQ(parseRequirement("zone:a=b=0"), (Requirement{Of::Zone, "a=b", 0}));
}

TEST(ParseRequirement, RefusesTheRest) {
    for (const char* text : {"", "95", "120%", "-1%", "free", "free:", "free:95", "zone:", "zone:a",
                             "zone:=95%", "zone:a=", "zone:a=95", "room:95%", "nan%"})
        EXPECT_THROW(parseRequirement(text), UsageError) << text;
}

CoverageReport sampleReport() {
    CoverageReport report;
    report.indoor_area = 20;
    report.free_area = 10;
    report.coverage.grid = 0.5;
    report.free_coverage.grid = 0.6;
    report.zones = {{.id = "door", .area = 2, .coverage = {.grid = 0.25, .exact = {}}},
                    {.id = "yard", .area = 0, .coverage = {.grid = 0, .exact = 0}}};
    report.unseen = {{{1, 2}, 3.5}, {{0, 0}, 1}};
    return report;
}

std::string missing(const char* text) { return shortfall(parseRequirement(text), sampleReport()); }

TEST(Shortfall, SaysWhatIsMissing) {
    EXPECT_EQ(missing("50%"), "");
    EXPECT_EQ(missing("60%"),
              "coverage is 50.00%, below the required 60%: 2.00 m2 are missing; the largest unseen "
              "spot has 3.50 m2 around (1.00, 2.00)");
    EXPECT_EQ(missing("free:60%"), "");
    EXPECT_EQ(missing("free:61%").substr(0, 40), "free coverage is 60.00%, below the requi");
    EXPECT_EQ(missing("zone:door=100%"),
              "coverage of zone door is 25.00%, below the required 100%: 1.50 m2 are missing");
    EXPECT_EQ(missing("zone:yard=1%"),
              "coverage of zone yard is 0.00%, below the required 1%: it has no floor in the room");
}

TEST(Shortfall, ShowsDifferencesBelowTheSecondDecimal) {
    CoverageReport report = sampleReport();
    report.coverage.grid = 0.949999;
    EXPECT_EQ(shortfall(parseRequirement("95%"), report).substr(0, 20), "coverage is 94.9999%");
}

TEST(MustHaveZone, HintsAtTheZoneThatIsMeant) {
    const Scene scene = sceneOf("ispace size=4,4\nzone id=door at=0,0 size=1,1\n");
    const auto check = [&scene](const char* text) {
        mustHaveZone(parseRequirement(text), scene.environment);
    };
    EXPECT_NO_THROW(check("zone:door=100%"));
    EXPECT_NO_THROW(check("free:100%"));
    try {
        check("zone:doof=100%");
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean `door`?"), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace ispace
