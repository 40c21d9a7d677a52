// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geom/pose.h"

namespace ispace {

/// Names of the tables in a folder that `simrun --record` has written. They are opened as regular
/// files only.
struct RecordedFiles {
    explicit RecordedFiles(const std::string& folder);
    std::string robots, odometry, bumpers, people, events, info;
};

/// The path of a file that a record names. \param name relative to the folder \throws
/// std::system_error if it does not exist; FormatError unless it is regular and lies in the folder
/// or below, links followed
std::string fileOfRecord(const std::string& folder, const std::string& name);
/// The path of scene.env, which old records lack; "" without one. \throws as fileOfRecord
std::string sceneOfRecord(const std::string& folder);

/// What info.csv says of a run.
struct RunInfo {
    double step = 0;         ///< seconds
    std::int64_t steps = 0;  ///< 0: not known
    std::uint64_t seed = 0;
    bool noise = false;  ///< of sensors
};

/// Nothing if the run was killed before info.csv was written, or wrote none. Old records have no
/// seed. \throws FormatError if it says something else
std::optional<RunInfo> recordedInfo(const std::string& folder);

/// State of a robot or a person at a moment of a run.
struct RunState {
    std::size_t who = 0;  ///< index of RunReader::who()
    Pose2 pose;
    double speed = 0, accel = 0;  ///< m/s, m/s^2, forward
    Angle rotspeed, rotaccel;     ///< a second, a second a second
    bool is_stalled = false;
    double phase = 0;      ///< of a person's gait
    double sidespeed = 0;  ///< m/s, to the left
    /// Where a robot believed to be, from 0,0 and heading 0 at its start, if that was recorded.
    std::optional<Pose2> odometry = {};
};

/// Somebody ran into something.
struct RunCollision {
    std::string id, other;  ///< other: a robot, a person or an element
};

/// Which bumpers of a robot touched something from a moment on.
struct RunBumpers {
    std::string id;
    std::vector<bool> hit;
};

/// Somebody in a record.
struct RunMember {
    std::string id;
    bool is_person = false;
};

/// Reads the poses of a recorded run, one moment after another, whatever its size: robots.csv, and
/// people.csv, odometry.csv, bumpers.csv and the collisions of events.csv if there are any.
///
/// The record may still be growing, or its run may have been killed: a last line without its end,
/// and a last moment at which some are missing, are left out.
class RunReader {
  public:
    /// \throws std::system_error if robots.csv cannot be read, FormatError as next()
    explicit RunReader(const std::string& folder);
    /// The content of the files in their place; all but the first may be empty. For tests.
    RunReader(std::string robots, std::string people, std::string events = "",
              std::string odometry = "", std::string bumpers = "");
    ~RunReader();
    RunReader(RunReader&&) noexcept;
    RunReader& operator=(RunReader&&) noexcept;

    /// Reads the next moment; false at the end. \throws FormatError with the line: other columns,
    /// no numbers, time that does not grow, somebody twice, moments of people that are none of
    /// robots
    bool next();
    /// Of the moment that was read last, seconds.
    [[nodiscard]] double time() const;
    /// Who is there at it: robots in the order of their lines, then people.
    [[nodiscard]] std::span<const RunState> states() const;
    /// Who ran into something in the step to it; nothing without events.csv, as from runs before
    /// there was one.
    [[nodiscard]] std::optional<std::span<const RunCollision>> collisions() const;
    /// Whose bumpers felt something else from it on, or from one since the moment before.
    [[nodiscard]] std::span<const RunBumpers> bumpers() const;
    /// Everybody so far; indices stay.
    [[nodiscard]] const std::vector<RunMember>& who() const;
    /// True if an incomplete last moment was left out; known at the end.
    [[nodiscard]] bool isCut() const;
    /// True if the record has odometry.
    [[nodiscard]] bool hasOdometry() const;
    /// The file of the robots, for messages.
    [[nodiscard]] const std::string& name() const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// When clients first changed the world of the run, by events.csv; nothing if they did not, or
/// without that file. \throws FormatError if it holds no events
std::optional<double> recordedChange(const std::string& folder);

}  // namespace ispace
