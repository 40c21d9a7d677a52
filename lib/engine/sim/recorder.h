// SPDX-License-Identifier: GPL-3.0-or-later
// Records of runs: a folder of tables, readings and pictures that replays, coverage and other
// programs read.
//
// Files hold whole lines up to the last flush, also after a crash of the program, but are not
// synchronised with the disk; on a full disk they are cut behind the last step that all of them
// hold. Except for timing.csv their text is the same in each run of the same commands. Written by
// the thread that steps the world; frames may be taken in others.
//
//     Recorder recorder("out", world, {.seed = 1}, &run.events(), &run.tracks());
//     run.recordWith(recorder);
//     …                                                 // the run
//     recorder.end(world);
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "sim/events.h"
#include "sim/record_form.h"
#include "sim/track_log.h"
#include "sim/world.h"

namespace ispace {

/// A request for a picture or depth frame to be recorded.
struct FrameJob {
    std::size_t sensor = 0;  ///< of the world, heavy
    /// Called with its present reading, in any thread.
    std::function<void(const SensorReading& reading)> use = {};
    /// Called after it between steps, with its exception, or null.
    std::function<void(const std::exception_ptr& failure)> deliver = {};
};

using FrameTaker = std::function<void(FrameJob job)>;

/// Contents and limits of a record.
struct RecordOptions {
    History history = {};
    std::uint64_t seed = 0;
    std::string scene = {};  ///< the content of scene.env
    /// Formats a scene for a file in the folder `scenes` of the record, in any thread; null: the
    /// record has no such files.
    std::function<std::string(const Scene&)> scene_text = {};
    bool odometry = false;  ///< write odometry.csv: it differs from the true poses
    bool noise = false;     ///< of the sensors, from the seed; for info.csv
    bool readings = true;   ///< of sensors, in scans.jsonl and pictures
    /// Maximum of pictures and depth frames per camera or ranger and simulated second; at higher
    /// rates every second, third, … frame is recorded. 0: no frames.
    double frame_rate = 1;
    /// Maximum rate of sonar rows per simulated second. 0: no rows.
    double sonar_rate = 10;
    RecordForm form = {};
    /// Takes frames in another thread; null: record() takes them.
    FrameTaker frame_taker = {};
    /// Limits the record to about this many bytes: the write that exceeds them throws FormatError;
    /// earlier writes remain.
    std::uint64_t max_bytes = std::numeric_limits<std::uint64_t>::max();
};

/// Records a run into a folder (thesis, table 3.4):
///
/// - robots.csv: t,id,x,y,heading_deg,speed,rotspeed_deg,accel,rotaccel_deg,stall; each robot at
///   time 0 and after each step
/// - people.csv: t,id,x,y,heading_deg,speed,rotspeed_deg,phase,sidespeed,stall; likewise
/// - odometry.csv: t,id,x,y,heading_deg,cov_xx,cov_xy,cov_yy,cov_xh,cov_yh,cov_hh; the estimated
///   pose of each robot, from 0,0 and heading 0 at its start, and its covariance; likewise, on
///   request
/// - sonars.csv: t,id,ranges; the sonar ranges of each robot
/// - bumpers.csv: t,id,hit; the pressed bumpers of each robot, at the start and at each change
/// - scans.jsonl: every reading, as `scan` writes it
/// - pictures/ID-NNNNNN.png and depths/ID-NNNNNN.png: frames of cameras and rangers by the number
///   of their period
/// - events.csv: events, see EventLog
/// - tracks.csv: what programs told of people and robots, see TrackLog
/// - scene.env: the scene of the run; scenes/scene-NNNNNN.env: those that clients loaded
/// - info.csv: dt,control_interval,steps,elapsed,seed,noise; see World::controlInterval; and every,
///   the time between moments, if RecordForm::every is not 0
/// - timing.csv: t,wall,steps at each flush; wall-clock seconds, the only file that may differ
///   between runs
///
/// Writes whole lines, at least every 0.1 s of wall time while record() or flushDue() is called;
/// frames appear whole. Where a compressed file is divided into blocks depends on that wall time;
/// its text does not. After an error the record ends with the last step that all files hold, which
/// info.csv names.
class Recorder {
  public:
    /// Creates the folder if it is missing (not its parents), locks it, and empties the files.
    /// \param events null: events.csv has no rows \throws std::system_error naming the file;
    /// FormatError if another run is recorded there, or if a file is a link to one elsewhere
    Recorder(const std::string& folder, World& world, const RecordOptions& options,
             EventLog* events = nullptr, const TrackLog* tracks = nullptr);
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// Returns the files in a folder of records: those that grow line by line; and all, also by
    /// their compressed names.
    static std::vector<std::string> growingFilesIn(const std::string& folder);
    static std::vector<std::string> filesIn(const std::string& folder);

    /// Records the state after a step; flushes if 0.1 s have passed, or a megabyte was written
    /// since. Without a frame_taker it also writes the readings and the frames that are due;
    /// otherwise finishStep() does that. \throws as flush(): the record then ends, and each further
    /// call throws the same; FormatError beyond RecordOptions::max_bytes
    void record(World& world);
    /// Writes the readings of the step recorded last, until about then. \returns true once that is
    /// done: the world may then go on, or be changed
    bool finishStep(World& world, std::chrono::steady_clock::time_point until);
    [[nodiscard]] const RecordOptions& options() const;
    /// Returns true if only frames that are still being taken are missing.
    [[nodiscard]] bool awaitsFrames() const;
    /// Ends the record: skips frames that are still being taken, with their lines.
    /// \throws as flush()
    void end(World& world);
    /// Writes the scene_text after a change whose request names files. \returns its file within the
    /// folder; "" if it cannot be written: record() then throws
    std::string recordScene(std::string_view text);
    /// Writes pending lines. \throws std::system_error, also for a full disk
    void flush(const World& world);
    /// Returns the descriptor that holds the lock, or -1 on a file system without locks: a process
    /// that inherits it keeps the folder locked.
    [[nodiscard]] int lock() const;
    /// Writes lines that have been pending for 0.1 s. \returns the time of the next call; nullopt
    /// if no lines are pending
    std::optional<std::chrono::steady_clock::time_point> flushDue(
        std::chrono::steady_clock::time_point now);

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
