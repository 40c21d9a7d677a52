// SPDX-License-Identifier: GPL-3.0-or-later
// fuzz_seeds FOLDER ENV...: writes the fuzzers' seeds that would go stale in a file:
// FOLDER/words.dict, the keywords and keys of the schemas, and FOLDER/glb/*.glb, compiled rooms.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <set>
#include <string>

#include "base/file.h"
#include "extensions.h"
#include "io/glb/glb_read.h"
#include "io/importers.h"
#include "record/text.h"
#include "scene/placement_schemas.h"

namespace {

using namespace ispace;

std::string dictionary() {
    std::set<std::string> words;
    for (const Schema& schema : sceneSchemas().all()) {
        words.insert(schema.keyword);
        for (const KeySpec& key : schema.keys) {
            words.insert(key.name);
            words.insert(key.choices.begin(), key.choices.end());
        }
    }
    std::string text;
    for (const std::string& word : words) text += '"' + word + "\"\n";
    return text;
}

/// Something to be in a file for each `mesh` record.
std::shared_ptr<const TriangleMesh> tetrahedron() {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh->triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    mesh->digest = meshDigest(*mesh);
    return mesh;
}

void compile(const std::string& file, const std::string& folder) {
    ImportOptions options;
    options.load_files = false;
    Document document = readDocument(file, options, sceneSchemas());
    for (Record& record : document.records)
        if (record.keyword() == "mesh") record.setMesh(tetrahedron());
    const Scene scene = makeScene(document, nullptr, DeviceCatalogue());
    writeAll(folder + '/' + std::filesystem::path(file).stem().string() + ".glb",
             writeGlb(scene, document));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    try {
        const std::string folder = argv[1];
        static_cast<void>(extensions());
        std::filesystem::create_directories(folder + "/glb");
        writeAll(folder + "/words.dict", dictionary());
        for (int i = 2; i < argc; ++i) compile(argv[i], folder + "/glb");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "fuzz_seeds: %s\n", error.what());
        return 1;
    }
    return 0;
}
