// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/scene/run: reads the records of runs: moments, collisions, changes of the scene.
//
// Records are untrusted, may be compressed, and may still grow: complete moments count, and each
// error names file and line. A reader takes constant memory, and O(bytes) for all moments. Not
// thread-safe; several readers may read one record at once. Poses are in the frame of the room,
// times seconds from the start.
//
//     RunReader run("run1");
//     while (run.next())
//         for (const RunState& state : run.states())
//             draw(run.time(), run.members()[state.member].id, state.pose);
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "scene/odometry_covariance.h"

namespace ispace {

/// Names of the files in a folder that `simrun --record` writes: that of a compressed one if it is
/// there (robots.csv.zst). Only regular files are opened.
struct RecordedFiles {
    explicit RecordedFiles(const std::string& folder);
    std::string robots, odometry, bumpers, people, events, info, scans;
};

/// Checks that the folder of a record exists. \throws std::system_error
void checkRecordFolder(const std::string& folder);
/// Returns the path of a file that a record names. \param name relative to the folder \throws
/// std::system_error if it does not exist; FormatError unless it is regular and lies in the folder
/// or below, links followed
std::string fileOfRecord(const std::string& folder, const std::string& name);
/// Returns the path of scene.env, which old records lack; "" without one. \throws as fileOfRecord
std::string sceneOfRecord(const std::string& folder);

/// The parameters of a run, from info.csv.
struct RunInfo {
    double step = 0;         ///< seconds
    double every = 0;        ///< seconds from one recorded moment to the next: a step, or several
    std::int64_t steps = 0;  ///< 0: unknown
    std::uint64_t seed = 0;
    bool noise = false;  ///< of sensors
};

/// Reads info.csv; empty if it is missing or empty, as after a killed run. Old records have no
/// seed. \throws FormatError for other content
std::optional<RunInfo> recordedInfo(const std::string& folder);

/// State of a robot or a person at a moment of a run.
struct RunState {
    std::size_t member = 0;  ///< index of RunReader::members()
    Pose2 pose;
    double speed = 0, accel = 0;  ///< m/s, m/s^2, forward
    Angle rotspeed, rotaccel;     ///< a second, a second a second
    bool is_stalled = false;
    double phase = 0;      ///< of a person's gait
    double sidespeed = 0;  ///< m/s, to the left
    /// The robot's odometry, from 0,0 and heading 0 at its start, if recorded.
    std::optional<EstimatedPose> odometry = {};
};

/// A collision of a robot or a person.
struct RunCollision {
    std::string id, other;  ///< other: a robot, a person or an element
};

/// A mover gave up its way.
struct RunUnreached {
    std::string id, to;             ///< to: a storey, a zone or an element, or ""
    std::optional<Point2> at = {};  ///< the point, of that storey or of the room
    std::string text = {};          ///< the reason, if known
};

/// The contacts of a robot's bumpers from a moment on.
struct RunBumpers {
    std::string id;
    std::vector<bool> hit;
};

/// A robot or a person of a record.
struct RunMember {
    std::string id;
    bool is_person = false;
    MotionAlphas alphas{};  ///< of errors of motion and odometry, if known
};

/// Reads the poses of a recorded run, one moment after another, in constant memory: robots.csv, and
/// if present people.csv, odometry.csv, bumpers.csv, and collisions and unreached targets of
/// events.csv.
///
/// The record may still grow, or its run may have been killed: an unterminated last line and an
/// incomplete last moment are skipped.
class RunReader {
  public:
    /// \throws std::system_error if robots.csv cannot be read, FormatError as next()
    explicit RunReader(const std::string& folder);
    /// Reads the content of the files from strings; all but the first may be empty. For tests.
    RunReader(std::string robots, std::string people, std::string events = "",
              std::string odometry = "", std::string bumpers = "");
    ~RunReader();
    RunReader(RunReader&&) noexcept;
    RunReader& operator=(RunReader&&) noexcept;

    /// Reads the next moment; false at the end. \throws FormatError with the line: unknown columns,
    /// invalid numbers, times that do not increase, a mover listed twice, moments of people without
    /// robots
    bool next();
    /// Returns the time of the current moment, in seconds.
    [[nodiscard]] double time() const;
    /// Returns the movers at this moment: robots in the order of their lines, then people.
    [[nodiscard]] std::span<const RunState> states() const;
    /// Returns the collisions in the step to this moment; empty optional without events.csv, as in
    /// runs of older versions.
    [[nodiscard]] std::optional<std::span<const RunCollision>> collisions() const;
    /// Returns the targets that movers gave up in the step to this moment.
    [[nodiscard]] std::span<const RunUnreached> unreached() const;
    /// Returns the bumpers that changed at this moment, or since the moment before.
    [[nodiscard]] std::span<const RunBumpers> bumpers() const;
    /// Returns all movers so far; indices stay valid.
    [[nodiscard]] const std::vector<RunMember>& members() const;
    /// Returns true if an incomplete last moment was skipped; known at the end.
    [[nodiscard]] bool isCut() const;
    /// Returns true if the record has odometry.
    [[nodiscard]] bool hasOdometry() const;
    /// Returns the name of the robots' file, for messages.
    [[nodiscard]] const std::string& name() const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Finds the time of the clients' first change to the world of the run in events.csv; empty without
/// changes or without that file. \throws FormatError if it holds no events
std::optional<double> recordedChange(const std::string& folder);

}  // namespace ispace
