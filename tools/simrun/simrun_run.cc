// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/simrun_run.h"

#include <sys/resource.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "base/run_files.h"
#include "cli/building_operands.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/scene_folder.h"
#include "record/text.h"
#include "report/view/film.h"
#include "report/view/run_picture.h"
#include "scene/run/run_reader.h"
#include "scene/scene.h"
#include "server/network.h"

namespace ispace {

SceneInput readInput(const SimrunOptions& options) {
    if (const std::string building = recordedBuilding(options.replay); !building.empty())
        throw UsageError(
            "--replay: " + options.replay +
            " is the record of a building: give it whole, or that of a room, such as " +
            options.replay + "/STOREY");
    std::vector<std::string> operands = options.operands;
    if (!options.replay.empty() && operands.empty()) {
        const std::string scene = sceneOfRecord(options.replay);
        if (scene.empty())
            throw UsageError(options.replay +
                             " holds no scene.env: give ENV and LAYOUT of the run");
        operands.push_back(scene);
    }
    SceneInput input = readScene({operands, options.rules, false});
    addZones(options.zones, input);
    return input;
}

std::string titleOf(const SimrunOptions& options, const SceneInput& input) {
    const std::string& shown = options.replay.empty() ? input.environment_operand : options.replay;
    return shown == "-" ? "" : baseName(shown);
}

std::optional<Replay> openReplay(const SimrunOptions& options, Scene& scene) {
    if (options.replay.empty()) return std::nullopt;
    Replay replay(options.replay);
    if (replay.changedAt())
        replay.makeChanges(changesOfRun(options.replay, scene, options.rules.max_work));
    replay.placeAtStart(scene);
    return replay;
}

void forward(Replay& replay, World& world, SimTime from) {
    while (world.time() < from)
        if (!replay.step(world))
            throw UsageError("--from: the record ends at t=" + formatSimTime(world.time()));
}

History historyOf(const SimrunCommand& command, const SceneInput& input) {
    History history = input.layout ? input.layout->history : History();
    history.push_back(command.historyLine(input.named));
    return history;
}

Script scriptOf(const SimrunOptions& options, const SceneInput& input, const World& world) {
    if (options.script.empty()) return {};
    const bool is_stdin = options.script == "-";
    if (is_stdin && (input.environment_operand == "-" || input.layout_operand == "-"))
        throw UsageError("stdin cannot be read twice: give the script or the scene as a file");
    const std::string text = is_stdin ? readStdin() : readAll(options.script);
    const std::string file = displayName(options.script);
    return {readScript(text, file, world), readDayPlan(text, file, world)};
}

RunOptions runOptionsOf(const SimrunOptions& options, const std::optional<RunInfo>& replay) {
    if (replay && !options.noise) return {.seed = replay->seed, .sensor_noise = replay->noise};
    if (replay) return {.seed = options.common.seed, .sensor_noise = true};
    return {.seed = options.common.seed, .noise = options.noise, .sensor_noise = options.noise};
}

std::unique_ptr<Progress> progressOf(Simulation& simulation, const SimrunOptions& options) {
    if (!options.until) return std::make_unique<SilentProgress>();
    auto progress = makeProgress("simrun", options.common.progress, options.common.quiet);
    progress->begin("steps", (*options.until + options.step - SimTime(1)) / options.step);
    simulation.onStep([bar = progress.get()] { bar->advance(1); });
    return progress;
}

void report(const Simulation& simulation, const SimrunOptions& options) {
    const World& world = simulation.world();
    logInfo(options.common, "simrun",
            std::to_string(world.steps()) + " steps, t=" + formatSimTime(world.time()));
    if (const auto& [steps, late, most, own] = simulation.lateness(); steps > 0)
        logInfo(options.common, "simrun",
                std::to_string(late) + " of " + std::to_string(steps) +
                    " steps began more than a step late, the latest by " +
                    formatMilliseconds(most) + " s, the program itself at work for " +
                    formatMilliseconds(own) + " s of that");
    if (const SimTime lost = simulation.lost(); lost > SimTime(0))
        logInfo(
            options.common, "simrun",
            "the world could not keep up: the clock gave up " + formatMilliseconds(lost) + " s");
}

void conclude(const RunJudge& judge, const SimrunOptions& options, const std::string& environment,
              JunitFile& junit) {
    const std::vector<RunVerdict> verdicts = judge.verdicts();
    std::vector<JunitCase> cases;
    cases.reserve(verdicts.size());
    for (const RunVerdict& verdict : verdicts)
        cases.push_back(
            {.name = verdict.expectation,
             .outcome = verdict.is_met ? JunitCase::Outcome::Met : JunitCase::Outcome::Unmet,
             .message = verdict.reason,
             .time = verdict.time});
    junit.write(baseName(environment), cases);
    if (const std::string unmet = unmetText(verdicts); !unmet.empty()) throw UnmetError(unmet);
    if (verdicts.size() == 1)
        tell(options.common, "simrun",
             "met at t=" + formatMilliseconds(verdicts.front().time) + ": " +
                 printable(verdicts.front().expectation));
    else if (!verdicts.empty())
        tell(options.common, "simrun",
             "all " + std::to_string(verdicts.size()) + " expectations are met");
}

namespace {

/// Returns the scene as one self-contained file for the folder of the record.
std::string sceneText(const Scene& scene, const History& history, const std::string& folder) {
    Document document;
    document.history = history;
    document.records = scene.records;
    rebaseFiles(document.records, "", folder);
    return writeRecordText(document);
}

}  // namespace

RunningRecord::RunningRecord(const SimrunOptions& options, Simulation& simulation,
                             const RecordOptions& record)
    : recorder(options.record, simulation.world(), record, &simulation.events(),
               &simulation.tracks()),
      guard(Recorder::growingFilesIn(options.record), recorder.lock()) {}

/// Computes the least size of the record before the run.
void checkRecord(const SimrunOptions& options, const World& world) {
    if (options.record.empty()) return;
    const auto stride = static_cast<double>(options.record_form.stride(world.stepLength()));
    if (!options.until) return;
    const double min_line = options.record_form.packs ? 1 : 20;  // bytes, of robots.csv
    const double steps = static_cast<double>(options.until->count()) /
                         static_cast<double>(options.step.count()) / stride;
    const double lines = std::ceil(steps) * static_cast<double>(world.movers().size());
    if (lines * min_line <= static_cast<double>(options.max_recorded)) return;
    throw UsageError("--record: " + formatDouble(lines) + " lines of robots and people until t=" +
                     formatSimTime(*options.until) + " are more than --record-limit, which is " +
                     byteCountText(options.max_recorded) + "; is --until in seconds?");
}

std::unique_ptr<RunningRecord> recordOf(Simulation& simulation, const SimrunOptions& options,
                                        const Scene& scene, const History& history, bool odometry,
                                        FrameTaker frame_taker) {
    if (options.record.empty()) return nullptr;
    RecordOptions record;
    record.history = history;
    record.seed = simulation.world().options().seed;
    record.noise = simulation.world().options().sensor_noise;
    record.odometry = odometry;
    record.scene = sceneText(scene, history, options.record);
    record.scene_text = [history, folder = options.record + "/scenes"](const Scene& loaded) {
        return sceneText(loaded, history, folder);
    };
    record.readings = options.records_readings.value_or(true);
    record.frame_rate = options.recorded_frames;
    record.sonar_rate = options.recorded_sonars;
    record.form = options.record_form;
    record.max_bytes = options.max_recorded;
    record.frame_taker = std::move(frame_taker);
    auto running = std::make_unique<RunningRecord>(options, simulation, record);
    simulation.recordWith(running->recorder);
    return running;
}

namespace {

/// A client requires a file descriptor: the limit is that of the process, less those in use.
ServerLimits withinFileLimit(ServerLimits limits, std::size_t others) {
    const rlim_t own = 32 + others;
    rlimit files{};
    if (::getrlimit(RLIMIT_NOFILE, &files) != 0) return limits;
    files.rlim_cur = files.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &files);
    const rlim_t most = files.rlim_cur > own ? files.rlim_cur - own : 1;
    limits.clients = static_cast<std::size_t>(std::min<rlim_t>(limits.clients, most));
    return limits;
}

}  // namespace

