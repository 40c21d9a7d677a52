// SPDX-License-Identifier: GPL-3.0-or-later
// Contents of mesh files in compiled ones.
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/glb/glb_file.h"
#include "io/glb/glb_read.h"
#include "io/glb/glb_write.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "support/test_glb.h"

namespace ispace {
namespace glb_mesh_test {

using Json = nlohmann::json;
using testing::compiled;
using testing::errorOf;
using testing::readCompiled;

std::shared_ptr<const TriangleMesh> meshOf(std::vector<std::array<float, 3>> vertices,
                                           std::vector<std::array<std::uint32_t, 3>> triangles) {
    const auto mesh = std::make_shared<TriangleMesh>();
    mesh->vertices = std::move(vertices);
    mesh->triangles = std::move(triangles);
    mesh->digest = meshDigest(*mesh);
    return mesh;
}

/// A closed tetrahedron with numbers that no rounding forgives.
std::shared_ptr<const TriangleMesh> tetrahedron(float size = 0.1F) {
    return meshOf({{0, 0, 0}, {size, 0, 0}, {0, 3 * size, 0}, {0, 0, 2 * size}},
                  {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
}

Document documentOf(const std::string& records) {
    return readRecordText("#env 1\n" + records, "room.env", sceneSchemas());
}

/// Records of `mesh` get these contents, in turn.
Document loaded(const std::string& records,
                const std::vector<std::shared_ptr<const TriangleMesh>>& meshes) {
    Document document = documentOf(records);
    std::size_t next = 0;
    for (Record& record : document.records)
        if (record.keyword() == "mesh") record.setMesh(meshes[next++ % meshes.size()]);
    return document;
}

Json jsonOf(const std::string& glb) { return Json::parse(glbChunks(glb, "").json); }

/// The file with other JSON.
std::string withJson(const std::string& glb, const Json& json) {
    const std::string data(glbChunks(glb, "").binary);
    return glbContainer(json.dump(), std::array<std::string_view, 1>{data});
}

const std::string kThree =
    "ispace size=40,40\nmesh id=a file=a.stl at=1,2,0.5 heading=30 unit=cm scale=3\n"
    "mesh id=b file=b.obj up=y at=-3,2 heading=-100\nmesh id=c file=c.ply up=x unit=inch\n";

TEST(GlbMesh, ContentComesBackBitByBit) {
    const auto one = tetrahedron(), two = tetrahedron(0.3F);
    const Document document = loaded(kThree, {one, two, one});
    const Document again = readCompiled(compiled(document));
    ASSERT_EQ(again.records.size(), 4U);
    const std::array wanted = {one, two, one};
    for (std::size_t i = 0; i < 3; ++i) {
        const Record& record = again.records[i + 1];
        ASSERT_NE(record.mesh(), nullptr);
        EXPECT_EQ(record.mesh()->vertices, wanted[i]->vertices);
        EXPECT_EQ(record.mesh()->triangles, wanted[i]->triangles);
        EXPECT_EQ(record.mesh()->digest, wanted[i]->digest);
        EXPECT_EQ(record.text("digest"), wanted[i]->digest);
    }
    EXPECT_EQ(again.records[1].mesh(), again.records[3].mesh());
    EXPECT_EQ(environmentDigest(again.records), environmentDigest(document.records));
    EXPECT_EQ(compiled(again), compiled(document));
}

TEST(GlbMesh, EqualContentIsStoredOnce) {
    const std::string glb = compiled(loaded(kThree, {tetrahedron()}));
    const Json json = jsonOf(glb);
    ASSERT_EQ(json["extras"]["ispace_meshes"].size(), 1U);
    EXPECT_EQ(json["extras"]["ispace_meshes"][0]["digest"], tetrahedron()->digest);
    std::vector<int> meshes;
    for (const Json& node : json["nodes"])
        if (node.contains("scale") || node["name"] == "b") meshes.push_back(node["mesh"]);
    ASSERT_EQ(meshes.size(), 3U);
    EXPECT_TRUE(meshes[0] == meshes[1] && meshes[1] == meshes[2]);
}

/// Parses the file with tinygltf: every node with its mesh in the world.
std::vector<Point3> worldVertices(const tinygltf::Model& model, const std::string& name) {
    const auto node = std::find_if(model.nodes.begin(), model.nodes.end(),
                                   [&](const tinygltf::Node& n) { return n.name == name; });
    if (node == model.nodes.end()) return {};
    const std::array<double, 4> q =
        node->rotation.empty() ? std::array<double, 4>{0, 0, 0, 1}
                               : std::array<double, 4>{node->rotation[0], node->rotation[1],
                                                       node->rotation[2], node->rotation[3]};
    const double scale = node->scale.empty() ? 1 : node->scale[0];
    const Point3 moved{node->translation[0], node->translation[1], node->translation[2]};
    std::vector<Point3> out;
    for (const auto& primitive : model.meshes[static_cast<std::size_t>(node->mesh)].primitives) {
        const auto& accessor =
            model.accessors[static_cast<std::size_t>(primitive.attributes.at("POSITION"))];
        const auto& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
        const unsigned char* const data =
            model.buffers[0].data.data() + view.byteOffset + accessor.byteOffset;
        for (std::size_t i = 0; i < accessor.count; ++i) {
            std::array<float, 3> v{};
            std::memcpy(v.data(), data + i * sizeof v, sizeof v);
            // v + 2 a x (a x v + w v), about the place of the node.
            const Vec3 p = scale * Vec3{v[0], v[1], v[2]}, axis{q[0], q[1], q[2]};
            const Point3 bent = Point3() + cross(axis, p) + q[3] * p;
            const Point3 turned = moved + p + 2 * cross(axis, bent - Point3());
            out.push_back({turned.x, -turned.z, turned.y});
        }
    }
    return out;
}

tinygltf::Model modelIn(const std::string& glb) {
    tinygltf::Model model;
    std::string error, warning;
    EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromMemory(
        &model, &error, &warning, reinterpret_cast<const unsigned char*>(glb.data()),
        static_cast<unsigned>(glb.size())));
    EXPECT_EQ(error + warning, "");
    return model;
}

TEST(GlbMesh, FurnitureStandsWhereTheBodiesDoAndSharesMeshes) {
    const std::string kinds[] = {"table size=1,1,0.7",
                                 "desk",
                                 "desk kind=closed",
                                 "chair",
                                 "barrier",
                                 "cube",
                                 "cylinder",
                                 "pillar",
                                 "pillar kind=round",
                                 "boxes count=4",
                                 "screen",
                                 "infra height=2.2 rows=3 cols=2",
                                 "floor kind=checker size=2,1"};
    const auto has_no_height = [](const std::string& kind) {
        return kind.starts_with("floor") || kind.starts_with("infra");
    };
    std::string text = "fence path=-50,-50;50,-50;50,50;-50,50 closed=yes\n";
    for (const std::string& kind : kinds)
        for (int k = 0; k < 3; ++k) {
            const std::string place = std::to_string(7 * k - 3) + ".25," + std::to_string(-5 * k) +
                                      (k < 2 || has_no_height(kind) ? "" : ",0.5");
            text += kind + " at=" + place + " heading=" + std::to_string(75 * k - 30) + "\n";
        }
    const Document document = documentOf(text);
    const Scene scene = makeScene(document, nullptr, DeviceCatalogue());
    const tinygltf::Model model = modelIn(writeGlb(scene, document));
    // The fence, the floor within, and what stands higher is another mesh.
    EXPECT_EQ(model.meshes.size(), 2 + 2 * std::size(kinds) - 2);
    constexpr double kFloat = 1e-6;
    std::size_t compared = 0;
    for (const ModelNode& node : modelOf(scene)) {
        if (node.keyword == "fence" || node.element == nullptr) continue;
        const std::vector<Point3> drawn = worldVertices(model, node.id);
        for (const Mesh& mesh : node.meshes)
            for (const Point3& corner : mesh.vertices)
                ASSERT_TRUE(std::any_of(drawn.begin(), drawn.end(), [&](const Point3& p) {
                    return length(p - corner) < kFloat;
                })) << node.id;
        ++compared;
    }
    EXPECT_EQ(compared, 3 * std::size(kinds));
}

TEST(GlbMesh, NodesStandWhereTheBodiesDo) {
    const Document document = loaded(kThree, {tetrahedron(), tetrahedron(0.3F)});
    const Scene scene = makeScene(document, nullptr, DeviceCatalogue());
    const tinygltf::Model model = modelIn(writeGlb(scene, document));
    std::size_t compared = 0;
    for (const ModelNode& node : modelOf(scene)) {
        if (node.keyword != "mesh") continue;
        const std::vector<Point3> drawn = worldVertices(model, node.id);
        const std::vector<Point3>& body = node.meshes.front().vertices;
        ASSERT_EQ(drawn.size(), body.size()) << node.id;
        for (const Point3& corner : body)
            EXPECT_TRUE(std::any_of(drawn.begin(), drawn.end(), [&](const Point3& p) {
                return length(p - corner) < 1e-9;
            })) << node.id;
        compared += body.size();
    }
    EXPECT_EQ(compared, 12U);
}

TEST(GlbMesh, ContentThatIsMissingOrWrong) {
    const std::string glb = compiled(loaded(kThree, {tetrahedron(), tetrahedron(0.3F)}));
    const auto damaged = [&](auto change) {
        Json json = jsonOf(glb);
        change(json["extras"]["ispace_meshes"], json["bufferViews"]);
        return errorOf(withJson(glb, json));
    };
    EXPECT_EQ(damaged([](Json&, Json&) {}), "no error");
    EXPECT_NE(damaged([](Json& files, Json&) {
                  files.clear();
              }).find("room.glb:3:67: error: damaged: the content of `a.stl` is not in the file"),
              std::string::npos)
        << damaged([](Json& files, Json&) { files.clear(); });
    for (const auto& bad : {Json(), Json(-1), Json(0.5), Json("x"), Json(99), Json::array()})
        for (const char* key : {"positions", "indices"})
            EXPECT_NE(damaged([&](Json& files, Json&) {
                          files[0][key] = bad;
                      }).find("extras.ispace_meshes names none of the "),
                      std::string::npos)
                << bad << key;
    const auto view = [](Json& files, const char* key) -> std::size_t { return files[0][key]; };
    EXPECT_NE(damaged([&](Json& files, Json& views) {
                  views[view(files, "positions")]["byteLength"] = 47;
              }).find("47 bytes of a mesh, wanted 12 each"),
              std::string::npos);
    EXPECT_NE(damaged([&](Json& files, Json& views) {
                  views[view(files, "positions")]["byteOffset"] = 1U << 30U;
              }).find("a mesh lies outside"),
              std::string::npos);
    EXPECT_NE(damaged([&](Json& files, Json& views) {
                  views[view(files, "positions")]["byteLength"] = 36;
              }).find("a corner beyond its 3 points"),
              std::string::npos);
    EXPECT_NE(damaged([&](Json& files, Json& views) {
                  views[view(files, "indices")]["byteLength"] = 36;
              }).find("has another digest than sha256:"),
              std::string::npos);
    EXPECT_NE(damaged([](Json& files, Json&) {
                  files[1]["digest"] = files[0]["digest"];
              }).find("is not in the file"),
              std::string::npos);
}

TEST(GlbMesh, PointsThatAreNoNumbersAreRefused) {
    std::string glb = compiled(loaded("ispace\nmesh file=a.stl\n", {tetrahedron()}));
    const Json json = jsonOf(glb);
    const std::size_t view = json["extras"]["ispace_meshes"][0]["positions"];
    const auto data = static_cast<std::size_t>(glbChunks(glb, "").binary.data() - glb.data());
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        std::string other = glb;
        std::memcpy(
            other.data() + data + json["bufferViews"][view]["byteOffset"].get<std::size_t>(), &bad,
            sizeof bad);
        EXPECT_NE(errorOf(other).find("a point that is no number"), std::string::npos);
    }
}

/// A file of a megabyte must not become gigabytes of meshes, whose digests may well be right.
TEST(GlbMesh, MeshesMayNotOverlap) {
    std::string points(1200, '\1');
    std::string records = "#env 1\nispace\n";
    Json files = Json::array(), views = Json::array();
    for (int i = 0; i < 50; ++i) {
        const std::size_t offset = static_cast<std::size_t>(i) * 4, length = 12 * 80;
        TriangleMesh mesh;
        mesh.vertices.resize(80);
        std::memcpy(mesh.vertices.data(), points.data() + offset, length);
        points[offset] = static_cast<char>(i);  // no two alike
    }
    for (int i = 0; i < 50; ++i) {
        const std::size_t offset = static_cast<std::size_t>(i) * 4, length = 12 * 80;
        TriangleMesh mesh;
        mesh.vertices.resize(80);
        std::memcpy(mesh.vertices.data(), points.data() + offset, length);
        mesh.digest = meshDigest(mesh);
        files.push_back(
            {{"digest", mesh.digest}, {"positions", 1 + 2 * i}, {"indices", 2 + 2 * i}});
        views.push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}});
        views.push_back({{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 0}});
        records += "mesh file=x digest=" + mesh.digest + '\n';
    }
    views.insert(views.begin(),
                 Json{{"buffer", 0}, {"byteOffset", 1200}, {"byteLength", records.size()}});
    const Json json = {{"extras", {{"ispace", 0}, {"ispace_meshes", files}}},
                       {"bufferViews", views}};
    const std::array<std::string_view, 2> parts{points, records};
    EXPECT_EQ(errorOf(glbContainer(json.dump(), parts)),
              "room.glb: error: damaged: its meshes overlap");
}

TEST(GlbMesh, FlippedBytesNeverDoWorseThanAnError) {
    const std::string glb = compiled(loaded(kThree, {tetrahedron()}));
    testing::surviveFlips(glb, glb.size(), 5);
}

}  // namespace glb_mesh_test
}  // namespace ispace
