// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/program.h"
#include "sim/world.h"

namespace ispace {

/// Records a run into a folder (thesis, table 3.4):
///
/// - robots.csv: t,id,x,y,heading_deg,speed,rotspeed_deg,accel,rotaccel_deg,stall; each robot at
///   time 0 and after each step
/// - scans.jsonl: every scan, as `scan` writes them
/// - info.csv: dt,control_interval,steps
/// - timing.csv: t,wall,steps at each flush; wall-clock seconds, the only thing that may differ
///   between runs
///
/// Whole lines are written, at least every 0.1 s of wall time while record() or flushDue() is
/// called. After an error the record ends with the last step that all files hold, which info.csv
/// names.
class Recorder {
  public:
    /// Makes the folder if it is missing (not its parents), locks it, and starts the files anew.
    /// \throws std::system_error naming the file; FormatError if another run is recorded there,
    ///         or where a file is a link to one elsewhere
    Recorder(const std::string& folder, const World& world, const History& history,
             std::uint64_t seed);
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// Limits robots.csv and scans.jsonl together to about this many bytes: the write that exceeds
    /// them throws FormatError; its lines stay.
    void limit(std::uint64_t bytes);
    /// The files in a folder of records; those that grow line by line come before info.csv.
    static std::vector<std::string> filesIn(const std::string& folder);

    /// Records the state after a step; flushes if 0.1 s have passed.
    void record(const World& world);
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
