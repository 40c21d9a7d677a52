// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/simrun_run.h"

#include <sys/resource.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <ostream>
#include <set>
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
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "cli/scene_folder.h"
#include "record/text.h"
#include "scene/run/run_reader.h"
#include "scene/scene.h"
#include "server/network.h"
#include "server/server.h"
#include "sim/recorder.h"
#include "sim/sole_world.h"
#include "sim/world_state.h"
#include "simrun/simrun_building.h"
#include "simrun/simrun_ports.h"
#include "simrun/simrun_report.h"

namespace ispace {

namespace {

constexpr const char* kTool = "simrun";

[[noreturn]] void refuseWholeRecord(const std::string& record) {
    throw UsageError("--replay: " + record +
                     " is the record of a building: give it whole, or that of a room, such as " +
                     record + "/STOREY");
}

/// Reads the operands; a record holds its own site.
SiteInput readInput(const SimrunOptions& options) {
    const std::string building = recordedBuilding(options.replay);
    std::vector<std::string> operands = options.operands;
    if (!options.replay.empty() && operands.empty()) {
        const std::string scene = building.empty() ? sceneOfRecord(options.replay) : building;
        if (scene.empty())
            throw UsageError(options.replay +
                             " holds no scene.env: give ENV and LAYOUT of the run");
        operands.push_back(scene);
    }
    SiteInput input = readSite({operands, options.rules, false});
    if (!building.empty() && input.isOneRoom()) refuseWholeRecord(options.replay);
    if (!options.replay.empty()) mustHoldRecord("--replay", options.replay);
    if (!options.replay.empty() && building.empty() && !input.isOneRoom())
        refuseRecordOfRoom(input, "--replay", options.replay);
    addZones(inOwnStorey(input, options.zones), input.building);
    warnOfImport(options.common, kTool, input);
    warn(options.common, kTool,
         siteWarnings(input, {.checks = {"unplaced", "outside", "buried", "paths"}}));
    return input;
}

/// Returns the title of the site or the record.
std::string titleOf(const SimrunOptions& options, const SiteInput& input) {
    const std::string& shown = options.replay.empty() ? input.environment_operand : options.replay;
    return shown == "-" ? "" : baseName(shown);
}

/// Opens the record to be served, and sets the scene to its beginning; nullopt without --replay.
std::optional<Replay> openReplay(const SimrunOptions& options, Scene& scene) {
    if (options.replay.empty()) return std::nullopt;
    Replay replay(options.replay);
    if (replay.changedAt())
        replay.makeChanges(changesOfRun(options.replay, scene, options.rules.max_work));
    replay.placeAtStart(scene);
    return replay;
}

/// Moves a replay to the time from which it is served.
void forward(Replay& replay, World& world, SimTime from) {
    while (world.time() < from)
        if (!replay.step(world))
            throw UsageError("--from: the record ends at t=" + formatSimTime(world.time()));
    // A record of this run begins with the room as these changes left it.
    static_cast<void>(replay.takeMade());
}

/// The commands of --script.
struct Script {
    std::vector<TimedCommand> commands;
    std::vector<std::shared_ptr<Director>> directors;
};
Script scriptOf(const SimrunOptions& options, const SiteInput& input, const World& world) {
    if (options.script.empty()) return {};
    const std::string text = scriptText(options, input), file = displayName(options.script);
    return {readScript(text, file, world), readDirectors(text, file, world)};
}

/// Warns of movers with a trip over storeys, in the run of one room.
void warnOfTrips(const Scene& scene, const CommonOptions& options) {
    for (const PlacedRecord& placed : scene.placed) {
        const Record& record = scene.records[placed.record];
        if (record.schema().find("trip") == nullptr || !record.has("trip")) continue;
        Diagnostic finding = record.finding(
            "trip", record.keyword() + ' ' + scene.ids[placed.record] +
                        " stands: its trip is over storeys, and this run has one: give it a "
                        "path, or run all storeys");
        finding.severity = Severity::Warning;
        warn(options, kTool, std::span<const Diagnostic>(&finding, 1));
    }
}

/// Returns true if --noise changes readings or, in a run that moves them, robots.
bool hasNoise(const Scene& scene, bool moves) {
    const bool strays = moves && std::any_of(scene.robots.begin(), scene.robots.end(),
                                             [](const PlacedRobot& robot) {
                                                 return robot.model.noise != MotionNoise();
                                             });
    return strays || std::any_of(scene.sensors.begin(), scene.sensors.end(),
                                 [](const Sensor& sensor) { return isNoisy(sensor.model); });
}

/// The run of one room.
class RoomRunSite final : public RunSite {
  public:
    RoomRunSite(const SimrunCommand& command, SiteInput room, std::optional<Replay> replay)
        : RunSite(command, std::move(room)),
          replay_(std::move(replay)),
          world_(input.only(), replay_ ? replay_->stepLength() : options.step,
                 runOptionsOf(options, replay_ ? std::optional(replay_->info()) : std::nullopt)) {
        if (replay_) forward(*replay_, world_, options.from);
        Script script = scriptOf(options, input, world_);
        simulation_.emplace(world_, std::move(script.commands), options.clock, options.until);
        for (std::shared_ptr<Director>& director : script.directors)
            simulation_->follow(std::move(director));
        if (replay_) simulation_->replay(*replay_, options.holds);
        sole_.emplace(*simulation_);
    }

