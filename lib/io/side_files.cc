// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/side_files.h"
#include "io/input.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/read_fence.h"
#include "base/run_files.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

/// \pre both are canonical
bool liesIn(const fs::path& folder, const fs::path& file) {
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
           folder.end();
}

fs::path folderOf(const std::string& path) {
    const fs::path folder = fs::path(path).parent_path();
    return folder.empty() ? "." : folder;
}

}  // namespace

RegularFile openRegular(const std::string& path) {
    struct stat info {};
    const auto check_kind = [&] {
        if (S_ISDIR(info.st_mode)) throw std::system_error(EISDIR, std::generic_category(), path);
        if (!S_ISREG(info.st_mode)) failFile(path, "it is no regular file");
    };
    mustBeReadable(path);
    // Before it is opened, too: to open a device may do things.
    if (::stat(path.c_str(), &info) != 0)
        throw std::system_error(errno, std::generic_category(), path);
    check_kind();
    OpenFile file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
    if (file.fd() < 0 || ::fstat(file.fd(), &info) != 0)
        throw std::system_error(errno, std::generic_category(), path);
    check_kind();
    noteInput(file.fd());
    return {std::move(file), static_cast<std::size_t>(info.st_size)};
}

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
