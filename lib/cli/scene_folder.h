// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "cli/operands.h"
#include "scene/devices.h"
#include "sim/world_editor.h"

namespace ispace {

/// The folder that clients of a run may read from. A name they give is relative to it (or
/// absolute), and must lead, links followed, to a regular file in it or below; no part of the way
/// is hidden (`.name`). So must what such a file names in its turn: includes, pictures, meshes and
/// whatever else. Errors name files as seen from the folder, and tell nothing of the content of
/// those that do not begin as records do (`#env 1`, `#3dm 1`).
class SceneFolder : public SceneSource {
  public:
    /// "" is the current folder. \throws std::system_error if there is none
    SceneFolder(const std::string& folder, const SceneRules& rules);
    /// That of a run's operands: where ENV lies, or LAYOUT if that names ENV.
    static std::string of(const SceneInput& input);

    [[nodiscard]] const DeviceCatalogue& devices() const override { return devices_; }
    [[nodiscard]] Scene load(const std::string& environment,
                             const std::string& layout) const override;
    void loadFilesOf(Record& record) const override;
    /// The file that a client's name means. \throws FormatError
    [[nodiscard]] std::string path(const std::string& name) const;

  private:
    std::string folder_;  // canonical
    SceneRules rules_;
    DeviceCatalogue devices_;
};

}  // namespace ispace
