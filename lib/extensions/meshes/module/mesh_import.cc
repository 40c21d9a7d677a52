// SPDX-License-Identifier: GPL-3.0-or-later
// read-mesh SUFFIX UP PARENT SIZE MEMORY SECONDS UNITS: reads the mesh on standard input and
// answers by the socket that is standard output, see base/confined.h. Started by meshes.cc alone.
#include "extensions/meshes/module/mesh_import.h"

#include <assimp/BaseImporter.h>
#include <assimp/commonMetaData.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/budget.h"
#include "base/message.h"
#include "base/module/confine.h"
#include "base/number.h"
#include "env/mesh.h"
#include "extensions/meshes/mesh_parts.h"
#include "extensions/meshes/module/handed_files.h"
#include "extensions/meshes/module/plain_gltf.h"
#include "extensions/meshes/module/plain_text.h"
#include "geom/planar_map.h"

// Debian builds assimp with its assertions, which abort the program on some damaged files. This
// function replaces assimp's own of the same name and throws an error, which assimp catches and
// reports like any other.
namespace Assimp {
// NOLINTNEXTLINE(misc-use-internal-linkage)
ASSIMP_API void aiAssertViolation(const char* expression, const char* /*file*/, int /*line*/) {
    throw std::runtime_error(std::string("assimp finds it wrong: ") + expression);
}
}  // namespace Assimp

namespace ispace::meshes {

namespace {

using Vertex = FloatPlace;
using Triangle = std::array<std::uint32_t, 3>;

constexpr std::size_t kMaxWords = 1000;
/// Mesh corners per unit of Budget, for meshes used more than once.
constexpr std::size_t kMeshCornersPerUnit = 8;

[[noreturn]] void fail(const std::string& message) { throw std::runtime_error(message); }

/// Returns assimp's message without the name of the file, which every message has, and the full
/// stop.
std::string assimpsWords(std::string words, const std::string& path) {
    words = words.substr(0, kMaxWords);
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
    return name.starts_with("glTF") || name.starts_with("Collada");
}

/// Merges the meshes of all nodes into one list of triangles.
class Gatherer {
  public:
    Gatherer(const aiScene& scene, bool turn_y_up, Budget& work)
        : scene_(scene), turn_y_up_(turn_y_up) {
        checkSize(work);
    }

    /// All in one.
    TriangleMesh gather() {
        TriangleMesh mesh;
        forEachNode([&](const Place& place) { addTo(mesh, *place.node, place.world_from_node); });
        return mesh;
    }

  private:
    /// To be called before any allocation: instances cost a file few bytes.
    void checkSize(Budget& work) const {
        std::vector<std::pair<const aiNode*, std::size_t>> open{{scene_.mRootNode, 1}};
        std::vector<bool> is_used(scene_.mNumMeshes);
        std::size_t nodes = 0, triangles = 0, vertices = 0;
        while (!open.empty()) {
            const auto [node, depth] = open.back();
            open.pop_back();
            if (++nodes > kMaxMeshNodes)
                fail("more than " + std::to_string(kMaxMeshNodes) + " nodes");
            if (depth > kMaxMeshNodeDepth)
                fail("nodes nested more than " + std::to_string(kMaxMeshNodeDepth) + " deep");
            for (unsigned i = 0; i < node->mNumMeshes; ++i) {
                const aiMesh& part = partOf(*node, i);
                triangles += part.mNumFaces;
                vertices += part.mNumVertices;
                const std::size_t corners = std::size_t{3} * part.mNumFaces + part.mNumVertices;
                if (is_used[node->mMeshes[i]] && !work.take(1 + corners / kMeshCornersPerUnit))
                    throw TooMuchWork("nodes that repeat meshes");
                is_used[node->mMeshes[i]] = true;
            }
            if (triangles > kMaxMeshTriangles || vertices > 3 * kMaxMeshTriangles)
                fail("more than " + std::to_string(kMaxMeshTriangles) + " triangles");
            for (unsigned i = 0; i < node->mNumChildren; ++i)
                open.emplace_back(node->mChildren[i], depth + 1);
        }
    }
    [[nodiscard]] const aiMesh& partOf(const aiNode& node, unsigned i) const {
        if (node.mMeshes[i] >= scene_.mNumMeshes)
            fail("bad mesh file: a part that it does not hold");
        return *scene_.mMeshes[node.mMeshes[i]];
    }

