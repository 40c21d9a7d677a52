// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/scene_folder.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "cli/common_options.h"
#include "io/input.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
    throw FormatError({name, 0, 0, why});
}

}  // namespace

SceneFolder::SceneFolder(const std::string& folder, bool any_environment)
    : folder_(fs::canonical(folder.empty() ? "." : folder).string()),
      any_environment_(any_environment),
      devices_(loadDevices(shareFolder() + "/devices")) {
    if (!fs::is_directory(folder_))
        throw std::system_error(ENOTDIR, std::generic_category(), folder);
}

std::string SceneFolder::of(const SceneInput& input) {
    const bool through_layout = std::find(input.named.begin(), input.named.end(),
                                          input.environment_operand) == input.named.end();
    const std::string& operand = through_layout ? input.layout_operand : input.environment_operand;
    return operand == "-" ? "" : fs::path(operand).parent_path().string();
}

std::string SceneFolder::path(const std::string& name) const {
    // What is elsewhere is not told apart from what is nowhere.
    constexpr const char* kNone = "there is no such file in the folder that clients may read";
    std::error_code error;
    const fs::path file = fs::canonical(fs::path(folder_) / name, error);
    if (error) refuse(name, kNone);
    const fs::path folder(folder_);
    const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    if (end != folder.end() || rest == file.end()) refuse(name, kNone);
    const bool hidden = std::any_of(
        rest, file.end(), [](const fs::path& part) { return part.string().starts_with('.'); });
    if (hidden || !fs::is_regular_file(file, error)) refuse(name, kNone);
    return file.string();
}

Scene SceneFolder::load(const std::string& environment, const std::string& layout) const {
    std::vector<std::string> operands = {path(environment)};
    if (!layout.empty()) operands.push_back(path(layout));
    SceneRequest request{std::move(operands), any_environment_, false};
    return readScene(request).scene;
}

void SceneFolder::loadFilesOf(Record& record) const {
    if (record.schema().find("side_files") != nullptr && record.text("side_files") != "folder")
        throw FormatError(record.finding("side_files", "clients may not set `side_files`"));
    for (const KeySpec& key : record.schema().keys)
        if (key.role == Role::File && record.has(key.name))
            record.set(key.name, path(record.text(key.name)), record.keyPlace(key.name));
    Document document;
    document.records.push_back(std::move(record));
    loadFiles(document, "-");
    record = std::move(document.records.front());
}

}  // namespace ispace
