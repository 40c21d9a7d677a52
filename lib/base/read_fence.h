// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ispace {

/// While this lives, readers of inputs (readAll, InputFile, openRegular, includes) find only
/// regular files in these folders and below, links followed, and none that is hidden (`.name`) or
/// below a hidden folder there; others seem not to exist.
///
/// One at a time per process. It is global on purpose, as RunFiles is, so that no reader can forget
/// it.
class ReadFence {
  public:
    /// \throws std::system_error if one of the folders is not there
    explicit ReadFence(const std::vector<std::string>& folders);
    ~ReadFence();
    ReadFence(const ReadFence&) = delete;
    ReadFence& operator=(const ReadFence&) = delete;
};

/// True if no fence keeps this file from being read; call it before opening the file.
bool mayBeRead(const std::string& name);
/// \throws std::system_error, as for a missing file, if it may not be read
void mustBeReadable(const std::string& name);

/// True if the file lies in the folder or below. \pre both are canonical
bool liesIn(const std::filesystem::path& folder, const std::filesystem::path& file);

/// True if `name` leads, links followed, to a regular file in this folder or below, and no part of
/// the way below it is hidden.
bool liesOpenlyIn(const std::string& folder, const std::string& name);

}  // namespace ispace
