// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh_format.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>

#include "base/message.h"

namespace ispace {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

/// The first line of OBJ is a statement, behind comments; some line is a vertex.
bool isObj(std::string_view bytes) {
    constexpr std::array<std::string_view, 11> kStatements{"mtllib", "usemtl", "o",  "g", "s", "v",
                                                           "vn",     "vt",     "vp", "f", "l"};
    const bool has_vertex = bytes.starts_with("v ") || bytes.find("\nv ") != std::string_view::npos;
    while (has_vertex && !bytes.empty()) {
        const std::string_view line = bytes.substr(0, bytes.find('\n'));
        bytes.remove_prefix(std::min(line.size() + 1, bytes.size()));
        const std::size_t begin = line.find_first_not_of(kBlanks);
        if (begin == std::string_view::npos || line[begin] == '#') continue;
        const std::string_view word =
            line.substr(begin, line.find_first_of(kBlanks, begin) - begin);
        return std::find(kStatements.begin(), kStatements.end(), word) != kStatements.end();
    }
    return false;
}

bool isBinaryStl(std::string_view bytes) {
    constexpr std::size_t kHeader = 84, kTriangle = 50;
    if (bytes.size() < kHeader + kTriangle) return false;
    std::size_t count = 0;
    for (std::size_t i = 4; i > 0; --i)
        count = count * 256 + static_cast<unsigned char>(bytes[80 + i - 1]);
    return bytes.size() == kHeader + count * kTriangle;
}

}  // namespace

std::optional<MeshFormat> meshFormatOf(std::string_view bytes) {
    const std::string_view start = bytes.substr(0, 4096);
    if (start.starts_with("ply\n") || start.starts_with("ply\r")) return MeshFormat::Ply;
    if (start.starts_with("solid") && start.find("facet") != std::string_view::npos)
        return MeshFormat::Stl;
    if (start.find("<COLLADA") != std::string_view::npos) return MeshFormat::Collada;
    if (isBinaryStl(bytes)) return MeshFormat::Stl;
    if (isObj(bytes)) return MeshFormat::Obj;
    return std::nullopt;
}

bool isMeshFile(std::string_view bytes) { return meshFormatOf(bytes).has_value(); }

bool hasMeshSuffix(const std::string& operand) {
    constexpr std::array<std::string_view, 5> kSuffixes{".obj", ".stl", ".ply", ".dae", ".gltf"};
    return std::find(kSuffixes.begin(), kSuffixes.end(), meshSuffix(operand)) != kSuffixes.end();
}

std::string meshSuffix(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    for (char& c : suffix)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return suffix;
}

std::string foreignMesh(const std::string& path) {
    constexpr std::array<std::string_view, 11> kSuffixes{
        ".3ds", ".3mf", ".amf", ".blend", ".fbx", ".lwo", ".ms3d", ".off", ".wrl", ".x", ".x3d"};
    const std::string suffix = meshSuffix(path);
    if (std::find(kSuffixes.begin(), kSuffixes.end(), suffix) == kSuffixes.end()) return "";
    const std::string stem = printable(std::filesystem::path(path).stem().string());
    return "a " + suffix + " mesh: convert it, for example with `assimp export FILE " + stem +
           ".obj` or with Blender";
}

}  // namespace ispace
