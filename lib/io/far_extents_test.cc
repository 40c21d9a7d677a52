// SPDX-License-Identifier: GPL-3.0-or-later
// Plans in surveyors' coordinates, with strays far away.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "base/file.h"
#include "base/number.h"
#include "io/importers.h"
#include "support/test_folder.h"
#include "support/test_import.h"

namespace ispace {
namespace {

/// Expects that the plan's corner lies less than a metre from the origin, and one note about it.
void expectMoved(const Document& document, const ImportReport& report, double area) {
    const Environment room = environmentOf(document);
    EXPECT_NEAR(room.indoor().area(), area, 1e-6);
    const Box2 box = bounds(room.indoor().parts.front().outline);
    EXPECT_LT(std::max(std::abs(box.low.x), std::abs(box.low.y)), 1.5);
    ASSERT_EQ(report.choices.size(), 1U);
    EXPECT_NE(report.choices[0].message.find("stands in surveyors' coordinates"),
              std::string::npos);
}

TEST(Surveyed, RosMaps) {
    const testing::TestFolder folder;
    std::string picture = "P5\n10 8\n255\n";
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 10; ++x)
            picture += static_cast<char>(x == 0 || y == 0 || x == 9 || y == 7 ? 0 : 254);
    writeAll(folder.file("base.pgm"), picture);
    ImportReport report;
    ImportOptions options;
    options.report = &report;
    options.clean = 0;
    expectMoved(readRosMap("image: base.pgm\nresolution: 0.5\n"
                           "origin: [448262.15, 5428611.7, 0]\nnegate: 0\n"
                           "occupied_thresh: 0.65\nfree_thresh: 0.196\n",
                           folder.file("map.yaml"), options, sceneSchemas()),
                report, 12);
}

TEST(Surveyed, HouseExpo) {
    ImportReport report;
    ImportOptions options;
    options.report = &report;
    const Document document = readHouseExpo(
        "{\"verts\": [[448262, 5428611], [448268, 5428611], [448268, 5428615], [448262, 5428615]],"
        "\"room_category\": {\"kitchen\": [[448263, 5428612, 448265, 5428614]]}}",
        "plan.json", options, sceneSchemas());
    expectMoved(document, report, 24);
    for (const Record& record : document.records)
        if (record.keyword() == "zone") {
            EXPECT_EQ(record.tuple("at"), (Tuple{2, 2}));
        }
}

TEST(Surveyed, Galleries) {
    ImportReport report;
    ImportOptions options;
    options.report = &report;
    expectMoved(readGalleryFile("4 448262/1 5428611/1 448268/1 5428611/1 448268/1 5428615/1 "
                                "448262/1 5428615/1",
                                "hall.pol", options, sceneSchemas()),
                report, 24);
}

/// A cloud of the walls of a room of 6 m x 4 m, with these points beside it.
std::string cloudWith(const std::string& strays, int count) {
    std::string points;
    int sum = count;
    const auto add = [&](double x, double y) {
        for (int i = 0; i <= 10; ++i, ++sum)
            points += formatDouble(x) + ' ' + formatDouble(y) + ' ' + formatDouble(0.2 * i) + '\n';
    };
    for (int i = 0; i <= 300; ++i)
        for (const double y : {0.0, 4.0}) add(0.02 * i, y);
    for (int i = 0; i <= 200; ++i)
        for (const double x : {0.0, 6.0}) add(x, 0.02 * i);
    const std::string size = std::to_string(sum);
    return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
           size + "\nHEIGHT 1\nPOINTS " + size + "\nDATA ascii\n" + strays + points;
}

TEST(Strays, OfCloudsAreLeftOut) {
    ImportOptions options;
    options.slice_walls = 0.5;
    options.slice_top = 1.8;
    const Document document = readPointCloud(cloudWith("5000 5000 1\n-9000 20 1.2\n", 2), "hall",
                                             options, sceneSchemas());
    EXPECT_NEAR(environmentOf(document).indoor().area(), 24, 0.3);
    EXPECT_EQ(warningsOf(document),
              "hall: warning: 2 points lie far from all others, at (5000.0, 5000.0) and others: "
              "left out\n");
}

}  // namespace
}  // namespace ispace
