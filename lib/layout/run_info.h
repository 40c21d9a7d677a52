// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

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

}  // namespace ispace
