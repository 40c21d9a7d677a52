// SPDX-License-Identifier: GPL-3.0-or-later
#include <meshoptimizer.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "base/file.h"
#include "base/message.h"
#include "extensions/meshes/mesh_parts.h"
#include "extensions/meshes/meshes.h"
#include "extensions/meshes/meshes_test.h"
#include "io/importers.h"
#include "io/mesh_files.h"
#include "record/text.h"
#include "support/test_import.h"
#include "support/test_paths.h"

namespace ispace::meshes {
namespace mesh_file_test {

using Vertex = std::array<float, 3>;

/// A folder of the running test's own.
class MeshFile : public ::testing::Test {
  protected:
    MeshFile()
        : folder_(std::filesystem::path(testing::buildPath("mesh_file_test")) /
                  ::testing::UnitTest::GetInstance()->current_test_info()->name()) {
        std::filesystem::create_directories(folder_);
        testing::addMeshesOnce();
    }
    ~MeshFile() override { std::filesystem::remove_all(folder_); }

    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_ / name).string();
    }
    TriangleMesh load(const std::string& name, const std::string& bytes,
                      const std::string& up = "auto") const {
        writeAll(path(name), bytes);
        return *loadMesh(path(name), {up});
    }
    /// Without the folder.
    [[nodiscard]] std::string errorOf(const std::string& name, const std::string& bytes) const {
        std::string errors = errorsOf([&] { load(name, bytes); });
        while (errors.find(folder_.string() + '/') != std::string::npos)
            errors.erase(errors.find(folder_.string() + '/'), folder_.string().size() + 1);
        return errors;
    }
    Document read(const std::string& env, const ImportOptions& options = {}) const {
        return parseDocument("#env 1\n" + env, path("room.env"), options, sceneSchemas());
    }

    std::filesystem::path folder_;
};

/// A tetrahedron of edges 2, 3 and 4 along the axes.
const std::string kObj =
    "# by hand\no tetra\nv 0 0 0\nv 2 0 0\nv 0 3 0\nv 0 0 4\n"
    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

double volumeOf(const TriangleMesh& mesh) {
    double six = 0;
    for (const auto& [i, j, k] : mesh.triangles) {
        const auto a = mesh.vertices[i], b = mesh.vertices[j], c = mesh.vertices[k];
        six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return six / 6;
}

Vertex extentOf(const TriangleMesh& mesh) {
    Vertex low = mesh.vertices[0], high = low;
    for (const Vertex& v : mesh.vertices)
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], v[i]);
            high[i] = std::max(high[i], v[i]);
        }
    return {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
}

void append(std::string& bytes, float value) {
    std::array<char, 4> raw{};
    std::memcpy(raw.data(), &value, 4);
    bytes.append(raw.data(), 4);
}

std::string binaryStl(const TriangleMesh& mesh) {
    std::string bytes(80, ' ');
    bytes += static_cast<char>(mesh.triangles.size());
    bytes += std::string(3, '\0');
    for (const auto& triangle : mesh.triangles) {
        for (int i = 0; i < 3; ++i) append(bytes, 0);
        for (const std::uint32_t corner : triangle)
            for (const float x : mesh.vertices[corner]) append(bytes, x);
        bytes += std::string(2, '\0');
    }
    return bytes;
}

std::string asciiStl(const TriangleMesh& mesh) {
    std::string text = "solid tetra\n";
    for (const auto& triangle : mesh.triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const std::uint32_t corner : triangle) {
            text += "vertex";
            for (const float x : mesh.vertices[corner]) text += ' ' + std::to_string(x);
            text += '\n';
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid tetra\n";
}

const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n2 0 0\n0 3 0\n0 0 4\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

std::string collada(const std::string& up, const std::string& unit) {
    return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter=")" +
           unit + R"("/><up_axis>)" + up + R"(</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 2 0 0 0 3 0 0 0 4</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";
}

/// The tetrahedron as glTF, its buffer inside; `node`: what a node says of its place.
std::string gltf(const std::string& nodes) {
    // 4 vertices of 3 floats, then 12 indices of a byte.
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": )" +
           nodes +
           R"(, "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0,0,0], "max": [2,3,4]},
  {"bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
 "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAAAAAAAAQEAAAAAAAAAAAAAAAAAAAIBAAAIBAAEDAAMCAQID"}]})";
}

