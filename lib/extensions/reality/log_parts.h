// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by the readers of logs.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "base/error.h"
#include "extensions/reality/log.h"

namespace ispace::reality {

/// Counts the ranges and points that a reader stores. \throws FormatError above kMaxLogValues
class LogBudget {
  public:
    explicit LogBudget(std::string name) : name_(std::move(name)) {}
    void take(std::size_t values);

  private:
    std::string name_;
    std::size_t taken_ = 0;
};

/// Sorts scans, clouds and bursts by time; equal times keep their order.
void sortLog(Log& log);
/// Leaves out the poses of sensors that stand still, and checks that the log has measurements.
/// \throws FormatError
void finishLog(Log& log);

/// Collects messages of ROS 2 and resolves their frames when all transforms are known.
class RosLogBuilder {
  public:
    explicit RosLogBuilder(std::string name, LogPictures pictures = LogPictures::Skip);
    ~RosLogBuilder();
    RosLogBuilder(const RosLogBuilder&) = delete;
    RosLogBuilder& operator=(const RosLogBuilder&) = delete;

    /// Returns true for the types that are read: "sensor_msgs/msg/LaserScan".
    [[nodiscard]] bool reads(std::string_view type) const;
    /// Reads a message in CDR. \param file, place of the message, for errors: "byte 4711"
    /// \throws FormatError
    void add(std::string_view topic, std::string_view type, std::string_view message,
             const std::string& file, const std::string& place);
    /// Resolves the poses. \throws FormatError without a measurement
    Log finish();

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Reads the records of an MCAP file. \throws FormatError with the byte
void addMcap(std::string_view bytes, const std::string& name, RosLogBuilder& builder);
/// Reads the messages of a rosbag2 storage file of SQLite. \throws FormatError, std::system_error
void addSqliteBag(const std::string& file, RosLogBuilder& builder);

/// Unpacks a frame of zstd or lz4 to `size` bytes. \throws FormatError without a place
std::string unpackedChunk(std::string_view compression, std::string_view packed,
                          std::uint64_t size);

}  // namespace ispace::reality
