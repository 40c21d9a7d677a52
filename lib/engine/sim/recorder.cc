// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of steps, and when they are written.
//
// Lines are collected and flushed ten times a second of wall time, or once there is much; only
// between steps, so that all files can be cut behind the same step. After an error the record ends
// with the last step that all files hold, and info.csv, whose room on the disk is taken first,
// names it.
#include "sim/recorder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "sense/formats/reading_text.h"
#include "sim/record_files.h"
#include "sim/sensor_reading.h"

namespace ispace {

namespace {

using std::chrono::steady_clock;

constexpr auto kFlushEvery = std::chrono::milliseconds(100);
/// Bytes of a file written at once, while they are in the processor's cache, and of all files until
/// the next flush.
constexpr std::size_t kWriteBlock = std::size_t{1} << 17, kMaxUnflushed = std::size_t{1} << 20;

/// Growing files in the order of Recorder::growingFilesIn, then the others.
enum File {
    kRobots,
    kOdometry,
    kPeople,
    kScans,
    kSonars,
    kBumpers,
    kEvents,
    kStates,
    kActivities,
    kTracks,
    kTiming,
    kInfo,
    kScene,
    kFiles
};
constexpr std::array<const char*, kFiles> kFileNames = {
    "robots.csv",  "odometry.csv", "people.csv", "scans.jsonl",    "sonars.csv",
    "bumpers.csv", "events.csv",   "states.csv", "activities.csv", "tracks.csv",
    "timing.csv",  "info.csv",     "scene.env"};
constexpr const char* kScenes = "scenes";
/// The files before this one may be compressed.
constexpr File kFirstPlain = kBumpers;

std::string pathIn(const std::string& folder, const char* name) {
    return (std::filesystem::path(folder) / name).string();
}

/// Returns n if every n-th period's frame is recorded; 0: no frames.
std::int64_t strideOf(double rate, double most) {
    if (most <= 0) return 0;
    return std::max<std::int64_t>(1, std::llround(std::ceil(rate / most - 1e-9)));
}

}  // namespace

struct Recorder::Data {
    /// Which frames of a sensor are recorded.
    struct FrameClock {
        std::string id = {};
        double rate = 0;
        std::int64_t stride = 0;   // 0: none
        std::int64_t period = -1;  // recorded last
    };

    Data(const std::string& name, const RecordOptions& how, EventLog* log, const TrackLog* told,
         SimTime step)
        : options(how),
          events_log(log),
          track_log(told),
          folder(name),
          lock(madeFolder(folder)),
          robots(growingFile(kRobots)),
          odometry(growingFile(kOdometry)),
          people(growingFile(kPeople)),
          scans(growingFile(kScans)),
          sonars(growingFile(kSonars)),
          bumpers(pathIn(folder, kFileNames[kBumpers])),
          events(pathIn(folder, kFileNames[kEvents])),
          states(pathIn(folder, kFileNames[kStates])),
          activities(pathIn(folder, kFileNames[kActivities])),
          tracks(pathIn(folder, kFileNames[kTracks])),
          timing(pathIn(folder, kFileNames[kTiming])),
          info(pathIn(folder, kFileNames[kInfo])),
          scene(pathIn(folder, kFileNames[kScene])),
          robot_columns(kRobotsHead, options.form),
          people_columns(kPeopleHead, options.form),
          stride(options.form.stride(step)),
          pictures(pathIn(folder, RecordedFrame::kPictures)),
          depths(pathIn(folder, RecordedFrame::kDepths)),
          scenes(pathIn(folder, kScenes), ".env") {
        if (options.sonar_rate > 0) sonar_periods.emplace(options.sonar_rate);
        // Readers would find the file of an earlier run beside that of this one.
        for (int i = 0; i < kFirstPlain; ++i) {
            const std::string plain = pathIn(folder, kFileNames[static_cast<File>(i)]);
            removeEarlier(options.form.packs ? plain : plain + std::string(kZstdSuffix));
        }
    }
    [[nodiscard]] std::string growingFile(File file) const {
        return pathIn(folder, kFileNames[file]) +
               std::string(options.form.packs ? kZstdSuffix : "");
    }