TEST_F(MeshFile, FormatsGiveTheSameBody) {
    const TriangleMesh obj = load("a.obj", kObj);
    EXPECT_EQ(obj.vertices.size(), 4U);
    EXPECT_EQ(obj.triangles.size(), 4U);
    EXPECT_DOUBLE_EQ(volumeOf(obj), 4);
    EXPECT_EQ(obj.digest, meshDigest(obj));
    for (const auto& [name, bytes] :
         {std::pair{"a.stl", binaryStl(obj)}, std::pair{"b.stl", asciiStl(obj)},
          std::pair{"a.ply", kPly}, std::pair{"a.dae", collada("Z_UP", "1")}}) {
        const TriangleMesh mesh = load(name, bytes);
        EXPECT_EQ(mesh.vertices.size(), 4U) << name;
        EXPECT_EQ(mesh.triangles.size(), 4U) << name;
        EXPECT_NEAR(volumeOf(mesh), 4, 1e-6) << name;
        EXPECT_EQ(extentOf(mesh), (Vertex{2, 3, 4})) << name;
    }
}

/// The tetrahedron in millimetres as 16-bit integers with a stride of 8 bytes, and its indices.
std::string quantisedBuffer() {
    std::string bytes;
    for (const std::array<std::int16_t, 4>& corner : {std::array<std::int16_t, 4>{0, 0, 0, 0},
                                                      {2000, 0, 0, 0},
                                                      {0, 3000, 0, 0},
                                                      {0, 0, 4000, 0}})
        bytes.append(reinterpret_cast<const char*>(corner.data()), 8);
    return bytes + std::string("\0\2\1\0\1\3\0\3\2\1\2\3", 12);
}

std::string quantisedGltf(const std::string& views, const std::string& buffers,
                          const std::string& extensions) {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
 "nodes": [{"mesh": 0, "scale": [0.001, 0.001, 0.001]}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
 "accessors": [{"bufferView": 0, "componentType": 5122, "count": 4, "type": "VEC3"},
  {"bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR"}],
 "bufferViews": )" +
           views + R"(, "buffers": )" + buffers + R"(,
 "extensionsRequired": [)" +
           extensions + "]}";
}

TEST_F(MeshFile, GltfWithIntegersForPositions) {
    const std::string views =
        R"([{"buffer": 0, "byteLength": 32, "byteStride": 8},
            {"buffer": 0, "byteOffset": 32, "byteLength": 12}])";
    const std::string inside =
        R"([{"byteLength": 44, "uri": "data:application/octet-stream;base64,)" +
        base64(quantisedBuffer()) + R"("}])";
    const std::string json = quantisedGltf(views, inside, R"("KHR_mesh_quantization")");
    const TriangleMesh mesh = load("q.gltf", json);
    EXPECT_EQ(mesh.triangles.size(), 4U);
    EXPECT_NEAR(volumeOf(mesh), 4, 1e-6);
    EXPECT_NEAR(extentOf(mesh)[1], 4, 1e-6);

    writeAll(path("q.bin"), quantisedBuffer());
    const std::string beside = R"([{"byteLength": 44, "uri": "q.bin"}])";
    EXPECT_NEAR(
        volumeOf(load("r.gltf", quantisedGltf(views, beside, R"("KHR_mesh_quantization")"))), 4,
        1e-6);
    // A view beyond its buffer, an extension that is not read, and one of materials alone.
    std::string beyond = json;
    beyond.replace(beyond.find("\"byteLength\": 32"), 16, "\"byteLength\": 99");
    EXPECT_NE(errorOf("s.gltf", beyond).find("beyond the end of its buffer"), std::string::npos);
    EXPECT_NE(errorOf("d.gltf", quantisedGltf(views, inside, R"("KHR_draco_mesh_compression")"))
                  .find("it requires the extension `KHR_draco_mesh_compression` of glTF"),
              std::string::npos);
    std::string lit = gltf("[{\"mesh\": 0}]");
    lit.insert(1, R"("extensionsRequired": ["KHR_materials_unlit"], )");
    EXPECT_DOUBLE_EQ(volumeOf(load("m.gltf", lit)), 4);
}

