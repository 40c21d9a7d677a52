// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/options.h"

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/common_options.h"
#include "cli/outputs.h"

namespace ispace {

namespace {

SimTime simTime(const std::string& text, SimTime least, SimTime most) {
    const auto time = parseSimTime(text);
    if (!time || *time < least || *time > most)
        throw UsageError(excerpt(text) + " is no time from " + formatSimTime(least) + " to " +
                         formatSimTime(most) + " s (`0.005`, `5ms`)");
    return *time;
}

}  // namespace

SimrunCommand::SimrunCommand(int argc, const char* const* argv)
    : ToolCommand(
          "simrun", "[ENV] [LAYOUT]",
          "Simulate the robots and sensors of a room and serve them over TCP. The first line of "
          "output says where; TERM, INT and the request SHUTDOWN end the run.") {
    line_.operands(options_.operands, 2);
    declareRun();
    declareReplay();
    declareDrawing();
    declareJudgement();
    declareServer();
    addAnyEnvironmentOption(line_, options_.any_environment);
    addCommonOptions(
        line_, options_.common,
        "draw the record of --replay there instead of serving it: the ways (.png, .svg, "
        ".pdf) or a film (.y4m; a folder or a pattern with %d for pictures)");
    line_.parse(argc, argv);
    takeExpectations();
    checkReplay();
    takeDrawing();
    options_.limits.shutdown = options_.shutdown.value_or(true);
    options_.limits.changes = options_.changes.value_or(true);
    options_.limits.token_first = !options_.listen.is_loopback;
    if (!options_.listen.is_loopback && options_.token_file.empty())
        throw UsageError("--listen: `" + options_.listen.address +
                         "`: other machines are served only with --token-file; or listen on "
                         "127.0.0.1");
}

void SimrunCommand::declareRun() {
    SimrunOptions& o = options_;
    constexpr double kMaxFrames = 1e5;
    line_.parsed(
        "--clock", "CLOCK", [&o](const std::string& text) { o.clock = parseClock(text); },
        "real[:RATE], fast, or step: simulated time follows wall time (RATE times as fast), runs "
        "as fast as it can, or waits for STEP requests (default real)",
        Enters::Nothing);
    line_.parsed(
        "--dt", "TIME",
        [&o](const std::string& text) {
            o.step = simTime(text, World::kShortestStep, World::kLongestStep);
        },
        "length of a step (default 5ms)", Enters::History);
    line_.parsed(
        "--until", "TIME",
        [&o](const std::string& text) { o.until = simTime(text, SimTime(0), kLongestTime); },
        "end the run at this simulated time (90, 90s, 1.5min)", Enters::History);
    line_.flag("--noise", o.noise,
               "robots, their odometry and their starts stray as motion_noise, odometry_noise and "
               "start_noise of their records say",
               Enters::History);
    line_.file("--script", "FILE", o.script,
               "commands for the robots, lines `TIME ROBOT COMMAND` (- is stdin)",
               Enters::BaseName);
    line_.file("--record", "DIR", o.record,
               "write what happens there: tables of robots, people and events, readings, pictures",
               Enters::Nothing);
    line_.parsed(
        "--record-frames", "RATE",
        [&o](const std::string& text) {
            const auto rate = parseDouble(text);
            if (!rate || *rate < 0 || *rate > kMaxFrames)
                throw UsageError(excerpt(text) +
                                 " is no number of frames a second from 0 to 100000");
            o.recorded_frames = *rate;
        },
        "pictures and depth frames recorded of each sensor in a simulated second, at most (default "
        "1; 0: none)",
        Enters::Nothing);
    line_.parsed(
        "--record-limit", "SIZE",
        [&o](const std::string& text) { o.max_recorded = byteCount(text); },
        "end the run once its record is larger, e.g. 500M (default 16G)", Enters::Nothing);
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
        [&o](const std::string& text) { o.from = simTime(text, SimTime(0), kLongestTime); },
        "begin the replay at this time of the record", Enters::History);
    line_.flag("--hold", o.holds,
               "serve the last moment of the record on and on, instead of ending with it",
               Enters::Nothing);
}

