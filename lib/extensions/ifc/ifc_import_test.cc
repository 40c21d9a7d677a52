// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "extensions/ifc/ifc.h"
#include "extensions/ifc/storey_plan.h"
#include "extensions/ifc/tests/test_ifc.h"
#include "geom/arrangement.h"
#include "support/test_import.h"

namespace ispace::ifc {
namespace ifc_import_test {

Document readCabin(const std::string& name, const ImportOptions& options = {}) {
    return readIfc(ifcBytes(name), name, options, sceneSchemas());
}

ImportReport reportOf(const std::string& name, const char* storey = "") {
    ImportReport report;
    ImportOptions options;
    options.storey = storey;
    options.report = &report;
    (void)readCabin(name, options);
    return report;
}

double zonesOf(const Document& document) {
    double sum = 0;
    for (const Record& record : document.records)
        if (record.keyword() == "zone") sum += std::abs(signedArea(zoneOutline(record)));
    return sum;
}

std::vector<std::string> texts(const Document& document, const char* keyword, const char* key) {
    std::vector<std::string> all;
    for (const Record& record : document.records)
        if (record.keyword() == keyword && record.has(key)) all.push_back(record.text(key));
    return all;
}

TEST(Ifc, Known) {
    EXPECT_TRUE(isIfc("\n/* by hand; */\nISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));"));
    EXPECT_TRUE(isIfc(ifcBytes("cabin-2x3-mm.ifc")));
    EXPECT_FALSE(
        isIfc("ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\n#1=IFCWALL();"));
    EXPECT_FALSE(isIfc("FILE_SCHEMA(('IFC4'));"));
    EXPECT_FALSE(isIfc(""));
}

class Cabin : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Schemas, Cabin, ::testing::Values("cabin-2x3-mm.ifc", "cabin-4-feet.ifc"));

TEST_P(Cabin, RoomsDoorsWindowsZonesAndThings) {
    const Document document = readCabin(GetParam());
    const Environment room = environmentOf(document);
    // Both rooms, the doorway between them and that of the front door.
    EXPECT_NEAR(room.indoor().area(), 14.8 + 8.8 + 0.8 * 0.1 + 0.9 * 0.3, 1e-4);
    ASSERT_EQ(room.indoor().parts.size(), 1U);
    EXPECT_NEAR(room.height(), 2.8, 1e-6);
    EXPECT_EQ(countOf(document, "door"), 2U);
    EXPECT_EQ(countOf(document, "window"), 2U);  // one of them an open hatch
    EXPECT_EQ(countOf(document, "zone"), 2U);
    EXPECT_NEAR(zonesOf(document), 23.6, 1e-4);
    EXPECT_EQ(texts(document, "zone", "name"), (std::vector<std::string>{"Küche", "Bath"}));
    EXPECT_EQ(texts(document, "zone", "number"), (std::vector<std::string>{"1", "2"}));
    EXPECT_EQ(countOf(document, "pillar"), 1U);
    EXPECT_EQ(countOf(document, "cube"), 1U);
    EXPECT_EQ(warningsOf(document).find("warning"), std::string::npos) << warningsOf(document);
}

TEST(Ifc, ThingsAcrossAWallStandInTheRoomsThatTheyReachInto) {
    std::string bytes = ifcBytes("cabin-2x3-mm.ifc");
    const std::string place = "(4600.,3200.,0.)";
    bytes.replace(bytes.find(place), place.size(), "(3450.,3200.,0.)");  // its middle in a wall
    EXPECT_EQ(countOf(readIfc(bytes, "a.ifc", {}, sceneSchemas()), "cube"), 1U);
    const std::string moved = "(3450.,3200.,0.)";
    bytes.replace(bytes.find(moved), moved.size(), "(8450.,3200.,0.)");  // outside
    EXPECT_EQ(countOf(readIfc(bytes, "a.ifc", {}, sceneSchemas()), "cube"), 0U);
}

/// Returns the choices, a line each.
std::string choicesOf(const ImportReport& report) {
    std::string lines;
    for (const Diagnostic& choice : report.choices)
        lines.append(lines.empty() ? "" : "\n").append(choice.text());
    return lines;
}

TEST(Ifc, StoreysAreChosen) {
    const std::string name = "cabin-2x3-mm.ifc";
    const std::string ground =
        name +
        ": note: read storey 2 \"Ground floor\" at 0.00 m, 23.6 m2 in 2 spaces, 5 walls, 2 doors, "
        "1 window; "
        "others: 1 \"Footing\" at -1.00 m, no spaces; 3 \"Upper floor\" at 3.00 m, no spaces; "
        "--storey NAME chooses";
    for (const char* storey : {"", "2", "ground FLOOR"})
        EXPECT_EQ(choicesOf(reportOf(name, storey)), ground) << storey;
    const auto refused = [&](const char* storey) {
        ImportOptions options;
        options.storey = storey;
        return errorsOf([&] { readCabin(name, options); });
    };
    EXPECT_EQ(
        refused("Ground flor")
            .find(name + ": error: the building has no storey `Ground flor`, did you mean `Ground "
                         "floor`?; its storeys: 1 \"Footing\""),
        0U)
        << refused("Ground flor");
    EXPECT_NE(refused("4").find("no storey `4`"), std::string::npos);
    EXPECT_NE(refused("all").find("one storey is read here"), std::string::npos);
}

TEST(Ifc, RoomsAreListedByStoreys) {
    const auto rooms_of = [](const std::string& name, bool all_storeys) {
        FoundRooms found;
        found.all_storeys = all_storeys;
        ImportOptions options;
        options.found = &found;
        (void)readCabin(name, options);
        return found.rooms;
    };
    const std::vector<FoundRoom> one = rooms_of("cabin-2x3-mm.ifc", false);
    ASSERT_EQ(one.size(), 1U);
    EXPECT_EQ(one[0].storey, "Ground floor");
    EXPECT_TRUE(one[0].is_kept);
    EXPECT_FALSE(one[0].floor.empty());
    const std::vector<FoundRoom> all = rooms_of("halt-4x3-m.ifc", true);
    ASSERT_EQ(all.size(), 2U);
    EXPECT_EQ(all[0].storey, "Platform level");
    EXPECT_EQ(all[1].storey, "Roof deck");
    EXPECT_NEAR(all[1].area, 6.8 * 3.8, 1e-4);
    EXPECT_FALSE(all[1].is_kept);
    EXPECT_TRUE(all[1].floor.empty());
    ImportOptions options;
    options.storey = all[1].storey;
    options.inside = {all[1].inside};
    EXPECT_NEAR(environmentOf(readCabin("halt-4x3-m.ifc", options)).indoor().area(), all[1].area,
                1e-6);
}

// A facility of IFC4.3 around the building, walls as polygonal faces, profiles as indexed curves.
TEST(Ifc, ReadsIfc4x3) {
    const ImportReport report = reportOf("halt-4x3-m.ifc");
    EXPECT_EQ(choicesOf(report),
              "halt-4x3-m.ifc: note: read storey 1 \"Platform level\" at 0.50 m, 23.4 m2 in 2 "
              "spaces, 5 walls, 2 doors, 1 window; others: 2 \"Roof deck\" at 3.50 m, no spaces; "
              "--storey NAME chooses");
    const Document document = readCabin("halt-4x3-m.ifc");
    EXPECT_EQ(warningsOf(document), "");
    EXPECT_NEAR(environmentOf(document).indoor().area(), 23.4 + 0.9 * 0.1 + 1 * 0.2, 1e-4);
    EXPECT_NEAR(zonesOf(document), 23.4, 1e-4);
    EXPECT_EQ(texts(document, "zone", "name"),
              (std::vector<std::string>{"Waiting room", "Tickets"}));
    EXPECT_EQ(countOf(document, "door"), 2U);
    EXPECT_EQ(countOf(document, "window"), 1U);
    EXPECT_EQ(countOf(document, "cube"), 2U);  // bench and counter; the kerb is outside
}

TEST(Ifc, StatedAreasAreDoubted) {
    // The file says 7 m2 of the bath, which has 8.8.
    const ImportReport report = reportOf("cabin-2x3-mm.ifc");
    ASSERT_EQ(report.doubts.size(), 1U);
    EXPECT_EQ(report.doubts[0].text(),
              "cabin-2x3-mm.ifc: warning: space 2 Bath: NetFloorArea says 7.0 m2, 20 % less than "
              "its outline of 8.8 m2: it "
              "counts the floor without columns and what lies under slopes (net)");
}

TEST(Ifc, BrokenPartsAreNamed) {
    const Document document = readCabin("broken-4-m.ifc");
    EXPECT_NEAR(environmentOf(document).indoor().area(), 23.95, 1e-4);
    EXPECT_NE(warningsOf(document).find(
                  "not read, though it may be a wall: IFCSWEPTDISKSOLID (1), in IFCWALL swept; "
                  "IFCWALL without a body (1), in IFCWALL; a missing instance (1), in IFCWALL "
                  "dangling; a number that is missing (1), in IFCWALL words for numbers; curves in "
                  "a loop (1), in IFCWALL curve in itself; placements in a loop (1), in IFCCOLUMN "
                  "in a loop; and 1 more kinds: export it with solids"),
              std::string::npos)
        << warningsOf(document);
}

TEST(Ifc, SpacesWithoutWallsEncloseThemselves) {
    std::string bytes = ifcBytes("cabin-4-feet.ifc");
    for (std::size_t at = 0; (at = bytes.find("IFCWALLSTANDARDCASE", at)) != std::string::npos;)
        bytes.replace(at, 19, "IFCNOTAWALLANYMOREX");
    const Document document = readIfc(bytes, "spaces.ifc", {}, sceneSchemas());
    EXPECT_NEAR(environmentOf(document).indoor().area(), 23.6, 1e-4);
    EXPECT_NEAR(environmentOf(document).height(), 2.5, 1e-6);
    EXPECT_NE(warningsOf(document).find("storey Ground floor: no walls enclose 2 spaces of 2"),
              std::string::npos);
}

TEST(Ifc, AStoreyWithoutWallsIsRefused) {
    std::string bytes = ifcBytes("cabin-2x3-mm.ifc");
    for (const std::string type : {"IFCWALLSTANDARDCASE", "IFCSPACE("})
        for (std::size_t at = 0; (at = bytes.find(type, at)) != std::string::npos;)
            bytes.replace(at, 6, "IFCNOT");
    const std::string errors = errorsOf([&] { readIfc(bytes, "bare.ifc", {}, sceneSchemas()); });
    EXPECT_EQ(errors.find("bare.ifc: error: read storey 2 \"Ground floor\""), 0U) << errors;
    EXPECT_NE(errors.find("it has neither walls nor spaces to enclose a room"), std::string::npos);
}

// Some programs do not say which hole a door or window fills.
TEST_P(Cabin, DoorsAndWindowsStandInHolesWithoutARelation) {
    const auto openings = [](const Document& document) {
        std::map<std::string, int> found;
        for (const Record& record : document.records)
            if (record.keyword() == "door" || record.keyword() == "window")
                ++found[record.keyword() + (record.has("glass") ? " " + record.text("glass") : "")];
        return found;
    };
    std::string bytes = ifcBytes(GetParam());
    const auto related = openings(readIfc(bytes, "cabin.ifc", {}, sceneSchemas()));
    for (std::size_t at = 0; (at = bytes.find("IFCRELFILLSELEMENT", at)) != std::string::npos;)
        bytes.replace(at, 18, "IFCRELOFANOTHERONE");
    EXPECT_EQ(openings(readIfc(bytes, "cabin.ifc", {}, sceneSchemas())), related);
}

// A wall that ends below a window once got a strip of 5 cm instead.
TEST(Ifc, WindowsAboveTheirWallsAreLeftOutWithANote) {
    std::string bytes = ifcBytes("cabin-2x3-mm.ifc");
    const auto change = [&](const std::string& from, const std::string& to) {
        const std::size_t at = bytes.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        bytes.replace(at, from.size(), to);
    };
    change("(6300.,2000.,1200.)", "(6300.,2000.,2300.)");  // the hatch
    change("#80=IFCEXTRUDEDAREASOLID(#76,#78,#79,2800.)",  // its wall
           "#80=IFCEXTRUDEDAREASOLID(#76,#78,#79,2000.)");
    const Document document = readIfc(bytes, "cabin.ifc", {}, sceneSchemas());
    EXPECT_EQ(countOf(document, "window"), 1U);
    const std::string note = "1 opening above or below the walls is left out";
    EXPECT_EQ(std::count_if(document.notes.begin(), document.notes.end(),
                            [&](const std::string& one) { return one.find(note) == 0; }),
              1);
}

TEST(Ifc, RefusalsNameUnreadGeometry) {
    std::string bytes = ifcBytes("cabin-2x3-mm.ifc");
    // The placement of the site hangs on itself, and all others on it.
    const std::size_t root = bytes.find("=IFCLOCALPLACEMENT($,");
    ASSERT_NE(root, std::string::npos);
    const std::size_t id = bytes.rfind('#', root);
    bytes.replace(root + 19, 1, bytes.substr(id, root - id));
    const std::string errors = errorsOf([&] { readIfc(bytes, "loop.ifc", {}, sceneSchemas()); });
    EXPECT_NE(errors.find("placements in a loop ("), std::string::npos) << errors;
}

// The inside of a wall is no room.
TEST(Ifc, WallsThatEncloseNoRoomAreReported) {
    std::string bytes = ifcBytes("cabin-2x3-mm.ifc");
    for (std::size_t at = 0; (at = bytes.find("IFCSPACE(", at)) != std::string::npos;)
        bytes.replace(at, 6, "IFCNOT");
    const std::size_t north = bytes.find("'north'");
    ASSERT_NE(north, std::string::npos);
    const std::size_t type = bytes.rfind("IFCWALL", north);
    bytes.replace(type, 7, "IFCBEAM");
    ImportOptions options;
    options.close_gaps = 0;
    const std::string warnings = warningsOf(readIfc(bytes, "open.ifc", options, sceneSchemas()));
    EXPECT_NE(warnings.find("enclose no room"), std::string::npos) << warnings;
}

TEST(Ifc, SurveyorsCoordinatesComeHome) {
    std::string bytes = ifcBytes("cabin-2x3-mm.ifc");
    // The site's placement is the first with a point of its own.
    const std::size_t site = bytes.find("IFCSITE");
    ASSERT_NE(site, std::string::npos);
    const std::size_t place = bytes.rfind("IFCCARTESIANPOINT((0.,0.,0.))", site);
    ASSERT_NE(place, std::string::npos);
    bytes.replace(place, 29, "IFCCARTESIANPOINT((4.5E9,5.4E9,0.))");
    const Document document = readIfc(bytes, "far.ifc", {}, sceneSchemas());
    const Environment room = environmentOf(document);
    EXPECT_NEAR(room.limits().low.x, 0, 1e-3);
    EXPECT_NEAR(room.limits().low.y, 0, 1e-3);
    EXPECT_NEAR(room.indoor().area(), 23.95, 1e-3);
}

TEST(Ifc, RefusesWhatIsDamaged) {
    const std::string whole = ifcBytes("cabin-2x3-mm.ifc");
    const auto error_of = [](const std::string& bytes) {
        return errorsOf([&] { readIfc(bytes, "damaged.ifc", {}, sceneSchemas()); });
    };
    EXPECT_EQ(error_of(whole.substr(0, whole.size() / 2)),
              "damaged.ifc: error: truncated: the building ends without `END-ISO-10303-21;`\n");
    EXPECT_EQ(error_of(whole.substr(0, whole.find("DATA;") + 6) + "ENDSEC;\nEND-ISO-10303-21;\n"),
              "damaged.ifc: error: an IFC file without a project, building or storey\n");
}

/// Right answers for buildings of other people, in the folder that ISPACE_TEST_DATA names.
struct Stranger {
    const char* file;
    const char* storey;
    double lowest, highest;  // indoor area, m2
    std::size_t doors, zones;
    double zone_area;
};

class Strangers : public ::testing::TestWithParam<Stranger> {};
INSTANTIATE_TEST_SUITE_P(
    Buildings, Strangers,
    ::testing::Values(Stranger{"duplex.ifc", "", 126.4, 133, 6, 10, 126.34},
                      Stranger{"duplex.ifc", "Level 2", 100, 130, 8, 10, 114.2},
                      Stranger{"fzk-haus.ifc", "", 98.8, 104.6, 5, 6, 101.386},
                      Stranger{"fzk-haus.ifc", "Dachgeschoss", 92, 96, 0, 1, 94.25},
                      Stranger{"openhouse.ifc", "", 43, 46, 1, 0, 0}),
    [](const auto& info) { return "Number" + std::to_string(info.index); });

TEST_P(Strangers, AreAsTheyShouldBe) {
    const char* const folder = std::getenv("ISPACE_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "ISPACE_TEST_DATA names no folder of buildings";
    const std::filesystem::path path =
        std::filesystem::path(folder) / "strangers" / "ifc" / GetParam().file;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
    ImportOptions options;
    options.storey = GetParam().storey;
    const Document document = readIfc(readAll(path.string()), path, options, sceneSchemas());
    const double area = environmentOf(document).indoor().area();
    EXPECT_GE(area, GetParam().lowest);
    EXPECT_LE(area, GetParam().highest);
    EXPECT_EQ(countOf(document, "door"), GetParam().doors);
    EXPECT_EQ(countOf(document, "zone"), GetParam().zones);
    EXPECT_NEAR(zonesOf(document), GetParam().zone_area, 0.01 * GetParam().zone_area);
}

}  // namespace ifc_import_test
}  // namespace ispace::ifc