ServerLimits limitsOf(const SimrunOptions& options) {
    constexpr std::size_t kOfPort = 64;  // connections of a port for topics
    std::size_t others = options.devices.connections();
    for (const auto& port : {options.foxglove, options.rosbridge}) others += port ? kOfPort : 0;
    ServerLimits limits = withinFileLimit(options.limits, others);
    if (!options.token_file.empty()) {
        limits.token = readToken(options.token_file);
        if (isOpenToOthers(options.token_file))
            warn(options.common, "simrun",
                 options.token_file + " can be read by other users: chmod 600 makes it yours");
    }
    return limits;
}

ServerLimits limitsOf(const SimrunOptions& options, const SceneInput& input) {
    ServerLimits limits = limitsOf(options);
    const std::string& folder = options.load_folder;
    limits.source = std::make_shared<SceneFolder>(folder.empty() ? SceneFolder::of(input) : folder,
                                                  options.rules);
    return limits;
}

namespace {

constexpr double kRounding = 1e-9;  // s

double endOf(const SimrunOptions& options) {
    return seconds(options.until.value_or(kMaxTime)) + kRounding;
}

/// Reads the record up to --until; calls `before` for each moment that is still to be added.
void readRecord(const SimrunOptions& options, RunPicture& picture,
                const std::function<void(double)>& before) {
    RunReader reader(options.replay);
    while (reader.next() && reader.time() <= endOf(options)) {
        before(reader.time());
        picture.add(reader);
    }
    if (reader.isCut())
        warn(options.common, "simrun", "the record ends in the midst of a step, which is left out");
}

/// Returns the time of the last moment up to --until; 0 without one. Drawing takes far longer.
double lastMoment(const SimrunOptions& options) {
    double last = 0;
    RunReader reader(options.replay);
    while (reader.next() && reader.time() <= endOf(options)) last = reader.time();
    return last;
}

/// Takes the pictures of a film: one each 1/fps s of it, and one of the end.
std::int64_t takeFilm(const SimrunOptions& options, RunPicture& picture,
                      const std::function<void(const Image&, int)>& write) {
    const DrawingOptions& film = options.drawing;
    int count = 0;
    bool has_moment = false;
    double last = 0;
    const auto time_of = [&](int frame) {
        return seconds(options.from) + frame * film.speed / film.fps;
    };
    const auto progress = makeProgress("simrun", options.common.progress, options.common.quiet);
    const double length = std::max(0.0, lastMoment(options) - seconds(options.from));
    progress->begin("pictures", 1 + std::llround(length * film.fps / film.speed));
    readRecord(options, picture, [&](double time) {
        for (; has_moment && time_of(count) < time - kRounding; ++count) {
            write(picture.frame(), count);
            progress->advance(1);
        }
        has_moment = true;
        last = time;
    });
    if (last < time_of(0) - kRounding)
        throw UsageError("--from: the record ends at t=" + formatDouble(last));
    write(picture.frame(), count);
    progress->advance(1);
    progress->end();
    return count + 1;
}

std::int64_t writeY4m(const SimrunOptions& options, RunPicture& picture) {
    FileStream file(options.common.output);
    const std::int64_t count = takeFilm(options, picture, [&](const Image& image, int frame) {
        if (frame == 0) file.stream() << y4mHeader(image.width, image.height, options.drawing.fps);
        file.stream() << y4mFrame(image);
    });
    file.commit();
    return count;
}

std::int64_t writeGif(const SimrunOptions& options, RunPicture& picture) {
    FileStream file(options.common.output);
    GifFilm film(options.drawing.fps);
    const std::int64_t count = takeFilm(options, picture, [&](const Image& image, int /*frame*/) {
        file.stream() << film.add(image);
    });
    file.stream() << film.end();
    file.commit();
    return count;
}

std::int64_t writePictures(const SimrunOptions& options, const OutputSet& files,
                           RunPicture& picture) {
    const std::string name = "run";
    EncodeAhead pictures(encodePng, writeAll);
    const std::int64_t count = takeFilm(options, picture, [&](const Image& image, int frame) {
        if (frame == 0) files.prepare({name}, true, {".png"});
        pictures.add(files.fileOf(name, frame, ".png"), image);
    });
    pictures.finish();
    return count;
}

}  // namespace

