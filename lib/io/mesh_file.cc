// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh_file.h"

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
#include "io/import_records.h"
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
    while (words.ends_with('.')) words.pop_back();
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

/// Puts the meshes of all nodes into one list of triangles.
class Gatherer {
  public:
    Gatherer(const aiScene& scene, const std::string& path, bool turn_y_up)
        : scene_(scene), path_(path), turn_y_up_(turn_y_up) {}

    TriangleMesh gather() {
        // A list instead of recursion: how deep nodes lie in each other is the file's choice.
        std::vector<std::pair<const aiNode*, aiMatrix4x4>> open{{scene_.mRootNode, {}}};
        while (!open.empty()) {
            const auto [node, outer] = open.back();
            open.pop_back();
            const aiMatrix4x4 world_from_node = outer * node->mTransformation;
            for (unsigned i = 0; i < node->mNumMeshes; ++i) add(node->mMeshes[i], world_from_node);
            for (unsigned i = node->mNumChildren; i > 0; --i)
                open.emplace_back(node->mChildren[i - 1], world_from_node);
        }
        return std::move(mesh_);
    }

  private:
    /// What a sensor looks at, in a model of ours.
    [[nodiscard]] bool isView(const aiMesh& part) const {
        aiString name;
        return part.mMaterialIndex < scene_.mNumMaterials &&
               scene_.mMaterials[part.mMaterialIndex]->Get(AI_MATKEY_NAME, name) ==
                   aiReturn_SUCCESS &&
               std::string_view(name.C_Str()) == kViewMaterial;
    }
    void add(unsigned index, const aiMatrix4x4& world_from_mesh) {
        if (index >= scene_.mNumMeshes) fail(path_, "bad mesh file: a part that it does not hold");
        const aiMesh& part = *scene_.mMeshes[index];
        if (isView(part)) return;
        if (mesh_.triangles.size() + part.mNumFaces > kMaxMeshTriangles ||
            mesh_.vertices.size() + part.mNumVertices > 3 * kMaxMeshTriangles)
            fail(path_, "more than " + std::to_string(kMaxMeshTriangles) + " triangles");
        const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
        for (unsigned i = 0; i < part.mNumVertices; ++i)
            mesh_.vertices.push_back(placed(part.mVertices[i], world_from_mesh));
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
            mesh_.triangles.push_back(triangle);
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
    TriangleMesh mesh_;
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

std::string folderOf(const std::string& operand) {
    return operand == "-" ? "" : std::filesystem::path(operand).parent_path().string();
}

/// "No such file or directory" of an error that names the file, too.
std::string reasonOf(const std::system_error& error) { return error.code().message(); }

/// Loads files, each once.
class MeshLoader {
  public:
    MeshLoader(Document& document, const std::string& operand)
        : document_(document), operand_(operand) {}

    void load() {
        for (Record& record : document_.records)
            if (record.keyword() == "mesh" && record.mesh() == nullptr) load(record);
        findings_.throwIfAny();
    }

  private:
    void load(Record& record) {
        const std::string& file = record.text("file");
        const std::string path = (std::filesystem::path(folderOf(operand_)) / file).string();
        try {
            std::shared_ptr<const TriangleMesh>& mesh = loaded_[{path, record.text("up")}];
            if (mesh == nullptr) {
                addSource(path);
                mesh = loadMesh(path, record.text("up"));
            }
            checkDigest(record, *mesh);
            record.setMesh(mesh);
        } catch (const std::system_error& error) {
            addFinding(record, path, " cannot be opened: " + reasonOf(error));
        } catch (const FormatError& error) {
            addFinding(record, path, ": " + error.diagnostics().front().message);
        }
    }

    /// An operand is named by the finding's place already.
    void addFinding(const Record& record, const std::string& path, const std::string& what) {
        const bool is_operand = path == operand_ && what.starts_with(": ");
        findings_.add(record.finding(
            "file", is_operand ? what.substr(2) : "mesh file `" + printable(path) + '`' + what));
    }

    void checkDigest(const Record& record, const TriangleMesh& mesh) {
        if (!record.has("digest") || record.text("digest") == mesh.digest) return;
        findings_.add(record.finding("digest", "mesh file `" + printable(record.text("file")) +
                                                   '`' + " has changed: its digest is " +
                                                   mesh.digest +
                                                   "; leave `digest` out to take it as it is"));
    }

    void addSource(const std::string& path) {
        std::vector<std::string>& sources = document_.sources;
        if (path != operand_ && std::find(sources.begin(), sources.end(), path) == sources.end())
            sources.push_back(path);
    }

    Document& document_;
    const std::string& operand_;
    std::map<std::pair<std::string, std::string>, std::shared_ptr<const TriangleMesh>> loaded_;
    Diagnostics findings_;
};

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

std::shared_ptr<const TriangleMesh> loadMesh(const std::string& path, const std::string& up) {
    checkReadable(path);
    checkPlyHeader(path);
    Assimp::Importer importer;
    const bool as_is = up != "auto";
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, as_is);
    const aiScene* scene =
        importer.ReadFile(path, aiProcess_Triangulate | aiProcess_ValidateDataStructure);
    if (scene == nullptr || scene->mRootNode == nullptr)
        fail(path, "bad mesh file: " + assimpsWords(importer.GetErrorString(), path));
    auto mesh = std::make_shared<TriangleMesh>(
        Gatherer(*scene, path, !as_is && comesWithYUp(*scene)).gather());
    importer.FreeScene();
    joinVertices(*mesh);
    std::erase_if(mesh->triangles, [&](const Triangle& t) { return !hasArea(*mesh, t); });
    if (mesh->triangles.empty()) fail(path, "a mesh file without triangles");
    joinVertices(*mesh);  // without those that only dropped triangles used
    mesh->digest = meshDigest(*mesh);
    return mesh;
}

void loadMeshes(Document& document, const std::string& operand) {
    MeshLoader(document, operand).load();
}

bool isMeshFile(std::string_view bytes) {
    const std::string_view start = bytes.substr(0, 4096);
    if (start.starts_with("ply\n") || start.starts_with("ply\r")) return true;
    if (start.starts_with("solid") && start.find("facet") != std::string_view::npos) return true;
    if (start.find("<COLLADA") != std::string_view::npos) return true;
    return isBinaryStl(bytes) || isObj(bytes);
}

bool hasMeshSuffix(const std::string& operand) {
    constexpr std::array<std::string_view, 9> kSuffixes{".obj", ".stl", ".ply", ".dae", ".gltf",
                                                        ".3ds", ".fbx", ".off", ".x3d"};
    std::string suffix = std::filesystem::path(operand).extension().string();
    for (char& c : suffix)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return std::find(kSuffixes.begin(), kSuffixes.end(), suffix) != kSuffixes.end();
}

Document meshDocument(const std::string& operand, const ImportOptions& options,
                      const Schemas& schemas) {
    if (operand == "-")
        throw FormatError(Diagnostic{displayName(operand), 0, 0,
                                     "a mesh on standard input: name its file instead, so that "
                                     "records can refer to it"});
    ImportRecords out(schemas, operand, options);
    Record& record = out.add("mesh", 0);
    const std::filesystem::path path(operand);
    record.set("id", out.freeId(path.stem().string(), "mesh"));
    record.set("file", path.filename().string());
    if (!options.units.empty()) record.set("unit", options.units);
    record.set("up", options.up);
    return out.take();
}

}  // namespace ispace
