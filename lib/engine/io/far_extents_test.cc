// SPDX-License-Identifier: GPL-3.0-or-later
// Maps in surveyors' coordinates.
#include <gtest/gtest.h>

#include <string>

#include "base/file.h"
#include "io/importers.h"
#include "support/test_folder.h"
#include "support/test_import.h"

namespace ispace {
namespace far_extents_test {

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

}  // namespace far_extents_test
}  // namespace ispace
