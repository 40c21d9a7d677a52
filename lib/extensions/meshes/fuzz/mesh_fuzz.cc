// SPDX-License-Identifier: GPL-3.0-or-later
// Files of meshes, read by their separate program: for any of its ends the library returns a mesh
// or throws FormatError, and leaves no file. The bytes determine the suffix.
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "extensions/meshes/mesh_parts.h"
#include "extensions/meshes/meshes_test.h"
#include "fuzz.h"
#include "io/mesh_files.h"

namespace {

using namespace ispace;

std::string suffixOf(std::string_view bytes) {
    if (bytes.starts_with("glTF")) return ".glb";
    if (bytes.starts_with("{")) return ".gltf";
    if (bytes.starts_with("<")) return ".dae";
    if (bytes.starts_with("ply")) return ".ply";
    return meshes::meshFormatOf(bytes) == meshes::MeshFormat::Stl || bytes.starts_with("solid")
               ? ".stl"
               : ".obj";
}

std::ptrdiff_t openFiles() {
    const std::filesystem::directory_iterator files("/proc/self/fd");
    return std::distance(begin(files), end(files));
}

void check(const TriangleMesh& mesh) {
    fuzz::require(!mesh.triangles.empty(), "no triangles");
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle)
            fuzz::require(corner < mesh.vertices.size(), "a corner that is no vertex");
    for (const auto& vertex : mesh.vertices)
        for (const float x : vertex) fuzz::require(std::isfinite(x), "a vertex that is no place");
}

std::ptrdiff_t filesBefore() {
    testing::addMeshesOnce();
    // Four vertices, and twelve corners of a byte each.
    constexpr std::array<float, 12> kVertices{0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4};
    std::string bytes(reinterpret_cast<const char*>(kVertices.data()), sizeof kVertices);
    bytes += std::string_view("\0\2\1\0\1\3\0\3\2\1\2\3", 12);
    fuzz::writeFile(fuzz::scratchFolder() + "/side.bin", bytes);
    fuzz::writeFile(fuzz::scratchFolder() + "/side.mtl", "newmtl a\n");
    return openFiles();
}

void readMesh(std::string_view bytes) {
    const std::string file = fuzz::scratchFolder() + "/mesh" + suffixOf(bytes);
    fuzz::writeFile(file, bytes);
    std::vector<std::string> side_files;
    check(*loadMesh(file, {}, &side_files));
    for (const std::string& side : side_files)
        fuzz::require(std::filesystem::is_regular_file(side), "a side file that is none");
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    static const std::ptrdiff_t files_before = filesBefore();
    try {
        readMesh(bytes);
    } catch (const FormatError&) {
        // A refusal leaves as little as a mesh.
    }
    require(openFiles() == files_before, "a file is left open");
    require(::waitpid(-1, nullptr, WNOHANG) < 0 && errno == ECHILD, "a process is left");
}