    Worlds& worlds() override { return *sole_; }
    [[nodiscard]] const Replay* replay(std::size_t /*room*/) const override {
        return replay_ ? &*replay_ : nullptr;
    }
    void recordWhole() override {}

  private:
    std::optional<Replay> replay_;
    World world_;
    std::optional<Simulation> simulation_;
    std::optional<SoleWorld> sole_;
};

}  // namespace

std::string scriptText(const SimrunOptions& options, const SiteInput& input) {
    if (options.script != "-") return readAll(options.script);
    if (input.environment_operand == "-" || input.layout_operand == "-")
        throw UsageError("stdin cannot be read twice: give the script or the scene as a file");
    return readStdin();
}

RunSite::RunSite(const SimrunCommand& command, SiteInput the_input)
    : options(command.options()), title(titleOf(options, the_input)), input(std::move(the_input)) {
    if (input.layout) history = input.layout->history;
    history.push_back(command.historyLine(input.named));
}

std::unique_ptr<RunSite> openSite(const SimrunCommand& command) {
    const SimrunOptions& options = command.options();
    SiteInput input = readInput(options);
    if (options.noise &&
        std::none_of(input.rooms().begin(), input.rooms().end(),
                     [&](const auto& scene) { return hasNoise(*scene, options.replay.empty()); }))
        warn(options.common, kTool,
             "--noise changes nothing: no sensor has noise, and no robot has motion_noise, "
             "odometry_noise or start_noise");
    if (!input.isOneRoom()) return openBuilding(command, std::move(input));
    if (holdsBuilding(options.record))
        throw UsageError("--record: " + options.record +
                         " holds the record of a building: give another folder");
    Scene scene = input.only();
    std::optional<Replay> replay = openReplay(options, scene);
    if (!replay) warnOfTrips(scene, options.common);
    input.building.scenes = {std::make_shared<const Scene>(std::move(scene))};
    return std::make_unique<RoomRunSite>(command, std::move(input), std::move(replay));
}

RunOptions runOptionsOf(const SimrunOptions& options, const std::optional<RunInfo>& replay) {
    if (replay && !options.noise) return {.seed = replay->seed, .sensor_noise = replay->noise};
    if (replay) return {.seed = options.common.seed, .sensor_noise = true};
    return {.seed = options.common.seed, .noise = options.noise, .sensor_noise = options.noise};
}

namespace {

/// Creates the progress bar of a run that ends at a given time.
std::unique_ptr<Progress> progressOf(Simulation& simulation, const SimrunOptions& options) {
    if (!options.until) return std::make_unique<SilentProgress>();
    auto progress = makeProgress("simrun", options.common.progress, options.common.quiet);
    progress->begin("steps", (*options.until + options.step - SimTime(1)) / options.step);
    simulation.onStep([bar = progress.get()] { bar->advance(1); });
    return progress;
}

/// Reports the length of a run and whether it kept up with the clock.
void reportEnd(const Simulation& simulation, const SimrunOptions& options) {
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

/// Reports the verdicts of the judge at the end. Completes the file of --junit.
/// \throws UnmetError if one is unmet
/// \param environment operand
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
        report(options.common, "simrun",
               "met at t=" + formatMilliseconds(verdicts.front().time) + ": " +
                   printable(verdicts.front().expectation));
    else if (!verdicts.empty())
        report(options.common, "simrun",
               "all " + std::to_string(verdicts.size()) + " expectations are met");
}

/// Returns the scene as one self-contained file for the folder of the record.
std::string sceneText(const Scene& scene, const History& history, const std::string& folder) {
    Document document;
    document.history = history;
    document.records = scene.records;
    rebaseFiles(document.records, "", folder);
    return writeRecordText(document);
}

/// The record of a room that is being written.
struct RunningRecord {
    RunningRecord(const std::string& folder, Simulation& simulation, const RecordOptions& record)
        : recorder(folder, simulation.world(), record, &simulation.events(), &simulation.tracks()),
          guard(Recorder::growingFilesIn(folder), recorder.lock()) {}
    Recorder recorder;
    LineGuard guard;
};

/// Computes the least size of the record before the run.
/// \throws UsageError if it is more than --record-limit
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

/// \param odometry it differs from the true poses
std::unique_ptr<RunningRecord> recordOf(Simulation& simulation, const SimrunOptions& options,
                                        const std::string& folder, const History& history,
                                        bool odometry, FrameTaker frame_taker) {
    RecordOptions record;
    record.history = history;
    record.seed = simulation.world().options().seed;
    record.noise = simulation.world().options().sensor_noise;
    record.odometry = odometry;
    record.scene = sceneText(simulation.world().scene(), history, folder);
    record.scene_text = [history, scenes = folder + "/scenes"](const Scene& loaded) {
        return sceneText(loaded, history, scenes);
    };
    record.readings = options.records_readings.value_or(true);
    record.frame_rate = options.recorded_frames;
    record.sonar_rate = options.recorded_sonars;
    record.form = options.record_form;
    record.max_bytes = options.max_recorded;
    record.frame_taker = std::move(frame_taker);
    auto running = std::make_unique<RunningRecord>(folder, simulation, record);
    simulation.recordWith(running->recorder);
    return running;
}

/// Records each room from now on. Replaces the records of an earlier run: call it after all steps
/// that may fail. Empty without --record.
std::vector<std::unique_ptr<RunningRecord>> recordsOf(const SimrunOptions& options, RunSite& site,
                                                      Server& server) {
    std::vector<std::unique_ptr<RunningRecord>> records;
    if (options.record.empty()) return records;
    const auto rooms = site.worlds().rooms();
    for (std::size_t i = 0; i < rooms.size(); ++i) {
        const std::string folder = folderOf(options.record, rooms[i]);
        if (folder != options.record) std::filesystem::create_directory(options.record);
        const Replay* const replay = site.replay(i);
        records.push_back(recordOf(*rooms[i].simulation, options, folder, site.history,
                                   replay != nullptr ? replay->hasOdometry() : options.noise,
                                   server.frameTaker(i)));
    }
    site.recordWhole();
    return records;
}

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

/// Returns the limits of the server, and the files that clients may read. Raises the limit of open
/// files of this process, as every client takes one.
ServerLimits limitsOf(const SimrunOptions& options, const SiteInput& input) {
    ServerLimits limits = withinFileLimit(options.limits, options.bridges->connections());
    if (!options.token_file.empty()) {
        limits.token = readToken(options.token_file);
        if (isOpenToOthers(options.token_file))
            warn(options.common, "simrun",
                 options.token_file + " can be read by other users: chmod 600 makes it yours");
    }
    limits.source = std::make_shared<SceneFolder>(
        options.load_folder.empty()
            ? SceneFolder::of(input.named, input.environment_operand, input.layout_operand)
            : options.load_folder,
        options.rules);
    return limits;
}

/// Reports collisions of robots on stderr, up to a number of lines: of a mover that runs into the
/// same thing again where it stands, the first.
class CollisionLog {
  public:
    CollisionLog(const World& world, const CommonOptions& options)
        : world_(&world), options_(&options) {}
    /// Reports the collisions of the world's last step.
    void report();