    struct Place {
        const aiNode* node;
        aiMatrix4x4 world_from_node;
    };

    template <typename Visit>
    void forEachNode(Visit visit) {
        // A list instead of recursion: the file decides the depth of nodes.
        std::vector<Place> open{{scene_.mRootNode, scene_.mRootNode->mTransformation}};
        while (!open.empty()) {
            const Place place = open.back();
            open.pop_back();
            visit(place);
            for (unsigned i = place.node->mNumChildren; i > 0; --i) {
                const aiNode* const child = place.node->mChildren[i - 1];
                open.push_back({child, place.world_from_node * child->mTransformation});
            }
        }
    }

    void addTo(TriangleMesh& mesh, const aiNode& node, const aiMatrix4x4& world_from_node) {
        for (unsigned i = 0; i < node.mNumMeshes; ++i) add(mesh, partOf(node, i), world_from_node);
    }

    /// Returns true for a field of view in one of our models.
    [[nodiscard]] bool isView(const aiMesh& part) const {
        aiString name;
        return part.mMaterialIndex < scene_.mNumMaterials &&
               scene_.mMaterials[part.mMaterialIndex]->Get(AI_MATKEY_NAME, name) ==
                   aiReturn_SUCCESS &&
               std::string_view(name.C_Str()) == kViewMaterial;
    }
    void add(TriangleMesh& mesh, const aiMesh& part, const aiMatrix4x4& world_from_mesh) {
        if (isView(part)) return;
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
                    fail("bad mesh file: a corner that it does not hold");
                triangle[k] = first + face.mIndices[k];
            }
            if (mirrored) std::swap(triangle[1], triangle[2]);
            mesh.triangles.push_back(triangle);
        }
    }

    [[nodiscard]] Vertex placed(const aiVector3D& local, const aiMatrix4x4& world_from_mesh) const {
        const aiVector3D p = world_from_mesh * local;
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            fail("bad mesh file: a vertex that is no place (NaN or infinity)");
        // Adding 0 turns -0 into 0, so that equal points have equal bytes.
        return turn_y_up_ ? Vertex{p.x + 0, -p.z + 0, p.y + 0} : Vertex{p.x + 0, p.y + 0, p.z + 0};
    }

    const aiScene& scene_;
    bool turn_y_up_;
};

/// Sorts vertices by their first use in a triangle and removes unused ones.
/// \param standing for each vertex its replacement; empty: all vertices keep themselves
void renumber(TriangleMesh& mesh, const std::vector<std::uint32_t>& standing = {}) {
    constexpr std::uint32_t kNone = UINT32_MAX;
    std::vector<std::uint32_t> index(mesh.vertices.size(), kNone);
    std::vector<Vertex> vertices;
    for (Triangle& triangle : mesh.triangles)
        for (std::uint32_t& corner : triangle) {
            const std::uint32_t vertex = standing.empty() ? corner : standing[corner];
            if (index[vertex] == kNone) {
                index[vertex] = static_cast<std::uint32_t>(vertices.size());
                vertices.push_back(mesh.vertices[vertex]);
            }
            corner = index[vertex];
        }
    mesh.vertices = std::move(vertices);
}

/// Exact enough: products of differences of floats are exact in doubles, so collinear corners of
/// the float grid give zero.
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

/// Equal vertices joined, triangles without area dropped.
void clean(TriangleMesh& mesh) {
    renumber(mesh, firstAtPlace(mesh.vertices));
    std::erase_if(mesh.triangles, [&](const Triangle& t) { return !hasArea(mesh, t); });
    renumber(mesh);  // without those that only dropped triangles used
}

