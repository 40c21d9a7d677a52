// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of a running world: edits of its records, another scene, and the way back.
//
// A change has a slow part, which any thread may do while the world goes on, and a short one
// between two steps. It is made whole or not at all. The library reads no files: SceneSource does,
// for the tool. Loads are checked before (run_limits.h), and at real time the measured work, too
// (pace.h).
//
//     const WorldEditor editor(run, source);
//     editor.edit(parseEdits("SET l1.range=0,8")).carryOut();
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "record/edit.h"
#include "scene/scene.h"
#include "sim/simulation.h"

namespace ispace {

/// Loads the files that a change of a world requires: the library reads no files by itself.
class SceneSource {
  public:
    virtual ~SceneSource() = default;
    [[nodiscard]] virtual const DeviceCatalogue& devices() const = 0;
    /// Reads a scene from two files; `layout` may be "". \throws FormatError, UsageError,
    /// std::system_error
    [[nodiscard]] virtual Scene load(const std::string& environment,
                                     const std::string& layout) const = 0;
    /// Loads the files that a changed record names, or rejects it. \throws as load()
    virtual void loadFilesOf(Record& record) const = 0;
};

/// An edit that is invalid in any world.
class BadEdit : public FormatError {
  public:
    explicit BadEdit(const FormatError& error) : FormatError(error) {}
};

/// No record has the id that an edit names.
class UnknownRecord : public FormatError {
  public:
    explicit UnknownRecord(const Edit& edit)
        : FormatError(Diagnostic{"", 0, 0, "no record has the id `" + edit.ids.text() + '`'}),
          id(edit.ids.text()) {}
    std::string id;
};

/// Facts about a change, reported to clients once it is made.
struct ChangeNews {
    /// Ids of the robots and people that a Set changes; one "" for all, if there are many.
    std::vector<std::string> movers = {};
    /// Scene after the change, for a record: its request names files. Else, or without a record,
    /// "".
    std::string scene_text = {};
};

/// A change of a world in two parts, so that a server can answer clients in between. A part that
/// fails leaves the world unchanged.
struct WorldChange {
    /// Does the slow part, in any thread and while the world goes on; the world must not be changed
    /// otherwise meanwhile. \throws BadEdit, UnknownRecord, FormatError, UsageError,
    /// std::system_error
    std::function<void()> prepare;
    /// Applies the change between steps. \returns the previous state, see World::change
    /// \throws FormatError
    std::function<std::shared_ptr<const void>()> adopt;
    std::shared_ptr<const ChangeNews> news;  ///< written by prepare()

    void carryOut() const {
        prepare();
        adopt();
    }
};

/// Changes a world by its records while it runs, within the bounds of run_limits.h.
class WorldEditor {
  public:
    WorldEditor(Simulation& simulation, std::shared_ptr<const SceneSource> source);

    /// Applies these edits to the world's records, see World::change. Robots and people whose
    /// position or heading is set keep the other at its current value.
    /// \param apart the edits set keys of different records, and each is to be valid without the
    ///        others: before and after, the loads together stay within the bounds
    [[nodiscard]] WorldChange edit(std::vector<Edit> edits, bool apart = false) const;
    /// Restarts in another scene, see World::restart.
    [[nodiscard]] WorldChange load(std::string environment, std::string layout) const;
    /// Restarts in the scene of the last start, see World::sharedStart.
    [[nodiscard]] WorldChange reset() const;

  private:
    using Check = std::function<void(const Scene& scene)>;
    /// \param apart see edit()
    [[nodiscard]] Check loadCheck(bool apart = false) const;
    [[nodiscard]] std::shared_ptr<const void> restart(const NextScene& next) const;
    /// Returns RecordOptions::scene_text; null without a record.
    [[nodiscard]] std::function<std::string(const Scene& scene)> sceneWriter() const;

    Simulation* simulation_;
    std::shared_ptr<const SceneSource> source_;
};

}  // namespace ispace
