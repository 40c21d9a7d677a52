// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan/scan_run.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/glob.h"
#include "base/message.h"
#include "base/number.h"
#include "base/zstd_text.h"
#include "cli/outputs.h"
#include "cli/recorded_operands.h"
#include "io/import_records.h"
#include "scene/run/run_reader.h"
#include "sense/formats/reading_format.h"
#include "sense/site_sensors.h"

namespace ispace {

namespace {

/// Reads robots' odometry at ascending times, except for scans that last several steps: these are
/// sorted by their last beams.
class RecordedOdometry {
  public:
    /// \param id_of returns the id across the site of a mover in the record
    RecordedOdometry(const std::string& folder, const Sensors& lasers,
                     std::function<std::string(const std::string&)> id_of)
        : run_(folder), id_of_(std::move(id_of)) {
        if (const auto info = recordedInfo(folder); info && info->every > info->step)
            thinned_ = info->every;
        has_next_ = run_.next();
        // A scan is complete in the step after its last beam.
        constexpr double kMaxStep = 1;
        for (const Sensor& laser : lasers.read)
            if (const double duration = laser.as<Laser>().duration(); duration > 0)
                kept_ = std::max(kept_, duration + kMaxStep);
    }
    struct Pose {
        Pose2 pose;
        bool is_true = true;  ///< in the room; false: by odometry
    };
    /// Returns the pose by odometry, or the true one if that was not recorded; nullopt before the
    /// record begins. \param robot its id across the site \throws FormatError if the record is
    /// thinned and lacks this time
    std::optional<Pose> poseOf(const std::string& robot, double time) {
        constexpr double kRounding = 1e-9;
        while (has_next_ && run_.time() <= time + kRounding) {
            Moment& moment = latest_.emplace_back();
            moment.time = run_.time();
            for (const RunState& state : run_.states()) {
                moment.poses.emplace_back(
                    id_of_(run_.members()[state.member].id),
                    state.odometry ? Pose{state.odometry->pose, false} : Pose{state.pose, true});
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
        const auto found = std::find_if(moment->poses.begin(), moment->poses.end(),
                                        [&](const auto& known) { return known.first == robot; });
        if (found == moment->poses.end()) return std::nullopt;
        return found->second;
    }

  private:
    struct Moment {
        double time = 0;
        std::vector<std::pair<std::string, Pose>> poses;
    };

    RunReader run_;
    std::function<std::string(const std::string&)> id_of_;
    std::deque<Moment> latest_;
    double kept_ = 0;                // seconds before the newest
    std::optional<double> thinned_;  // seconds between moments, if that is more than a step
    bool has_next_ = false;
};

/// The rooms of a site in a record: a folder each, or the record itself.
class RecordedSite {
  public:
    RecordedSite(const std::string& folder, const SiteInput& input)
        : folder_(folder), input_(&input), is_whole_(holdsBuilding(folder)) {
        mustHoldRecord("--run", folder);
        if (!is_whole_ && !input.isOneRoom()) refuseRecordOfRoom(input, "--run", folder);
    }
    [[nodiscard]] std::string folder(std::size_t room) const {
        return recordOfStorey(recordFor(*input_, folder_), input_->building.document.storeys[room]);
    }
    /// Returns the id across the site of a thing in the record of a room. In that of a building,
    /// and in its part, movers and sensors on them have the storey of their start before their ids.
    [[nodiscard]] std::string siteId(std::size_t room, const std::string& recorded) const {
        if (input_->isOneRoom()) {
            const std::string prefix = input_->storey + '/';
            return recorded.starts_with(prefix) ? recorded.substr(prefix.size()) : recorded;
        }
        return recorded.find('/') == std::string::npos ? input_->idOf(room, recorded) : recorded;
    }
    /// Checks the movers at the start. \throws FormatError for one that the site does not have
    void checkStart() const {
        for (std::size_t room = 0; room < input_->rooms().size(); ++room) {
            RunReader run(folder(room));
            if (!run.next()) continue;
            for (const RunState& state : run.states()) {
                const std::string& id = run.members()[state.member].id;
                if (!isOfSite(siteId(room, id)))
                    throw FormatError({run.name(), 0, 0,
                                       "the scene has no robot or person " + excerpt(id) +
                                           ": it is not that of the record"});
            }
        }
    }

  private:
    [[nodiscard]] bool isOfSite(const std::string& mover) const {
        // A guest from another storey.
        if (is_whole_ && input_->isOneRoom() && mover.find('/') != std::string::npos) return true;
        for (std::size_t room = 0; room < input_->rooms().size(); ++room) {
            const auto is_it = [&](const auto& one) { return input_->idOf(room, one.id) == mover; };
            const Scene& scene = *input_->rooms()[room];
            if (std::any_of(scene.robots.begin(), scene.robots.end(), is_it) ||
                std::any_of(scene.people.begin(), scene.people.end(), is_it))
                return true;
        }
        return false;
    }

    std::string folder_;
    const SiteInput* input_;
    bool is_whole_;  // of a building
};

/// Returns all movers of a run, including those added later. Robots of the scenes have their
/// alphas.
std::vector<RunMember> membersOf(const RecordedSite& record, const SiteInput& input) {
    std::vector<RunMember> members;
    for (std::size_t room = 0; room < input.rooms().size(); ++room) {
        RunReader run(record.folder(room));
        while (run.next()) {
        }
        for (const RunMember& member : run.members())
            if (std::none_of(members.begin(), members.end(),
                             [&](const RunMember& known) { return known.id == member.id; }))
                members.push_back(member);
    }
    for (std::size_t room = 0; room < input.rooms().size(); ++room)
        for (const PlacedRobot& robot : input.rooms()[room]->robots)
            for (RunMember& member : members)
                if (record.siteId(room, member.id) == input.idOf(room, robot.id))
                    member.alphas = alphasOf(robot.model.noise);
    return members;
}

/// Writes the poses of a room's movers, up to the times of the readings, to a stream of a format.
class RecordedMoments {
  public:
    /// \param members of the format \param count of moments so far
    RecordedMoments(const std::string& folder, std::size_t room, std::span<const RunMember> members,
                    const ReadingFormat& format, ReadingStream& stream, std::uint32_t& count)
        : run_(folder),
          room_(room),
          members_(members),
          format_(format),
          stream_(stream),
          count_(count),
          has_next_(run_.next()) {}

    void writeUntil(double time) {
        for (; has_next_ && run_.time() <= time; has_next_ = run_.next()) {
            // Readers interpolate; steps are often a few milliseconds.
            constexpr double kInterval = 0.02, kRounding = 1e-9;
            if (run_.time() + kRounding < due_) continue;
            due_ = run_.time() + kInterval;
            std::vector<RunState> states(run_.states().begin(), run_.states().end());
            for (RunState& state : states) state.member = memberOf(run_.members()[state.member].id);
            std::string text;
            format_.appendMoment(text, count_++, run_.time(), room_, states);
            stream_.write(text);
        }
    }

  private:
    [[nodiscard]] std::size_t memberOf(const std::string& id) const {
        const auto found = std::find_if(members_.begin(), members_.end(),
                                        [&id](const RunMember& one) { return one.id == id; });
        return static_cast<std::size_t>(found - members_.begin());
    }

    RunReader run_;
    std::size_t room_;
    std::span<const RunMember> members_;
    const ReadingFormat& format_;
    ReadingStream& stream_;
    std::uint32_t& count_;
    double due_ = 0;
    bool has_next_;
};

SiteSensors recordedLasers(const ScanToolOptions& options, const SiteInput& input) {
    SiteSensors lasers = sensorsOf(input.rooms(), input.ids(), inOwnStorey(input, options.select));
    std::vector<Sensor> kept;
    std::size_t next = 0;
    for (SensorRoom& room : lasers.rooms) {
        for (; next < room.read_end; ++next)
            if (lasers.sensors.read[next].is<Laser>())
                kept.push_back(std::move(lasers.sensors.read[next]));
        room.read_end = kept.size();
    }
    lasers.sensors.read = std::move(kept);
    if (lasers.sensors.read.empty())
        throw UsageError("--run: the record has no scans of " +
                         std::string(options.select.empty() ? "lasers" : "such lasers") +
                         ", and other readings stay as they are recorded");
    return lasers;
}

/// Reads the recorded scans of a site, and writes them.
class RecordedReadings {
  public:
    RecordedReadings(const ScanToolOptions& options, const SiteInput& input,
                     const SiteSensors& lasers, const RecordedSite& record,
                     const ReadingFormat& format, std::span<const RunMember> members,
                     ReadingStream& stream)
        : options_(options),
          input_(input),
          site_(input),
          lasers_(lasers.sensors),
          rooms_(lasers.rooms),
          record_(record),
          format_(format),
          members_(members),
          stream_(stream) {}

    /// Writes the scans of a room. \return their number
    std::int64_t write(std::size_t room) {
        const std::string folder = record_.folder(room), name = RecordedFiles(folder).scans;
        const auto file = std::make_shared<TextFile>(name, InputKind::Regular);
        RecordedScans scans([file](std::string& bytes) { return file->read(bytes); }, name);
        RecordedOdometry odometry(folder, lasers_, [this, room](const std::string& id) {
            return record_.siteId(room, id);
        });
        std::optional<RecordedMoments> moments;
        if (!members_.empty())
            moments.emplace(folder, room, members_, format_, stream_, moment_count_);
        std::int64_t count = 0;
        while (const auto found = scans.next()) {
            const std::string id = record_.siteId(room, found->sensor);
            const auto laser = std::find_if(lasers_.read.begin(), lasers_.read.end(),
                                            [&](const Sensor& sensor) { return sensor.id == id; });
            if (laser == lasers_.read.end()) {
                if (isWanted(id)) ++unknown_[{name, found->sensor}];
                continue;
            }
            if (found->ranges.size() != static_cast<std::size_t>(laser->as<Laser>().beams))
                throw FormatError({name, 0, 0,
                                   "a scan of " + laser->id + " with " +
                                       std::to_string(found->ranges.size()) +
                                       " beams, which it does not have in this scene"});
            const auto index = static_cast<std::size_t>(laser - lasers_.read.begin());
            const std::size_t home = roomOf(rooms_, index);
            Scan scan{.time = found->time,
                      .frame = found->frame,
                      .number = found->number,
                      .pose = inRoom(room, home, found->pose),
                      .beam_poses = {},
                      .ranges = found->ranges};
            if (options_.format == "carmen" && laser->mount) {
                const std::string& robot = input_.rooms()[home]->robots[laser->mount->robot].id;
                if (const auto at = odometry.poseOf(input_.idOf(home, robot), scan.time)) {
                    scan.pose = mountedPose(at->pose, laser->mount->robot_from_sensor);
                    if (at->is_true) scan.pose = inRoom(room, home, scan.pose);
                }
            }
            if (moments) moments->writeUntil(scan.time);
            std::string text;
            format_.append(text, index, std::vector<Scan>{std::move(scan)});
            stream_.write(text);
            ++count;
        }
        if (moments) moments->writeUntil(std::numeric_limits<double>::infinity());
        return count;
    }

    /// Returns a warning of the scans left out, for each sensor that the site does not have.
    /// \param written scans \throws FormatError if these are all
    [[nodiscard]] std::vector<Diagnostic> leftOut(std::int64_t written) const {
        std::vector<Diagnostic> found;
        found.reserve(unknown_.size());
        if (const auto first = unknown_.begin(); written == 0 && first != unknown_.end())
            throw FormatError({first->first.first, 0, 0,
                               "the scene has no laser " + excerpt(first->first.second) +
                                   ": it is not that of the record"});
        for (const auto& [sensor, count] : unknown_)
            found.push_back({.file = sensor.first,
                             .message = std::to_string(count) + " scans of " +
                                        excerpt(sensor.second) +
                                        " are left out: the scene has no such laser",
                             .severity = Severity::Warning});
        return found;
    }

  private:
    /// Returns true for a sensor that the site does not have, unless --select leaves it out.
    [[nodiscard]] bool isWanted(const std::string& sensor) const {
        for (std::size_t room = 0; room < input_.rooms().size(); ++room)
            for (const Sensor& known : input_.rooms()[room]->sensors)
                if (input_.idOf(room, known.id) == sensor) return false;
        const std::vector<std::string> globs = inOwnStorey(input_, options_.select);
        return globs.empty() || std::any_of(globs.begin(), globs.end(), [&](const auto& glob) {
                   return Glob(glob).matches(sensor);
               });
    }
    /// Converts a pose of a room to the frame of another, where the sensor was at the start.
    [[nodiscard]] Pose3 inRoom(std::size_t from, std::size_t to, const Pose3& pose) const {
        if (from == to) return pose;
        return toInner(*site_.siteFromRoom(to), toOuter(*site_.siteFromRoom(from), pose));
    }

    const ScanToolOptions& options_;
    const SiteInput& input_;
    SeenSite site_;
    const Sensors& lasers_;
    std::span<const SensorRoom> rooms_;
    const RecordedSite& record_;
    const ReadingFormat& format_;
    std::span<const RunMember> members_;
    ReadingStream& stream_;
    std::uint32_t moment_count_ = 0;
    std::map<std::pair<std::string, std::string>, std::int64_t> unknown_;  // scans, by file and id
};

}  // namespace

void writeRecorded(const ScanCommand& command) {
    const ScanToolOptions& options = command.options();
    checkRecordFolder(options.run);
    const SiteInput input = readSite(
        {operandsOrRecorded(options.operands, "--run", options.run), options.rules, false, {}});
    warnOfImport(options.common, "scan", input);
    const RecordedSite record(options.run, input);
    record.checkStart();
    SiteSensors lasers = recordedLasers(options, input);
    shareFrame(options, SeenSite(input), lasers.rooms);
    FormatOptions how = formatOptions(command, input, lasers.rooms);
    const bool wants_moments = options.format == "mcap";
    if (wants_moments) {
        how.members = membersOf(record, input);
        if (const auto info = recordedInfo(record.folder(0))) how.moment_interval = info->every;
    }
    const std::vector<RunMember> members = how.members;
    const auto format = makeFormat(options.format, lasers.sensors, std::move(how));
    if (!format->isStream())
        throw UsageError(
            "--run: " + options.format +
            " holds one reading a file; take one of jsonl|csv|raw|carmen|mcap|npz|npy|las");
    format->checkStream();
    if (format->isBinary()) refuseTerminal(options.common.output, options.format);
    OutputFile output(options.common.output);
    const auto stream = format->stream([&output](auto bytes) { output.write(bytes); });
    RecordedReadings readings(options, input, lasers, record, *format, members, *stream);
    std::vector<std::string> files = input.files;
    std::int64_t count = 0;
    for (std::size_t room = 0; room < input.rooms().size(); ++room) {
        count += readings.write(room);
        files.push_back(RecordedFiles(record.folder(room)).scans);
        if (wants_moments) files.push_back(RecordedFiles(record.folder(room)).robots);
    }
    warn(options.common, "scan", readings.leftOut(count));
    stream->finish();
    output.commit();
    writeDependencies(options.common, files);
    logInfo(options.common, "scan", std::to_string(count) + " scans written");
}

}  // namespace ispace
