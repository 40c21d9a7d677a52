// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan/scan_run.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "base/zstd_text.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "io/import_records.h"
#include "scene/run/run_reader.h"
#include "sense/formats/reading_format.h"
#include "sense/selection.h"

namespace ispace {

namespace {

/// Reads robots' odometry at ascending times, except for scans that last several steps: these are
/// sorted by their last beams.
class RecordedOdometry {
  public:
    RecordedOdometry(const std::string& folder, const Scene& scene, const Sensors& lasers)
        : run_(folder) {
        for (const PlacedRobot& robot : scene.robots) robots_.push_back(robot.id);
        if (const auto info = recordedInfo(folder); info && info->every > info->step)
            thinned_ = info->every;
        has_next_ = run_.next();
        // A scan is complete in the step after its last beam.
        constexpr double kMaxStep = 1;
        for (const Sensor& laser : lasers.read)
            if (const double duration = laser.as<Laser>().duration(); duration > 0)
                kept_ = std::max(kept_, duration + kMaxStep);
    }
    /// Returns the pose by odometry, or the true one if that was not recorded; nullopt before the
    /// record begins. \throws FormatError if the record is thinned and lacks this time
    std::optional<Pose2> poseOf(std::size_t robot, double time) {
        constexpr double kRounding = 1e-9;
        while (has_next_ && run_.time() <= time + kRounding) {
            Moment& moment = latest_.emplace_back();
            moment.time = run_.time();
            for (const RunState& state : run_.states()) {
                const std::string& id = run_.members()[state.member].id;
                moment.poses.emplace_back(id, state.odometry ? state.odometry->pose : state.pose);
            }
            while (latest_.size() > 1 && latest_[1].time <= moment.time - kept_)
                latest_.pop_front();
            has_next_ = run_.next();
        }
        const auto moment = std::find_if(latest_.rbegin(), latest_.rend(), [&](const Moment& each) {
            return each.time <= time + kRounding;
        });
        if (moment == latest_.rend()) return std::nullopt;
        if (thinned_ && std::abs(moment->time - time) > kRounding)
            throw FormatError({run_.name(), 0, 0,
                               "holds no moment at t=" + formatDouble(time) +
                                   " of a scan, as it was recorded with --record-every " +
                                   formatDouble(*thinned_) + ": choose another format"});
        const auto found =
            std::find_if(moment->poses.begin(), moment->poses.end(),
                         [&](const auto& known) { return known.first == robots_[robot]; });
        if (found == moment->poses.end()) return std::nullopt;
        return found->second;
    }

  private:
    struct Moment {
        double time = 0;
        std::vector<std::pair<std::string, Pose2>> poses;
    };

    RunReader run_;
    std::vector<std::string> robots_;
    std::deque<Moment> latest_;
    double kept_ = 0;                // seconds before the newest
    std::optional<double> thinned_;  // seconds between moments, if that is more than a step
    bool has_next_ = false;
};

/// Returns all movers of a run, including those added later. Robots of the scene have its alphas.
std::vector<RunMember> membersOf(const std::string& folder, const Scene& scene) {
    RunReader run(folder);
    while (run.next()) {
    }
    std::vector<RunMember> members = run.members();
    for (RunMember& member : members)
        for (const PlacedRobot& robot : scene.robots)
            if (robot.id == member.id) member.alphas = alphasOf(robot.model.noise);
    return members;
}

/// Writes the poses of all movers, up to the times of the readings, to a stream of a format.
class RecordedMoments {
  public:
    RecordedMoments(const std::string& folder, const ReadingFormat& format, ReadingStream& stream)
        : run_(folder), format_(format), stream_(stream), has_next_(run_.next()) {}

    void writeUntil(double time) {
        for (; has_next_ && run_.time() <= time; has_next_ = run_.next()) {
            // Readers interpolate; steps are often a few milliseconds.
            constexpr double kInterval = 0.02, kRounding = 1e-9;
            if (run_.time() + kRounding < due_) continue;
            due_ = run_.time() + kInterval;
            std::string text;
            format_.appendMoment(text, count_++, run_.time(), run_.states());
            stream_.write(text);
        }
    }

