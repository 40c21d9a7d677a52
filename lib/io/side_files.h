// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "base/file.h"

namespace ispace {

/// A regular file, open for reading.
struct RegularFile {
    OpenFile file;
    std::size_t size = 0;
};

/// Opens a file that must be regular, and waits for no pipe. \throws FormatError for devices, pipes
/// and sockets; std::system_error if it cannot be opened, also for a folder
RegularFile openRegular(const std::string& path);

/// The file that another one names, by a name relative to that one's folder, or nothing if there is
/// none. \param anywhere false: it must lie in that folder or below, links followed
/// \throws FormatError for `path` if it may not be read there or is no regular file
std::optional<RegularFile> openSideFile(const std::string& path, const std::string& name,
                                        bool anywhere);

/// Where openSideFile looks.
std::string sideFilePath(const std::string& path, const std::string& name);

}  // namespace ispace
