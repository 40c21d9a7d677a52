// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>

#include "base/file.h"

namespace ispace {

/// The file that `path` names, relative to its folder; nothing if it does not exist. \param
/// anywhere false: it must lie in that folder, or in one of `others` (relative to it), or below,
/// links followed \throws FormatError for `path` if the file may not lie there or is not regular
std::optional<RegularFile> openSideFile(const std::string& path, const std::string& name,
                                        bool anywhere, std::span<const std::string> others = {});

/// The path that openSideFile() opens: `name` is relative to the folder of `path`, for "-" to the
/// current one.
std::string sideFilePath(const std::string& path, const std::string& name);

}  // namespace ispace
