// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/glb/glb_read.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "base/error.h"
#include "base/file.h"
#include "env/mesh.h"
#include "io/importers.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "support/test_folder.h"
#include "support/test_glb.h"

namespace ispace {
namespace glb_test {

using Json = nlohmann::json;
using testing::errorOf;
using testing::readCompiled;

Document documentOf(const std::string& text) {
    return readRecordText(text, "room.env", sceneSchemas());
}

std::string compiled(const std::string& text) { return testing::compiled(documentOf(text)); }

std::uint32_t word(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

Json jsonOf(const std::string& glb) { return Json::parse(glb.substr(20, word(glb, 12))); }

/// A container around any JSON and data.
std::string container(std::string json, std::string data) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4, '\0');
    const auto bytes = [](std::size_t value) {
        std::string out(4, '\0');
        for (char& c : out) {
            c = static_cast<char>(value & 255U);
            value >>= 8U;
        }
        return out;
    };
    return "glTF" + bytes(2) + bytes(28 + json.size() + data.size()) + bytes(json.size()) + "JSON" +
           json + bytes(data.size()) + std::string("BIN\0", 4) + data;
}

/// Vertices of a node's mesh in the world, in our axes.
std::vector<Point3> verticesOf(const std::string& glb, const std::string& name) {
    const Json json = jsonOf(glb);
    const std::size_t data = 20 + word(glb, 12) + 8;
    Point3 origin;
    std::vector<Point3> vertices;
    for (const Json& node : json["nodes"])
        if (node["name"] == "room" && node.contains("translation"))
            origin = {node["translation"][0], -node["translation"][2].get<double>(),
                      node["translation"][1]};
    for (const Json& node : json["nodes"]) {
        if (node["name"] != name) continue;
        for (const Json& primitive :
             json["meshes"][node["mesh"].get<std::size_t>()]["primitives"]) {
            const Json accessor =
                json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
            const Json view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
            const std::size_t begin = data + view.value("byteOffset", std::size_t{0}) +
                                      accessor.value("byteOffset", std::size_t{0});
            for (std::size_t i = 0; i < accessor["count"].get<std::size_t>(); ++i) {
                std::array<float, 3> v{};
                std::memcpy(v.data(), glb.data() + begin + i * sizeof v, sizeof v);
                vertices.push_back({origin.x + static_cast<double>(v[0]),
                                    origin.y - static_cast<double>(v[2]),
                                    origin.z + static_cast<double>(v[1])});
            }
        }
    }
    return vertices;
}

const std::string kRoom =
    "#env 1\n"
    "# by hand\n"
    "ispace id=room at=2,1 size=8,6,2.5\n"
    "inside at=1,1\n"
    "zone id=all at=2,1 size=2,2\n"
    "desk id=d1 at=2,3 heading=30 size=1.2,0.8,0.7\n"
    "table at=0,0\n"
    "chair id=c1 at=3,0\n"
    "cylinder at=4,2\n"
    "laser id=l1 at=1,0,0.5 heading=90 tilt=-30\n";

TEST(Glb, GivesTheRecordsBack) {
    const std::string glb = compiled(kRoom);
    EXPECT_TRUE(isGlb(glb));
    EXPECT_FALSE(isGlb("glT"));
    const Document document = readCompiled(glb);
    EXPECT_EQ(document.records, documentOf(kRoom).records);
    EXPECT_EQ(document.history, History{"by hand"});
    EXPECT_EQ(document.kind, DocumentKind::Environment);
    EXPECT_EQ(writeRecordText(document), writeRecordText(documentOf(kRoom)));
}

TEST(Glb, EqualInputGivesEqualBytes) { EXPECT_EQ(compiled(kRoom), compiled(kRoom)); }

TEST(Glb, OneNamedNodePerElementThatIsSeen) {
    const Json json = jsonOf(compiled(kRoom));
    std::vector<std::string> names;
    for (const Json& node : json["nodes"]) names.push_back(node["name"]);
    EXPECT_EQ(names, (std::vector<std::string>{"room", "d1", "table1", "c1", "cylinder1", "floor",
                                               "l1", "room"}));
    EXPECT_EQ(json["nodes"][1]["extras"]["keyword"], "desk");
    EXPECT_FALSE(json["nodes"][5].contains("extras"));
    EXPECT_EQ(json["asset"], (Json{{"version", "2.0"}, {"generator", "ispace"}}));
    EXPECT_EQ(json["scenes"][0]["nodes"], Json({7}));
    EXPECT_EQ(json["nodes"][7]["children"].size(), 7U);
    EXPECT_EQ(json["extras"]["ispace"], 0);
    for (const Json& mesh : json["meshes"]) EXPECT_FALSE(mesh["primitives"].empty());
}

TEST(Glb, SheetsAreSeenFromBothSides) {
    const Json json = jsonOf(compiled(kRoom));
    for (const Json& material : json["materials"]) {
        const std::string name = material["name"];
        EXPECT_EQ(material.value("doubleSided", false),
                  name == "wall" || name == "floor" || name == kViewMaterial)
            << name;
    }
}

TEST(Glb, AxesAndBounds) {
    const std::string glb = compiled(kRoom);
    const Json json = jsonOf(glb);
    double top = 0;
    for (const Point3 p : verticesOf(glb, "floor")) {
        EXPECT_TRUE((p.x == -2 || p.x == 6) && (p.y == -2 || p.y == 4) && p.z == 0);
    }
    // Furniture has its own frame.
    for (const Point3 p : verticesOf(glb, "d1")) {
        EXPECT_LE(std::abs(p.x), 0.6F);
        EXPECT_LE(std::abs(p.y), 0.4F);
        top = std::max(top, p.z);
    }
    EXPECT_NEAR(top, 0.7, 1e-6);
    EXPECT_EQ(json["nodes"][1]["name"], "d1");
    EXPECT_EQ(json["nodes"][1]["translation"], Json({2.0, 0.0, -3.0}));
    const Json laser = json["nodes"][6];
    EXPECT_EQ(laser["name"], "l1");
    EXPECT_EQ(laser["translation"], Json({1.0, 0.5, 0.0}));
}

/// The sensor's x axis as the node's rotation turns it must be the beam of bearing 0.
TEST(Glb, SensorsFaceAlongTheirBeam) {
    std::mt19937_64 random(12);
    std::uniform_real_distribution<double> angle(-180, 180);
    for (int round = 0; round < 50; ++round) {
        const Pose3 pose{{0, 0, 0.2},
                         Angle::degrees(angle(random)),
                         Angle::degrees(angle(random) / 2),
                         Angle::degrees(angle(random))};
        Document document = documentOf("#env 1\nispace\nlaser id=l1 at=0,0,0.2\n");
        document.records[1].set("heading", pose.heading.degrees());
        document.records[1].set("tilt", pose.tilt.degrees());
        document.records[1].set("roll", pose.roll.degrees());
        const std::string glb = testing::compiled(document);
        const Json json = jsonOf(glb);
        const auto node = std::find_if(json["nodes"].begin(), json["nodes"].end(),
                                       [](const Json& n) { return n["name"] == "l1"; });
        ASSERT_NE(node, json["nodes"].end());
        const auto q = (*node)["rotation"].get<std::array<double, 4>>();
        EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-12);
        // Columns of the rotation matrix: where glTF's X and -Z, our x and y, go.
        const auto [x, y, z, w] = q;
        const Vec3 forward{1 - 2 * (y * y + z * z), -2 * (x * z - w * y), 2 * (x * y + w * z)};
        const Vec3 left{-2 * (x * z + w * y), 1 - 2 * (x * x + y * y), -2 * (y * z - w * x)};
        const Vec3 want_forward = pose.beam(Angle::degrees(0));
        const Vec3 want_left = pose.beam(Angle::degrees(90));
        EXPECT_NEAR(length(Vec3{forward.x - want_forward.x, forward.y - want_forward.y,
                                forward.z - want_forward.z}),
                    0, 1e-12);
        EXPECT_NEAR(length(Vec3{left.x - want_left.x, left.y - want_left.y, left.z - want_left.z}),
                    0, 1e-12);
    }
}

