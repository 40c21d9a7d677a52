// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh/mesh_file.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/confined.h"
#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "io/exporters.h"
#include "io/ifc/building.h"
#include "io/import_records.h"
#include "io/mesh/mesh_parts.h"
#include "record/text.h"

namespace ispace {

namespace {

/// Loads files, each once.
class MeshLoader {
  public:
    MeshLoader(Document& document, const std::string& operand, const ImportOptions& options)
        : document_(document),
          operand_(operand),
          files_(options.meshes != nullptr ? *options.meshes : own_files_),
          limit_(options.max_work),
          work_(0, limit_) {}

    void load() {
        for (Record& record : document_.records)
            if (record.keyword() == "mesh" && record.mesh() == nullptr) load(record);
        findings_.throwIfAny();
    }

  private:
    void load(Record& record) {
        const std::string& file = record.text("file");
        const std::string path = sideFilePath(operand_, file);
        try {
            if (std::find(document_.sources.begin(), document_.sources.end(), path) ==
                document_.sources.end()) {
                const std::size_t bytes = openRegular(path).size;
                work_.grant(bytes);
                if (limit_.whole != nullptr) limit_.whole->grant(bytes);
                addSource(path);
            }
            const auto& [mesh, side_files] = files_.load(
                path,
                {record.text("up"), record.text("side_files") == "anywhere", {limit_.max, &work_}});
            for (const std::string& side : side_files) addSource(side);
            checkDigest(record, *mesh);
            record.setMesh(mesh);
        } catch (const std::system_error& error) {
            addFinding(record, path, " cannot be opened: " + error.code().message());
        } catch (const FormatError& error) {
            addFinding(record, path, ": " + error.diagnostics().front().message);
        }
    }

    /// A finding already names the operand and the line.
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
    MeshFiles own_files_;
    MeshFiles& files_;
    WorkLimit limit_;
    Budget work_;  // of all files
    Diagnostics findings_;
};

}  // namespace

const MeshFiles::Loaded& MeshFiles::load(const std::string& path, const MeshOptions& options) {
    std::error_code ignored;
    const std::filesystem::path file(path);
    const auto [known, is_new] =
        files_.try_emplace({std::filesystem::weakly_canonical(file, ignored).string(),
                            std::filesystem::weakly_canonical(file.parent_path(), ignored).string(),
                            options.up, options.side_files_anywhere});
    File& found = known->second;
    if (is_new) try {
            found.loaded.mesh = loadMesh(path, options, &found.loaded.side_files);
        } catch (...) {
            found.failure = std::current_exception();
        }
    if (found.failure) std::rethrow_exception(found.failure);
    return found.loaded;
}

void loadMeshes(Document& document, const std::string& operand, const ImportOptions& options) {
    MeshLoader(document, operand, options).load();
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

std::shared_ptr<const TriangleMesh> loadMesh(const std::string& path, const MeshOptions& options,
                                             std::vector<std::string>* side_files) {
    if (const std::string what = foreignMesh(path); !what.empty()) failFile(path, "it is " + what);
    const RegularFile main = openRegular(path);
    std::set<std::string> opened;
    const auto open = [&](const std::string& name) {
        auto file = openSideFile(path, name, options.side_files_anywhere);
        const std::string side = sideFilePath(path, name);
        if (file && side_files != nullptr && opened.insert(side).second)
            side_files->push_back(side);
        return file;
    };
    const auto limits = [](std::size_t bytes) { return meshLimits(bytes, false); };
    Budget work(main.size, options.max_work);
    auto mesh = std::make_shared<TriangleMesh>(
        unpackedMesh(readConfined({.name = path,
                                   .program = "read-mesh",
                                   .arguments = {meshSuffix(path), options.up, "mesh"},
                                   .file = main.file.fd(),
                                   .bytes = main.size,
                                   .limits = limits,
                                   .open = open,
                                   .work = &work,
                                   .kind = "mesh file",
                                   .reader = "assimp",
                                   .subject = "meshes are",
                                   .hint = "; is it installed, with assimp?"}),
                     path));
    if (mesh->triangles.empty()) failFile(path, "a mesh file without triangles");
    mesh->digest = meshDigest(*mesh);
    return mesh;
}

Building readBuildingInChild(std::string_view bytes, const std::string& name,
                             std::optional<double> slice, Budget& work) {
    const OpenFile copy = fileInMemory(bytes);
    const std::string answer = readConfined(
        {.name = name,
         .program = "read-mesh",
         .arguments = {meshSuffix(name), slice ? formatDouble(*slice) : "", "building"},
         .file = copy.fd(),
         .bytes = bytes.size(),
         .limits = [](std::size_t size) { return meshLimits(size, true); },
         .work = &work,
         .kind = "IFC file",
         .reader = "its reader",
         .subject = "buildings are",
         .hint = "; is it installed, with assimp?"});
    try {
        return unpackedBuilding(answer);
    } catch (const std::runtime_error& error) {
        failFile(name, std::string("bad IFC file: ") + error.what());
    }
}

}  // namespace ispace
