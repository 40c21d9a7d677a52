// SPDX-License-Identifier: GPL-3.0-or-later
// Reads logs of any format into one form. Logs are untrusted: sizes and numbers are bounded.
#include "extensions/reality/log.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/number.h"
#include "base/zstd_text.h"
#include "cli/operands.h"
#include "extensions/reality/log_parts.h"
#include "scene/run/run_reader.h"

namespace ispace::reality {

namespace {

using nlohmann::json;

constexpr float kLogNoReturn = std::numeric_limits<float>::infinity();
constexpr double kFarAway = 1e6;  // metres

/// \throws FormatError without a place
[[noreturn]] void refuseLine(const std::string& message) { throw FormatError({"", 0, 0, message}); }

double numberOf(const json& line, const char* key, double lowest, double highest) {
    const double value = line.at(key).get<double>();
    if (!(value >= lowest && value <= highest))
        refuseLine(std::string("`") + key + "` is no number from " + formatDouble(lowest) + " to " +
                   formatDouble(highest));
    return value;
}

Pose3 loggedPose(const json& line) {
    constexpr std::size_t kNumbers = 6;
    const auto pose = line.at("pose").get<std::vector<double>>();
    if (pose.size() != kNumbers) refuseLine("`pose` has not six numbers");
    for (const double value : pose)
        if (!(std::abs(value) <= kFarAway)) refuseLine("`pose` is out of range");
    return {{pose[0], pose[1], pose[2]},
            Angle::radians(pose[3]),
            Angle::radians(pose[4]),
            Angle::radians(pose[5])};
}

std::vector<float> rangesOf(const json& values) {
    std::vector<float> ranges;
    ranges.reserve(values.size());
    for (const json& value : values) {
        const float range = value.is_null() ? kLogNoReturn : value.get<float>();
        if (!(range >= 0)) refuseLine("a range below 0");
        ranges.push_back(range);
    }
    return ranges;
}

LogScan scanOfLine(const json& line) {
    LogScan scan;
    constexpr double kMostRadians = 7;
    scan.first = Angle::radians(numberOf(line, "angle_min", -kMostRadians, kMostRadians));
    scan.step = Angle::radians(numberOf(line, "angle_increment", -kMostRadians, kMostRadians));
    scan.min_range = numberOf(line, "range_min", 0, kFarAway);
    scan.max_range = numberOf(line, "range_max", 0, kFarAway);
    scan.ranges = rangesOf(line.at("ranges"));
    scan.poses.corrected = loggedPose(line);
    return scan;
}

/// Converts the picture of a ranger.
LogCloud cloudOfLine(const json& line) {
    LogCloud cloud;
    constexpr double kMostPixels = 1 << 16, kMostFocal = 1e9;
    const auto columns = static_cast<std::size_t>(numberOf(line, "width", 1, kMostPixels));
    const auto rows = static_cast<std::size_t>(numberOf(line, "height", 1, kMostPixels));
    const json& depths = line.at("depths");
    if (!depths.is_array() || depths.size() != columns * rows)
        refuseLine("`depths` has not width times height numbers");
    cloud.ranges = rangesOf(depths);
    cloud.max_range = numberOf(line, "range_max", 0, kFarAway);
    if (line.at("projection").get<std::string>() != "pinhole")
        refuseLine("`projection` is not pinhole, the one that is read");
    const double fx = numberOf(line, "fx", 1e-9, kMostFocal);
    const double fy = numberOf(line, "fy", 1e-9, kMostFocal);
    const double cx = numberOf(line, "cx", -kMostPixels, kMostPixels);
    const double cy = numberOf(line, "cy", -kMostPixels, kMostPixels);
    cloud.rays.reserve(cloud.ranges.size());
    for (std::size_t k = 0; k < cloud.ranges.size(); ++k) {
        const std::size_t row = k / columns, column = k % columns;
        const double left = -(static_cast<double>(column) - cx) / fx;
        const double up = -(static_cast<double>(row) - cy) / fy;
        // Depths are multiples of a ray with forward component 1.
        const double size = std::hypot(1.0, left, up);
        cloud.rays.push_back({static_cast<float>(1 / size), static_cast<float>(left / size),
                              static_cast<float>(up / size)});
        cloud.ranges[k] = static_cast<float>(cloud.ranges[k] * size);
    }
    cloud.poses.corrected = loggedPose(line);
    return cloud;
}

LogBurst burstOfLine(const json& line) {
    LogBurst burst;
    burst.corrected = loggedPose(line);
    for (const json& one : line.at("heard"))
        burst.heard.emplace_back(one.at("receiver").get<std::string>(),
                                 numberOf(one, "range", 0, kFarAway));
    return burst;
}

template <typename Part>
void storePart(std::vector<Part>& parts, Part part, const json& line) {
    part.sensor = line.at("sensor").get<std::string>();
    constexpr double kMostSeconds = 1e12;
    part.time = numberOf(line, "t", -kMostSeconds, kMostSeconds);
    parts.push_back(std::move(part));
}

/// Reads lines of ispace-scan/1; an incomplete last line is skipped, as a killed run leaves it.
void addScanLines(std::string_view bytes, const std::string& name, LogPictures pictures, Log& log) {
    const std::string folder =
        name == "-" ? "" : std::filesystem::path(name).parent_path().string();
    LogBudget budget(name);
    int number = 0;
    for (std::size_t begin = 0; begin < bytes.size();) {
        const std::size_t end = bytes.find('\n', begin);
        if (end == std::string_view::npos) break;
        const std::string_view text = bytes.substr(begin, end - begin);
        begin = end + 1;
        ++number;
        try {
            const json line = json::parse(text);
            if (!line.is_object()) refuseLine("no line of ispace-scan/1");
            if (number == 1) {
                if (line.value("schema", "") != "ispace-scan/1")
                    refuseLine("its first line does not say ispace-scan/1");
            } else if (line.contains("ranges")) {
                budget.take(line["ranges"].size());
                storePart(log.scans, scanOfLine(line), line);
            } else if (line.contains("depths")) {
                budget.take(line["depths"].size());
                storePart(log.clouds, cloudOfLine(line), line);
            } else if (line.contains("heard") && line.contains("pose")) {
                budget.take(line["heard"].size());
                storePart(log.bursts, burstOfLine(line), line);
            } else if (pictures == LogPictures::Keep && line.contains("file") &&
                       line["file"].is_string()) {
                budget.take(1);
                const std::filesystem::path file = line["file"].get<std::string>();
                LogPicture picture;
                picture.file = (std::filesystem::path(folder) / file).string();
                storePart(log.pictures, std::move(picture), line);
            }
        } catch (const json::exception&) {
            throw FormatError({displayName(name), number, 0, "no line of ispace-scan/1"});
        } catch (const FormatError& error) {
            throw FormatError({displayName(name), number, 0, error.diagnostics().front().message});
        }
    }
}

/// Returns the poses of parts of one sensor, for any of the parts that have them.
template <typename Part>
const Pose3* correctedOf(const Part& part) {
    if constexpr (requires { part.poses; })
        return part.poses.corrected ? &*part.poses.corrected : nullptr;
    else
        return part.corrected ? &*part.corrected : nullptr;
}

bool isSamePose(const Pose3& a, const Pose3& b) {
    constexpr double kMetres = 1e-6, kDegrees = 1e-5;
    const auto turns = [](Angle x, Angle y) { return std::abs(wrapped(x - y).degrees()); };
    return length(a.position - b.position) < kMetres && turns(a.heading, b.heading) < kDegrees &&
           turns(a.tilt, b.tilt) < kDegrees && turns(a.roll, b.roll) < kDegrees;
}

/// Leaves out the poses of sensors that stand still.
template <typename Part>
void forgetFixed(std::vector<Part>& parts) {
    std::map<std::string, std::pair<Pose3, bool>> sensors;  // first pose, and whether it moves
    for (const Part& part : parts)
        if (const Pose3* const pose = correctedOf(part)) {
            auto& [first, moves] = sensors.try_emplace(part.sensor, *pose, false).first->second;
            moves = moves || !isSamePose(first, *pose);
        }
    for (Part& part : parts) {
        const auto found = sensors.find(part.sensor);
        if (found == sensors.end() || found->second.second) continue;
        if constexpr (requires { part.poses; }) {
            // One that its carrier has is known, wherever that stands.
            if (!part.poses.odometry) part.poses.corrected.reset();
        } else {
            part.corrected.reset();
        }
    }
}

/// Adds the odometry of robots of a record to the log and to the scans of their sensors.
void addRecordedOdometry(const std::string& folder, Log& log) {
    const std::string scene_file = sceneOfRecord(folder);
    std::map<std::string, std::pair<std::string, Pose3>> mounts;  // sensor: robot, pose on it
    if (!scene_file.empty()) {
        log.files.push_back(scene_file);
        SceneRequest request{.operands = {scene_file}};
        request.layout_from_stdin = false;
        const SceneInput input = readScene(request);
        for (const Sensor& sensor : input.scene.sensors)
            if (sensor.mount)
                mounts.emplace(sensor.id, std::pair(input.scene.robots[sensor.mount->robot].id,
                                                    sensor.mount->robot_from_sensor));
    }
    RunReader run(folder);
    std::map<std::string, std::size_t> next;  // scan of each robot's sensors
    std::size_t scans = 0;
    while (run.next()) {
        constexpr double kRounding = 1e-9;
        for (const RunState& state : run.states()) {
            if (!state.odometry) continue;
            while (scans < log.scans.size() && log.scans[scans].time < run.time() - kRounding)
                ++scans;
            log.odometry.push_back({.source = run.members()[state.member].id,
                                    .time = run.time(),
                                    .pose = state.odometry->pose,
                                    .scans_before = scans,
                                    .begins = false});
        }
    }
    std::map<std::string, std::vector<const LogOdometry*>> ways;
    for (const LogOdometry& each : log.odometry) ways[each.source].push_back(&each);
    for (LogScan& scan : log.scans) {
        const auto mount = mounts.find(scan.sensor);
        if (mount == mounts.end()) continue;
        scan.poses.mount = mount->second.second;
        const auto way = ways.find(mount->second.first);
        if (way == ways.end()) continue;
        constexpr double kRounding = 1e-9;
        const auto after = std::upper_bound(
            way->second.begin(), way->second.end(), scan.time + kRounding,
            [](double time, const LogOdometry* each) { return time < each->time; });
        if (after != way->second.begin()) scan.poses.odometry = (*(after - 1))->pose;
    }
}

Log readRecordFolder(const std::string& folder, LogPictures pictures) {
    Log log;
    log.name = folder;
    log.format = "record";
    const RecordedFiles files(folder);
    log.files = {files.scans, files.robots};
    TextFile file(files.scans, InputKind::Regular);
    std::string text;
    while (file.read(text)) {
        if (text.size() > kMaxFileBytes)
            throw FormatError({files.scans, 0, 0, "more than " + formatBytes(kMaxFileBytes)});
    }
    addScanLines(text, files.scans, pictures, log);
    text.clear();
    sortLog(log);
    addRecordedOdometry(folder, log);
    finishLog(log);
    return log;
}

/// The storage files of a rosbag2 folder, in the order in which they were written.
std::vector<std::string> bagFiles(const std::string& folder) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().string();
        if (name.ends_with(".mcap") || name.ends_with(".db3")) files.push_back(name);
        if (name.ends_with(".mcap.zstd") || name.ends_with(".db3.zstd"))
            throw FormatError({name, 0, 0, "a compressed file of a bag: unpack it with zstd -d"});
    }
    // bag_10 follows bag_9.
    std::sort(files.begin(), files.end(), [](const std::string& a, const std::string& b) {
        return std::pair(a.size(), a) < std::pair(b.size(), b);
    });
    return files;
}

