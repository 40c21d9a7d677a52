// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh_load.h"

#include <assimp/commonMetaData.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "base/utf8.h"
#include "env/material.h"
#include "record/digest.h"

// Debian builds assimp with its assertions, which abort the program on some damaged files. This
// stands before assimp's own function of the same name and makes an error of them, which assimp
// catches and reports as any other.
namespace Assimp {
// NOLINTNEXTLINE(misc-use-internal-linkage)
ASSIMP_API void aiAssertViolation(const char* expression, const char* /*file*/, int /*line*/) {
    throw std::runtime_error(std::string("assimp finds it wrong: ") + expression);
}
}  // namespace Assimp

namespace ispace {

namespace {

using Vertex = std::array<float, 3>;
using Triangle = std::array<std::uint32_t, 3>;

[[noreturn]] void fail(const std::string& path, const std::string& message) {
    throw FormatError(Diagnostic{path, 0, 0, message});
}

/// Throws if the file cannot be read: assimp does not say why.
void checkReadable(const std::string& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error))
        throw std::system_error(std::make_error_code(std::errc::is_a_directory), path);
    if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
        fail(path, "it is no regular file");  // devices and pipes may have no end
    errno = 0;
    if (!std::ifstream(path, std::ios::binary))
        throw std::system_error(errno != 0 ? errno : EIO, std::generic_category(), path);
}

/// Throws for headers of PLY on which assimp 5.2 never ends (cut off before `end_header`), or for
/// which it would allocate whatever they say: an element takes a byte of the file at least.
void checkPlyHeader(const std::string& path) {
    std::string start(1 << 20, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(file.gcount()));
    if (!start.starts_with("ply")) return;
    const std::uintmax_t size = std::filesystem::file_size(path);
    std::istringstream header(start);
    for (std::string line; std::getline(header, line) && !header.eof();) {
        std::istringstream words(line);
        std::string word, name, count;
        words >> word >> name >> count;
        if (word == "end_header") return;
        const auto number = parseInteger(count);
        if (word == "element" &&
            (!number || *number < 0 || static_cast<std::uintmax_t>(*number) > size))
            fail(path, "bad mesh file: " + excerpt(count) + " elements " + excerpt(name) + " in " +
                           std::to_string(size) + " bytes");
    }
    fail(path, "bad mesh file: a PLY header without `end_header`");
}

/// What assimp says, without the name of the file, which every message has, and the full stop.
std::string assimpsWords(std::string words, const std::string& path) {
    for (const std::string& part : {" of file \"" + path + '"', " for " + path})
        if (const std::size_t at = words.find(part); at != std::string::npos)
            words.erase(at, part.size());
    while (words.ends_with('.') || words.ends_with(' ') || words.ends_with('\n')) words.pop_back();
    return printable(words);
}

/// Formats that assimp gives with y upwards.
bool comesWithYUp(const aiScene& scene) {
    aiString format;
    if (scene.mMetaData == nullptr || !scene.mMetaData->Get(AI_METADATA_SOURCE_FORMAT, format))
        return false;
    const std::string_view name = format.C_Str();
    return name.starts_with("glTF") || name.starts_with("Collada") ||
           name.starts_with("Industry Foundation Classes");
}

/// Puts the meshes of all nodes into one list of triangles.
class Gatherer {
  public:
    Gatherer(const aiScene& scene, const std::string& path, bool turn_y_up)
        : scene_(scene), path_(path), turn_y_up_(turn_y_up) {}

    /// All in one.
    TriangleMesh gather() {
        TriangleMesh mesh;
        forEachNode([&](const Place& place) { addTo(mesh, *place.node, place.world_from_node); });
        return mesh;
    }

    /// Each node's by itself.
    std::vector<MeshPart> gatherParts() {
        std::vector<MeshPart> parts;
        forEachNode([&](const Place& place) {
            if (place.node->mNumMeshes == 0) return;
            MeshPart& part = parts.emplace_back();
            for (const aiNode* node = place.node; node != nullptr; node = node->mParent)
                part.nodes.push_back({node->mName.C_Str(), heights_.at(node)});
            addTo(part.mesh, *place.node, place.world_from_node);
        });
        return parts;
    }

  private:
    struct Place {
        const aiNode* node;
        aiMatrix4x4 world_from_node;
    };

    template <typename Visit>
    void forEachNode(Visit visit) {
        // A list instead of recursion: how deep nodes lie in each other is the file's choice.
        std::vector<Place> open{{scene_.mRootNode, scene_.mRootNode->mTransformation}};
        while (!open.empty()) {
            const Place place = open.back();
            open.pop_back();
            heights_[place.node] = placed({}, place.world_from_node)[2];
            visit(place);
            for (unsigned i = place.node->mNumChildren; i > 0; --i) {
                const aiNode* const child = place.node->mChildren[i - 1];
                open.push_back({child, place.world_from_node * child->mTransformation});
            }
        }
    }

    void addTo(TriangleMesh& mesh, const aiNode& node, const aiMatrix4x4& world_from_node) {
        for (unsigned i = 0; i < node.mNumMeshes; ++i) add(mesh, node.mMeshes[i], world_from_node);
    }

