// SPDX-License-Identifier: GPL-3.0-or-later
// Days of work as users do them, as processes on one core, beside the equivalent that bounds them:
// the same run unrecorded, level lasers in the same building, the rooms of a sweep in one
// batch, a file copied. Ratios of processor time; a row above its goal is marked.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "bench_scenes.h"
#include "bench_table.h"
#include "tool_run.h"

namespace {

using namespace ispace;

/// Does the work once. \returns seconds of processor time
using Work = std::function<double()>;

struct Day {
    std::string name;
    std::string equivalent;
    double goal = 1;  ///< ratio of the work to its equivalent
    Work work, equal;
    std::function<void()> verify;  ///< after the first round \throws FormatError
};

using Words = std::vector<std::string>;

/// Runs a tool of this build: words[0] is its name.
Work command(Words words) {
    words[0] = ISPACE_TOOLS "/" + words[0];
    return [words] { return bench::runTool(words, "/dev/null").processor; };
}

void mustBe(bool is_so, const std::string& failure) {
    if (!is_so) throw FormatError({"days", 0, 0, failure});
}

/// A hall in which this many robots wander, each with sonars, bumpers and a laser of 181 beams at
/// 10 Hz.
Words hallOfRobots(const std::string& folder, int count) {
    constexpr double kApart = 4;
    const int columns = static_cast<int>(std::ceil(std::sqrt(count)));
    const double side = kApart * (columns + 1);
    const std::string name = folder + "/hall" + std::to_string(count);
    const std::string length = formatDouble(side);
    writeAll(name + ".env", "#env 1\nispace size=" + length + "," + length + "\n");
    std::string layout = "#3dm 1\n";
    for (int i = 0; i < count; ++i) {
        const std::string id = "r" + std::to_string(i);
        const int column = i % columns + 1, row = i / columns + 1;
        const double x = kApart * column - side / 2, y = kApart * row - side / 2;
        layout.append("robot id=").append(id).append(" model=pioneer-3dx walk=wander at=");
        layout.append(formatDouble(x)).append(",").append(formatDouble(y));
        layout.append(" heading=").append(std::to_string(37 * i % 360)).append("\n");
        layout.append("laser on=").append(id).append(" fov=180 step=1 range=8 rate=10\n");
    }
    writeAll(name + ".3dm", layout);
    return {"simrun", name + ".env", name + ".3dm", "-j", "1", "--clock", "fast", "--until"};
}

Day recordedRun(const std::string& folder, int robots, int seconds, double goal) {
    Words run = hallOfRobots(folder, robots);
    run.push_back(std::to_string(seconds));
    Words recorded = run;
    const std::string record = folder + "/record" + std::to_string(robots);
    recorded.insert(recorded.end(), {"--record", record});
    const auto verify = [=] {
        constexpr int kSteps = 100, kLine = 30;
        mustBe(
            readAll(record + "/robots.csv").size() > static_cast<std::size_t>(kSteps * seconds) *
                                                         static_cast<std::size_t>(kLine * robots),
            "the record lacks steps");
    };
    return {"record " + std::to_string(robots) + " robots, " + std::to_string(seconds) + " s",
            "not recorded",
            goal,
            command(recorded),
            command(run),
            verify};
}

/// A building of 1 840 furnished rooms with ten sensors of this record in its corridors and rooms.
Words buildingWith(const std::string& folder, const std::string& name, const std::string& record) {
    constexpr int kColumns = 46, kRows = 40, kSensors = 10, kPitch = 7;
    const std::string room = folder + "/building.env", layout = folder + '/' + name + ".3dm";
    writeAll(room, bench::officeText(kColumns, kRows));
    std::string text = "#3dm 1\n";
    for (int i = 0; i < kSensors; ++i) {
        text.append(record).append(" heading=").append(std::to_string(36 * i)).append(" at=");
        text.append(formatDouble(17.3 * i + 2)).append(",");
        text.append(formatDouble(kPitch * (4 * i + 1) + (i % 2 == 0 ? -1 : 2.5)));
        text.append(i % 2 == 0 ? ",2.4\n" : ",1.9\n");
    }
    writeAll(layout, text);
    return {"coverage", room, layout, "-j", "1", "--json"};
}

Day camerasInBuilding(const std::string& folder) {
    const Words cameras = buildingWith(folder, "cameras", "camera fov=90 range=12 tilt=-35");
    const Words lasers = buildingWith(folder, "lasers", "laser fov=90 step=0.5 range=12");
    return {"10 cameras of 12 m in 1 840 rooms",
            "10 level lasers",
            2,
            command(cameras),
            command(lasers),
            {}};
}

std::vector<Day> allDays(const std::string& folder) {
    return {
        camerasInBuilding(folder),
        recordedRun(folder, 1, 3600, 1.5),
        recordedRun(folder, 100, 60, 1.5),
        recordedRun(folder, 1000, 10, 1.5),
    };
}

void measure(benchmark::State& state, const Day& day) {
    double work = HUGE_VAL, equal = HUGE_VAL;
    for (auto _ : state) {
        equal = std::min(equal, day.equal());
        work = std::min(work, day.work());
        state.SetIterationTime(work);
        if (day.verify) day.verify();
    }
    const double ratio = work / equal;
    state.counters["ratio"] = ratio;
    state.SetLabel(bench::leftCell(day.name, 36) + bench::leftCell(day.equivalent, 28) +
                   bench::cell(work, 2, 8) + bench::cell(equal, 2, 8) + bench::cell(ratio, 2, 8) +
                   bench::cell(day.goal, 1, 8) + (ratio > day.goal ? "  above" : ""));
}

}  // namespace

int main(int argc, char** argv) {
    constexpr int kRounds = 3;
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const bench::Folder scratch;
    const std::vector<Day> days = allDays(scratch.name);
    for (const Day& day : days)
        benchmark::RegisterBenchmark(("days/" + day.name).c_str(),
                                     [&day](benchmark::State& state) { measure(state, day); })
            ->Iterations(kRounds)
            ->UseManualTime();
    bench::TableReporter table(
        {{"days", "Days of work, seconds of processor time on one core; the quickest of " +
                      std::to_string(kRounds) +
                      "\n                                    equivalent                      work"
                      "   equal   ratio    goal"}});
    benchmark::RunSpecifiedBenchmarks(&table);
    return 0;
}