Log readBagFolder(const std::string& folder, const std::vector<std::string>& files,
                  LogPictures pictures) {
    RosLogBuilder builder(folder, pictures);
    for (const std::string& file : files) {
        if (file.ends_with(".db3"))
            addSqliteBag(file, builder);
        else
            addMcap(readAll(file, InputKind::Regular), file, builder);
    }
    Log log = builder.finish();
    log.format = "rosbag2";
    log.files = files;
    return log;
}

Log readLogFolder(const std::string& folder, LogPictures pictures) {
    if (const std::vector<std::string> files = bagFiles(folder); !files.empty())
        return readBagFolder(folder, files, pictures);
    const RecordedFiles record(folder);
    if (std::filesystem::exists(record.scans) && std::filesystem::exists(record.robots))
        return readRecordFolder(folder, pictures);
    throw FormatError({folder, 0, 0,
                       "neither a bag of ROS 2 (.mcap, .db3) nor a record of simrun (scans.jsonl, "
                       "robots.csv)"});
}

constexpr std::string_view kMcap = "\x89MCAP";
constexpr std::string_view kSqlite{"SQLite format 3\0", 16};

/// Returns true if one of the first lines is a message of CARMEN.
bool isCarmen(std::string_view bytes) {
    constexpr std::size_t kLines = 1000;
    for (std::size_t line = 0, begin = 0; line < kLines && begin < bytes.size(); ++line) {
        const std::size_t end = std::min(bytes.find('\n', begin), bytes.size());
        const std::string_view text = bytes.substr(begin, end - begin);
        for (const std::string_view type : {"FLASER ", "ODOM ", "ROBOTLASER"})
            if (text.starts_with(type)) return true;
        begin = end + 1;
    }
    return false;
}

}  // namespace

