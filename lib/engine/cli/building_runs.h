// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of buildings: several worlds in one run of simrun, and movers that go between them. One
// extension opens them, and reports before a run what would hinder it (envc --check). See
// cli/extension.h.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "scene/run/run_changes.h"
#include "scene/run/run_reader.h"
#include "scene/scene.h"
#include "sim/replay.h"
#include "sim/simulation.h"
#include "sim/world.h"
#include "sim/worlds.h"
#include "site/storeys.h"

namespace ispace {

/// Settings of a building's run.
struct BuildingRunOptions {
    SimTime step = std::chrono::milliseconds(5);
    RunOptions run = {};
    Clock clock = {};
    std::optional<SimTime> until = {};
    std::string replay = {};  ///< folder of a record to be replayed; "": none
    bool holds = false;       ///< at its end, see Simulation::replay()
    /// Reads the changes of a room's record, which begins with that scene; null: they are left out.
    std::function<RunChanges(const std::string& folder, const Scene& start)> changes = {};
};

/// Returns the parameters of a recorded run of a building, of the first storey that has them.
/// \param folder has the record of each storey \throws as recordedInfo() and RunReader
RunInfo recordedInfo(const std::string& folder, const StoreyedDocument& building);

/// The worlds of a building's run.
class BuildingWorlds : public Worlds {
  public:
    /// Returns the replay of a room; null in other runs.
    [[nodiscard]] virtual const Replay* replay(std::size_t room) const = 0;
    /// Gives the commands of a script from now on: lines as those of readScript(), with the ids
    /// across the building. \throws FormatError with all findings
    virtual void follow(std::string_view script, const std::string& file) = 0;
    /// Records the lifts from now on, in the folder that has the records of the rooms. \throws as
    /// LineFile, then each step as a write
    virtual void recordLifts(const std::string& folder) = 0;
};

}  // namespace ispace
