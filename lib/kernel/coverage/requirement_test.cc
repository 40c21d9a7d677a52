// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/requirement.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/test_scenes.h"

namespace ispace {
namespace requirement_test {

using Of = Requirement::Of;

TEST(ParseRequirement, KnowsAllForms) {
    EXPECT_EQ(parseRequirement("95%"), (Requirement{Of::Indoor, "", 0.95}));
    EXPECT_EQ(parseRequirement("0.95"), (Requirement{Of::Indoor, "", 0.95}));
    EXPECT_EQ(parseRequirement("free:50%"), (Requirement{Of::Free, "", 0.5}));
    EXPECT_EQ(parseRequirement("zone:door=100%"), (Requirement{Of::Zone, "door", 1}));
    EXPECT_EQ(parseRequirement("zone:a=b=0"), (Requirement{Of::Zone, "a=b", 0}));
    EXPECT_EQ(parseRequirement("monitor:95%"), (Requirement{Of::Indoor, "", 0.95, 0}));
    EXPECT_EQ(parseRequirement("recognize:free:50%"), (Requirement{Of::Free, "", 0.5, 3}));
    EXPECT_EQ(parseRequirement("identify:door=100%"), (Requirement{Of::Zone, "door", 1, 4}));
    EXPECT_EQ(parseRequirement("identify:zone:door=1"), (Requirement{Of::Zone, "door", 1, 4}));
    // The levels of 2025; two have the densities of classes of 2015, and keep their names.
    constexpr auto kLevels = DensityStandard::Levels2025;
    EXPECT_EQ(parseRequirement("overview:90%"), (Requirement{Of::Indoor, "", 0.9, 6, kLevels}));
    EXPECT_EQ(parseRequirement("discern:door=90%"),
              (Requirement{Of::Zone, "door", 0.9, 8, kLevels}));
    EXPECT_EQ(parseRequirement("perceive:free:1"), (Requirement{Of::Free, "", 1, 3, kLevels}));
    EXPECT_EQ(parseRequirement("scrutinize:5%"), (Requirement{Of::Indoor, "", 0.05, 10, kLevels}));
}

TEST(ParseRequirement, ReadsWhatItIsWrittenAs) {
    EXPECT_EQ(requirementText({Of::Indoor, "", 0.95}), "95%");
    EXPECT_EQ(requirementText({Of::Zone, "door", 1, 4}), "identify:zone:door=100%");
    EXPECT_EQ(requirementText(parseRequirement("characterize:95%")), "characterise:95%");
    for (const char* text : {"0.125", "free:50%", "zone:a=b=0", "monitor:95%", "recognize:free:50%",
                             "outline:95%", "validate:free:50%", "perceive:zone:a=1"}) {
        const Requirement requirement = parseRequirement(text);
        EXPECT_EQ(parseRequirement(requirementText(requirement)), requirement) << text;
    }
}

TEST(ParseRequirement, IsWrittenInWords) {
    EXPECT_EQ(requirementPhrase(parseRequirement("0.95")), "95% of the indoor floor");
    EXPECT_EQ(requirementPhrase(parseRequirement("discern:free:80%")),
              "80% of the free floor at discern (80 px/m)");
    EXPECT_EQ(requirementPhrase(parseRequirement("identify:door=1")),
              "100% of zone door at identify (250 px/m)");
}

TEST(ParseRequirement, RefusesTheRest) {
    for (const char* text : {"", "95", "120%", "-1%", "free", "free:", "free:95", "zone:", "zone:a",
                             "zone:=95%", "zone:a=", "zone:a=95", "room:95%", "nan%", "identify",
                             "identify:", "identify:detect:1", "discern:detect:1", "250:95%"})
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

Verdict verdict(const char* text, const CoverageReport& report = sampleReport()) {
    Coverage coverage;
    coverage.report = report;
    return checkRequirement(parseRequirement(text), coverage);
}
std::string missing(const char* text) {
    const Verdict found = verdict(text);
    return found.is_met ? "" : found.text;
}

TEST(CheckRequirement, SaysWhatIsMissing) {
    EXPECT_EQ(missing("50%"), "");
    EXPECT_EQ(missing("60%"),
              "coverage is 50.00% (by cells), below the required 60%: 2.00 m2 are missing; the "
              "largest unseen spot has 3.50 m2 around (1.00, 2.00)");
    EXPECT_EQ(missing("free:60%"), "");
    EXPECT_EQ(missing("free:61%").substr(0, 51),
              "free coverage is 60.00% (by cells), below the requi");
    EXPECT_EQ(missing("zone:door=100%"),
              "coverage of zone door is 25.00% (by cells), below the required 100%: 1.50 m2 are "
              "missing");
    EXPECT_EQ(missing("zone:yard=1%"),
              "coverage of zone yard is 0.00% (exact), below the required 1%: it has no floor in "
              "the room");
}

TEST(CheckRequirement, ShowsDifferencesBelowTheSecondDecimal) {
    CoverageReport report = sampleReport();
    report.coverage.grid = 0.949999;
    EXPECT_EQ(verdict("95%", report).text.substr(0, 20), "coverage is 94.9999%");
}

TEST(CheckRequirement, ExactMetricsDecideWhereTheyAreKnown) {
    CoverageReport report = sampleReport();
    report.coverage = {.grid = 0.1515, .exact = 0.1416};
    EXPECT_FALSE(verdict("15%", report).is_met);
    EXPECT_EQ(verdict("15%", report).text.substr(0, 30), "coverage is 14.16% (exact), be");
    EXPECT_TRUE(verdict("14%", report).is_met);
    EXPECT_EQ(verdict("14%", report).text, "coverage is 14.16% (exact), as required (14%)");
    report.coverage = {.grid = 0.1416, .exact = 0.1515};
    EXPECT_TRUE(verdict("15%", report).is_met);
    report.coverage.exact.reset();
    EXPECT_FALSE(verdict("15%", report).is_met);
    // A zone without cells, and a zone without measured cells.
    report.zones[0].coverage = {.grid = {}, .exact = 1};
    EXPECT_TRUE(verdict("zone:door=100%", report).is_met);
    report.zones[0].coverage = {};
    EXPECT_FALSE(verdict("zone:door=0%", report).is_met);
    EXPECT_EQ(verdict("zone:door=0%", report).text.substr(0, 37),
              "coverage of zone door is not known: n");
}

TEST(CheckRequirement, WhatIsSeenWholeIsWhole) {
    // Of an askew room exact areas are some 1e-9 off.
    const Scene scene = sceneOf(
        "fence path=0,0;7.1,2.3;4.9,8.2;-2.2,5.9 closed=yes\nlaser at=2.3,4.1 range=20 fov=360\n");
    const CoverageReport report = coverageOf(scene).report;
    ASSERT_TRUE(report.coverage.exact);
    EXPECT_TRUE(verdict("100%", report).is_met) << *report.coverage.exact;
    CoverageReport less = report;
    less.coverage.exact = 1 - 1e-6;
    EXPECT_FALSE(verdict("100%", less).is_met);
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

}  // namespace requirement_test
}  // namespace ispace