void drawRecord(const SimrunOptions& options, const Scene& scene, const std::string& title) {
    RunPicture picture(scene, {.width = options.drawing.width, .title = title});
    std::int64_t count = 1;
    if (const auto files = OutputSet::of(options.common.output)) {
        count = writePictures(options, *files, picture);
    } else if (options.drawing.format == "y4m") {
        count = writeY4m(options, picture);
    } else if (options.drawing.format == "gif") {
        count = writeGif(options, picture);
    } else {
        readRecord(options, picture, [](double) {});
        const PictureFormat format = options.drawing.format == "svg"   ? PictureFormat::Svg
                                     : options.drawing.format == "pdf" ? PictureFormat::Pdf
                                                                       : PictureFormat::Png;
        writeAll(options.common.output, picture.write(format));
    }
    writeDependencies(options.common,
                      std::vector<std::string>{RecordedFiles(options.replay).robots});
    logInfo(options.common, "simrun",
            std::to_string(count) + (count == 1 ? " picture" : " pictures") + " drawn");
}

namespace {

constexpr int kMaxCollisions = 100;
constexpr const char* kTool = "simrun";

std::string textOf(const World& world, const Collision& collision) {
    const Point2 place = world.status(collision.robot).pose.position;
    return "t=" + formatMilliseconds(collision.time) + ' ' + world.movers()[collision.robot].id +
           " at " + formatFixed(place.x, 3) + ',' + formatFixed(place.y, 3) + " ran into " +
           std::string(collision.into);
}

}  // namespace

