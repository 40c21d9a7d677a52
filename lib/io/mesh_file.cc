// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh_file.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>
#include <tuple>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "io/import_records.h"
#include "io/side_files.h"

namespace ispace {

namespace {

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
        const std::string path = sideFilePath(operand_, file);
        try {
            MeshOptions options{record.text("up"), record.text("side_files") == "anywhere"};
            std::shared_ptr<const TriangleMesh>& mesh =
                loaded_[{path, options.up, options.side_files_anywhere}];
            if (mesh == nullptr) {
                addSource(path);
                std::vector<std::string> side_files;
                mesh = loadMesh(path, options, &side_files);
                for (const std::string& side : side_files) addSource(side);
            }
            checkDigest(record, *mesh);
            record.setMesh(mesh);
        } catch (const std::system_error& error) {
            addFinding(record, path, " cannot be opened: " + error.code().message());
        } catch (const FormatError& error) {
            addFinding(record, path, ": " + error.diagnostics().front().message);
        }
    }

    /// The place of a finding already names an operand.
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
    std::map<std::tuple<std::string, std::string, bool>, std::shared_ptr<const TriangleMesh>>
        loaded_;
    Diagnostics findings_;
};

}  // namespace

void loadMeshes(Document& document, const std::string& operand) {
    MeshLoader(document, operand).load();
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