  private:
    struct Bump {
        std::string into;
        Point2 at;
    };
    const World* world_;
    const CommonOptions* options_;
    std::map<std::string, Bump, std::less<>> last_;  // by mover
    int count_ = 0;
};

/// Reports on stderr the points, zones and things that movers give up to reach: each once for a
/// mover, up to a number of lines.
class UnreachedLog {
  public:
    /// Subscribes to the events.
    UnreachedLog(Simulation& simulation, const CommonOptions& options);
    /// Reports the events since the last call.
    void report();

  private:
    Simulation* simulation_;
    const CommonOptions* options_;
    std::int64_t next_ = 0;       // event
    std::set<std::string> told_;  // movers and targets
};

/// Reports on stderr when a run by the clock Real falls behind it, and when it keeps up again.
class LagLog {
  public:
    LagLog(const Simulation& simulation, const CommonOptions& options)
        : simulation_(&simulation), options_(&options) {}
    /// Reads the clock after a step.
    void report();

  private:
    const Simulation* simulation_;
    const CommonOptions* options_;
    std::chrono::nanoseconds lost_{};             // at the last step
    std::chrono::steady_clock::time_point last_;  // time of the last loss
    bool is_behind_ = false;
    int count_ = 0;  // number of delays
};

std::string textOf(const World& world, const Collision& collision) {
    const Point2 place = world.status(collision.robot).pose.position;
    return "t=" + formatMilliseconds(collision.time) + ' ' + world.movers()[collision.robot].id +
           " at " + formatFixed(place.x, 3) + ',' + formatFixed(place.y, 3) + " ran into " +
           std::string(collision.into);
}

void CollisionLog::report() {
    constexpr int kMaxCollisions = 100;
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
        if (++count_ == kMaxCollisions)
            warn(*options_, kTool, "further collisions are not reported");
    }
}

UnreachedLog::UnreachedLog(Simulation& simulation, const CommonOptions& options)
    : simulation_(&simulation), options_(&options) {
    simulation.events().want({EventKind::Unreached});
    next_ = simulation.events().next();
}

void UnreachedLog::report() {
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

void LagLog::report() {
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

/// Reports once that a change of a recorded run cannot be repeated.
class FailureLog {
  public:
    FailureLog(const Replay& replay, const CommonOptions& options)
        : replay_(&replay), options_(&options) {}
    void report();

  private:
    const Replay* replay_;
    const CommonOptions* options_;
    bool is_told_ = false;
};

void FailureLog::report() {
    if (is_told_) return;
    const std::string failure = replay_->failure();
    is_told_ = !failure.empty();
    if (is_told_) warn(*options_, kTool, failure);
}

/// Reports on stderr what the worlds of a run tell after each step.
class StepLogs {
  public:
    StepLogs(RunSite& site, const CommonOptions& options);
    void report();

  private:
    LagLog lag_;
    std::vector<CollisionLog> collisions_;
    std::vector<UnreachedLog> unreached_;
    std::vector<FailureLog> failures_;
};

StepLogs::StepLogs(RunSite& site, const CommonOptions& options)
    : lag_(*site.worlds().rooms().front().simulation, options) {
    const auto rooms = site.worlds().rooms();
    for (std::size_t i = 0; i < rooms.size(); ++i) {
        Simulation& simulation = *rooms[i].simulation;
        if (const Replay* const replay = site.replay(i)) {
            failures_.emplace_back(*replay, options);
        } else {
            collisions_.emplace_back(simulation.world(), options);
            unreached_.emplace_back(simulation, options);
        }
    }
}

void StepLogs::report() {
    lag_.report();
    for (CollisionLog& log : collisions_) log.report();
    for (UnreachedLog& log : unreached_) log.report();
    for (FailureLog& log : failures_) log.report();
}

/// Runs it. If other threads are still at work at the end, the process exits at once, with the same
/// status and lines: they use objects that would be destroyed, and a picture or a large room may
/// take minutes.
void endingAtOnce(const std::function<bool()>& is_busy, JunitFile& junit,
                  const SimrunOptions& options, const std::function<void()>& work) {
    std::exception_ptr failure;
    try {
        work();
    } catch (...) {
        failure = std::current_exception();
    }
    const auto end = [&failure] {
        if (failure) std::rethrow_exception(failure);
    };
    if (is_busy()) std::_Exit(runTool("simrun", [&] { junit.during(options.operands, end); }));
    end();
}

/// Waits for the files of the record, if they are read.
void completeRecords(const SimrunOptions& options, std::span<const RunRoom> rooms) {
    if (options.report.empty() && !options.records->isAsked()) return;
    for (const RunRoom& room : rooms)
        for (const std::string& file : Recorder::filesIn(folderOf(options.record, room)))
            completeOutput(file);
}

}  // namespace

void serve(RunSite& site, const SimrunOptions& options, JunitFile& junit) {
    Worlds& worlds = site.worlds();
    const auto rooms = worlds.rooms();
    for (const RunRoom& room : rooms)
        warn(options.common, kTool, startWarnings(room.simulation->world()));
    Simulation& simulation = *rooms.front().simulation;
    StepLogs logs(site, options.common);
    simulation.onStep([&logs] { logs.report(); });
    const auto judge = options.judges->judge(rooms);
    judge->observe();
    simulation.onStep([&judge] { judge->observe(); });
    if (options.judges->isAsked()) simulation.keepOrder();

    std::vector<std::string> replayed;
    for (const RunRoom& room : rooms) {
        checkRecord(options, room.simulation->world());
        if (!options.replay.empty()) replayed.push_back(folderOf(options.replay, room));
    }
    Server server(simulation, options.listen, limitsOf(options, site.input), &worlds);
    servePorts(server, simulation, options, site.title, std::move(replayed));
    const StopSignals signals;
    server.stopOn(signals.descriptor());
    std::optional<OutputFile> port_file;
    if (!options.port_file.empty()) {
        port_file.emplace(options.port_file);
        port_file->write(std::to_string(server.port()) + '\n');
    }
    const auto records = recordsOf(options, site, server);
    const auto progress = progressOf(simulation, options);
    announce(server, options);
    if (port_file) port_file->commit();
    const auto serve_and_conclude = [&] {
        server.run();
        progress->end();
        for (std::size_t i = 0; i < records.size(); ++i)
            records[i]->recorder.end(rooms[i].simulation->world());
        options.bridges->commit(options.common);
        reportLosses(server, options);
        reportEnd(simulation, options);
        for (std::size_t i = 0; i < rooms.size(); ++i)
            if (const Replay* const replay = site.replay(i); replay != nullptr && replay->isCut())
                warn(options.common, "simrun",
                     (rooms[i].id.empty() ? "" : rooms[i].id + ": ") +
                         "the record ends in the midst of a step, which is left out");
        completeRecords(options, rooms);
        if (!options.report.empty())
            writeAll(options.report, reportFile(options, site.input, *judge, site.history.back()));
        options.records->conclude({site.input, options.record, options.common, options.rules});
        judge->report(options.record);
        conclude(*judge, options, site.input.environment_operand, junit);
    };
    endingAtOnce([&server] { return server.isBusy(); }, junit, options, serve_and_conclude);
}

namespace {

/// Warns that a run changed its world, of which the picture shows the start.
void warnOfChanges(const Replay& replay, const CommonOptions& options) {
    if (const auto& time = replay.changedAt())
        warn(options, kTool,
             "the world of the run was changed at t=" + formatMilliseconds(*time) +
                 ": the room is drawn as it was at the start");
}

}  // namespace

void drawRecord(const SimrunOptions& options) {
    const SiteInput input = readInput(options);
    if (!input.isOneRoom()) refuseWholeRecord(options.replay);
    Scene scene = input.only();
    if (const auto replay = openReplay(options, scene)) warnOfChanges(*replay, options.common);
    const std::string title = titleOf(options, input);
    const std::int64_t count = options.drawing->draw(
        {scene, options.replay, title, options.from, options.until, options.common});
    writeDependencies(options.common,
                      std::vector<std::string>{RecordedFiles(options.replay).robots});
    logInfo(options.common, "simrun",
            std::to_string(count) + (count == 1 ? " picture" : " pictures") + " drawn");
}

}  // namespace ispace
