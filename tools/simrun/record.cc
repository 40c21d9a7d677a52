// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/record.h"

#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "cli/operands.h"
#include "record/text.h"

namespace ispace {

namespace {

/// The scene as one file that stands by itself in the folder of the record.
std::string sceneText(const Scene& scene, const History& history, const std::string& folder) {
    Document document;
    document.history = history;
    document.records = scene.records;
    rebaseFiles(document.records, "", folder);
    return writeRecordText(document);
}

}  // namespace

RunningRecord::RunningRecord(const SimrunOptions& options, Simulation& simulation,
                             const RecordOptions& record)
    : recorder(options.record, simulation.world(), record, &simulation.events()),
      guard(Recorder::growingFilesIn(options.record), recorder.lock()) {}

/// What the record of a run until a given time holds at least is known before it begins.
void checkRecord(const SimrunOptions& options, const World& world) {
    if (options.record.empty() || !options.until) return;
    constexpr double kShortestLine = 20;  // bytes, of robots.csv
    const double steps =
        static_cast<double>(options.until->count()) / static_cast<double>(options.step.count());
    const double lines = std::ceil(steps) * static_cast<double>(world.movers().size());
    if (lines * kShortestLine <= static_cast<double>(options.max_recorded)) return;
    throw UsageError("--record: " + formatDouble(lines) + " lines of robots and people until t=" +
                     formatSimTime(*options.until) + " are more than --record-limit, which is " +
                     byteCountText(options.max_recorded) + "; is --until in seconds?");
}

std::unique_ptr<RunningRecord> recordOf(Simulation& simulation, const SimrunOptions& options,
                                        const Scene& scene, const History& history, bool odometry,
                                        FrameTaker frame_taker) {
    if (options.record.empty()) return nullptr;
    RecordOptions record;
    record.history = history;
    record.seed = simulation.world().options().seed;
    record.noise = simulation.world().options().sensor_noise;
    record.odometry = odometry;
    record.scene = sceneText(scene, history, options.record);
    record.scene_text = [history, folder = options.record + "/scenes"](const Scene& loaded) {
        return sceneText(loaded, history, folder);
    };
    record.frame_rate = options.recorded_frames;
    record.sonar_rate = options.recorded_sonars;
    record.max_bytes = options.max_recorded;
    record.frame_taker = std::move(frame_taker);
    auto running = std::make_unique<RunningRecord>(options, simulation, record);
    simulation.recordWith(running->recorder);
    return running;
}

}  // namespace ispace
