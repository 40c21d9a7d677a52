// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <sstream>

#include "base/number.h"
#include "io/exporters.h"
#include "io/glb/glb_write.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "support/test_layout.h"

namespace ispace {

namespace mesh_export_test {

Scene sceneOf(const std::string& text) {
    return makeScene(readRecordText("#env 1\n" + text, "room.env", sceneSchemas()), nullptr,
                     DeviceCatalogue());
}

std::vector<std::string> idsOf(const std::vector<ModelNode>& nodes) {
    std::vector<std::string> ids;
    for (const ModelNode& node : nodes) ids.push_back(node.id);
    return ids;
}

TEST(Model, ElementsThenFloorThenWhatIsPlaced) {
    const Scene scene = sceneOf(
        "laser id=l1 at=1,0\nispace id=room size=8,6\ninside at=1,1\n"
        "zone id=z at=2,1 size=2,2\ndesk at=2,1\nrobot id=r1 at=0,1\ntable at=-2,-1\n");
    const std::vector<ModelNode> nodes = modelOf(scene);
    EXPECT_EQ(idsOf(nodes),
              (std::vector<std::string>{"room", "desk1", "table1", "floor", "l1", "r1"}));
    EXPECT_EQ(nodes[1].keyword, "desk");
    EXPECT_EQ(nodes[3].keyword, "");
    for (const ModelNode& node : nodes) {
        const bool is_element = node.id != "floor" && node.id != "l1" && node.id != "r1";
        EXPECT_EQ(node.element != nullptr, is_element) << node.id;
        EXPECT_EQ(node.pose.has_value(), node.id == "l1" || node.id == "r1") << node.id;
        ASSERT_FALSE(node.meshes.empty());
        for (const Mesh& mesh : node.meshes) EXPECT_FALSE(mesh.triangles.empty()) << node.id;
    }
    EXPECT_EQ(nodes[0].element->id, "room");
}

TEST(Model, PlacedThingsStandInFramesOfTheirOwn) {
    const Scene scene =
        sceneOf("ispace size=8,6\nlaser at=1,2,0.5 heading=90 tilt=-10\nrobot at=2,1 heading=45\n");
    const std::vector<ModelNode> nodes = modelOf(scene);
    ASSERT_EQ(nodes.size(), 4U);
    const ModelNode& laser = nodes[2];
    EXPECT_EQ(laser.pose->position, (Point3{1, 2, 0.5}));
    EXPECT_EQ(laser.pose->heading, Angle::degrees(90));
    EXPECT_EQ(laser.pose->tilt, Angle::degrees(-10));
    EXPECT_EQ(laser.meshes[0].material, Material::Sensor);
    const ModelNode& robot = nodes[3];
    EXPECT_EQ(robot.pose->position, (Point3{2, 1, 0}));
    EXPECT_EQ(robot.pose->heading, Angle::degrees(45));
    EXPECT_EQ(robot.meshes[0].material, Material::Robot);
    for (const Point3& p : robot.meshes[0].vertices) EXPECT_LT(length(p.onFloor() - Point2()), 1);
}

using ispace::testing::scene;

using Triangle = std::array<Point3, 3>;

/// Triangles with the normals they are written with.
struct Soup {
    std::vector<Triangle> triangles;
    std::vector<Vec3> normals;
};

/// As a program reads it that takes y as up: objects, materials, faces.
struct ObjModel {
    std::vector<std::string> objects;
    std::map<std::string, Soup> by_object;
    std::set<std::string> materials;
    std::string mtllib;
    std::string wrong;  ///< the first line that is not understood
};

ObjModel parseObj(const std::string& text) {
    ObjModel model;
    std::vector<Point3> vertices;
    std::vector<Vec3> normals;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string first, a, b, c, rest;
        words >> first;
        if (first == "#") continue;
        words >> a >> b >> c >> rest;
        const auto number = [](const std::string& word) { return parseDouble(word).value(); };
        if (first == "mtllib") {
            model.mtllib = a;
        } else if (first == "o") {
            model.objects.push_back(a);
        } else if (first == "usemtl") {
            model.materials.insert(a);
        } else if (first == "v") {
            vertices.push_back({number(a), -number(c), number(b)});
        } else if (first == "vn") {
            normals.push_back({number(a), -number(c), number(b)});
        } else if (first == "f") {
            Triangle triangle;
            std::size_t normal = 0;
            const std::array<std::string, 3> words_of_face{a, b, c};
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t slash = words_of_face[i].find("//");
                triangle[i] = vertices.at(std::stoul(words_of_face[i].substr(0, slash)) - 1);
                normal = std::stoul(words_of_face[i].substr(slash + 2)) - 1;
            }
            Soup& soup = model.by_object[model.objects.back()];
            soup.triangles.push_back(triangle);
            soup.normals.push_back(normals.at(normal));
        } else if (model.wrong.empty()) {
            model.wrong = line;
        }
        if (!rest.empty()) model.wrong = line;
    }
    return model;
}

