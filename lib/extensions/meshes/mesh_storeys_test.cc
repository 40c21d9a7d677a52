// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes in the rooms of a building.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/file.h"
#include "extensions/meshes/meshes_test.h"
#include "site/storeys.h"
#include "support/test_folder.h"
#include "support/test_import.h"

namespace ispace::meshes {
namespace mesh_storeys_test {

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// A mesh of one triangle on so many nodes: each repetition takes a unit of work.
std::string repeatedTriangle(int nodes) {
    std::string all, list;
    for (int i = 0; i < nodes; ++i) {
        all += std::string(i > 0 ? "," : "") + "{\"mesh\":0}";
        list += (i > 0 ? "," : "") + std::to_string(i);
    }
    return "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[" + list +
           "]}],\"nodes\":[" + all +
           "],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
           "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
           "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],"
           "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
           "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"
           "\"max\":[1,1,0]}]}";
}

TEST(MeshesOfBuildings, AreReadAndPaidForOnce) {
    testing::addMeshesOnce();
    const testing::TestFolder folder;
    const auto write = [&](const std::string& name, const std::string& text) {
        writeAll(folder.file(name), text);
        return folder.file(name);
    };
    const auto house = [&](const std::vector<std::string>& meshes) {
        std::string storeys = "#env 1\n";
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            const std::string file = "r" + std::to_string(i) + ".env";
            write(file, "#env 1\nispace size=8,6\nmesh file=" + meshes[i] + "\n");
            storeys += "storey file=" + file + " z=" + std::to_string(3 * i) + '\n';
        }
        return storeys;
    };
    for (const char* name : {"a.gltf", "b.gltf", "c.gltf"}) write(name, repeatedTriangle(301));
    const std::string name = write("house.env", "");
    ImportOptions options;
    options.max_work.max = 500;
    EXPECT_EQ(readBuilding(house({"a.gltf", "a.gltf", "a.gltf"}), name, options).storeys.size(),
              3U);
    const std::string storeys = house({"a.gltf", "b.gltf", "c.gltf"});
    const std::string error = errorsOf([&] { readBuilding(storeys, name, options); });
    EXPECT_TRUE(contains(error, "r1.env:3:11: error: mesh file")) << error;
    EXPECT_TRUE(contains(error,
                         "b.gltf`: nodes that repeat meshes make more than 500 units of work "
                         "(`--max-work 1000` allows more)"))
        << error;
    EXPECT_FALSE(contains(error, "r2.env")) << error;
    options.max_work.max = 900;
    EXPECT_EQ(readBuilding(storeys, name, options).storeys.size(), 3U);
}

}  // namespace mesh_storeys_test
}  // namespace ispace::meshes
