// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/message.h"
#include "sim/events.h"
#include "sim/world.h"

namespace ispace {

/// A picture or depth frame that is to be recorded.
struct FrameJob {
    std::size_t sensor = 0;  ///< of the world, heavy
    /// Called with its reading of now, in any thread.
    std::function<void(const SensorReading& reading)> use = {};
    /// Called after it between steps, with what was thrown, or null.
    std::function<void(const std::exception_ptr& failure)> deliver = {};
};

using FrameTaker = std::function<void(FrameJob job)>;

struct RecordOptions {
    History history = {};
    std::uint64_t seed = 0;
    std::string scene = {};  ///< the content of scene.env
    /// A scene as a file in the folder `scenes` of the record; null: see recordScene().
    std::function<std::string(const Scene&)> scene_text = {};
    bool odometry = false;  ///< odometry.csv gets rows: it differs from the true poses
    bool noise = false;     ///< the sensors', from the seed; for info.csv
    /// Pictures and depth frames of each camera and ranger in a simulated second, at most; of those
    /// with a higher rate every second, third, … is recorded. 0: none.
    double frame_rate = 1;
    /// What sonars measure so many times a simulated second, at most. 0: not at all.
    double sonar_rate = 10;
    /// Has frames made in another thread; null: record() makes them.
    FrameTaker frame_taker = {};
    /// Limits the record to about this many bytes: the write that exceeds them throws FormatError;
    /// what is written stays.
    std::uint64_t max_bytes = std::numeric_limits<std::uint64_t>::max();
};

/// Records a run into a folder (thesis, table 3.4):
///
/// - robots.csv: t,id,x,y,heading_deg,speed,rotspeed_deg,accel,rotaccel_deg,stall; each robot at
///   time 0 and after each step
/// - people.csv: t,id,x,y,heading_deg,speed,rotspeed_deg,phase,sidespeed,stall; likewise
/// - odometry.csv: t,id,x,y,heading_deg; where each robot believes to be, from 0,0 and heading 0 at
///   its start; likewise, if wanted
/// - sonars.csv: t,id,ranges; what the sonars of each robot measure
/// - bumpers.csv: t,id,hit; what the bumpers of each robot feel, at the start and when it changes
/// - scans.jsonl: every reading, as `scan` writes it
/// - pictures/ID-NNNNNN.png and depths/ID-NNNNNN.png: frames of cameras and rangers by the number
/// of
///   their period
/// - events.csv: what happened, see EventLog
/// - scene.env: the scene of the run; scenes/scene-NNNNNN.env: those that clients loaded
/// - info.csv: dt,control_interval,steps,elapsed,seed,noise; see World::controlInterval
/// - timing.csv: t,wall,steps at each flush; wall-clock seconds, the only thing that may differ
///   between runs
///
/// Whole lines are written, at least every 0.1 s of wall time while record() or flushDue() is
/// called; frames appear whole. After an error the record ends with the last step that all files
/// hold, which info.csv names.
class Recorder {
  public:
    /// Makes the folder if it is missing (not its parents), locks it, and starts the files anew.
    /// \param events null: events.csv has no rows \throws std::system_error naming the file;
    /// FormatError if another run is recorded there, or where a file is a link to one elsewhere
    Recorder(const std::string& folder, World& world, const RecordOptions& options,
             EventLog* events = nullptr);
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// The files in a folder of records: those that grow line by line, then the others.
    static std::vector<std::string> growingFilesIn(const std::string& folder);
    static std::vector<std::string> filesIn(const std::string& folder);

    /// Records the state after a step; flushes if 0.1 s have passed. Without a frame_taker what
    /// sensors read is recorded, too, and the frames that are due; else finishStep() does that.
    void record(World& world);
    /// Records what sensors read in the step recorded last, until about then. \returns true once
    /// that is done: the world may then go on, or be changed
    bool finishStep(World& world, std::chrono::steady_clock::time_point until);
    [[nodiscard]] const RecordOptions& options() const;
    /// True if only frames that are being made are missing.
    [[nodiscard]] bool awaitsFrames() const;
    /// Ends the record: frames that are still being made are left out, with their lines.
    /// \throws as flush()
    void end(World& world);
    /// Writes a scene after a change that its request does not say all about. \returns its file
    /// within the folder; "" without scene_text, or if it cannot be written: record() then throws
    std::string recordScene(const Scene& scene);
    /// Writes out what is pending. \throws std::system_error, also for a full disk
    void flush(const World& world);
    /// The descriptor that holds the lock, or -1 on a file system without: a process that inherits
    /// it keeps the folder locked.
    [[nodiscard]] int lock() const;
    /// Writes out what has been pending for 0.1 s. \returns when to call it again; nothing if
    /// nothing is pending
    std::optional<std::chrono::steady_clock::time_point> flushDue(
        std::chrono::steady_clock::time_point now);

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
