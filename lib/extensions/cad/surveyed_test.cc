// SPDX-License-Identifier: GPL-3.0-or-later
// Drawings in surveyors' coordinates, and formats told apart by content.
#include <gtest/gtest.h>

#include <string>

#include "base/number.h"
#include "extensions/cad/cad.h"
#include "extensions/cad/tests/test_dxf.h"
#include "support/test_import.h"

namespace ispace::cad {
namespace surveyed_test {

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

TEST(Surveyed, Svg) {
    ImportReport report;
    ImportOptions options;
    options.report = &report;
    options.units = "m";
    const Environment room =
        environmentOf(readSvg("<svg><rect x='448262' y='-5428799' width='8' height='6'/></svg>",
                              "a.svg", options, sceneSchemas()));
    EXPECT_NEAR(room.indoor().area(), 48, 1e-6);
    const Box2 box = bounds(room.indoor().parts.front().outline);
    EXPECT_LT(std::max(std::abs(box.low.x), std::abs(box.low.y)), 10);
    ASSERT_EQ(report.choices.size(), 1U);
    EXPECT_NE(report.choices[0].message.find("the drawing stands in surveyors' coordinates"),
              std::string::npos);
    // With a page there, and a stray line at the origin.
    EXPECT_NEAR(environmentOf(readSvg("<svg width='10000mm' height='8000mm' viewBox='448000 "
                                      "-5428800 10 8'><rect x='448001' y='-5428799' width='8' "
                                      "height='6'/><path d='M0 0h1'/></svg>",
                                      "a.svg", {}, sceneSchemas()))
                    .indoor()
                    .area(),
                48, 1e-6);
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

TEST(CadImporters, ToldApartByContent) {
    addImporters(cadImporters());
    const auto parse = [](const std::string& bytes) {
        return parseDocument(bytes, "room", {}, sceneSchemas());
    };
    const std::string dxf = drawing(rectangle("W", 0, 0, 4, 3), "", 6);
    EXPECT_EQ(parse(dxf).records.size(), 2U);
    EXPECT_EQ(parse("999\n# not a comment\n" + dxf).records.size(), 2U);
    EXPECT_EQ(parse("{\"verts\": [[0, 0], [1, 0], [0, 1]]}").records.size(), 2U);
}

}  // namespace surveyed_test
}  // namespace ispace::cad
