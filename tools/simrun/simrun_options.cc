// SPDX-License-Identifier: GPL-3.0-or-later
// Options of the run, of records and replays, and of the server.
#include "simrun/simrun_options.h"

#include <algorithm>
#include <chrono>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/common_options.h"
#include "cli/outputs.h"
#include "cli/storey_operands.h"
#include "extensions.h"
#include "simrun/simrun_record.h"

namespace ispace {

SimTime timeOption(const std::string& text, SimTime least, SimTime most) {
    const auto time = parseSimTime(text);
    if (!time || *time < least || *time > most)
        throw UsageError(excerpt(text) + " is no time from " + formatSimTime(least) + " to " +
                         formatSimTime(most) + " s (`0.005`, `5ms`)");
    return *time;
}

namespace {

double recordedRate(const std::string& text, const std::string& what) {
    constexpr double kMaxRate = 1e5;
    const auto rate = parseDouble(text);
    if (!rate || *rate < 0 || *rate > kMaxRate)
        throw UsageError(excerpt(text) + " is no number of " + what + " a second from 0 to 100000");
    return *rate;
}

}  // namespace

SimrunCommand::SimrunCommand(int argc, const char* const* argv)
    : ToolCommand(
          "simrun", "[ENV] [LAYOUT]",
          "Simulate the robots and sensors of a room and serve them over TCP. The first line of "
          "output holds the address; TERM, INT and the request SHUTDOWN end the run.") {
    line_.example("simrun room.env robots.3dm --web 127.0.0.1:8080",
                  "a world in real time, with a page to watch and drive it");
    line_.example("simrun room.env robots.3dm --clock fast --until 60 --record run",
                  "a minute of simulated time, recorded as fast as possible");
    line_.operands(options_.operands, 2);
    line_.group("The run");
    declareRun();
    line_.group("Replays");
    declareReplay();
    drawings_ = std::make_shared<DrawingExtensions>(extensions().drawings());
    drawings_->declare(line_);
    line_.group("Tests");
    declareJudgement();
    line_.group("The server");
    declareServer();
    line_.built(extensions().names());
    ToolExtensions tool_extensions(extensions().options(), "simrun");
    tool_extensions.declare(line_);
    addSceneRules(line_, options_.rules);
    addStoreyOption(line_, options_.rules, "default: all storeys");
    addCommonOptions(
        line_, options_.common,
        "draw the record of --replay there instead of serving it: the ways (.png, .svg, "
        ".pdf) or a film (.y4m, .gif; a folder or a pattern with %d for pictures)");
    line_.essential({"--version", "--clock", "--dt", "--until", "--noise", "--script", "--record",
                     "--report", "--replay", "--listen", "--storey", "--output", "--quiet",
                     "--threads", "--seed"});
    line_.parse(argc, argv);
    options_.task =
        tool_extensions.task(line_, {options_.common, options_.rules, options_.operands});
    if (options_.task) return;
    takeJudgement();
    checkReplay();
    takeDrawing();
    takeServer();
}

void SimrunCommand::declareRun() {
    SimrunOptions& o = options_;
    line_.texts("--zone", "ZONE", o.zones,
                "add a zone for events and --expect: rect:X,Y,X,Y, poly:X,Y;X,Y;..., or "
                "door:GLOB[,M] within M of doors (1.5m), named DOOR-zone",
                Enters::History);
    line_.parsed(
        "--clock", "CLOCK", [&o](const std::string& text) { o.clock = parseClock(text); },
        "real[:RATE], fast, or step: simulated time follows wall time (RATE times as fast), runs "
        "as fast as it can, or waits for STEP requests (default real)",
        Enters::Nothing);
    line_.parsed(
        "--dt", "TIME",
        [&o](const std::string& text) {
            o.step = timeOption(text, World::kMinStep, World::kMaxStep);
        },
        "length of a step (default 5ms)", Enters::History);
    line_.parsed(
        "--until", "TIME",
        [&o](const std::string& text) { o.until = timeOption(text, SimTime(0), kMaxTime); },
        "end the run at this simulated time (90, 90s, 1.5min)", Enters::History);
    line_.flag("--noise", o.noise,
               "sensors have the noise of their records; robots, their odometry and their starts "
               "that of motion_noise, odometry_noise and start_noise",
               Enters::History);
    line_.file("--script", "FILE", o.script,
               "commands for the robots, lines `TIME ROBOT COMMAND` (- is stdin)",
               Enters::BaseName);
    line_.file("--record", "DIR", o.record,
               "write the run there: tables of robots, people and events, readings, pictures",
               Enters::Nothing);
    line_.file("--report", "FILE", o.report,
               "with --record: at the end of the run write a report for people, as a page with the "
               "ways of robots and people and the floor that sensors see (.html, .pdf), or as JSON "
               "(.json)",
               Enters::Nothing);
    o.reports = std::make_shared<const ReportExtensions>(extensions().reports());
    line_.switchFlag("--record-readings", "--no-record-readings", o.records_readings,
                     "record the readings of sensors (default)",
                     "leave them out: events and states remain", Enters::Nothing);
    line_.parsed(
        "--record-frames", "RATE",
        [&o](const std::string& text) { o.recorded_frames = recordedRate(text, "frames"); },
        "maximum of recorded pictures and depth frames of each sensor in a simulated second "
        "(default 1; 0: off)",
        Enters::Nothing);
    line_.parsed(
        "--record-sonars", "RATE",
        [&o](const std::string& text) { o.recorded_sonars = recordedRate(text, "readings"); },
        "maximum of recorded readings of each robot's sonars in a simulated second (default 10; 0: "
        "off)",
        Enters::Nothing);
    line_.parsed(
        "--record-limit", "SIZE",
        [&o](const std::string& text) { o.max_recorded = byteCount(text); },
        "end the run once its record is larger, e.g. 500M (default 16G)", Enters::Nothing);
    addRecordForm(line_, o.record_form);
    o.records = std::make_shared<RecordExtensions>(extensions().records());
    o.records->declare(line_);
}

void SimrunCommand::declareJudgement() {
    SimrunOptions& o = options_;
    o.judges = std::make_shared<JudgeExtensions>(extensions().judges());
    o.judges->declare(line_);
    line_.file("--junit", "FILE", o.junit,
               "write the verdicts on the expectations there, as XML that CI servers read",
               Enters::Nothing);
}

void SimrunCommand::takeJudgement() {
    options_.judges->take(line_);
    if (line_.given("--junit") && !options_.judges->isAsked())
        throw UsageError("--junit writes what became of expectations: give --expect");
}

void SimrunCommand::declareReplay() {
    SimrunOptions& o = options_;
    line_.file(
        "--replay", "DIR", o.replay,
        "serve the run that --record wrote there once more: all go as recorded, sensors read; "
        "ENV and LAYOUT are those of the record unless given",
        Enters::BaseName);
    line_.parsed(
        "--from", "TIME",
        [&o](const std::string& text) { o.from = timeOption(text, SimTime(0), kMaxTime); },
        "begin the replay at this time of the record", Enters::History);
    line_.flag("--hold", o.holds,
               "serve the last moment of the record on and on, instead of ending with it",
               Enters::Nothing);
}

void SimrunCommand::checkReplay() const {
    const SimrunOptions& o = options_;
    o.records->take(line_);
    if (line_.given("--report")) {
        if (o.record.empty())
            throw UsageError("--report is about a recorded run: give --record DIR");
        if (isStdout(o.report)) throw UsageError("give --report a file, such as run.html");
        o.reports->take(o.report);
    }
    if (o.record.empty())
        for (const char* option :
             {"--record-readings", "--no-record-readings", "--record-frames", "--record-sonars",
              "--record-every", "--record-columns", "--record-compression"})
            if (line_.given(option))
                throw UsageError(std::string(option) + " is about a record: give --record DIR");
    if (o.replay.empty()) {
        for (const char* option : {"--from", "--hold"})
            if (line_.given(option))
                throw UsageError(std::string(option) + " is about a record: give --replay DIR");
        return;
    }
    for (const char* option : {"--script", "--dt"})
        if (line_.given(option))
            throw UsageError(std::string(option) +
                             " does not go with --replay: steps and motions are the record's");
    if (o.until && *o.until <= o.from) throw UsageError("--from is not before --until");
    if (!o.record.empty() && o.record == o.replay)
        throw UsageError("--record would replace what --replay reads: give another folder");
}

void SimrunCommand::takeDrawing() {
    SimrunOptions& o = options_;
    if (!line_.given("--output")) {
        for (const std::string& option : drawings_->options())
            if (line_.given(option))
                throw UsageError(option + " is about a picture of a record: give -o FILE");
        return;
    }
    if (o.replay.empty())
        throw UsageError(
            "-o is a picture or a film of a record: give --replay DIR (a run writes to --record "
            "DIR)");
    std::vector<std::string> of_runs{"--record", "--clock", "--hold", "--listen", "--port-file"};
    for (const auto& of_extensions : {o.bridges->options(), o.judges->options()})
        of_runs.insert(of_runs.end(), of_extensions.begin(), of_extensions.end());
    for (const std::string& option : of_runs)
        if (line_.given(option))
            throw UsageError(option + " does not go with -o, which serves nobody");
    o.drawing = drawings_->take(line_, o.common.output);
}

void SimrunCommand::declareServer() {
    SimrunOptions& o = options_;
    constexpr int kMaxClients = 100'000;
    line_.parsed(
        "--listen", "ADDR:PORT", [&o](const std::string& text) { o.listen = parseEndpoint(text); },
        "where clients connect; port 0 takes any free one (default 127.0.0.1:0)", Enters::Nothing);
    line_.file("--port-file", "FILE", o.port_file,
               "write the port number there when clients can connect", Enters::Nothing);
    line_.parsed(
        "--max-clients", "N",
        [&o](const std::string& text) {
            const auto count = parseInteger(text);
            if (!count || *count < 1 || *count > kMaxClients)
                throw UsageError(excerpt(text) + " is not a whole number from 1 to " +
                                 std::to_string(kMaxClients));
            o.limits.clients = static_cast<std::size_t>(*count);
        },
        "clients served at once; rejects more (default 256)", Enters::Nothing);
    line_.file("--token-file", "FILE", o.token_file,
               "its first line is the token that clients need to change the world or end the run, "
               "and for any role if they may connect from other machines",
               Enters::Nothing);
    line_.parsed(
        "--watchdog", "TIME",
        [&o](const std::string& text) {
            o.limits.watchdog =
                timeOption(text, std::chrono::milliseconds(1), std::chrono::hours(24));
        },
        "stop the robot or person of a client that is silent for this long (wall time)",
        Enters::Nothing);
    line_.flag("--wait-for-readers", o.limits.waits_for_readers,
               "with --clock fast or step: wait until clients have read the streams and topics "
               "that they asked for, each for at most the time of --watchdog, else 10 s",
               Enters::Nothing);
    line_.file("--load", "DIR", o.load_folder,
               "folder from which the request LOAD reads (default that of ENV)", Enters::Nothing);
    line_.switchFlag("--changes", "--no-changes", o.changes,
                     "let clients change the world (default)", "reject it", Enters::Nothing);
    line_.switchFlag("--shutdown", "--no-shutdown", o.shutdown,
                     "let the request SHUTDOWN end the run (default)", "reject it",
                     Enters::Nothing);
    o.bridges = std::make_shared<BridgeExtensions>(extensions().bridges());
    o.bridges->declare(line_);
}

void SimrunCommand::takeServer() {
    SimrunOptions& o = options_;
    o.limits.shutdown = o.shutdown.value_or(true);
    o.limits.changes = o.changes.value_or(true);
    o.limits.token_first = !o.listen.is_loopback;
    if (o.limits.waits_for_readers && o.clock.kind == Clock::Kind::Real)
        throw UsageError(
            "--wait-for-readers requires --clock fast or step: real time does not wait");
    mustBeOneFile("--report", o.report);
    BridgeRules rules{line_, o.limits, !o.replay.empty(), !o.token_file.empty()};
    o.bridges->take(rules);
    if (!o.listen.is_loopback && o.token_file.empty())
        throw UsageError("--listen: `" + o.listen.address +
                         "`: other machines are served only with --token-file; or listen on "
                         "127.0.0.1");
}

}  // namespace ispace
