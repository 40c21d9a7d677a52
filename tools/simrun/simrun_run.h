// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/batch.h"
#include "cli/common_options.h"
#include "cli/operands.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "scene/scene.h"
#include "server/server.h"
#include "sim/command.h"
#include "sim/expect.h"
#include "sim/recorder.h"
#include "sim/replay.h"
#include "sim/simulation.h"
#include "sim/world.h"
#include "simrun/simrun_options.h"

namespace ispace {

/// The operands; a record knows its scene.
SceneInput readInput(const SimrunOptions& options);

/// Of what is shown: the room, or the record.
std::string titleOf(const SimrunOptions& options, const SceneInput& input);

/// The record to be served, and the scene as it begins; nothing without --replay.
std::optional<Replay> openReplay(const SimrunOptions& options, Scene& scene);

/// Up to where a record is to be served from.
void forward(Replay& replay, World& world, SimTime from);

History historyOf(const SimrunCommand& command, const SceneInput& input);

/// The commands of --script.
std::vector<TimedCommand> scriptOf(const SimrunOptions& options, const SceneInput& input,
                                   const World& world);

/// Robots of a record go where it says; its sensors have their noise of then, unless another is
/// asked for.
RunOptions runOptionsOf(const SimrunOptions& options, const std::optional<Replay>& replay);

/// Shows how far a run is that ends at a given time.
std::unique_ptr<Progress> progressOf(Simulation& simulation, const SimrunOptions& options);

/// Says how far a run came and whether it kept up with the clock.
void report(const Simulation& simulation, const SimrunOptions& options);

/// The last word on a run: whether it did what --expect says. Completes the file of --junit.
/// \throws UnmetError if it did not
void conclude(const ExpectationJudge& judge, const SimrunOptions& options, const SceneInput& input,
              JunitFile& junit);

/// A record that is being written.
struct RunningRecord {
    RunningRecord(const SimrunOptions& options, Simulation& simulation,
                  const RecordOptions& record);
    Recorder recorder;
    LineGuard guard;
};

/// What the record of a run until a given time holds at least is known before it begins.
/// \throws UsageError if that is more than --record-limit
void checkRecord(const SimrunOptions& options, const World& world);

/// Replaces the records of the run before: to be called when all that may go wrong has gone well.
/// Null without --record. \param odometry it differs from the true poses
std::unique_ptr<RunningRecord> recordOf(Simulation& simulation, const SimrunOptions& options,
                                        const Scene& scene, const History& history, bool odometry,
                                        FrameTaker frame_taker);

/// Limits of the server, with what clients need to know and may read. Raises the number of files
/// that this process may open, as every client takes one.
ServerLimits limitsOf(const SimrunOptions& options, const SceneInput& input);

/// The first line of output: clients can connect now.
/// \param web address of the page; "" without
/// \param devices where device ports are
void announce(const Server& server, const std::string& web, const DeviceAddresses& devices);

/// Draws the record of --replay to -o, as a picture or a film.
/// \param title of the picture; "" for none
void drawRecord(const SimrunOptions& options, const Scene& scene, const std::string& title);

/// Says on stderr what robots run into, up to a number of lines that nobody reads beyond.
class CollisionLog {
  public:
    CollisionLog(const World& world, const CommonOptions& options)
        : world_(&world), options_(&options) {}
    /// Tells the collisions of the world's last step.
    void tell();

  private:
    const World* world_;
    const CommonOptions* options_;
    int count_ = 0;
};

/// Says on stderr when a run by the clock Real falls behind it, and when it keeps up again.
class LagLog {
  public:
    LagLog(const Simulation& simulation, const CommonOptions& options)
        : simulation_(&simulation), options_(&options) {}
    /// Looks at the clock after a step.
    void tell();

  private:
    const Simulation* simulation_;
    const CommonOptions* options_;
    std::chrono::nanoseconds lost_{};             // as last seen
    std::chrono::steady_clock::time_point last_;  // when some was lost
    bool is_behind_ = false;
    int count_ = 0;  // of times it fell behind
};

/// Says so if no sensor has noise, nor a robot that moves by itself.
void warnOfNoNoise(const Scene& scene, bool moves, const CommonOptions& options);

/// Says once what change of a recorded run cannot be made again.
class FailureLog {
  public:
    FailureLog(const std::optional<Replay>& replay, const CommonOptions& options)
        : replay_(replay ? &*replay : nullptr), options_(&options) {}
    void tell();

  private:
    const Replay* replay_;
    const CommonOptions* options_;
    bool is_told_ = false;
};

/// Says that a run changed its world, of which the picture shows the start.
void warnOfChanges(const Replay& replay, const CommonOptions& options);

}  // namespace ispace
