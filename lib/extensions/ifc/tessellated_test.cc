// SPDX-License-Identifier: GPL-3.0-or-later
// Buildings as exporters of tessellated geometry write them: holes in meshes, gaps, rounding, zip.
#include <gtest/gtest.h>
#include <zlib.h>

#include <string>
#include <vector>

#include "base/file.h"
#include "env/zone.h"
#include "extensions/ifc/ifc.h"
#include "extensions/ifc/ifc_import.h"
#include "extensions/ifc/ifc_zip.h"
#include "extensions/ifc/reader/building.h"
#include "extensions/ifc/storey_plan.h"
#include "extensions/ifc/tests/test_ifc_house.h"
#include "support/test_import.h"
#include "support/test_work.h"

namespace ispace::ifc {
namespace tessellated_test {

Document read(const std::string& bytes, const ImportOptions& options = {}) {
    return readIfc(bytes, "house.ifc", options, sceneSchemas());
}

TEST(TessellatedHouse, HasTheSameRoomsHoweverItsHolesAreGiven) {
    using Holes = IfcHouse::Holes;
    for (const bool holes_in_mesh : {true, false})
        for (const Holes holes : {Holes::Body, Holes::Reference, Holes::WithoutBody, Holes::Absent})
            for (const bool spaces : {true, false})
                for (const double turned : {0.0, 37.3}) {
                    IfcHouse house;
                    house.holes_in_mesh = holes_in_mesh;
                    house.holes = holes;
                    house.spaces = spaces;
                    house.turned = turned;
                    house.triangles = turned == 0;
                    house.offset = turned == 0 ? 0 : 4123.456789;
                    const Document document = read(ifcHouse(house));
                    const std::string name = std::to_string(holes_in_mesh) +
                                             std::to_string(static_cast<int>(holes)) +
                                             std::to_string(spaces) + std::to_string(turned);
                    EXPECT_NEAR(environmentOf(document).indoor().area(), IfcHouse::kArea, 1e-3)
                        << name;
                    EXPECT_EQ(countOf(document, "door"), 2U) << name;
                    EXPECT_EQ(countOf(document, "window"), 5U) << name;
                    EXPECT_EQ(warningsOf(document), "") << name;
                }
}

TEST(TessellatedHouse, DoorsMayStandInFrontOfTheirWalls) {
    IfcHouse house;
    house.holes = IfcHouse::Holes::WithoutBody;
    house.leaf_from = -0.15;
    house.leaf_to = 0.05;
    EXPECT_NEAR(environmentOf(read(ifcHouse(house))).indoor().area(), IfcHouse::kArea, 1e-3);
}

TEST(TessellatedHouse, EachStoreyIsARoom) {
    IfcHouse house;
    house.storeys = 3;
    house.spaces = false;
    house.holes = IfcHouse::Holes::Absent;
    for (const char* storey : {"", "1", "Level 3"}) {
        ImportOptions options;
        options.storey = storey;
        const double area = environmentOf(read(ifcHouse(house), options)).indoor().area();
        EXPECT_NEAR(area, IfcHouse::kArea - (storey[0] == 'L' ? 0.9 * 0.3 : 0), 1e-3) << storey;
    }
    EXPECT_EQ(readIfcStoreys(ifcHouse(house), "house.ifc", {}, sceneSchemas()).storeys.size(), 3U);
}

// Exporters round the ends of walls, each for itself.
TEST(StoreyWalls, EdgesOfMicrometresAreNoCorners) {
    const auto building_with = [](std::vector<Polygon> walls) {
        Building building;
        building.storeys.resize(1);
        building.storeys[0].cut = 1;
        for (Polygon& outline : walls) {
            BuildingWall wall;
            wall.section.parts.push_back({{std::move(outline)}, {}});
            building.walls.push_back(std::move(wall));
        }
        return building;
    };
    const Building building =
        building_with({{{0, 0}, {4, 0}, {4, 3e-6}, {4.000002, 0.2}, {4, 0.200002}, {0, 0.2}},
                       {{4, -1}, {4.2, -1}, {4.2, 2}, {4.000002, 2}, {4, 1.999998}, {4, 0.5}}});
    const StoreyWalls walls = wallsOf(building, 0, ampleWork());
    ASSERT_FALSE(walls.solids.empty());
    for (const Region& solid : walls.solids)
        solid.forEachEdge([](const Segment2& edge) { EXPECT_GT(distance(edge.a, edge.b), 1e-5); });
}

TEST(Ifc, DoorsAreKnownByTheirNames) {
    const Environment room = environmentOf(read(ifcHouse({})));
    EXPECT_EQ(readZones("door:Front*,1.5", room).size(), 1U);
    EXPECT_EQ(readZones("door:Inner-door,0.5", room).size(), 1U);
    try {
        static_cast<void>(readZones("door:Back*,1", room));
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_NE(std::string(error.what()).find("its doors: Front-door (0.90 m), Inner-door"),
                  std::string::npos)
            << error.what();
    }
}

// The lower storey is nearer to height 0, but only the upper one has a door to the outside.
TEST(Ifc, TheStoreyWithTheFrontDoorIsRead) {
    Building building;
    building.storeys.resize(2);
    building.storeys[0].elevation = -0.5;
    building.storeys[1].elevation = 2;
    for (BuildingStorey& storey : building.storeys) {
        storey.cut = storey.elevation + 1;
        storey.doors = 1;
    }
    for (const std::uint64_t storey : {0U, 1U}) {
        BuildingSpace space;
        space.storey = storey;
        const double width = storey == 0 ? 8 : 4;
        space.outline.parts.push_back({{{{0, 0}, {width, 0}, {width, 4}, {0, 4}}}, {}});
        building.spaces.push_back(space);
        BuildingOpening door;
        door.storey = storey;
        door.box.center = {4, 2};
        door.box.along = {0, 1};
        door.box.length = 0.9;
        door.box.width = 0.1;
        building.openings.push_back(door);
    }
    EXPECT_EQ(chosenStorey(building, {}), 1U);
    for (BuildingSpace& space : building.spaces) space.storey = 1;  // by walls: none, both outside
    building.openings[1].storey = 0;
    EXPECT_EQ(chosenStorey(building, {}), 0U);
}

std::uint32_t crcOf(const std::string& text) {
    return static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size())));
}

