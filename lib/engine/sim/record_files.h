// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/sim: the files of a record, and their lines.
//
// A line is whole or absent: text is collected in memory and written up to its last newline, a torn
// line of a full disk is taken back, and a file of an earlier run is replaced, not overwritten.
// Links to files and folders are refused, so that a record cannot be led elsewhere; those to
// devices and pipes are followed. Numbers have the shortest text that reads back to the same
// double; a number that equals that of the row before is not formatted again.
#pragma once

#include <sys/types.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/number.h"
#include "base/zstd_text.h"
#include "sim/events.h"
#include "sim/record_form.h"
#include "sim/sensor_reading.h"
#include "sim/world.h"

namespace ispace {

/// A file that grows by whole lines, in the order of steps. One whose name ends in kZstdSuffix is
/// compressed: it grows by blocks, which hold the lines of one write.
class LineFile {
  public:
    /// Creates the file empty. \throws std::system_error naming it; FormatError if it is a link
    explicit LineFile(std::string name);
    ~LineFile();
    LineFile(const LineFile&) = delete;
    LineFile& operator=(const LineFile&) = delete;

    /// The next flush writes this, up to the last newline.
    std::string pending;

    /// Marks the end of this step's lines in `pending`.
    void endStep(std::int64_t step) {
        ends_.push_back({step, size_ + static_cast<off_t>(pending.size())});
    }
    /// Returns the last step whose lines are all in the file, of those that are stored.
    [[nodiscard]] std::int64_t wholeSteps() const;
    /// Returns the last step, up to this one, behind which the file can be truncated: in a
    /// compressed file the last at the end of a block.
    [[nodiscard]] std::int64_t lastCut(std::int64_t step) const;
    /// Truncates the file after this step. Skips devices and pipes, which cannot be truncated.
    /// \pre lastCut(step) == step
    void cutBehind(std::int64_t step);
    /// Removes the stored ends before that of this step: the file will not be truncated there.
    void forgetBefore(std::int64_t step) {
        const auto later = std::upper_bound(
            ends_.begin(), ends_.end(), step,
            [](std::int64_t value, const StepEnd& end) { return value < end.step; });
        if (later - ends_.begin() > 1) ends_.erase(ends_.begin(), later - 1);
        if (!ends_.empty())
            std::erase_if(blocks_, [first = ends_.front().size](const Block& block) {
                return block.text < first;
            });
    }
    /// Replaces the whole content by `text`, which must not be shorter. Less than a page is written
    /// whole or not at all. \throws std::system_error
    void rewrite(std::string_view text);
    /// After an error the file is not written any more and each call throws that error again: lines
    /// after a gap would pass for the whole. \throws std::system_error
    void flush();
    /// Likewise, if more than `size` bytes are pending.
    void flushBlock(std::size_t size) {
        if (pending.size() > size) flush();
    }

    /// Returns the bytes in the file.
    [[nodiscard]] std::uint64_t size() const {
        return static_cast<std::uint64_t>(packer_ ? packed_ : size_);
    }

  private:
    struct StepEnd {
        std::int64_t step;
        off_t size;  // of the text up to that step
    };
    /// The end of a block of a compressed file, in its text and in the file.
    struct Block {
        off_t text, file;
    };

    void write();
    void takeBackTornLine(std::string_view written);
    [[nodiscard]] const Block* blockEndingAt(off_t text) const;
    void endFrame();

    std::string name_;
    int fd_;
    int error_ = 0;
    off_t size_ = 0;    // bytes of whole lines, before compression
    off_t packed_ = 0;  // bytes of whole blocks in the file, if it is compressed
    std::vector<StepEnd> ends_;
    std::unique_ptr<ZstdPacker> packer_;  // null: plain
    std::vector<Block> blocks_;
};

/// Removes a regular file of an earlier run. \throws std::system_error; FormatError if it is a link
void removeEarlier(const std::string& name);

/// Creates `folder` if it is missing, and returns it. \throws std::system_error
const std::string& madeFolder(const std::string& folder);

/// The lock of a record's folder.
class FolderLock {
  public:
    /// Waits a moment for a run that is just ending. \throws FormatError if another run records
    /// there
    explicit FolderLock(const std::string& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;
    [[nodiscard]] int descriptor() const { return fd_; }

  private:
    int fd_;
};

/// Files of one frame each in their own folder, which is created with the first frame.
class FrameFiles {
  public:
    /// Ends the name of an incomplete file.
    static constexpr std::string_view kUnfinished = ".part";