TEST(Glb, RobotsStandAtTheirStart) {
    const std::string glb = compiled(
        "#env 1\nispace size=8,8\n"
        "robot id=box at=2,1 heading=90 size=0.6,0.4,0.3 center=0.1\n"
        "robot id=twin at=-2,1 size=0.6,0.4,0.3 center=0.1\n"
        "robot id=round at=0,-2 radius=0.25 height=0.5\n"
        "laser id=l1 on=box at=0.2,0,0.3\n");
    const Json json = jsonOf(glb);
    std::map<std::string, Json> nodes;
    for (const Json& node : json["nodes"]) nodes[node["name"]] = node;
    EXPECT_EQ(nodes["box"]["translation"], Json({2.0, 0.0, -1.0}));
    EXPECT_EQ(nodes["box"]["extras"]["keyword"], "robot");
    const double half = std::sqrt(0.5);
    const auto turn = nodes["box"]["rotation"].get<std::array<double, 4>>();
    EXPECT_NEAR(turn[1], half, 1e-12);  // about glTF's Y
    EXPECT_NEAR(turn[3], half, 1e-12);
    EXPECT_EQ(nodes["box"]["mesh"], nodes["twin"]["mesh"]);
    EXPECT_NE(nodes["box"]["mesh"], nodes["round"]["mesh"]);
    EXPECT_EQ(nodes["l1"]["translation"][0], 2.0);
    EXPECT_NEAR(nodes["l1"]["translation"][2].get<double>(), -1.2, 1e-12);

    // In its own frame: the box about its middle, and a nose that stands out in front.
    Box2 plan;
    double top = 0;
    std::vector<Point3> vertices = verticesOf(glb, "twin");
    for (const Point3& p : vertices) {
        plan.add(p.onFloor());
        top = std::max(top, p.z);
    }
    EXPECT_NEAR(plan.low.x, -0.2, 1e-6);
    EXPECT_NEAR(plan.high.x, 0.45, 1e-6);
    EXPECT_NEAR(plan.low.y, -0.2, 1e-6);
    EXPECT_NEAR(plan.high.y, 0.2, 1e-6);
    EXPECT_NEAR(top, 0.3, 1e-6);
    for (const Point3& p : verticesOf(glb, "round"))
        EXPECT_TRUE(length(p.onFloor() - Point2()) < 0.25 + 1e-6 || (p.y == 0 && p.x > 0.25));
}