std::optional<Pose3> LogPoses::best() const {
    if (corrected) return corrected;
    if (!odometry) return std::nullopt;
    const Pose3 on = mount.value_or(Pose3());
    const Point2 place = *odometry * on.position.onFloor();
    return Pose3{{place.x, place.y, on.position.z},
                 wrapped(odometry->heading + on.heading),
                 on.tilt,
                 on.roll};
}

void LogBudget::take(std::size_t values) {
    taken_ += values;
    if (taken_ > kMaxLogValues)
        throw FormatError(
            {displayName(name_), 0, 0,
             "more than " + std::to_string(kMaxLogValues) + " ranges and points; cut the log"});
}

void sortLog(Log& log) {
    const auto sort = [](auto& parts) {
        std::stable_sort(parts.begin(), parts.end(),
                         [](const auto& a, const auto& b) { return a.time < b.time; });
    };
    sort(log.scans);
    sort(log.clouds);
    sort(log.bursts);
    sort(log.pictures);
}

void finishLog(Log& log) {
    forgetFixed(log.scans);
    forgetFixed(log.clouds);
    forgetFixed(log.bursts);
    if (log.scans.empty() && log.clouds.empty() && log.bursts.empty())
        throw FormatError({displayName(log.name), 0, 0,
                           log.pictures.empty()
                               ? "the log holds no scans and no clouds"
                               : "the log holds pictures alone: cameras are placed by the people "
                                 "that lasers see, too"});
}

