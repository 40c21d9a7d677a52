// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/reality: compares logs of real sensors with a plan, and fits the noise of the
// sensors. Uses cli and below; liblz4 and SQLite inside.
//
// A log in any of its formats: CARMEN, MCAP and rosbag2 folders of ROS 2, the JSON lines of `scan`,
// the records of `simrun`.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/pose.h"

namespace ispace::reality {

/// The poses that a log has for one measurement. That of a sensor which stands still during the
/// whole log is left out, as it is the unknown of a calibration.
struct LogPoses {
    std::optional<Pose2> odometry = {};   ///< of the carrier, in the frame of odometry
    std::optional<Pose3> corrected = {};  ///< of the sensor, in the frame of a map
    std::optional<Pose3> mount = {};      ///< of the sensor, in the frame of its carrier

    /// Returns the pose of the sensor: the corrected one, else by odometry.
    [[nodiscard]] std::optional<Pose3> best() const;
};

/// One scan of a laser: beam k has bearing `first + k * step` in the sensor's frame.
struct LogScan {
    std::string sensor;  ///< its id, the topic, or FLASER, ROBOTLASER1, ...
    double time = 0;     ///< seconds; some logs have one time for all scans: the order holds
    Angle first, step;
    double beam_time = 0;                 ///< seconds from beam to beam, if the log has it
    double min_range = 0, max_range = 0;  ///< metres
    std::vector<float> ranges;            ///< metres; +infinity is no return
    LogPoses poses;
};

/// A point cloud, or a picture of a 3-D ranger: rays from the sensor's origin, in its frame.
struct LogCloud {
    std::string sensor;
    double time = 0;
    std::vector<std::array<float, 3>> rays;  ///< unit vectors
    std::vector<float> ranges;               ///< along them, metres; +infinity is no return
    double max_range = 0;                    ///< metres; +infinity if unknown
    LogPoses poses;
};

/// A burst of an ultrasonic tag.
struct LogBurst {
    std::string sensor;  ///< the tag
    double time = 0;
    std::optional<Pose3> corrected;  ///< of the tag; empty for one that stands still
    std::vector<std::pair<std::string, double>> heard;  ///< receivers and distances in metres
};

/// A picture of a camera, as it is stored.
struct LogPicture {
    std::string sensor;
    double time = 0;
    std::string file = {};   ///< that holds it; "" for one within the log
    std::string bytes = {};  ///< PNG, JPEG, PGM or PPM; "" for one in a file
};

/// A pose by odometry.
struct LogOdometry {
    std::string source;  ///< "ODOM", the topic, or the robot's id
    double time = 0;
    Pose2 pose;
    /// Number of scans in Log::scans that precede it, as times of some logs are useless.
    std::size_t scans_before = 0;
    /// True if its frame begins anew here: the next motion is relative to this pose. Logs of
    /// corrected poses begin anew at each scan.
    bool begins = false;
};

struct Log {
    std::string name;                ///< as the user named it
    std::string format;              ///< "carmen", "mcap", "rosbag2", "jsonl" or "record"
    std::vector<std::string> files;  ///< that were read
    // Each in the order of time; those of CARMEN as they are written.
    std::vector<LogScan> scans;
    std::vector<LogCloud> clouds;
    std::vector<LogBurst> bursts;
    std::vector<LogPicture> pictures;  ///< if they were asked for
    std::vector<LogOdometry> odometry;
};

/// Whether a reader keeps the pictures of cameras: most logs consist of little else.
enum class LogPictures { Skip, Keep };

/// Most ranges and points of a log, together: as many fit in 3 GB.
constexpr std::size_t kMaxLogValues = 200'000'000;

/// Reads a log, in the format that its content has; `operand` is a file, a folder (rosbag2, a
/// record of simrun) or - for stdin. \throws FormatError with the line of text, or the byte of a
/// binary file, for anything malformed, and for a log without measurements; std::system_error
Log readLog(const std::string& operand, LogPictures pictures = LogPictures::Skip);

/// Returns true for a log of one file: CARMEN, MCAP, JSON lines of scan. O(1)
bool isLog(std::string_view bytes);
/// Reads a log of one file from memory. \param name of the file, for messages \throws as readLog()
Log parseLog(std::string_view bytes, const std::string& name,
             LogPictures pictures = LogPictures::Skip);

// The formats, from memory. `name` is that of the file, for messages. \throws FormatError

/// CARMEN: FLASER (bearings from -90 degrees on, by the number of beams as CARMEN guesses them),
/// ROBOTLASERn, ODOM. A reading of the maximum range is no return. Poses of the laser that keep
/// their offset to the robot's odometry are the odometry; others are corrected.
Log readCarmenLog(std::string_view bytes, const std::string& name);
/// `scan -o x.jsonl`: lasers, rangers, tags, and pictures in files beside it.
Log readScanLines(std::string_view bytes, const std::string& name,
                  LogPictures pictures = LogPictures::Skip);
/// MCAP with messages in CDR: LaserScan, PointCloud2, Odometry, tf, Image and CompressedImage.
Log readMcapLog(std::string_view bytes, const std::string& name,
                LogPictures pictures = LogPictures::Skip);

}  // namespace ispace::reality