Soup parseStl(const std::string& bytes) {
    Soup soup;
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, 4);
    EXPECT_EQ(bytes.size(), 84 + 50 * static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < count; ++i) {
        std::array<float, 12> numbers;
        std::memcpy(numbers.data(), bytes.data() + 84 + 50 * i, sizeof numbers);
        const auto at = [&](std::size_t k) { return static_cast<double>(numbers[k]); };
        soup.normals.push_back({at(0), at(1), at(2)});
        soup.triangles.push_back(
            {Point3{at(3), at(4), at(5)}, Point3{at(6), at(7), at(8)}, {at(9), at(10), at(11)}});
        std::uint16_t attribute = 1;
        std::memcpy(&attribute, bytes.data() + 84 + 50 * i + 48, 2);
        EXPECT_EQ(attribute, 0);
    }
    return soup;
}

/// Of closed surfaces, by the divergence theorem.
double volumeOf(const Soup& soup) {
    double volume = 0;
    for (const Triangle& t : soup.triangles)
        volume += dot(t[0] - Point3(), cross(t[1] - Point3(), t[2] - Point3())) / 6;
    return volume;
}

double areaOf(const Soup& soup) {
    double area = 0;
    for (const Triangle& t : soup.triangles) area += length(cross(t[1] - t[0], t[2] - t[0])) / 2;
    return area;
}

void expectUnitNormals(const Soup& soup) {
    for (std::size_t i = 0; i < soup.triangles.size(); ++i)
        EXPECT_GT(dot(faceNormal(soup.triangles[i]), soup.normals[i]), 1 - 1e-5);
}

/// What the model is made of, in the world.
std::vector<Triangle> trianglesOf(const Scene& from) {
    std::vector<Triangle> triangles;
    for (const ModelNode& node : modelOf(from)) {
        const Frame3 frame = frameOf(node);
        for (const Mesh& mesh : node.meshes)
            for (const auto& t : mesh.triangles) {
                const Triangle corners{inWorld(frame, mesh.vertices[t[0]]),
                                       inWorld(frame, mesh.vertices[t[1]]),
                                       inWorld(frame, mesh.vertices[t[2]])};
                if (!(faceNormal(corners) == Vec3())) triangles.push_back(corners);
            }
    }
    return triangles;
}

const char* const kRoom =
    "fence id=outer path=0,0;8,0;8,6;3,6;3,5;0,5 closed=yes thickness=0.2\n"
    "wall id=thin from=3,5 to=3,3.6\ninside at=1,1\n"
    "desk id=d1 at=1.5,4 heading=30\nchair at=1.2,3\ntable at=5,3\n"
    "cube id=box at=6,1 heading=20 size=0.5,0.4,0.3\ncylinder id=can at=5,5 size=0.4\n"
    "laser id=l1 at=1,1,0.5 heading=30 tilt=-20\nrobot id=r1 at=4,1 heading=70\n";