/// One of the suffixes by which assimp knows its importer, without the dot.
std::string suffixOf(MeshFormat format) {
    const auto* const known =
        std::find_if(kMeshSuffixes.begin(), kMeshSuffixes.end(),
                     [format](const MeshSuffix& row) { return row.format == format; });
    return std::string(known->suffix.substr(1));
}

/// Keeps only the importers for this suffix, two for glTF: assimp would try the others on files
/// that these reject.
void leaveOnly(const std::string& suffix, Assimp::Importer& importer) {
    for (std::size_t i = importer.GetImporterCount(); i > 0; --i) {
        Assimp::BaseImporter* const one = importer.GetImporter(i - 1);
        std::set<std::string> suffixes;
        one->GetExtensionList(suffixes);
        if (suffixes.count(suffix) > 0) continue;
        importer.UnregisterLoader(one);
        delete one;
    }
}

}  // namespace

TriangleMesh importMesh(MeshFormat format, std::size_t size, const std::string& up,
                        const std::optional<std::string>& obj_up, Budget& work) {
    Assimp::Importer importer;
    // Materials of OBJ have no say in where triangles are.
    const bool reads_side_files = format == MeshFormat::Gltf || format == MeshFormat::Glb;
    std::optional<PlainGltf> plain;
    if (reads_side_files) {
        HandedFiles buffers(size, suffixOf(format), true);
        plain = plainGltf(
            format, MappedInput(size).bytes(),
            [&buffers](const std::string& uri) { return buffers.read(uri); }, work);
    }
    const std::string suffix = suffixOf(plain ? MeshFormat::Gltf : format);
    leaveOnly(suffix, importer);
    auto files = std::make_unique<HandedFiles>(size, suffix, reads_side_files);
    if (plain) {
        files->hold(files->name(), std::move(plain->json));
        for (auto& [uri, bytes] : plain->buffers) files->hold(uri, std::move(bytes));
    }
    if (auto text = plainMeshText(format, MappedInput(size).bytes()))
        files->hold(files->name(), *std::move(text));
    const std::string name = files->name();
    importer.SetIOHandler(files.release());
    const bool as_is = up != "auto";
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, as_is);
    const aiScene* const scene =
        importer.ReadFile(name, aiProcess_Triangulate | aiProcess_ValidateDataStructure);
    if (scene == nullptr || scene->mRootNode == nullptr)
        fail("bad mesh file: it cannot be read as " + suffix + " (assimp says: " +
             assimpsWords(importer.GetErrorString(), name) + "); is it damaged?");
    Gatherer gatherer(*scene, !as_is && (obj_up == "y" || comesWithYUp(*scene)), work);
    TriangleMesh mesh = gatherer.gather();
    clean(mesh);
    return mesh;
}

}  // namespace ispace::meshes

namespace {

using namespace ispace;

/// Properties of a mesh file found before assimp reads it.
struct MeshHead {
    meshes::MeshFormat format;
    std::optional<std::string> obj_up;
};

MeshHead checkedHead(std::size_t size, const std::string& suffix) {
    const MappedInput input(size);
    MeshHead head{meshes::meshFormat(input.bytes(), suffix), {}};
    meshes::checkMesh(head.format, input.bytes());
    if (head.format == meshes::MeshFormat::Obj) head.obj_up = meshes::objUpComment(input.bytes());
    return head;
}

std::string answer(const std::string& suffix, const std::string& up, std::size_t size,
                   Budget& work) {
    const MeshHead head = checkedHead(size, suffix);
    return packedMesh(meshes::importMesh(head.format, size, up, head.obj_up, work));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 9) return 2;
    return runConfined(argc, argv, meshLimits(SIZE_MAX), [argv](auto size, Budget& work) {
        return answer(argv[1], argv[2], size, work);
    });
}
