// SPDX-License-Identifier: GPL-3.0-or-later
// What scan reads before it takes readings, and what readings there are to take.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cli/operands.h"
#include "scan/scan_options.h"
#include "sense/reading_run.h"
#include "sense/selection.h"

namespace ispace {

/// The sensor that takes the poses: that of --model, or the only laser, ranger or camera of the
/// scene, placed or not. It does not see the robot or person that carries it there. \param sources
/// what --model names is appended \throws UsageError for a bad --model and where it is not clear
/// which; FormatError as laserOf
Sensors sensorForPoses(const ScanToolOptions& options, const Scene& scene,
                       const DeviceCatalogue& devices, std::vector<std::string>& sources);

/// What formats need to know, with the history of the scene and of this command.
FormatOptions formatOptions(const ScanCommand& command, const SceneInput& input);

/// Where readings go: one stream, a set of files, or one cloud.
class Delivery {
  public:
    virtual ~Delivery() = default;
    [[nodiscard]] virtual Packing how() const = 0;
    /// What it keeps of the readings it may take out of them.
    virtual void write(Readings& readings) = 0;
    /// All is written.
    virtual void commit() = 0;
};

/// \param count readings there will be; negative: nobody knows
/// \throws UsageError where one file is named for several readings of a format that cannot hold
/// them
std::unique_ptr<Delivery> makeDelivery(const ScanToolOptions& options, const Sensors& sensors,
                                       const ReadingFormat& format, std::int64_t count);

/// Where several readings become one cloud: pcd and ply in the world frame.
bool isOneCloud(const ScanToolOptions& options);

/// \throws FormatError for more points than one file may have
void checkPoints(std::size_t points);

/// What is read as scene. \throws UsageError where two things are to come from stdin
SceneRequest requestOf(const ScanToolOptions& options);

/// The sensors of a scene that are read where they stand. \throws UsageError or FormatError if
/// there are none
Sensors placedSensors(const ScanToolOptions& options, const SceneInput& input);

/// What a run has to take, and where it goes.
struct ReadingWork {
    std::unique_ptr<ReadingSource> source;
    std::unique_ptr<Delivery> delivery;  ///< null: all is done
    std::int64_t count = -1;             ///< of readings; -1 if nobody knows
};

/// What this run takes: all, or the part of it that is its own and not done yet.
ReadingWork workOf(const ScanCommand& command, const SceneInput& input, const Sensors& sensors,
                   const ReadingFormat& format);

/// Writes the scans that `simrun --record` has recorded (--run without --view) in another format.
/// \throws as the scene's readers, UsageError where the format cannot hold scans in one file
void writeRecorded(const ScanCommand& command);

}  // namespace ispace