TEST(Obj, OneBoxToTheLetter) {
    const ExportedFiles files = writeObj(scene("ispace id=room size=2,2\n"
                                               "cube id=box at=0.5,0.25 size=0.5,0.5,0.1\n"),
                                         "room.mtl");
    const std::size_t at = files.product.find("o box\n");
    ASSERT_NE(at, std::string::npos);
    const std::string box = files.product.substr(at, files.product.find("o floor\n") - at);
    EXPECT_EQ(box.substr(0, box.find("usemtl")),
              "o box\nv 0.25 0 0\nv 0.75 0 0\nv 0.75 0 -0.5\nv 0.25 0 -0.5\nv 0.25 0.1 0\n"
              "v 0.75 0.1 0\nv 0.75 0.1 -0.5\nv 0.25 0.1 -0.5\n");
    EXPECT_NE(box.find("usemtl box\n"), std::string::npos);
    EXPECT_EQ(files.product.rfind("# ispace: metres, y up", 0), 0U);
    EXPECT_NE(files.product.find("\nmtllib room.mtl\n"), std::string::npos);
    EXPECT_NE(files.beside.find("\nnewmtl box\nKd 0.7"), std::string::npos);
}

TEST(Obj, HoldsTheModelExactly) {
    const Scene room = scene(kRoom);
    const ObjModel model = parseObj(writeObj(room, "a.mtl").product);
    EXPECT_EQ(model.wrong, "");
    EXPECT_EQ(model.mtllib, "a.mtl");
    std::vector<std::string> ids;
    std::vector<Triangle> all;
    for (const ModelNode& node : modelOf(room)) ids.push_back(node.id);
    EXPECT_EQ(model.objects, ids);
    for (const std::string& id : ids) {
        const Soup& soup = model.by_object.at(id);
        expectUnitNormals(soup);
        all.insert(all.end(), soup.triangles.begin(), soup.triangles.end());
    }
    // Shortest decimals read back as the very same doubles.
    EXPECT_EQ(all, trianglesOf(room));
    EXPECT_NEAR(volumeOf(model.by_object.at("box")), 0.5 * 0.4 * 0.3, 1e-12);
    EXPECT_NEAR(areaOf(model.by_object.at("thin")), 1.4 * 2.5, 1e-9);
}

TEST(Obj, MaterialsAreThoseThatAreUsed) {
    const ExportedFiles files = writeObj(scene(kRoom), "a.mtl");
    std::set<std::string> defined;
    std::istringstream lines(files.beside);
    for (std::string word; lines >> word;)
        if (word == "newmtl" && lines >> word) defined.insert(word);
    EXPECT_EQ(defined, parseObj(files.product).materials);
    EXPECT_TRUE(defined.contains("wood"));
    const ExportedFiles plain = writeObj(scene(kRoom), "");
    EXPECT_EQ(plain.beside, "");
    EXPECT_EQ(plain.product.find("mtl"), std::string::npos);
    EXPECT_EQ(parseObj(plain.product).wrong, "");
}

TEST(Stl, HoldsTheModelInFloats) {
    const Scene room = scene(kRoom);
    const std::string bytes = writeStl(room);
    EXPECT_NE(bytes.substr(0, 5), "solid");
    const Soup soup = parseStl(bytes);
    const std::vector<Triangle> wanted = trianglesOf(room);
    ASSERT_EQ(soup.triangles.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_LT(length(soup.triangles[i][k] - wanted[i][k]), 1e-6);
    expectUnitNormals(soup);
    const Soup exact{wanted, {}};
    EXPECT_NEAR(volumeOf(soup), volumeOf(exact), 1e-4);
}

TEST(Stl, LeavesOutWhatFloatsCannotTell) {
    // A millimetre at 900 km is less than floats tell.
    const Scene far = scene(
        "fence path=900000,0;900008,0;900008,6;900000,6 closed=yes\n"
        "cube at=900004,3 size=0.001,0.5,0.5\n");
    const Soup soup = parseStl(writeStl(far));
    EXPECT_FALSE(soup.triangles.empty());
    for (const Triangle& t : soup.triangles) {
        EXPECT_FALSE(t[0] == t[1]);
        EXPECT_FALSE(t[1] == t[2]);
        EXPECT_FALSE(t[2] == t[0]);
    }
    EXPECT_LT(soup.triangles.size(), trianglesOf(far).size());
}

TEST(ObjAndStl, EqualScenesGiveEqualBytes) {
    EXPECT_TRUE(writeObj(scene(kRoom), "a.mtl").product == writeObj(scene(kRoom), "a.mtl").product);
    EXPECT_TRUE(writeStl(scene(kRoom)) == writeStl(scene(kRoom)));
}

}  // namespace mesh_export_test

}  // namespace ispace
