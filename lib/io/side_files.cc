// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/side_files.h"
#include "io/input.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/read_fence.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

fs::path folderOf(const std::string& path) {
    const fs::path folder = fs::path(path).parent_path();
    return folder.empty() ? "." : folder;
}

}  // namespace

std::string sideFilePath(const std::string& path, const std::string& name) {
    return (fs::path(path).parent_path() / name).string();
}

std::optional<RegularFile> openSideFile(const std::string& path, const std::string& name,
                                        bool anywhere, std::span<const std::string> others) {
    std::error_code error;
    const fs::path place = fs::canonical(sideFilePath(path, name), error);
    if (error || !mayBeRead(place.string())) return std::nullopt;
    const bool is_in_others =
        std::any_of(others.begin(), others.end(), [&](const std::string& other) {
            std::error_code missing;
            const fs::path folder = fs::canonical(sideFilePath(path, other), missing);
            return !missing && liesIn(folder, place);
        });
    if (!anywhere && !is_in_others && !liesIn(fs::canonical(folderOf(path)), place))
        failFile(path, "it names the file " + excerpt(name) +
                           ", which lies outside its folder: put it there, or allow it in a `mesh` "
                           "record with side_files=anywhere");
    try {
        return openRegular(place.string());
    } catch (const FormatError&) {
        failFile(path, "it names the file " + excerpt(name) + ", which is no regular file");
    } catch (const std::system_error& cause) {
        failFile(path, "it names the file " + excerpt(name) +
                           ", which cannot be opened: " + cause.code().message());
    }
}

}  // namespace ispace
