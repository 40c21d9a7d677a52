// SPDX-License-Identifier: GPL-3.0-or-later
// The course of a run: reads the site, opens its worlds, serves clients until the end, writes
// products.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/batch.h"
#include "cli/common_options.h"
#include "cli/site_operands.h"
#include "scene/scene.h"
#include "sim/replay.h"
#include "sim/world.h"
#include "sim/worlds.h"
#include "simrun/simrun_options.h"

namespace ispace {

/// A run that is about to begin: its worlds, and what only a room or a building knows of itself.
class RunSite {
  public:
    RunSite(const SimrunCommand& command, SiteInput the_input);
    RunSite(const RunSite&) = delete;
    RunSite& operator=(const RunSite&) = delete;
    virtual ~RunSite() = default;

    /// Returns the worlds; the first one leads the others.
    [[nodiscard]] virtual Worlds& worlds() = 0;
    /// Returns the replay of a room; null in other runs.
    [[nodiscard]] virtual const Replay* replay(std::size_t room) const = 0;
    /// Records in the folder of --record what belongs to no room, once the rooms are recorded.
    virtual void recordWhole() = 0;

    const SimrunOptions& options;
    const std::string title;  ///< of the environment or the record
    History history;          ///< of the run, its command last
    const SiteInput input;
};

/// Returns the folder of a room in that of a record: of the only room, the folder itself.
inline std::string folderOf(const std::string& record, const RunRoom& room) {
    return room.id.empty() ? record : record + '/' + room.id;
}

/// Reads the file of --script. \throws UsageError if that is stdin and the scene was read from it
std::string scriptText(const SimrunOptions& options, const SiteInput& input);

/// Reads a site, or its record, and warns of it. \throws as the readers do
std::unique_ptr<RunSite> openSite(const SimrunCommand& command);

/// Returns options of a run or a replay; a replay keeps the noise of its record unless an option
/// sets another.
RunOptions runOptionsOf(const SimrunOptions& options, const std::optional<RunInfo>& replay);

/// Runs it, and serves it to clients until its end. Completes the file of --junit. \throws as the
/// servers and records do, UnmetError if an expectation is unmet
void serve(RunSite& site, const SimrunOptions& options, JunitFile& junit);

/// Draws the record of --replay to -o, as a picture or a film.
void drawRecord(const SimrunOptions& options);

}  // namespace ispace
