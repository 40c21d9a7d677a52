// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "cli/line_guard.h"
#include "layout/scene.h"
#include "sim/recorder.h"
#include "sim/simulation.h"
#include "simrun/options.h"

namespace ispace {

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

}  // namespace ispace
