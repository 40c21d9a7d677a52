// SPDX-License-Identifier: GPL-3.0-or-later
// The readings of scan, and their output.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cli/site_operands.h"
#include "scan/scan_options.h"
#include "sense/reading_run.h"
#include "sense/site_sensors.h"

namespace ispace {

/// Returns the options that formats require, with the history of the scene and of this command.
FormatOptions formatOptions(const ScanCommand& command, const SiteInput& input,
                            std::vector<SensorRoom> rooms);

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

/// Gives readings of several rooms in one file the frame of the site.
void shareFrame(const ScanToolOptions& options, const SeenSite& site,
                std::vector<SensorRoom>& rooms);

/// Reads the sensors of all rooms, room by room, or one along poses. Returns the number of
/// readings; 0 if the part exists already. \throws as the readers do, UsageError for sensors that
/// the format cannot hold
std::int64_t takeReadings(const ScanCommand& command, const ScanToolOptions& options);

/// Writes the scans that `simrun --record` has recorded (--run) in another format.
/// \throws as the scene's readers, UsageError if the format cannot hold scans in one file
void writeRecorded(const ScanCommand& command);

}  // namespace ispace