void SimrunCommand::checkReplay() const {
    const SimrunOptions& o = options_;
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

void SimrunCommand::declareDrawing() {
    DrawingOptions& o = options_.drawing;
    line_.choice("--to", to_, {"png", "svg", "pdf", "y4m"},
                 "format of FILE (default: its suffix, else png)", Enters::Nothing);
    constexpr int kNarrowest = 200, kWidest = 10000;
    line_.count("--width", "PIXELS", o.width, kNarrowest, kWidest,
                "width of the picture or the film", Enters::Nothing);
    const auto positive = [this](const std::string& name, double& variable, double most,
                                 const std::string& help) {
        line_.parsed(
            name, "N",
            [&variable, most](const std::string& text) {
                const auto value = parseDouble(text);
                constexpr double kLeast = 0.001;
                if (!value || *value < kLeast || *value > most)
                    throw UsageError(excerpt(text) + " is no number from 0.001 to " +
                                     formatDouble(most));
                variable = *value;
            },
            help, Enters::Nothing);
    };
    positive("--fps", o.fps, 1000, "pictures a second of the film (default 25)");
    positive("--speed", o.speed, 1e6, "simulated seconds in a second of the film (default 1)");
}

void SimrunCommand::takeDrawing() {
    SimrunOptions& o = options_;
    if (!line_.given("--output")) {
        for (const char* option : {"--to", "--width", "--fps", "--speed"})
            if (line_.given(option))
                throw UsageError(std::string(option) +
                                 " is about a picture of a record: give -o FILE");
        return;
    }
    if (o.replay.empty())
        throw UsageError(
            "-o is a picture or a film of a record: give --replay DIR (a run writes to --record "
            "DIR)");
    for (const char* option :
         {"--record", "--expect", "--clock", "--hold", "--listen", "--web", "--port-file"})
        if (line_.given(option))
            throw UsageError(std::string(option) + " does not go with -o, which serves nobody");
    const bool is_set = OutputSet::of(o.common.output).has_value();
    o.drawing.format = is_set && to_.empty()
                           ? "png"
                           : outputFormat(to_, o.common.output, {"png", "svg", "pdf", "y4m"});
    if (is_set && o.drawing.format != "png")
        throw UsageError("the pictures of a film are PNG; a film in one file is .y4m");
    const bool is_film = is_set || o.drawing.format == "y4m";
    for (const char* option : {"--fps", "--speed", "--from"})
        if (!is_film && line_.given(option))
            throw UsageError(std::string(option) +
                             " is about films: give -o FILE.y4m, or a folder");
    if (!is_set && o.drawing.format != "svg")
        refuseTerminal(o.common.output, o.drawing.format == "y4m" ? "a film" : "a picture");
}

void SimrunCommand::declareJudgement() {
    SimrunOptions& o = options_;
    line_.texts("--expect", "SENTENCE", expected_,
                "exit with 3 unless the run does this, e.g. 'r1 within 0.4 of 2,1 before 60', "
                "'no collision', 'h1 unseen at most 5' (see the manual)",
                Enters::Nothing);
    line_.file("--junit", "FILE", o.junit,
               "write what became of the expectations there, as XML that CI servers read",
               Enters::Nothing);
}

void SimrunCommand::takeExpectations() {
    for (const std::string& text : expected_)
        options_.expected.push_back(
            ofOption("--expect", [&text] { return parseExpectation(text); }));
    if (line_.given("--junit") && expected_.empty())
        throw UsageError("--junit writes what became of expectations: give --expect");
}

void SimrunCommand::declareServer() {
    SimrunOptions& o = options_;
    constexpr int kMaxClients = 100'000;
    line_.parsed(
        "--listen", "ADDR:PORT", [&o](const std::string& text) { o.listen = parseEndpoint(text); },
        "where clients connect; port 0 takes any free one (default 127.0.0.1:0)", Enters::Nothing);
    line_.parsed(
        "--web", "ADDR:PORT",
        [&o](const std::string& text) {
            o.web = parseEndpoint(text);
            if (!o.web->is_loopback)
                throw UsageError(excerpt(text) +
                                 ": the page is for browsers of this machine; use 127.0.0.1");
        },
        "show the running world to browsers there; port 0 takes any free one", Enters::Nothing);
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
        "clients served at once; more are refused (default 256)", Enters::Nothing);
    line_.file("--token-file", "FILE", o.token_file,
               "its first line is what clients must know to change the world or end the run, and "
               "for anything if they may connect from other machines",
               Enters::Nothing);
    line_.parsed(
        "--watchdog", "TIME",
        [&o](const std::string& text) {
            o.limits.watchdog = simTime(text, std::chrono::milliseconds(1), std::chrono::hours(24));
        },
        "stop a robot or person whose client has been silent for so long (wall time)",
        Enters::Nothing);
    line_.file("--load", "DIR", o.load_folder,
               "folder from which the request LOAD reads (default that of ENV)", Enters::Nothing);
    line_.switchFlag("--changes", "--no-changes", o.changes,
                     "let clients change the world (default)", "refuse it", Enters::Nothing);
    line_.switchFlag("--shutdown", "--no-shutdown", o.shutdown,
                     "let the request SHUTDOWN end the run (default)", "refuse it",
                     Enters::Nothing);
}

}  // namespace ispace
