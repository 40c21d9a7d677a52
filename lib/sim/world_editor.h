// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "layout/scene.h"
#include "record/edit.h"
#include "sim/simulation.h"

namespace ispace {

/// What changes of a world need from outside, since the library reads no files by itself.
class SceneSource {
  public:
    virtual ~SceneSource() = default;
    [[nodiscard]] virtual const DeviceCatalogue& devices() const = 0;
    /// The scene of two files, `layout` may be "". \throws FormatError, UsageError,
    /// std::system_error
    [[nodiscard]] virtual Scene load(const std::string& environment,
                                     const std::string& layout) const = 0;
    /// Loads what a changed record names, or refuses it. \throws as load()
    virtual void loadFilesOf(Record& record) const = 0;
};

/// Changes a world by its records while it runs. What fails leaves the world as it was.
class WorldEditor {
  public:
    /// Scenes of so many records at most are made.
    static constexpr std::size_t kMaxRecords = 100'000;

    WorldEditor(Simulation& simulation, std::shared_ptr<const SceneSource> source);

    /// True if an edit other than Add is about anything that is there.
    [[nodiscard]] bool finds(const Edit& edit) const;
    /// The robots and people that an edit other than Add is about.
    [[nodiscard]] std::vector<std::string> moversOf(const Edit& edit) const;
    /// The records after these edits. Robots and people whose place or heading is set are where
    /// they are now but for that. \throws FormatError, std::system_error
    [[nodiscard]] std::vector<Record> edited(const std::vector<Edit>& edits) const;
    /// The world goes on with them, see World::change. \param edits those that made the records
    /// \throws FormatError
    void adopt(std::vector<Record> records, const std::vector<Edit>& edits);
    /// Starts anew in another scene, see World::restart. \throws as SceneSource::load
    void load(const std::string& environment, const std::string& layout);
    /// Starts anew in the scene of the beginning, or loaded last. \throws FormatError
    void reset();

  private:
    Simulation* simulation_;
    std::shared_ptr<const SceneSource> source_;
    Scene start_;
};

}  // namespace ispace
