// SPDX-License-Identifier: GPL-3.0-or-later
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

/// An edit that cannot be made, whatever is in the world.
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

/// What is to be told of a change once it is made.
struct ChangeNews {
    /// Ids of the robots and people that a Set is about; one "" for all, if they are many.
    std::vector<std::string> movers = {};
    /// Its request does not say all: it names files.
    bool needs_scene = false;
};

/// A change of a world in two parts, for those who have somebody else to serve meanwhile. What
/// fails leaves the world as it was.
struct WorldChange {
    /// What takes long: in any thread and while the world goes on, but is changed by nobody else.
    /// \throws BadEdit, UnknownRecord, FormatError, UsageError, std::system_error
    std::function<void()> prepare;
    /// The world goes on with it, between steps. \returns what it was, see World::change
    /// \throws FormatError
    std::function<std::shared_ptr<const void>()> adopt;
    std::shared_ptr<const ChangeNews> news;  ///< filled by prepare()

    void carryOut() const {
        prepare();
        adopt();
    }
};

/// Changes a world by its records while it runs, within the bounds of run_limits.h.
class WorldEditor {
  public:
    WorldEditor(Simulation& simulation, std::shared_ptr<const SceneSource> source);

    /// The world goes on with its records after these edits, see World::change. Robots and people
    /// whose place or heading is set are where they are then but for that.
    [[nodiscard]] WorldChange edit(std::vector<Edit> edits) const;
    /// It starts anew in another scene, see World::restart.
    [[nodiscard]] WorldChange load(std::string environment, std::string layout) const;
    /// It starts anew in the scene in which it did so last, see World::sharedStart.
    [[nodiscard]] WorldChange reset() const;

  private:
    using Check = std::function<void(const Scene& scene)>;
    [[nodiscard]] Check loadCheck() const;

    Simulation* simulation_;
    std::shared_ptr<const SceneSource> source_;
};

}  // namespace ispace