TEST_F(MeshFile, GltfWithPackedBuffers) {
    const std::string plain = quantisedBuffer();
    std::string packed(meshopt_encodeVertexBufferBound(4, 8), '\0');
    packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()),
                                             packed.size(), plain.data(), 4, 8));
    const std::size_t vertices = packed.size();
    std::array<unsigned, 12> indices{};
    for (std::size_t i = 0; i < 12; ++i) indices[i] = static_cast<unsigned char>(plain[32 + i]);
    std::string faces(meshopt_encodeIndexBufferBound(12, 4), '\0');
    faces.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(faces.data()),
                                           faces.size(), indices.data(), 12));
    packed += faces;
    const auto view = [](const std::string& packing) {
        return R"({"buffer": 1, "byteLength": 0, "extensions": {"EXT_meshopt_compression": )" +
               packing + "}}";
    };
    const std::string views = '[' +
                              view(R"({"buffer": 0, "byteLength": )" + std::to_string(vertices) +
                                   R"(, "byteStride": 8, "count": 4, "mode": "ATTRIBUTES"})") +
                              ',' +
                              view(R"({"buffer": 0, "byteOffset": )" + std::to_string(vertices) +
                                   R"(, "byteLength": )" + std::to_string(faces.size()) +
                                   R"(, "byteStride": 4, "count": 12, "mode": "TRIANGLES"})") +
                              ']';
    const auto json = [&](const std::string& bytes) {
        std::string text = quantisedGltf(
            views,
            R"([{"byteLength": )" + std::to_string(bytes.size()) + R"(, "uri": "data:;base64,)" +
                base64(bytes) +
                R"("}, {"byteLength": 64, "extensions": {"EXT_meshopt_compression": {"fallback": true}}}])",
            R"("KHR_mesh_quantization", "EXT_meshopt_compression")");
        return text.replace(text.find("5121"), 4, "5125");
    };
    EXPECT_NEAR(volumeOf(load("p.gltf", json(packed))), 4, 1e-6);
    std::string damaged = packed;
    damaged[0] = 'x';
    EXPECT_NE(errorOf("x.gltf", json(damaged)).find("cannot be unpacked"), std::string::npos);
}

TEST_F(MeshFile, WhatPointsUp) {
    // Files of these know: y of glTF, and what COLLADA says.
    EXPECT_EQ(extentOf(load("a.gltf", gltf("[{\"mesh\": 0}]"))), (Vertex{2, 4, 3}));
    EXPECT_DOUBLE_EQ(volumeOf(load("a.gltf", gltf("[{\"mesh\": 0}]"))), 4);
    EXPECT_EQ(extentOf(load("y.dae", collada("Y_UP", "1"))), (Vertex{2, 4, 3}));
    EXPECT_EQ(extentOf(load("x.dae", collada("X_UP", "1")))[2], 2);
    EXPECT_EQ(extentOf(load("y.obj", "# ispace: metres, y up: x, z, -y of the room\n" + kObj)),
              (Vertex{2, 4, 3}));
    EXPECT_EQ(extentOf(load("z.obj", "# Z-UP\n" + kObj)), (Vertex{2, 3, 4}));
    EXPECT_EQ(extentOf(load("z.obj", "# geometry updated\n" + kObj)), (Vertex{2, 3, 4}));
    EXPECT_EQ(extentOf(load("z.obj", kObj + "# y up\n")), (Vertex{2, 3, 4}));
    // As they are.
    EXPECT_EQ(extentOf(load("a.gltf", gltf("[{\"mesh\": 0}]"), "y")), (Vertex{2, 3, 4}));
    EXPECT_EQ(extentOf(load("y.dae", collada("Y_UP", "1"), "y")), (Vertex{2, 3, 4}));
    EXPECT_EQ(extentOf(load("a.obj", kObj, "y")), (Vertex{2, 3, 4}));
    EXPECT_EQ(extentOf(load("y.obj", "# y up\n" + kObj, "z")), (Vertex{2, 3, 4}));
}