    /// What a sensor looks at, in a model of ours.
    [[nodiscard]] bool isView(const aiMesh& part) const {
        aiString name;
        return part.mMaterialIndex < scene_.mNumMaterials &&
               scene_.mMaterials[part.mMaterialIndex]->Get(AI_MATKEY_NAME, name) ==
                   aiReturn_SUCCESS &&
               std::string_view(name.C_Str()) == kViewMaterial;
    }
    void add(TriangleMesh& mesh, unsigned index, const aiMatrix4x4& world_from_mesh) {
        if (index >= scene_.mNumMeshes) fail(path_, "bad mesh file: a part that it does not hold");
        const aiMesh& part = *scene_.mMeshes[index];
        if (isView(part)) return;
        if (mesh.triangles.size() + part.mNumFaces > kMaxMeshTriangles ||
            mesh.vertices.size() + part.mNumVertices > 3 * kMaxMeshTriangles)
            fail(path_, "more than " + std::to_string(kMaxMeshTriangles) + " triangles");
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (unsigned i = 0; i < part.mNumVertices; ++i)
            mesh.vertices.push_back(placed(part.mVertices[i], world_from_mesh));
        const bool mirrored = world_from_mesh.Determinant() < 0;
        for (unsigned i = 0; i < part.mNumFaces; ++i) {
            const aiFace& face = part.mFaces[i];
            if (face.mNumIndices != 3) continue;  // points and lines
            Triangle triangle{};
            for (std::size_t k = 0; k < 3; ++k) {
                if (face.mIndices[k] >= part.mNumVertices)
                    fail(path_, "bad mesh file: a corner that it does not hold");
                triangle[k] = first + face.mIndices[k];
            }
            if (mirrored) std::swap(triangle[1], triangle[2]);
            mesh.triangles.push_back(triangle);
        }
    }

    [[nodiscard]] Vertex placed(const aiVector3D& local, const aiMatrix4x4& world_from_mesh) const {
        const aiVector3D p = world_from_mesh * local;
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            fail(path_, "bad mesh file: a vertex that is no place (NaN or infinity)");
        // Adding 0 makes 0 of -0, so that equal places have equal bytes.
        return turn_y_up_ ? Vertex{p.x + 0, -p.z + 0, p.y + 0} : Vertex{p.x + 0, p.y + 0, p.z + 0};
    }

    const aiScene& scene_;
    const std::string& path_;
    bool turn_y_up_;
    std::map<const aiNode*, double> heights_;
};

/// Vertices of the same place become one, in the order of their first use by a triangle; those
/// that none uses are dropped.
void joinVertices(TriangleMesh& mesh) {
    std::vector<std::uint32_t> order(mesh.vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t k) {
        return mesh.vertices[i] == mesh.vertices[k] ? i < k : mesh.vertices[i] < mesh.vertices[k];
    });
    std::vector<std::uint32_t> standing(order.size());  // for each vertex
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool repeats = i > 0 && mesh.vertices[order[i]] == mesh.vertices[order[i - 1]];
        standing[order[i]] = repeats ? standing[order[i - 1]] : order[i];
    }
    constexpr std::uint32_t kNone = UINT32_MAX;
    std::vector<std::uint32_t> index(order.size(), kNone);
    std::vector<Vertex> vertices;
    for (Triangle& triangle : mesh.triangles)
        for (std::uint32_t& corner : triangle) {
            const std::uint32_t vertex = standing[corner];
            if (index[vertex] == kNone) {
                index[vertex] = static_cast<std::uint32_t>(vertices.size());
                vertices.push_back(mesh.vertices[vertex]);
            }
            corner = index[vertex];
        }
    mesh.vertices = std::move(vertices);
}

/// Exact enough: products of differences of floats in doubles vanish where corners lie on a line
/// of the float grid.
bool hasArea(const TriangleMesh& mesh, const Triangle& triangle) {
    const auto& [i, j, k] = triangle;
    if (i == j || j == k || k == i) return false;
    const auto corner = [&](std::uint32_t vertex) {
        const auto [x, y, z] = mesh.vertices[vertex];
        return std::array<double, 3>{x, y, z};
    };
    const auto a = corner(i), b = corner(j), c = corner(k);
    const std::array<double, 3> u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const std::array<double, 3> v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    return u[1] * v[2] != u[2] * v[1] || u[2] * v[0] != u[0] * v[2] || u[0] * v[1] != u[1] * v[0];
}

/// Calls read(Gatherer&) while the file is open.
template <typename Read>
void withGatherer(const std::string& path, const std::string& up, Read read) {
    checkReadable(path);
    checkPlyHeader(path);
    Assimp::Importer importer;
    const bool as_is = up != "auto";
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, as_is);
    const aiScene* scene =
        importer.ReadFile(path, aiProcess_Triangulate | aiProcess_ValidateDataStructure);
    if (scene == nullptr || scene->mRootNode == nullptr)
        fail(path, "bad mesh file: " + assimpsWords(importer.GetErrorString(), path));
    Gatherer gatherer(*scene, path, !as_is && comesWithYUp(*scene));
    read(gatherer);
}

/// Equal vertices joined, triangles without area dropped.
void clean(TriangleMesh& mesh) {
    joinVertices(mesh);
    std::erase_if(mesh.triangles, [&](const Triangle& t) { return !hasArea(mesh, t); });
    joinVertices(mesh);  // without those that only dropped triangles used
}

}  // namespace

std::shared_ptr<const TriangleMesh> loadMesh(const std::string& path, const std::string& up) {
    auto mesh = std::make_shared<TriangleMesh>();
    withGatherer(path, up, [&](Gatherer& gatherer) { *mesh = gatherer.gather(); });
    clean(*mesh);
    if (mesh->triangles.empty()) fail(path, "a mesh file without triangles");
    mesh->digest = meshDigest(*mesh);
    return mesh;
}

std::vector<MeshPart> loadMeshParts(const std::string& path, const std::string& up) {
    std::vector<MeshPart> parts;
    withGatherer(path, up, [&](Gatherer& gatherer) { parts = gatherer.gatherParts(); });
    for (MeshPart& part : parts) clean(part.mesh);
    std::erase_if(parts, [](const MeshPart& part) { return part.mesh.triangles.empty(); });
    if (parts.empty()) fail(path, "a mesh file without triangles");
    return parts;
}

}  // namespace ispace