TEST(Glb, PlansFarFromTheOriginKeepTheirShape) {
    const std::string glb = compiled(
        "#env 1\nfence path=500000.3,-400000.7;500004.3,-400000.7;"
        "500004.3,-399997.7 closed=yes\n");
    const std::vector<Point3> vertices = verticesOf(glb, "floor");
    ASSERT_EQ(vertices.size(), 3U);
    for (const Point3 p : vertices) {
        EXPECT_LT(std::min(std::abs(p.x - 500000.3), std::abs(p.x - 500004.3)), 1e-6);
        EXPECT_LT(std::min(std::abs(p.y + 400000.7), std::abs(p.y + 399997.7)), 1e-6);
    }
}

TEST(Glb, TruncatedFilesNameBothNumbers) {
    const std::string glb = compiled(kRoom);
    EXPECT_EQ(errorOf(glb.substr(0, 7)), "room.glb: error: truncated: 7 of at least 12 bytes");
    EXPECT_EQ(errorOf(glb.substr(0, 100)),
              "room.glb: error: truncated: 100 of " + std::to_string(glb.size()) + " bytes");
    EXPECT_EQ(errorOf(glb + "x"), "room.glb: error: damaged: " + std::to_string(glb.size() + 1) +
                                      " of " + std::to_string(glb.size()) + " bytes");
    for (std::size_t size = 0; size < glb.size(); size += size < 300 ? 1 : 97)
        EXPECT_THROW(readCompiled(glb.substr(0, size)), FormatError) << size;
}