    /// Removes the frames of an earlier run. \throws std::system_error naming a file that cannot be
    /// removed; FormatError if the folder is a link
    explicit FrameFiles(std::string folder, std::string_view ending = ".png");

    /// Writes a frame, whole or not at all. \throws std::system_error
    void write(const std::string& name, std::string_view bytes, std::int64_t step);
    /// Removes the frames of later steps.
    void cutBehind(std::int64_t step);
    /// Keeps the frames of steps up to this one for good.
    void keepUpTo(std::int64_t step) {
        std::erase_if(recent_, [step](const Frame& frame) { return frame.step <= step; });
    }
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

/// The text of a number in a table.
struct NumberText {
    std::uint64_t bits = ~std::uint64_t{0};  ///< of the number; at first of none
    std::size_t size = 0;
    std::array<char, kNumberRoom + kNumberSlack> text;
};
/// The texts of a table's last rows: most numbers are those of the step before.
using RowTexts = std::vector<NumberText>;

// The header of a table, and the rows of all its movers at the world's time.
constexpr std::string_view kRobotsHead =
    "t,id,x,y,heading_deg,speed,rotspeed_deg,accel,rotaccel_deg,stall\n";
/// \param kept as TableColumns::kept
void appendRobotRows(std::string& out, const World& world, RowTexts& known, std::uint32_t kept);
constexpr std::string_view kOdometryHead =
    "t,id,x,y,heading_deg,cov_xx,cov_xy,cov_yy,cov_xh,cov_yh,cov_hh\n";
void appendOdometryRows(std::string& out, const World& world, RowTexts& known);
constexpr std::string_view kPeopleHead =
    "t,id,x,y,heading_deg,speed,rotspeed_deg,phase,sidespeed,stall\n";
void appendPeopleRows(std::string& out, const World& world, RowTexts& known, std::uint32_t kept);

/// Writes the ranges of robots' sonars, in the order of the model, "inf" without an echo; robots
/// without sonars have no row.
constexpr std::string_view kSonarsHead = "t,id,ranges\n";
void appendSonarRows(std::string& out, World& world);
constexpr std::string_view kBumpersHead = "t,id,hit\n";
/// Writes rows of the robots with changed bumpers since the last call with `felt`, which
/// holds the bumpers of each robot; empty before the first call.
void appendBumperRows(std::string& out, const World& world, std::vector<std::vector<bool>>& felt);

/// Writes rows of the states that change, as data sets of smart homes have them.
constexpr std::string_view kStatesHead = "t,id,state,value\n";
/// \pre the event is a state
void appendStateRow(std::string& out, const Event& event);

/// Rows of the actions of people, as labels of the states.
constexpr std::string_view kActivitiesHead = "begin,end,id,activity,action,done\n";
class ActivityRows {
  public:
    /// Writes a row if the event ends an action. \pre it is an activity
    void append(std::string& out, const Event& event);

  private:
    std::map<std::string, SimTime> begun_;  // by person
};

/// Writes a reading as a line of JSON, as `scan` does. A frame with its own file has "file" instead
/// of its pixels.
void appendReadingLine(std::string& out, const Sensor& sensor, const SensorReading& reading,
                       std::span<const Sensor> receivers, const std::string& file = "");

/// Returns the name of a frame's file: the sensor's id and the number of the period.
std::string frameName(const std::string& id, std::int64_t seq, std::string_view ending = ".png");
/// Converts a frame to PNG: of a ranger 16-bit grey in millimetres, 0 for no return. \pre the
/// reading is heavy
std::string frameBytes(const Sensor& sensor, const SensorReading& reading);

/// A picture or depth frame of a step, written once all before it are made.
struct RecordedFrame {
    /// The folders of their files.
    static constexpr const char *kPictures = "pictures", *kDepths = "depths";

    explicit RecordedFrame(const Sensor& the_sensor)
        : sensor(the_sensor), is_picture(the_sensor.is<Camera>()) {}

    /// Builds file and line of a reading. Call it in any thread.
    void make(const SensorReading& reading);
    /// Marks it as made. One for which memory ran out is skipped: a client may have added its
    /// camera. \throws `failure` otherwise
    void finish(const std::exception_ptr& failure);

    Sensor sensor;
    bool is_picture, is_made = false;
    std::string name, bytes, line;  // "": it is skipped
};

}  // namespace ispace
