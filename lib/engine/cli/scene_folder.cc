// SPDX-License-Identifier: GPL-3.0-or-later
// Clients name files of one folder and no others: names are resolved first, links included, and
// readers enforce the same by a fence (InputSandbox, in this process). Messages do not tell whether
// a file exists elsewhere, and quote no file that is not a scene.
#include "cli/scene_folder.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/run_files.h"
#include "cli/common_options.h"
#include "io/importers.h"
#include "record/text.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

// Does not reveal whether a file exists elsewhere.
constexpr const char* kNone = "there is no such file in the folder that clients may read";

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
    throw FormatError({name, 0, 0, why});
}

/// \throws std::system_error naming it if it is no folder
std::string canonicalFolder(const std::string& folder) {
    std::error_code error;
    const fs::path place = fs::canonical(folder, error);
    if (!error && !fs::is_directory(place)) error.assign(ENOTDIR, std::generic_category());
    if (error) throw std::system_error(error, folder);
    return place.string();
}

void replaceAll(std::string& text, const std::string& old, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(old, at)) != std::string::npos; at += by.size())
        text.replace(at, old.size(), by);
}

bool beginsAsRecords(const std::string& file) {
    try {
        std::string bytes;
        InputFile input(file);
        static_cast<void>(input.read(bytes));
        return isRecordText(bytes);
    } catch (const std::system_error&) {
        return false;
    }
}

/// Converts names in texts for clients, which may not know the folder's path.
class ClientNames {
  public:
    explicit ClientNames(const std::string& folder) : folder_(folder) {}
    /// A file that the client has named.
    void add(const std::string& path, const std::string& written) {
        names_.emplace_back(path, written);
    }
    [[nodiscard]] std::string in(std::string text) const {
        for (const auto& [path, written] : names_) replaceAll(text, path, written);
        replaceAll(text, folder_ == "/" ? folder_ : folder_ + "/", "");
        return text;
    }
    /// Removes quotations of files that are no scene. \pre the fence stands
    [[nodiscard]] FormatError in(const FormatError& error) const {
        constexpr const char* kHidden =
            "this file cannot be used: envc --check may say why; what it names must lie in the "
            "folder that clients may read, too";
        std::vector<Diagnostic> findings = error.diagnostics();
        for (Diagnostic& finding : findings) {
            // The text of a request has no file.
            const bool tells =
                !fs::path(finding.file).is_absolute() || beginsAsRecords(finding.file);
            finding.message = tells ? in(finding.message) : kHidden;
            finding.file = in(finding.file);
        }
        return FormatError(std::move(findings));
    }
    /// Calls read() with the fence around the folder. \throws FormatError, UsageError
    template <typename Read>
    auto guarded(Read read) const {  // NOLINT(modernize-use-nodiscard): it may give nothing
        const InputSandbox fence({folder_, shareFolder() + "/devices"});
        try {
            return read();
        } catch (const FormatError& error) {
            throw in(error);
        } catch (const UsageError& error) {
            throw UsageError(in(std::string(error.what())));
        } catch (const std::system_error& error) {
            refuse("", in(std::string(error.what())));
        }
    }

  private:
    std::string folder_;
    std::vector<std::pair<std::string, std::string>> names_;
};

}  // namespace

SceneFolder::SceneFolder(const std::string& folder, const SceneRules& rules)
    : folder_(canonicalFolder(folder.empty() ? "." : folder)),
      rules_(rules),
      devices_(shippedDevices()) {}

std::string SceneFolder::of(const std::vector<std::string>& named, const std::string& environment,
                            const std::string& layout) {
    const bool through_layout = std::find(named.begin(), named.end(), environment) == named.end();
    const std::string& operand = through_layout ? layout : environment;
    return operand == "-" ? "" : fs::path(operand).parent_path().string();
}

std::string SceneFolder::path(const std::string& name) const {
    std::error_code error;
    const fs::path file = fs::canonical(fs::path(folder_) / name, error);
    if (error) refuse(name, kNone);
    if (!liesOpenlyIn(folder_, file.string())) refuse(name, kNone);
    return file.string();
}

Scene SceneFolder::load(const std::string& environment, const std::string& layout) const {
    ClientNames names(folder_);
    std::vector<std::string> operands;
    for (const std::string& name : {environment, layout}) {
        if (name.empty()) continue;
        operands.push_back(path(name));
        names.add(operands.back(), name);
    }
    SceneRequest request{std::move(operands), rules_, false};
    request.is_further = true;
    return names.guarded([&] {
        Scene scene = readScene(request).scene;
        // They are read when a picture is taken.
        for (const Record& record : scene.records)
            if (record.schema().find("texture") != nullptr && record.has("texture") &&
                !mayBeRead(record.text("texture")))
                throw FormatError(record.finding("texture", kNone));
        return scene;
    });
}

void SceneFolder::loadFilesOf(Record& record) const {
    if (record.schema().find("side_files") != nullptr && record.text("side_files") != "folder")
        throw FormatError(record.finding("side_files", "clients may not set `side_files`"));
    ClientNames names(folder_);
    for (const KeySpec& key : record.schema().keys) {
        if (key.role != Role::File || !record.has(key.name)) continue;
        const std::string written = record.text(key.name);
        record.set(key.name, path(written), record.keyPlace(key.name));
        names.add(record.text(key.name), written);
    }
    Document document;
    document.records.push_back(std::move(record));
    ImportOptions options;
    options.max_work.max = rules_.max_work;
    names.guarded([&] { loadFiles(document, "-", options); });
    record = std::move(document.records.front());
}

}  // namespace ispace