/// The same with a header that hides it.
TEST(Glb, ShortenedFilesWithFittingLength) {
    const std::string glb = compiled("#env 1\nispace\n");
    for (std::size_t size = 12; size < glb.size(); ++size) {
        std::string part = glb.substr(0, size);
        const auto length = static_cast<std::uint32_t>(size);
        std::memcpy(part.data() + 8, &length, sizeof length);
        EXPECT_THROW(readCompiled(part), FormatError) << size;
    }
}

TEST(Glb, ForeignAndDamagedFiles) {
    EXPECT_EQ(errorOf("#env 1\n"),
              "room.glb: error: not a binary glTF file: wanted `glTF` at its beginning");
    EXPECT_EQ(errorOf(container(R"({"asset":{"version":"2.0"}})", "")),
              "room.glb: error: no ispace records in this glTF file: compile the environment with "
              "`envc … -o room.glb`");
    // Only the top level's extras count.
    EXPECT_NE(errorOf(container(R"({"nodes":[{"extras":{"ispace":0}}],"x":{"ispace":0}})", ""))
                  .find("no ispace records"),
              std::string::npos);
    EXPECT_EQ(errorOf(container(R"({"extras":{"ispace":1},"bufferViews":[{}]})", "")),
              "room.glb: error: damaged: extras.ispace names none of the 1 buffer views");
    for (const char* bad : {"-1", "0.5", "\"0\"", "null", "true"})
        EXPECT_EQ(
            errorOf(container(
                std::string(R"({"extras":{"ispace":)") + bad + R"(},"bufferViews":[{}]})", "")),
            "room.glb: error: damaged: extras.ispace names none of the 1 buffer views");
    const std::string view = R"({"extras":{"ispace":0},"bufferViews":[{"buffer":0,"byteOffset":)";
    for (const char* bad :
         {R"(4,"byteLength":8}]})", R"(18446744073709551615,"byteLength":2}]})",
          R"(0,"byteLength":18446744073709551615}]})", R"(18446744073709551612,"byteLength":8}]})",
          R"(9,"byteLength":0}]})", R"(-5,"byteLength":8}]})", R"(0.7,"byteLength":8}]})",
          R"("x","byteLength":8}]})", R"(0,"byteLength":-1}]})"})
        EXPECT_EQ(errorOf(container(view + bad, "12345678")),
                  "room.glb: error: damaged: the records lie outside of its 8 bytes of data");
    EXPECT_EQ(errorOf(container("{]", "")).substr(0, 34), "room.glb: error: damaged: bad JSON");
    std::string version = container("{}", "");
    version[4] = 1;
    EXPECT_EQ(errorOf(version), "room.glb: error: binary glTF version 1, wanted 2");
}

/// The rest of the JSON is not looked at once everything is there.
TEST(Glb, StopsReadingWhereTheRecordsAreFound) {
    const std::string text = "#env 1\ndesk at=1,2\n";
    const std::string view =
        R"("bufferViews":[{"buffer":0,"byteLength":)" + std::to_string(text.size()) + "}]";
    for (const std::string& head :
         {R"({"extras":{"ispace":0},)" + view, '{' + view + R"(,"extras":{"ispace":0})"}) {
        EXPECT_EQ(readCompiled(container(head + "}", text)).records.size(), 1U);
        EXPECT_EQ(readCompiled(container(head + ",]]]", text)).records.size(), 1U);
    }
    EXPECT_NE(errorOf(container(view.substr(0, 20) + "]]", text)).find("bad JSON"),
              std::string::npos);
}

