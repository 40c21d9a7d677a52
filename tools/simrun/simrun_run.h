// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/batch.h"
#include "cli/common_options.h"
#include "cli/operands.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "scene/scene.h"
#include "server/server.h"
#include "sim/activity.h"
#include "sim/command.h"
#include "sim/recorder.h"
#include "sim/replay.h"
#include "sim/simulation.h"
#include "sim/world.h"
#include "simrun/simrun_options.h"

namespace ispace {

/// Reads the operands; a record holds its own scene.
SceneInput readInput(const SimrunOptions& options);

/// Returns the title of the room or the record.
std::string titleOf(const SimrunOptions& options, const SceneInput& input);

/// Opens the record to be served, and sets the scene to its beginning; nullopt without --replay.
std::optional<Replay> openReplay(const SimrunOptions& options, Scene& scene);

/// Moves a replay to the time from which it is served.
void forward(Replay& replay, World& world, SimTime from);

History historyOf(const SimrunCommand& command, const SceneInput& input);

/// The commands of --script.
struct Script {
    std::vector<TimedCommand> commands;
    DayPlan days;  ///< of people
};
Script scriptOf(const SimrunOptions& options, const SceneInput& input, const World& world);

/// Returns options of a run or a replay; a replay keeps the noise of its record unless an option
/// sets another.
RunOptions runOptionsOf(const SimrunOptions& options, const std::optional<RunInfo>& replay);

/// Creates the progress bar of a run that ends at a given time.
std::unique_ptr<Progress> progressOf(Simulation& simulation, const SimrunOptions& options);

/// Reports the length of a run and whether it kept up with the clock.
void report(const Simulation& simulation, const SimrunOptions& options);

/// Reports the verdicts of the judge at the end. Completes the file of --junit.
/// \throws UnmetError if one is unmet
/// \param environment operand
void conclude(const RunJudge& judge, const SimrunOptions& options, const std::string& environment,
              JunitFile& junit);

/// A record that is being written.
struct RunningRecord {
    RunningRecord(const SimrunOptions& options, Simulation& simulation,
                  const RecordOptions& record);
    Recorder recorder;
    LineGuard guard;
};

/// Computes the least size of the record before the run.
/// \throws UsageError if it is more than --record-limit
void checkRecord(const SimrunOptions& options, const World& world);

/// Replaces the records of an earlier run: call it after all steps that may fail. Null without
/// --record. \param odometry it differs from the true poses
std::unique_ptr<RunningRecord> recordOf(Simulation& simulation, const SimrunOptions& options,
                                        const Scene& scene, const History& history, bool odometry,
                                        FrameTaker frame_taker);

/// Returns the limits of the server. Raises the limit of open files of this process, as every
/// client takes one.
ServerLimits limitsOf(const SimrunOptions& options);
/// Likewise, with the values and files that clients may read.
ServerLimits limitsOf(const SimrunOptions& options, const SceneInput& input);

/// Draws the record of --replay to -o, as a picture or a film.
/// \param title of the picture, may be ""
void drawRecord(const SimrunOptions& options, const Scene& scene, const std::string& title);

/// Reports collisions of robots on stderr, up to a number of lines: of a mover that runs into the
/// same thing again where it stands, the first.
class CollisionLog {
  public:
    CollisionLog(const World& world, const CommonOptions& options)
        : world_(&world), options_(&options) {}
    /// Reports the collisions of the world's last step.
    void tell();

  private:
    struct Bump {
        std::string into;
        Point2 at;
    };
    const World* world_;
    const CommonOptions* options_;
    std::map<std::string, Bump, std::less<>> last_;  // by mover
    int count_ = 0;
};

/// Reports on stderr the points, zones and things that movers give up to reach: each once for a
/// mover, up to a number of lines.
class UnreachedLog {
  public:
    /// Subscribes to the events.
    UnreachedLog(Simulation& simulation, const CommonOptions& options);
    /// Reports the events since the last call.
    void tell();

  private:
    Simulation* simulation_;
    const CommonOptions* options_;
    std::int64_t next_ = 0;       // event
    std::set<std::string> told_;  // movers and targets
};

/// Reports on stderr when a run by the clock Real falls behind it, and when it keeps up again.
class LagLog {
  public:
    LagLog(const Simulation& simulation, const CommonOptions& options)
        : simulation_(&simulation), options_(&options) {}
    /// Reads the clock after a step.
    void tell();

  private:
    const Simulation* simulation_;
    const CommonOptions* options_;
    std::chrono::nanoseconds lost_{};             // at the last step
    std::chrono::steady_clock::time_point last_;  // time of the last loss
    bool is_behind_ = false;
    int count_ = 0;  // number of delays
};

/// Warns of movers with a trip over storeys, in the run of one room.
void warnOfTrips(const Scene& scene, const CommonOptions& options);

/// Returns true if --noise changes readings or, in a run that moves them, robots.
bool hasNoise(const Scene& scene, bool moves);
/// Warns that no scene of a run has noise.
void warnOfNoNoise(const CommonOptions& options);

/// Reports once that a change of a recorded run cannot be repeated.
class FailureLog {
  public:
    /// \param replay null: tells of no change
    FailureLog(const Replay* replay, const CommonOptions& options)
        : replay_(replay), options_(&options) {}
    void tell();

  private:
    const Replay* replay_;
    const CommonOptions* options_;
    bool is_told_ = false;
};

/// Warns that a run changed its world, of which the picture shows the start.
void warnOfChanges(const Replay& replay, const CommonOptions& options);

}  // namespace ispace