TEST_F(MeshFile, ColladaComesInMetres) {
    const Vertex extent = extentOf(load("cm.dae", collada("Z_UP", "0.01")));
    EXPECT_FLOAT_EQ(extent[0], 0.02F);
    EXPECT_FLOAT_EQ(extent[2], 0.04F);
}

TEST_F(MeshFile, NodesPlaceTheirParts) {
    // Twice: moved by 10 along x; mirrored and doubled along y under a node turned about y.
    const TriangleMesh mesh = load("a.gltf", gltf(R"([{"children": [1, 2]},
        {"mesh": 0, "translation": [10, 0, 0]},
        {"rotation": [0, 0.7071067811865476, 0, 0.7071067811865476], "children": [3]},
        {"mesh": 0, "scale": [1, -2, 1]}])"),
                                   "y");
    EXPECT_EQ(mesh.triangles.size(), 8U);
    EXPECT_NEAR(volumeOf(mesh), 4 + 8, 1e-5) << "a mirrored part must not be inside out";
    const Vertex extent = extentOf(mesh);
    EXPECT_NEAR(extent[0], 12, 1e-5);
    EXPECT_NEAR(extent[1], 9, 1e-5);
}

TEST_F(MeshFile, PolygonsAreCutOthersDropped) {
    const TriangleMesh mesh = load("a.obj",
                                   "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 5 5 5\nv 1 0 0\nv 0 0 0\n"
                                   "f 1 2 3 4\n"  // two triangles
                                   "l 1 5\np 5\n"
                                   "f 1 2 6\n"    // on a line
                                   "f 1 7 3\n");  // two corners in one place
    EXPECT_EQ(mesh.triangles.size(), 2U);
    EXPECT_EQ(mesh.vertices.size(), 4U);
}

