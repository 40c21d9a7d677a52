// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/options.h"

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/common_options.h"

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
    constexpr double kMost = 1e5;
    const auto rate = parseDouble(text);
    if (!rate || *rate < 0 || *rate > kMost)
        throw UsageError(excerpt(text) + " is no number of " + what + " a second from 0 to 100000");
    return *rate;
}

}  // namespace

SimrunCommand::SimrunCommand(int argc, const char* const* argv)
    : ToolCommand(
          "simrun", "[ENV] [LAYOUT]",
          "Simulate the robots and sensors of a room and serve them over TCP. The first line of "
          "output holds the address; TERM, INT and the request SHUTDOWN end the run.") {
    line_.operands(options_.operands, 2);
    declareRun();
    declareReplay();
    declareDrawing();
    declareJudgement();
    declareServer();
    addSceneRules(line_, options_.rules);
    addCommonOptions(
        line_, options_.common,
        "draw the record of --replay there instead of serving it: the ways (.png, .svg, "
        ".pdf) or a film (.y4m, .gif; a folder or a pattern with %d for pictures)");
    line_.parse(argc, argv);
    takeExpectations();
    checkReplay();
    takeDrawing();
    takeServer();
}

void SimrunCommand::declareRun() {
    SimrunOptions& o = options_;
    line_.texts("--zone", "ZONE", o.zones,
                "add a zone for events and --expect: rect:X,Y,X,Y, poly:X,Y;X,Y;..., or "
                "door:GLOB,M within M of doors, named DOOR-zone",
                Enters::History);
    line_.parsed(
        "--clock", "CLOCK", [&o](const std::string& text) { o.clock = parseClock(text); },
        "real[:RATE], fast, or step: simulated time follows wall time (RATE times as fast), runs "
        "as fast as it can, or waits for STEP requests (default real)",
        Enters::Nothing);
    line_.parsed(
        "--dt", "TIME",
        [&o](const std::string& text) {
            o.step = timeOption(text, World::kShortestStep, World::kLongestStep);
        },
        "length of a step (default 5ms)", Enters::History);
    line_.parsed(
        "--until", "TIME",
        [&o](const std::string& text) { o.until = timeOption(text, SimTime(0), kLongestTime); },
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
}

void SimrunCommand::declareJudgement() {
    SimrunOptions& o = options_;
    line_.texts("--expect", "SENTENCE", expected_,
                "exit with 3 unless the run does this, e.g. 'r1 within 0.4 of 2,1 before 60', "
                "'no collision', 'h1 unseen at most 5' (see the manual)",
                Enters::Nothing);
    line_.file("--junit", "FILE", o.junit,
               "write the verdicts on the expectations there, as XML that CI servers read",
               Enters::Nothing);
}

void SimrunCommand::takeExpectations() {
    for (const std::string& text : expected_)
        options_.expected.push_back(
            ofOption("--expect", [&text] { return parseExpectation(text); }));
    if (line_.given("--junit") && expected_.empty())
        throw UsageError("--junit writes what became of expectations: give --expect");
}

}  // namespace ispace