/// What comes of reading: the records, or the error.
template <typename Read>
std::string outcomeOf(Read read) {
    try {
        return writeRecordText(read());
    } catch (const FormatError& error) {
        return error.what();
    }
}

/// Of a file only parts are read, but the same comes of it, damaged or not.
TEST(Glb, AFileIsReadAsItsBytesAre) {
    const testing::TestFolder folder;
    const std::string file = folder.file("room.glb");
    std::string long_room = kRoom;
    for (int i = 0; i < 3000; ++i) long_room += "desk at=" + std::to_string(i) + ",5\n";
    const std::string glb = compiled(kRoom), long_glb = compiled(long_room);
    std::vector<std::string> all = {
        glb,
        long_glb,
        long_glb.substr(0, long_glb.size() / 2),
        glb.substr(0, 15),
        glb + "x",
        container(R"({"extras":{"ispace":1},"bufferViews":[{}]})", ""),
        container(R"({"x":")" + std::string(70000, 'x') +
                      R"(","extras":{"ispace":0},"bufferViews":[{"byteLength":7}]})",
                  "#env 1\n")};
    std::mt19937_64 random(3);
    for (int i = 0; i < 300; ++i) {
        all.push_back(glb);
        char& byte = all.back()[random() % 700];
        byte = static_cast<char>(byte ^ static_cast<char>(1U << (random() % 8)));
    }
    for (const std::string& bytes : all) {
        writeAll(file, bytes);
        EXPECT_EQ(outcomeOf([&] { return readDocument(file, {}, sceneSchemas()); }),
                  outcomeOf([&] { return parseDocument(bytes, file, {}, sceneSchemas()); }));
    }
}

TEST(Glb, TellsItsOwnFilesFromMeshesOfOthers) {
    const std::string glb = compiled(kRoom);
    EXPECT_TRUE(glbHasRecords(glb));
    EXPECT_FALSE(glbHasRecords(container(R"({"asset":{"version":"2.0"}})", "")));
    EXPECT_FALSE(glbHasRecords(container(R"({"extras":{"other":0},"bufferViews":[{}]})", "")));
    // What is damaged is for readGlb to explain.
    EXPECT_TRUE(glbHasRecords(glb.substr(0, 100)));
    EXPECT_TRUE(glbHasRecords("glTF"));
    EXPECT_TRUE(glbHasRecords(container("{]", "")));
}

TEST(Glb, ReadsWhatOthersWroteAnew) {
    const std::string text = "#env 1\ndesk at=1,2\n";
    const std::string json =
        R"({"bufferViews":[{"byteLength":4},{"extras":{"byteOffset":99},"byteOffset":4,)"
        R"("byteLength":)" +
        std::to_string(text.size()) +
        R"(,"buffer":0}],"extras":{"a":[1,{"ispace":7}],"ispace":1}})";
    EXPECT_EQ(readCompiled(container(json, "____" + text)).records.size(), 1U);
}

TEST(Glb, NestingCostsNoStack) {
    for (const char open : {'[', '{'}) {
        std::string json = R"({"extras":)";
        for (int i = 0; i < 2000000; ++i) json += open == '[' ? "[" : R"({"a":)";
        EXPECT_NE(errorOf(container(json, "")).find("bad JSON"), std::string::npos);
    }
}

TEST(Glb, FlippedBytesNeverDoWorseThanAnError) {
    const std::string glb = compiled("#env 1\nispace\ndesk at=1,2\n");
    const std::size_t front = 20 + word(glb, 12) + 120;  // header, JSON and the records
    testing::surviveFlips(glb, std::min(front, glb.size()), 77);
}

}  // namespace glb_test
}  // namespace ispace
