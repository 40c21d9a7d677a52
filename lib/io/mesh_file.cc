// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/utf8.h"
#include "io/import_records.h"

namespace ispace {

namespace {

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