void CollisionLog::tell() {
    constexpr double kSamePlace = 0.05;  // metres
    for (const Collision& collision : world_->collisions()) {
        if (count_ == kMaxCollisions) return;
        const Point2 at = world_->status(collision.robot).pose.position;
        const auto [last, is_new] = last_.try_emplace(world_->movers()[collision.robot].id);
        const bool is_known = !is_new && last->second.into == collision.into &&
                              distance(last->second.at, at) < kSamePlace;
        if (is_known) continue;
        last->second = {std::string(collision.into), at};
        warn(*options_, kTool, textOf(*world_, collision));
        if (++count_ == kMaxCollisions) warn(*options_, kTool, "no more of these are told");
    }
}

UnreachedLog::UnreachedLog(Simulation& simulation, const CommonOptions& options)
    : simulation_(&simulation), options_(&options) {
    simulation.events().want({EventKind::Unreached});
    next_ = simulation.events().next();
}

void UnreachedLog::tell() {
    constexpr std::size_t kMaxTold = 100;
    const EventLog& events = simulation_->events();
    for (next_ = std::max(next_, events.first()); next_ < events.next(); ++next_) {
        const Event& event = events.at(next_);
        if (event.kind != EventKind::Unreached || told_.size() == kMaxTold) continue;
        const auto text_of = [](Point2 p) {
            return formatFixed(p.x, 3) + ',' + formatFixed(p.y, 3);
        };
        std::string target = event.other;
        if (event.place) target += (target.empty() ? "" : "/") + text_of(*event.place);
        if (!told_.insert(event.id + ' ' + target).second) continue;
        const World& world = simulation_->world();
        const auto mover = world.moverNamed(event.id);
        warn(*options_, kTool,
             "t=" + formatMilliseconds(event.time) + ' ' + event.id +
                 (mover ? " at " + text_of(world.status(*mover).pose.position) : "") +
                 " gave up its way to " + target +
                 (event.text.empty() ? "" : ": " + printable(event.text)));
        if (told_.size() == kMaxTold) warn(*options_, kTool, "further ones are not reported");
    }
}

bool hasNoise(const Scene& scene, bool moves) {
    const bool strays = moves && std::any_of(scene.robots.begin(), scene.robots.end(),
                                             [](const PlacedRobot& robot) {
                                                 return robot.model.noise != MotionNoise();
                                             });
    return strays || std::any_of(scene.sensors.begin(), scene.sensors.end(),
                                 [](const Sensor& sensor) { return isNoisy(sensor.model); });
}

void warnOfNoNoise(const CommonOptions& options) {
    warn(options, kTool,
         "--noise changes nothing: no sensor has noise, and no robot has motion_noise, "
         "odometry_noise or start_noise");
}

void warnOfTrips(const Scene& scene, const CommonOptions& options) {
    for (const PlacedRecord& placed : scene.placed) {
        const Record& record = scene.records[placed.record];
        if (record.schema().find("trip") == nullptr || !record.has("trip")) continue;
        Diagnostic finding = record.finding(
            "trip", record.keyword() + ' ' + scene.ids[placed.record] +
                        " stands: its trip is over storeys, and this run has one; run the "
                        "building without --storey");
        finding.severity = Severity::Warning;
        warn(options, kTool, std::span<const Diagnostic>(&finding, 1));
    }
}

void LagLog::tell() {
    using std::chrono::steady_clock;
    constexpr std::chrono::seconds kCalm(1);  // without a loss, before the run counts as keeping up
    constexpr int kMaxReported = 10;
    const auto due = simulation_->due();
    if (!due) return;
    const auto now = steady_clock::now();
    const auto say = [&](const std::string& text) {
        if (count_ <= kMaxReported)
            warn(*options_, kTool, "t=" + formatSimTime(simulation_->world().time()) + text);
    };
    if (simulation_->lost() > lost_) {
        lost_ = simulation_->lost();
        last_ = now;
        if (std::exchange(is_behind_, true)) return;
        ++count_;
        say(" the run falls behind real time, by " + formatMilliseconds(lost_) +
            " s so far: steps take longer than the clock gives them" +
            (count_ == kMaxReported ? "; further ones are not reported" : ""));
    } else if (is_behind_ && now <= *due && now - last_ >= kCalm) {
        is_behind_ = false;
        say(" the run keeps up with real time again, " + formatMilliseconds(lost_) +
            " s behind in all");
    }
}

void FailureLog::tell() {
    if (is_told_ || replay_ == nullptr) return;
    const std::string failure = replay_->failure();
    is_told_ = !failure.empty();
    if (is_told_) warn(*options_, kTool, failure);
}

void warnOfChanges(const Replay& replay, const CommonOptions& options) {
    if (const auto& time = replay.changedAt())
        warn(options, kTool,
             "the world of the run was changed at t=" + formatMilliseconds(*time) +
                 ": the room is drawn as it was at the start");
}

}  // namespace ispace