TEST_F(MeshFile, NamesWhatIsWrong) {
    EXPECT_THROW(loadMesh(path("none.obj"), {}), std::system_error);
    EXPECT_THROW(loadMesh(folder_.string(), {}), std::system_error);
    EXPECT_NE(errorsOf([] { loadMesh("/dev/zero", {}); }).find("it is no regular file"),
              std::string::npos);
    EXPECT_EQ(errorOf("cut.stl", std::string(90, 'x')),
              "cut.stl: error: bad mesh file: it cannot be read as stl (assimp says: Failed to "
              "determine STL storage representation); is it damaged?\n");
    EXPECT_EQ(errorOf("a.obj", "nonsense").find("a.obj: error: bad mesh file: "), 0U);
    EXPECT_EQ(errorOf("a.obj", "").find("a.obj: error: bad mesh file: "), 0U);
    EXPECT_EQ(errorOf("a.xyz", "whatever").find("a.xyz: error: bad mesh file: "), 0U);
    EXPECT_NE(errorOf("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), "no error");
    EXPECT_NE(errorOf("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "no error");
    EXPECT_NE(errorOf("inf.obj", "v 0 0 1e39\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "no error");
    EXPECT_NE(errorOf("cut.ply", "ply\nformat ascii").find("a PLY header without `end_header`"),
              std::string::npos);
    EXPECT_NE(errorOf("huge.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n")
                  .find("`4000000000` elements `vertex` in "),
              std::string::npos);
    EXPECT_NE(errorOf("index.ply", kPly.substr(0, kPly.size() - 2) + "9\n"), "no error");
}

TEST_F(MeshFile, DamagedFilesDoNoHarm) {
    const TriangleMesh good = load("good.obj", kObj);
    for (const auto& [name, bytes] : {std::pair<std::string, std::string>{"d.stl", binaryStl(good)},
                                      {"d.ply", kPly},
                                      {"d.obj", kObj}})
        surviveDamage(
            bytes, [&, file = name](const std::string& damaged) { (void)load(file, damaged); },
            100);
}

TEST_F(MeshFile, RecordsGetTheirContent) {
    std::filesystem::create_directories(folder_ / "chairs");
    writeAll(path("chairs/t.obj"), kObj);
    const Document document = read(
        "mesh file=chairs/t.obj\nmesh file=chairs/t.obj at=1,2\n"
        "mesh file=chairs/t.obj up=y\nmesh file=" +
        path("chairs/t.obj") + "\n");
    ASSERT_NE(document.records[0].mesh(), nullptr);
    EXPECT_EQ(document.records[0].mesh(), document.records[1].mesh()) << "each file once";
    EXPECT_EQ(document.records[0].mesh()->vertices, document.records[2].mesh()->vertices);
    EXPECT_EQ(document.sources, std::vector<std::string>{path("chairs/t.obj")});
    ImportOptions unread;
    unread.load_files = false;
    const Document text = read("mesh file=none.obj\n", unread);
    EXPECT_EQ(text.records[0].mesh(), nullptr);
    EXPECT_TRUE(text.sources.empty());
}

TEST_F(MeshFile, SideFilesAreSources) {
    std::filesystem::create_directories(folder_ / "chairs");
    std::filesystem::create_directories(folder_ / "colours");
    writeAll(path("chairs/t.mtl"), "newmtl red\n");
    writeAll(path("colours/t.mtl"), "newmtl red\n");
    writeAll(path("chairs/inside.obj"), "mtllib t.mtl\n" + kObj);
    writeAll(path("chairs/missing.obj"), "mtllib C:\\somebody\\t.mtl\n" + kObj);
    writeAll(path("chairs/outside.obj"), "mtllib ../colours/t.mtl\n" + kObj);
    using Texts = std::vector<std::string>;
    EXPECT_EQ(read("mesh file=chairs/inside.obj\n").sources,
              (Texts{path("chairs/inside.obj"), path("chairs/t.mtl")}));
    EXPECT_EQ(read("mesh file=chairs/missing.obj\n").sources, Texts{path("chairs/missing.obj")});
    EXPECT_NE(errorsOf([&] {
                  read("mesh file=chairs/outside.obj\n");
              }).find("`../colours/t.mtl`, which lies outside its folder"),
              std::string::npos);
    const Document anywhere = read("mesh file=chairs/outside.obj side_files=anywhere\n");
    EXPECT_EQ(anywhere.sources,
              (Texts{path("chairs/outside.obj"), path("chairs/../colours/t.mtl")}));
    // Where side files may be is no part of what the room is.
    EXPECT_EQ(environmentDigest(anywhere.records),
              environmentDigest(read("mesh file=chairs/inside.obj\n").records));
    // A plan that is cut from a mesh was made of them, too.
    ImportOptions cut;
    cut.slice_walls = 1;
    EXPECT_EQ(readDocument(path("chairs/inside.obj"), cut, sceneSchemas()).sources,
              Texts{path("chairs/t.mtl")});
}

TEST_F(MeshFile, OtherFormatsAreRefusedByName) {
    const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    EXPECT_EQ(errorOf("chair.OFF", off),
              "chair.OFF: error: it is a .off mesh: convert it, for example with `assimp export "
              "FILE chair.obj` or with Blender\n");
    // By content no importer is found that the suffix does not say.
    EXPECT_EQ(errorOf("chair.obj", off).find("chair.obj: error: bad mesh file: "), 0U);
    EXPECT_NE(errorOf("chair", off).find("wanted OBJ, STL, PLY"), std::string::npos);
    EXPECT_EQ(load("chair.txt", kObj).triangles.size(), 4U);
    EXPECT_NE(errorsOf([&] {
                  parseDocument(off, path("chair.off"), {}, sceneSchemas());
              }).find("not an environment or layout but a .off mesh: convert it"),
              std::string::npos);
}

TEST_F(MeshFile, FindingsAreAtTheRecords) {
    writeAll(path("t.obj"), kObj);
    writeAll(path("bad.obj"), "nonsense");
    const std::string digest = read("mesh file=t.obj\n").records[0].mesh()->digest;
    EXPECT_EQ(errorsOf([&] { read("mesh file=t.obj digest=" + digest + "\n"); }), "no error");
    std::string errors = errorsOf([&] {
        read("mesh file=none.obj\nmesh at=1,1 file=bad.obj\nmesh file=t.obj digest=sha256:00\n");
    });
    while (errors.find(folder_.string()) != std::string::npos)
        errors.replace(errors.find(folder_.string()), folder_.string().size(), "F");
    EXPECT_EQ(
        errors.find(
            "F/room.env:2:11: error: mesh file `F/none.obj` cannot be opened: No such file or "
            "directory\nF/room.env:3:18: error: mesh file `F/bad.obj`: bad mesh file: "),
        0U)
        << errors;
    EXPECT_NE(errors.find("F/room.env:4:24: error: mesh file `t.obj` has changed: its digest is " +
                          digest),
              std::string::npos)
        << errors;
}

TEST_F(MeshFile, AsOperand) {
    writeAll(path("My Chair.obj"), kObj);
    ImportOptions options;
    options.units = "cm";
    options.own.edit<UpAxis>().name = "y";
    const Document document = readDocument(path("My Chair.obj"), options, sceneSchemas());
    EXPECT_EQ(writeRecordText(document),
              "#env 1\nmesh id=my-chair file=\"My Chair.obj\" unit=cm up=y\n");
    EXPECT_NE(document.records[0].mesh(), nullptr);
    EXPECT_TRUE(document.sources.empty());
    writeAll(path("bad.ply"), "ply\nformat ascii 1.0\n");
    EXPECT_EQ(errorsOf([&] { readDocument(path("bad.ply"), {}, sceneSchemas()); }),
              path("bad.ply") + ": error: bad mesh file: a PLY header without `end_header`\n");
    EXPECT_NE(errorsOf([&] { parseDocument(kObj, "-", {}, sceneSchemas()); }).find("name its file"),
              std::string::npos);
}

TEST_F(MeshFile, KnownByContentElseBySuffix) {
    const TriangleMesh mesh = load("a.obj", kObj);
    for (const std::string& bytes :
         {kObj, binaryStl(mesh), asciiStl(mesh), kPly, collada("Y_UP", "1"),
          std::string("mtllib a.mtl\ng x\nv 1 2 3\n")})
        EXPECT_TRUE(isMeshFile(bytes)) << bytes.substr(0, 20);
    for (const std::string& bytes :
         {std::string(), std::string("v 1 2 3"), std::string("desk: {v: 1}\nv 1 2\n"),
          std::string("solid ground\n"), std::string("plywood: 1\n")})
        EXPECT_EQ(isMeshFile(bytes), bytes == "v 1 2 3") << bytes;
    EXPECT_TRUE(hasMeshSuffix("a/b.GLTF"));
    EXPECT_FALSE(hasMeshSuffix("a/b.yaml"));
    EXPECT_FALSE(hasMeshSuffix("-"));
}

TEST_F(MeshFile, ToldApartByContent) {
    using namespace std::string_literals;
    ImportOptions unread;
    unread.load_files = false;
    for (const std::string& bytes :
         {"# Blender\nmtllib a.mtl\nv 1 2 3\n"s, "ply\nformat ascii 1.0\n"s,
          "solid x\nfacet normal\n"s, "<?xml?><COLLADA>"s,
          std::string(80, ' ') + "\1\0\0\0"s + std::string(50, '\0')})
        EXPECT_EQ(parseDocument(bytes, "x", unread, sceneSchemas()).records.front().keyword(),
                  "mesh")
            << bytes;
    // Only the suffix tells.
    EXPECT_EQ(
        parseDocument("{\"asset\": {\"version\": \"2.0\"}}", "a/chair.gltf", unread, sceneSchemas())
            .records.front()
            .text("file"),
        "chair.gltf");
}

TEST_F(MeshFile, IsAPlanWhenItIsCut) {
    ImportOptions options;
    const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    EXPECT_FALSE(isPlan(mesh, "room.obj", options, sceneSchemas()));
    options.slice_walls = 1;
    EXPECT_TRUE(isPlan(mesh, "room.obj", options, sceneSchemas()));
}

}  // namespace mesh_file_test
}  // namespace ispace::meshes
