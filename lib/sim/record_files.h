// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sim: the files of a record.
// Private to lib/sim: the lines of a record.
#pragma once

#include <sys/types.h>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sim/sensor_reading.h"
#include "sim/world.h"

namespace ispace {

/// A file that grows by whole lines, those of a step after those of the step before.
class LineFile {
  public:
    /// Starts it anew. \throws std::system_error naming it; FormatError where it is a link
    explicit LineFile(std::string name);
    ~LineFile();
    LineFile(const LineFile&) = delete;
    LineFile& operator=(const LineFile&) = delete;

    /// What the next flush writes, up to the last newline.
    std::string pending;

    /// What is pending ends with the lines of this step.
    void endStep(std::int64_t step) {
        ends_.push_back({step, size_ + static_cast<off_t>(pending.size())});
    }
    /// The last step whose lines are all in the file, of those since the last forget().
    [[nodiscard]] std::int64_t wholeSteps() const;
    /// Cuts the file behind this step. Devices and pipes refuse to be cut and have nothing to
    /// keep.
    void cutBehind(std::int64_t step);
    /// All ends of steps but the last may go: nothing will be cut there.
    void forget() {
        if (ends_.size() > 1) ends_.erase(ends_.begin(), ends_.end() - 1);
    }
    /// Puts `text` in place of the whole content, which must not have been longer. Of less than a
    /// page, it is written whole or not at all. \throws std::system_error
    void rewrite(std::string_view text);
    /// After an error nothing more is written and each call throws it again: lines behind a gap
    /// would pass for the whole. \throws std::system_error
    void flush();

    [[nodiscard]] std::uint64_t size() const { return static_cast<std::uint64_t>(size_); }

  private:
    struct StepEnd {
        std::int64_t step;
        off_t size;  // of the file with it
    };

    void write();
    void takeBackTornLine(std::string_view written);

    std::string name_;
    int fd_;
    int error_ = 0;
    off_t size_ = 0;  // bytes of whole lines in the file
    std::vector<StepEnd> ends_;
};

/// `folder`, made if it is missing. \throws std::system_error
const std::string& madeFolder(const std::string& folder);

/// The lock of a folder that is recorded into.
class FolderLock {
  public:
    /// Waits a moment for a run that is just ending. \throws FormatError if another run goes on
    /// there
    explicit FolderLock(const std::string& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;
    [[nodiscard]] int descriptor() const { return fd_; }

  private:
    int fd_;
};

/// Files of one frame each in a folder of their own, which is made with the first of them.
class FrameFiles {
  public:
    /// Ends the name of a file that is being written.
    static constexpr std::string_view kUnfinished = ".part";

    /// What an earlier run left there is removed. \throws std::system_error naming what cannot be
    /// removed; FormatError where the folder is a link
    explicit FrameFiles(std::string folder, std::string_view ending = ".png");

    /// Writes a frame, whole or not at all. \throws std::system_error
    void write(const std::string& name, std::string_view bytes, std::int64_t step);
    /// Removes the frames of later steps.
    void cutBehind(std::int64_t step);
    /// Frames so far stay.
    void forget() { recent_.clear(); }
    [[nodiscard]] std::uint64_t size() const { return size_; }

  private:
    struct Frame {
        std::string path;
        std::int64_t step;
    };

    std::string folder_;
    bool is_made_ = false;
    std::uint64_t size_ = 0;
    std::vector<Frame> recent_;
};

// The head of a table, and the rows of everybody in it at the world's time.
constexpr std::string_view kRobotsHead =
    "t,id,x,y,heading_deg,speed,rotspeed_deg,accel,rotaccel_deg,stall\n";
void appendRobotRows(std::string& out, const World& world);
constexpr std::string_view kOdometryHead = "t,id,x,y,heading_deg\n";
void appendOdometryRows(std::string& out, const World& world);
constexpr std::string_view kPeopleHead =
    "t,id,x,y,heading_deg,speed,rotspeed_deg,phase,sidespeed,stall\n";
void appendPeopleRows(std::string& out, const World& world);

/// What the sonars of robots measure, in the order of the model, "inf" without an echo; robots
/// without any have no row.
constexpr std::string_view kSonarsHead = "t,id,ranges\n";
void appendSonarRows(std::string& out, World& world);
constexpr std::string_view kBumpersHead = "t,id,hit\n";
/// Rows of the robots whose bumpers feel something else than at the last call with `felt`, which
/// has what each of them felt, empty before.
void appendBumperRows(std::string& out, const World& world, std::vector<std::vector<bool>>& felt);

/// A reading as a line of JSON, as `scan` writes it. A frame that has a file of its own says "file"
/// in place of its pixels.
void appendReadingLine(std::string& out, const RunSensor& sensor, const SensorReading& reading,
                       std::span<const Sensor> receivers, const std::string& file = "");

/// The name of a frame's file: the sensor's id and the number of the period.
std::string frameName(const std::string& id, std::int64_t seq, std::string_view ending = ".png");
/// The frame as PNG: of a ranger 16-bit grey in millimetres, 0 for none. \pre the reading is heavy
std::string frameBytes(const RunSensor& sensor, const SensorReading& reading);

}  // namespace ispace