  private:
    RunReader run_;
    const ReadingFormat& format_;
    ReadingStream& stream_;
    double due_ = 0;
    std::uint32_t count_ = 0;
    bool has_next_;
};

Sensors recordedLasers(const ScanToolOptions& options, const Scene& scene) {
    Sensors lasers = sensorsOf(scene, options.select);
    std::erase_if(lasers.read, [](const Sensor& sensor) { return !sensor.is<Laser>(); });
    if (lasers.read.empty())
        throw UsageError("--run: the record has no scans of " +
                         std::string(options.select.empty() ? "lasers" : "such lasers") +
                         ", and other readings stay as they are recorded");
    return lasers;
}

/// A record holds its own scene.
SceneInput sceneOf(const ScanToolOptions& options) {
    std::vector<std::string> operands = options.operands;
    if (operands.empty()) operands.push_back(fileOfRecord(options.view.run, "scene.env"));
    return readScene({operands, options.rules, false, {}});
}

}  // namespace

void writeRecorded(const ScanCommand& command) {
    const ScanToolOptions& options = command.options();
    checkRecordFolder(options.view.run);
    const SceneInput input = sceneOf(options);
    warnOfImport(options.common, "scan", input);
    const Sensors lasers = recordedLasers(options, input.scene);
    FormatOptions how = formatOptions(command, command.options(), input);
    const bool wants_moments = options.format == "mcap";
    if (wants_moments) {
        how.members = membersOf(options.view.run, input.scene);
        if (const auto info = recordedInfo(options.view.run)) how.moment_interval = info->every;
    }
    const auto format = makeFormat(options.format, lasers, std::move(how));
    if (!format->isStream())
        throw UsageError(
            "--run: " + options.format +
            " holds one reading a file; take one of jsonl|csv|raw|carmen|mcap|npz|npy|las");
    format->checkStream();
    if (format->isBinary()) refuseTerminal(options.common.output, options.format);
    const std::string name = RecordedFiles(options.view.run).scans;
    const auto file = std::make_shared<TextFile>(name, InputKind::Regular);
    RecordedScans scans([file](std::string& bytes) { return file->read(bytes); }, name);
    RecordedOdometry odometry(options.view.run, input.scene, lasers);
    const bool wants_odometry = options.format == "carmen";
    OutputFile output(options.common.output);
    const auto stream = format->stream([&output](auto bytes) { output.write(bytes); });
    std::optional<RecordedMoments> moments;
    if (wants_moments) moments.emplace(options.view.run, *format, *stream);
    std::int64_t count = 0;
    while (const auto found = scans.next()) {
        const auto laser =
            std::find_if(lasers.read.begin(), lasers.read.end(),
                         [&](const Sensor& sensor) { return sensor.id == found->sensor; });
        if (laser == lasers.read.end()) continue;
        if (found->ranges.size() != static_cast<std::size_t>(laser->as<Laser>().beams))
            throw FormatError({name, 0, 0,
                               "a scan of " + laser->id + " with " +
                                   std::to_string(found->ranges.size()) +
                                   " beams, which it does not have in this scene"});
        Scan scan{.time = found->time,
                  .frame = found->frame,
                  .number = found->number,
                  .pose = found->pose,
                  .beam_poses = {},
                  .ranges = found->ranges};
        if (wants_odometry && laser->mount) {
            const auto robot = odometry.poseOf(laser->mount->robot, scan.time);
            if (robot) scan.pose = mountedPose(*robot, laser->mount->robot_from_sensor);
        }
        if (moments) moments->writeUntil(scan.time);
        std::string text;
        format->append(text, static_cast<std::size_t>(laser - lasers.read.begin()),
                       std::vector<Scan>{std::move(scan)});
        stream->write(text);
        ++count;
    }
    if (moments) moments->writeUntil(std::numeric_limits<double>::infinity());
    stream->finish();
    output.commit();
    std::vector<std::string> files = filesOf(input);
    files.push_back(name);
    if (wants_moments) files.push_back(RecordedFiles(options.view.run).robots);
    writeDependencies(options.common, files);
    logInfo(options.common, "scan", std::to_string(count) + " scans written");
}

}  // namespace ispace