Log readScanLines(std::string_view bytes, const std::string& name, LogPictures pictures) {
    Log log;
    log.name = name;
    log.format = "jsonl";
    addScanLines(bytes, name, pictures, log);
    sortLog(log);
    finishLog(log);
    return log;
}

Log readMcapLog(std::string_view bytes, const std::string& name, LogPictures pictures) {
    RosLogBuilder builder(name, pictures);
    addMcap(bytes, name, builder);
    return builder.finish();
}

bool isLog(std::string_view bytes) {
    constexpr std::size_t kHeader = 200;
    return bytes.starts_with(kMcap) || isCarmen(bytes) ||
           (bytes.starts_with('{') &&
            bytes.substr(0, kHeader).find("\"ispace-scan/") != std::string_view::npos);
}

Log parseLog(std::string_view bytes, const std::string& name, LogPictures pictures) {
    Log log;
    if (bytes.starts_with(kMcap)) {
        log = readMcapLog(bytes, name, pictures);
    } else if (bytes.starts_with(kSqlite)) {
        throw FormatError({displayName(name), 0, 0, "a bag of SQLite: its name must end in .db3"});
    } else if (bytes.starts_with('{')) {
        log = readScanLines(bytes, name, pictures);
    } else if (isCarmen(bytes)) {
        log = readCarmenLog(bytes, name);
    } else {
        throw FormatError({displayName(name), 0, 0,
                           "no log that is read: CARMEN, MCAP, a folder of rosbag2, JSON lines of "
                           "scan, a record of simrun"});
    }
    log.files = {name};
    return log;
}

Log readLog(const std::string& operand, LogPictures pictures) {
    std::error_code ignored;
    if (operand != "-" && std::filesystem::is_directory(operand, ignored))
        return readLogFolder(operand, pictures);
    if (operand.ends_with(".db3")) {
        Log log = readBagFolder(operand, {operand}, pictures);
        return log;
    }
    return parseLog(operand == "-" ? readStdin() : readAll(operand), operand, pictures);
}

}  // namespace ispace::reality