    RecordOptions options;
    EventLog* events_log;
    const TrackLog* track_log;
    std::string folder;
    FolderLock lock;
    LineFile robots, odometry, people, scans, sonars, bumpers, events, states, activities, tracks,
        timing, info, scene;
    TableColumns robot_columns, people_columns;
    std::int64_t stride;  // steps from one recorded moment to the next
    RowTexts robot_texts, odometry_texts, people_texts;
    FrameFiles pictures, depths, scenes;
    std::int64_t scene_count = 0;
    steady_clock::time_point started = steady_clock::now(), flushed = started;
    // As of the last record() call, for the destructor's writes.
    SimTime time{}, step_length{}, control_interval{};
    std::int64_t steps = 0;
    bool flushed_all = false;  // no record() call since the last flush
    std::uint64_t flushed_size = 0;
    std::exception_ptr ended;  // the error that ended the record early
    std::int64_t next_event = 0, next_track = 0;
    ActivityRows activity_rows;
    // Of the world's sensors, rebuilt after a change.
    std::int64_t changes = -1;
    std::vector<Sensor> receivers;
    std::vector<FrameClock> frame_clocks;
    bool has_sonars = false;
    std::vector<std::vector<bool>> felt;   // pressed bumpers of each robot
    std::vector<std::string> felt_robots;  // their ids
    std::optional<Periods> sonar_periods;
    SimTime sonars_due{};
    // Of the step recorded last: the next of World::latestReadings() to be written, and frames,
    // which follow.
    bool is_open = false, awaits_frames = false;
    std::size_t next_reading = 0;
    std::vector<std::shared_ptr<RecordedFrame>> frames;