/// Builds an archive of one file, deflated. \param stated its size
std::string zipOf(const std::string& name, const std::string& text, std::uint32_t stated) {
    std::string packed(compressBound(static_cast<uLong>(text.size())) + 64, '\0');
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    std::string fields;  // of both headers, from the version on
    for (const int word : {20, 0, 8, 0, 0}) appendLittle(fields, static_cast<std::uint16_t>(word));
    appendLittle(fields, crcOf(text));
    appendLittle(fields, static_cast<std::uint32_t>(packed.size()));
    appendLittle(fields, stated);
    appendLittle(fields, static_cast<std::uint16_t>(name.size()));
    appendLittle(fields, std::uint16_t{0});
    std::string zip = "PK\3\4" + fields + name + packed;
    const auto directory = static_cast<std::uint32_t>(zip.size());
    zip += "PK\1\2";
    appendLittle(zip, std::uint16_t{20});
    zip += fields + std::string(14, '\0') + name;
    const std::uint32_t size = static_cast<std::uint32_t>(zip.size()) - directory;
    zip += std::string("PK\5\6\0\0\0\0\1\0\1\0", 12);
    appendLittle(zip, size);
    appendLittle(zip, directory);
    return zip + std::string(2, '\0');
}

TEST(IfcZip, Opens) {
    const std::string text = ifcHouse({});
    const std::string zip = zipOf("House.IFC", text, static_cast<std::uint32_t>(text.size()));
    ASSERT_TRUE(isIfc(zip));
    EXPECT_EQ(unzippedIfc(zip, "house.ifczip", ampleWork()), text);
    EXPECT_NEAR(environmentOf(read(zip)).indoor().area(), IfcHouse::kArea, 1e-3);
    EXPECT_FALSE(isIfc(zipOf("plan.svg", text, 1)));
}

TEST(IfcZip, RefusesBombsAndDamage) {
    const std::string text = ifcHouse({});
    const auto refusal = [&](const std::string& zip) {
        Budget work(zip.size());
        return errorsOf([&] { (void)unzippedIfc(zip, "house.ifczip", work); });
    };
    EXPECT_NE(refusal(zipOf("a.ifc", text, 4'000'000'000U)).find("units of work"),
              std::string::npos);
    std::string damaged = zipOf("a.ifc", text, static_cast<std::uint32_t>(text.size()));
    damaged[damaged.size() / 2] ^= 1;
    EXPECT_NE(refusal(damaged).find("damaged zip archive"), std::string::npos) << refusal(damaged);
    EXPECT_NE(refusal(damaged.substr(0, 100)).find("damaged zip archive"), std::string::npos);
}

}  // namespace tessellated_test
}  // namespace ispace::ifc
