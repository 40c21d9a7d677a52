// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the reader of a mesh file, and reads each file once for all records that name it. A file
// that failed fails again with the same error, without being read.
#include "io/mesh_files.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "io/exporters.h"
#include "record/text.h"

namespace ispace {

namespace {

std::vector<MeshReader>& addedReaders() {
    static std::vector<MeshReader> readers;
    return readers;
}

/// Reads the first bytes of a file, whose position stays.
std::string startOf(const RegularFile& main) {
    std::string start(std::min(main.size, kMeshStart), '\0');
    std::size_t size = 0;
    while (size < start.size()) {
        const ssize_t taken = ::pread(main.file.fd(), start.data() + size, start.size() - size,
                                      static_cast<off_t>(size));
        if (taken < 0 && errno == EINTR) continue;
        if (taken <= 0) break;
        size += static_cast<std::size_t>(taken);
    }
    start.resize(size);
    return start;
}

/// Finds the reader of a file. \throws FormatError if there is none
const MeshReader& readerOf(const std::string& path, const RegularFile& main) {
    const std::string start = startOf(main);
    const std::vector<MeshReader>& readers = addedReaders();
    auto found = std::find_if(readers.begin(), readers.end(), [&start](const MeshReader& reader) {
        return reader.recognises != nullptr && reader.recognises(start);
    });
    if (found == readers.end())
        found = std::find_if(readers.begin(), readers.end(),
                             [](const MeshReader& reader) { return reader.recognises == nullptr; });
    if (found != readers.end()) return *found;
    const std::string lacks = missingReader(start, path);
    failFile(path, lacks.empty() ? "this build has no extension that reads it as a mesh" : lacks);
}

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

void addMeshReaders(std::span<const MeshReader> readers) {
    addedReaders().insert(addedReaders().end(), readers.begin(), readers.end());
}

bool hasMeshSuffix(const std::string& file) {
    const std::string suffix = fileSuffix(file);
    return std::any_of(
        addedReaders().begin(), addedReaders().end(), [&suffix](const MeshReader& reader) {
            return std::find(reader.suffixes.begin(), reader.suffixes.end(), suffix) !=
                   reader.suffixes.end();
        });
}

std::string fileSuffix(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    for (char& c : suffix)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return suffix;
}

std::string foreignMesh(const std::string& path) {
    constexpr std::array<std::string_view, 11> kSuffixes{
        ".3ds", ".3mf", ".amf", ".blend", ".fbx", ".lwo", ".ms3d", ".off", ".wrl", ".x", ".x3d"};
    const std::string suffix = fileSuffix(path);
    if (std::find(kSuffixes.begin(), kSuffixes.end(), suffix) == kSuffixes.end()) return "";
    const std::string stem = printable(std::filesystem::path(path).stem().string());
    return "a " + suffix + " mesh: convert it, for example with `assimp export FILE " + stem +
           ".obj` or with Blender";
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
    Budget work(main.size, options.max_work);
    auto mesh = std::make_shared<TriangleMesh>(
        readerOf(path, main).read({path, main, options, work, open}));
    if (mesh->triangles.empty()) failFile(path, "a mesh file without triangles");
    mesh->digest = meshDigest(*mesh);
    return mesh;
}

}  // namespace ispace