    /// Returns true if events are newer than the last record.
    [[nodiscard]] bool hasNewEvents() const {
        return (events_log != nullptr && next_event < events_log->next()) ||
               (track_log != nullptr && next_track < track_log->next());
    }
    [[nodiscard]] std::array<LineFile*, 10> stepFiles() {
        return {&robots,  &odometry, &people, &scans,      &sonars,
                &bumpers, &events,   &states, &activities, &tracks};
    }
    /// Returns the last step that all files hold, and behind which all can be cut.
    [[nodiscard]] std::int64_t wholeSteps() {
        std::int64_t whole = steps;
        for (const LineFile* file : stepFiles()) whole = std::min(whole, file->wholeSteps());
        for (std::int64_t before = whole + 1; whole < before;) {
            before = whole;
            for (const LineFile* file : stepFiles()) whole = std::min(whole, file->lastCut(whole));
        }
        return whole;
    }
    void begin();
    void remember(const World& world);
    void lookAtSensors(const World& world);
    void takeFrames(World& world);
    bool appendScans(World& world, steady_clock::time_point until);
    bool finishStep(World& world, steady_clock::time_point until);
    void flushIfDue();
    void appendFeelings(World& world);
    void appendFrame(const RecordedFrame& frame);
    void appendEvents();
    void append(World& world);
    [[nodiscard]] std::uint64_t size() const;
    void writeLines();
    void writeInfo();
    void endEarly();
    void flush();
};

void Recorder::Data::begin() {
    robots.pending = robot_columns.head;
    odometry.pending = kOdometryHead;
    people.pending = people_columns.head;
    sonars.pending = kSonarsHead;
    bumpers.pending = kBumpersHead;
    scans.pending = scanHeaderLine(options.history, options.seed);
    events.pending = eventTableHead();
    if (!events.pending.ends_with('\n')) events.pending += '\n';
    states.pending = kStatesHead;
    activities.pending = kActivitiesHead;
    tracks.pending = trackTableHead();
    timing.pending = "t,wall,steps\n";
    // Its place on the disk is taken first: it tells how a record ends whose disk gets full.
    writeInfo();
    scene.pending = options.scene;
    scene.flush();
    if (events_log != nullptr) next_event = events_log->next();
    if (track_log != nullptr) next_track = track_log->next();
}

void Recorder::Data::remember(const World& world) {
    time = world.time();
    step_length = world.stepLength();
    control_interval = world.controlInterval();
    steps = world.steps();
    flushed_all = false;
}

/// Looks only if the records of the world have changed. Indices may have changed, too: what was
/// recorded last belongs to ids.
void Recorder::Data::lookAtSensors(const World& world) {
    if (std::exchange(changes, world.changes()) == world.changes()) return;
    receivers.clear();
    std::map<std::string, FrameClock> before;
    for (FrameClock& clock : frame_clocks) before.emplace(clock.id, std::move(clock));
    frame_clocks.clear();
    for (const Sensor& sensor : world.sensors()) {
        if (sensor.tryAs<Receiver>() != nullptr) receivers.push_back(sensor);
        if (!isHeavy(sensor)) {
            frame_clocks.emplace_back();
            continue;
        }
        const double rate = periodRate(sensor);
        const auto known = before.find(sensor.id);
        const bool goes_on = known != before.end() && known->second.rate == rate;
        frame_clocks.push_back(FrameClock{.id = sensor.id,
                                          .rate = rate,
                                          .stride = strideOf(rate, options.frame_rate),
                                          .period = goes_on ? known->second.period : -1});
    }
    has_sonars = false;
    std::map<std::string, std::vector<bool>> felt_before;
    for (std::size_t i = 0; i < felt.size(); ++i)
        felt_before.emplace(felt_robots[i], std::move(felt[i]));
    felt.clear();
    felt_robots.clear();
    for (const PlacedRobot& robot : world.robots()) {
        has_sonars = has_sonars || !robot.model.sonar.places.empty();
        std::vector<bool>& bumpers = felt_before[robot.id];
        if (bumpers.size() != robot.model.bumpers.size()) bumpers.clear();
        felt.push_back(std::move(bumpers));
        felt_robots.push_back(robot.id);
    }
}

/// Frames are recorded in the step in which their period begins, even if clients take others.
void Recorder::Data::takeFrames(World& world) {
    if (!options.readings) return;
    for (std::size_t i = 0; i < frame_clocks.size(); ++i) {
        FrameClock& clock = frame_clocks[i];
        if (clock.stride == 0) continue;
        const std::int64_t period = world.period(i);
        if (std::exchange(clock.period, period) == period || period % clock.stride != 0) continue;
        if (world.isCaptured(i) && world.reading(i).time != world.time()) continue;
        const auto frame = frames.emplace_back(std::make_shared<RecordedFrame>(world.sensors()[i]));
        if (!options.frame_taker) {
            frame->make(world.captureNow(i));
            frame->is_made = true;
            continue;
        }
        // The record may end before the frame is taken.
        options.frame_taker(
            {i, [frame](const SensorReading& reading) { frame->make(reading); },
             [frame](const std::exception_ptr& failure) { frame->finish(failure); }});
    }
}

void Recorder::Data::appendFrame(const RecordedFrame& frame) {
    if (frame.line.empty()) return;
    (frame.is_picture ? pictures : depths).write(frame.name, frame.bytes, steps);
    scans.pending += frame.line;
}

/// \returns true once all readings but frames are written
bool Recorder::Data::appendScans(World& world, steady_clock::time_point until) {
    if (!world.readSome(until)) return false;
    while (next_reading < world.latestReadings().size()) {
        const std::size_t i = world.latestReadings()[next_reading++];
        const Sensor& sensor = world.sensors()[i];
        if (isHeavy(sensor) || !options.readings) continue;
        appendReadingLine(scans.pending, sensor, world.reading(i), receivers);
        // Bounds the memory for one step of many lasers.
        scans.flushBlock(kWriteBlock);
        if (steady_clock::now() >= until) break;
    }
    return next_reading >= world.latestReadings().size();
}

bool Recorder::Data::finishStep(World& world, steady_clock::time_point until) {
    if (!is_open) return true;
    flushed_all = false;
    // Only once: the world may change before the frames are taken.
    awaits_frames = awaits_frames || appendScans(world, until);
    if (!awaits_frames) return false;
    while (!frames.empty() && frames.front()->is_made) {
        appendFrame(*frames.front());
        frames.erase(frames.begin());
    }
    if (!frames.empty()) return false;
    scans.endStep(steps);
    is_open = false;
    return true;
}

/// Not within a step: then files would end with different steps, and after a full disk, compressed
/// ones could be cut behind none that all of them hold.
void Recorder::Data::flushIfDue() {
    if (is_open) return;
    const bool much = size() > flushed_size + kMaxUnflushed;
    if (much || steady_clock::now() - flushed >= kFlushEvery) flush();
}

/// Writes rows of sonars and bumpers.
void Recorder::Data::appendFeelings(World& world) {
    lookAtSensors(world);
    if (has_sonars && sonar_periods && world.time() >= sonars_due) {
        sonars_due = sonar_periods->begin(sonar_periods->newest(world.time()) + 1);
        appendSonarRows(sonars.pending, world);
    }
    sonars.endStep(steps);
    appendBumperRows(bumpers.pending, world, felt);
    bumpers.endStep(steps);
}

void Recorder::Data::appendEvents() {
    if (events_log != nullptr) {
        next_event = std::max(next_event, events_log->first());
        for (; next_event < events_log->next(); ++next_event) {
            const Event& event = events_log->at(next_event);
            appendEventRow(events.pending, event);
            if (event.kind == EventKind::State) appendStateRow(states.pending, event);
            if (event.kind == EventKind::Activity) activity_rows.append(activities.pending, event);
        }
    }
    if (track_log != nullptr)
        for (next_track = std::max(next_track, track_log->first()); next_track < track_log->next();
             ++next_track)
            appendTrackRow(tracks.pending, track_log->at(next_track));
    for (LineFile* const file : {&events, &states, &activities, &tracks}) file->endStep(steps);
}

/// Rows of a step are appended at once, but its readings later (finishStep()): until then the step
/// is open.
void Recorder::Data::append(World& world) {
    if (steps % stride == 0) {
        appendRobotRows(robots.pending, world, robot_texts, robot_columns.kept);
        if (options.odometry) appendOdometryRows(odometry.pending, world, odometry_texts);
        appendPeopleRows(people.pending, world, people_texts, people_columns.kept);
    }
    robots.endStep(steps);
    odometry.endStep(steps);
    people.endStep(steps);
    appendEvents();
    appendFeelings(world);
    is_open = true;
    awaits_frames = false;
    next_reading = 0;
    takeFrames(world);
}

void Recorder::Data::writeInfo() {
    const bool is_thinned = options.form.every > SimTime(0);
    std::string text = "dt,control_interval,steps,elapsed,seed,noise";
    text.append(is_thinned ? ",every\n" : "\n");
    text.append(formatSimTime(step_length)).append(",").append(formatSimTime(control_interval));
    text.append(",").append(std::to_string(steps));
    text.append(",").append(formatSimTime(steps * step_length));
    text.append(",").append(std::to_string(options.seed)).append(options.noise ? ",1" : ",0");
    if (is_thinned) text.append(",").append(formatSimTime(options.form.every));
    text += '\n';
    info.rewrite(text);
}

std::uint64_t Recorder::Data::size() const {
    return robots.size() + odometry.size() + people.size() + scans.size() + sonars.size() +
           bumpers.size() + events.size() + states.size() + activities.size() + tracks.size() +
           pictures.size() + depths.size() + scenes.size();
}

/// Rows first, then their number: after a crash in between, the record tells fewer steps than its
/// files hold, not more.
void Recorder::Data::writeLines() {
    for (LineFile* file : stepFiles()) file->flush();
    // While readings of this step lack, the step before may have to be the last.
    const std::int64_t whole = wholeSteps();
    for (LineFile* file : stepFiles()) file->forgetBefore(whole);
    for (FrameFiles* files : {&pictures, &depths, &scenes}) files->keepUpTo(whole);
    writeInfo();
    const std::chrono::duration<double> wall = flushed - started;
    timing.pending.append(formatSimTime(time)).append(",").append(formatFixed(wall.count(), 6));
    timing.pending.append(",").append(std::to_string(steps)).append("\n");
    timing.flush();
    flushed_all = true;
    flushed_size = size();
    if (const std::uint64_t bytes = flushed_size; bytes > options.max_bytes)
        throw FormatError({folder, 0, 0,
                           "the record has " + std::to_string(bytes) +
                               " bytes at t=" + formatSimTime(time) + ", wanted at most " +
                               std::to_string(options.max_bytes) + " (--record-limit)"});
}

/// A file cannot be written: the record ends with the last step that all files hold.
void Recorder::Data::endEarly() {
    ended = std::current_exception();
    steps = wholeSteps();
    for (LineFile* file : stepFiles()) file->cutBehind(steps);
    for (FrameFiles* files : {&pictures, &depths, &scenes}) files->cutBehind(steps);
    flushed_all = true;
    try {
        writeInfo();
    } catch (const std::system_error&) {
        // Only the first error is reported.
    }
}

void Recorder::Data::flush() {
    if (ended) std::rethrow_exception(ended);
    flushed = steady_clock::now();
    try {
        // Writes events that clients raised since the step.
        if (hasNewEvents()) appendEvents();
        writeLines();
    } catch (const std::system_error&) {
        endEarly();
        throw;
    }
}

std::vector<std::string> Recorder::growingFilesIn(const std::string& folder) {
    std::vector<std::string> files;
    files.reserve(kInfo);
    for (int i = 0; i < kInfo; ++i)
        files.push_back(pathIn(folder, kFileNames[static_cast<File>(i)]));
    return files;
}

std::vector<std::string> Recorder::filesIn(const std::string& folder) {
    std::vector<std::string> files = growingFilesIn(folder);
    for (const File file : {kInfo, kScene}) files.push_back(pathIn(folder, kFileNames[file]));
    for (int i = 0; i < kFirstPlain; ++i)
        files.push_back(files[static_cast<std::size_t>(i)] + std::string(kZstdSuffix));
    return files;
}

Recorder::Recorder(const std::string& folder, World& world, const RecordOptions& options,
                   EventLog* events, const TrackLog* tracks)
    : data_(std::make_unique<Data>(folder, options, events, tracks, world.stepLength())) {
    if (events != nullptr) events->want(allEventKinds());
    data_->remember(world);
    data_->begin();
    record(world);
    // Reports write errors before the run.
    flush(world);
}

Recorder::~Recorder() {
    try {
        if (!data_->flushed_all) data_->flush();
    } catch (const std::exception&) {
        // flush() reports it.
    }
}

void Recorder::record(World& world) {
    Data& data = *data_;
    if (data.ended) std::rethrow_exception(data.ended);
    data.remember(world);
    try {
        data.append(world);
        if (!data.options.frame_taker) data.finishStep(world, steady_clock::time_point::max());
        for (LineFile* file : data.stepFiles()) file->flushBlock(kWriteBlock);
    } catch (const std::system_error&) {
        data.endEarly();
        throw;
    }
    data.flushIfDue();
}

bool Recorder::finishStep(World& world, steady_clock::time_point until) {
    Data& data = *data_;
    if (data.ended) return true;
    try {
        const bool is_whole = data.finishStep(world, until);
        data.flushIfDue();
        return is_whole;
    } catch (const std::system_error&) {
        data.endEarly();
        throw;
    }
}

const RecordOptions& Recorder::options() const { return data_->options; }

bool Recorder::awaitsFrames() const { return data_->is_open && data_->awaits_frames; }

void Recorder::end(World& world) {
    std::erase_if(data_->frames, [](const auto& frame) { return !frame->is_made; });
    finishStep(world, steady_clock::time_point::max());
    flush(world);
}

std::string Recorder::recordScene(std::string_view text) {
    Data& data = *data_;
    if (data.ended) return "";
    const std::string name = frameName("scene", ++data.scene_count, ".env");
    try {
        data.scenes.write(name, text, data.steps);
    } catch (const std::system_error&) {
        data.endEarly();
        return "";
    }
    return std::string(kScenes) + "/" + name;
}

int Recorder::lock() const { return data_->lock.descriptor(); }

void Recorder::flush(const World& world) {
    if (!data_->ended) data_->remember(world);
    data_->flush();
}

std::optional<steady_clock::time_point> Recorder::flushDue(steady_clock::time_point now) {
    if (data_->flushed_all && !data_->hasNewEvents()) return std::nullopt;
    const auto due = data_->flushed + kFlushEvery;
    if (now < due) return due;
    data_->flush();
    return std::nullopt;
}

}  // namespace ispace
