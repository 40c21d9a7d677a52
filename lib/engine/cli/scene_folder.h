// SPDX-License-Identifier: GPL-3.0-or-later
// The fence around --load-folder of simrun(1): rooms, layouts and their files come from one folder
// when clients name them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/operands.h"
#include "scene/devices.h"
#include "sim/world_editor.h"

namespace ispace {

/// The folder that clients of a run may read from. A name from a client is relative to it (or
/// absolute), and must lead, links followed, to a regular file in it or below; no part of the path
/// is hidden (`.name`). The same holds for files that such a file names: includes, pictures, meshes
/// and others. Errors name files relative to the folder, and quote only files that begin as records
/// do (`#env 1`, `#3dm 1`): a client learns neither the content of other files nor which files
/// exist elsewhere.
class SceneFolder : public SceneSource {
  public:
    /// "" is the current folder. \throws std::system_error if there is none
    SceneFolder(const std::string& folder, const SceneRules& rules);
    /// Returns the folder of a run's operands: that of ENV, or of LAYOUT if that names ENV.
    /// \param named the operands given
    static std::string of(const std::vector<std::string>& named, const std::string& environment,
                          const std::string& layout);

    [[nodiscard]] const DeviceCatalogue& devices() const override { return devices_; }
    [[nodiscard]] Scene load(const std::string& environment,
                             const std::string& layout) const override;
    void loadFilesOf(Record& record) const override;
    /// Converts a client's name to a path, links followed. \throws FormatError, with the same text
    /// for a missing file as for one outside of the folder
    [[nodiscard]] std::string path(const std::string& name) const;

  private:
    std::string folder_;  // canonical
    SceneRules rules_;
    DeviceCatalogue devices_;
};

}  // namespace ispace
