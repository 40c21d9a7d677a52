// SPDX-License-Identifier: GPL-3.0-or-later
// Inputs of scan, and the readings to take.
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

/// Returns the sensor that takes the poses: that of --model, or the only laser, ranger or camera of
/// the scene, placed or not. It does not see the robot or person that carries it. \param sources
/// the file that --model names is appended \throws UsageError for a bad --model and for an
/// ambiguous sensor; FormatError as withParameters()
Sensors sensorForPoses(const ScanToolOptions& options, const Scene& scene,
                       const DeviceCatalogue& devices, std::vector<std::string>& sources);

/// Returns the options that formats require, with the history of the scene and of this command.
FormatOptions formatOptions(const ScanCommand& command, const ScanToolOptions& options,
                            const SceneInput& input);

/// Writes readings to one stream, a set of files, or one cloud.
class Delivery {
  public:
    virtual ~Delivery() = default;
    [[nodiscard]] virtual Packing how() const = 0;
    /// Writes readings; may move data out of them.
    virtual void write(Readings& readings) = 0;
    /// Completes the output.
    virtual void commit() = 0;
};

/// \param count readings there will be; negative: unknown
/// \throws UsageError if one file is named for several readings of a format that cannot hold them
std::unique_ptr<Delivery> makeDelivery(const ScanToolOptions& options, const Sensors& sensors,
                                       const ReadingFormat& format, std::int64_t count);

/// Returns true if several readings are merged into one cloud: pcd and ply in the world frame.
bool isOneCloud(const ScanToolOptions& options);

/// \throws FormatError for more points than one file may have
void checkPoints(std::size_t points);

/// Returns the request for the scene. \throws UsageError if two inputs are stdin
SceneRequest requestOf(const ScanToolOptions& options);

/// Returns the sensors of a scene that are read at their own poses. \throws UsageError or
/// FormatError without any
Sensors placedSensors(const ScanToolOptions& options, const SceneInput& input);

/// Readings of a run, and their output.
struct ReadingWork {
    std::unique_ptr<ReadingSource> source;
    std::unique_ptr<Delivery> delivery;  ///< null: all readings are complete
    std::int64_t count = -1;             ///< of readings; -1 if unknown
};

/// Returns the readings that this run takes: all, or its part less the completed ones.
ReadingWork workOf(const ScanCommand& command, const ScanToolOptions& options,
                   const SceneInput& input, const Sensors& sensors, const ReadingFormat& format);

/// Writes the scans that `simrun --record` has recorded (--run without --view) in another format.
/// \throws as the scene's readers, UsageError if the format cannot hold scans in one file
void writeRecorded(const ScanCommand& command);

}  // namespace ispace
