// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/error.h"
#include "place/sites.h"

namespace ispace {
namespace {

std::vector<Site> sitesOf(const std::string& text) {
    return readSites(text, "sites.csv", {Angle::degrees(0), Angle::degrees(180)});
}

std::string findingsOf(const std::string& text) {
    try {
        static_cast<void>(sitesOf(text));
    } catch (const FormatError& error) {
        std::string out;
        for (const Diagnostic& diagnostic : error.diagnostics()) out += diagnostic.text() + '\n';
        return out;
    }
    return "";
}

TEST(ReadSites, TakesPlacesAndHeadings) {
    const auto sites =
        sitesOf("# of last year\n\n x, y ,heading\r\n1,2\r\n -3.5 , 4e-1 , 90 # here\n1,-2,\n");
    ASSERT_EQ(sites.size(), 3U);
    EXPECT_EQ(sites[0], (Site{{1, 2}, {Angle::degrees(0), Angle::degrees(180)}}));
    EXPECT_EQ(sites[1], (Site{{-3.5, 0.4}, {Angle::degrees(90)}}));
    EXPECT_EQ(sites[2].headings.size(), 2U);
    EXPECT_TRUE(sitesOf("").empty());
    EXPECT_TRUE(sitesOf("x,y\n#1,2").empty());
}

TEST(ReadSites, JoinsLinesOfOnePlace) {
    const auto sites = sitesOf("0,1,90\n5,5,0\n-0,1,450\n0,1,-180\n0,1\n");
    ASSERT_EQ(sites.size(), 2U);
    EXPECT_EQ(sites[0].headings,
              (std::vector<Angle>{Angle::degrees(90), Angle::degrees(-180), Angle::degrees(0)}));
    EXPECT_EQ(sites[1].place, (Point2{5, 5}));
}

TEST(ReadSites, SaysWhereAndWhatIsWrong) {
    EXPECT_EQ(findingsOf("1,2\n 1,a,3\n"), "sites.csv:2:4: error: y `a` is no number\n");
    EXPECT_EQ(findingsOf("7\n"), "sites.csv:1:1: error: 1 field, a line is x,y or x,y,heading\n");
    EXPECT_EQ(findingsOf("1,2,3, 4\n"),
              "sites.csv:1:8: error: 4 fields, a line is x,y or x,y,heading\n");
    EXPECT_EQ(findingsOf("1,\n"), "sites.csv:1:3: error: y is missing\n");
    EXPECT_EQ(findingsOf("nan,1\n"), "sites.csv:1:1: error: x `nan` is no number\n");
    EXPECT_EQ(findingsOf("1,1e7\n"),
              "sites.csv:1:3: error: y `1e7` is too large: a million at most\n");
    // A header stands before all places.
    EXPECT_EQ(findingsOf("1,2\nx,y\n"), "sites.csv:2:1: error: x `x` is no number\n");
    // All that is wrong is told.
    EXPECT_EQ(findingsOf("1\n2,3\n4\n"),
              "sites.csv:1:1: error: 1 field, a line is x,y or x,y,heading\n"
              "sites.csv:3:1: error: 1 field, a line is x,y or x,y,heading\n");
    std::string much;
    for (int i = 0; i < 100; ++i) much += "a,b\n";
    EXPECT_THROW(sitesOf(much), FormatError);
}

}  // namespace
}  // namespace ispace
