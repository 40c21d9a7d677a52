// SPDX-License-Identifier: GPL-3.0-or-later
// Days of work as users do them, as processes on one core, beside the equivalent that bounds them:
// the same run unrecorded, level lasers in the same building, edits in a small one, the rooms of a
// sweep as one building, a file copied. Ratios of processor time; a row above its goal is marked.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "bench_scenes.h"
#include "bench_table.h"
#include "sim/world_editor.h"
#include "support/test_paths.h"
#include "support/test_source.h"
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

/// A building of 1 840 furnished rooms with sensors of this record in its corridors and rooms.
Words buildingWith(const std::string& folder, const std::string& name, const std::string& record,
                   int sensors = 10) {
    constexpr int kColumns = 46, kRows = 40, kPitch = 7, kLength = 184;
    const std::string room = folder + "/building.env", layout = folder + '/' + name + ".3dm";
    writeAll(room, bench::officeText(kColumns, kRows));
    std::string text = "#3dm 1\n";
    for (int i = 0; i < sensors; ++i) {
        text.append(record).append(" heading=").append(std::to_string(36 * i)).append(" at=");
        text.append(formatDouble(std::fmod(17.3 * i + 2, kLength))).append(",");
        text.append(formatDouble(kPitch * ((4 * i + 1) % kRows) + (i % 2 == 0 ? -1 : 2.5)));
        text.append(i % 2 == 0 ? ",2.4\n" : ",1.9\n");
    }
    writeAll(layout, text);
    return {"coverage", room, layout, "-q", "-j", "1", "--json"};
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

Day manyCamerasInBuilding(const std::string& folder) {
    constexpr double kSeconds = 3;
    return {"500 cameras of 12 m in 1 840 rooms",
            "3 seconds",
            1,
            command(buildingWith(folder, "cameras500", "camera fov=90 range=12 tilt=-35", 500)),
            [] { return kSeconds; },
            {}};
}

/// 1 000 furnished rooms with a laser each: a file each, or together in one building.
Day sweepOfRooms(const std::string& folder) {
    constexpr int kColumns = 40, kRows = 25, kPitch = 7, kWidth = 4;
    const std::string head = "#3dm 1\n", laser = "laser fov=180 step=1 range=8 at=";
    const std::string room = folder + "/room.env", layout = folder + "/room.3dm";
    writeAll(room, bench::officeText(1, 1));
    writeAll(layout, head + laser + "2,3\n");
    std::string list, lasers = head;
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            list.append(room).append(" ").append(layout).append("\n");
            lasers.append(laser).append(std::to_string(kWidth * column + 2)).append(",");
            lasers.append(std::to_string(kPitch * row + 3)).append("\n");
        }
    writeAll(folder + "/rooms.list", list);
    writeAll(folder + "/rooms.env", bench::officeText(kColumns, kRows));
    writeAll(folder + "/rooms.3dm", lasers);
    return {"1 000 rooms, coverage --batch",
            "one building of them",
            0.8,
            command({"coverage", "--batch", folder + "/rooms.list", "-q", "-j", "1"}),
            command({"coverage", folder + "/rooms.env", folder + "/rooms.3dm", "-q", "-j", "1"}),
            {}};
}

/// Two lasers placed in each of 50 furnished rooms, beside the 24 ms a room that place them in
/// 10 000 rooms in two minutes on two cores.
Day arrangedRooms(const std::string& folder) {
    constexpr int kRooms = 50;
    constexpr double kRoomSeconds = 0.024;
    const std::string list = folder + "/arranged.list", layouts = folder + "/arranged/";
    const std::string room = bench::officeText(1, 1);
    std::string lines;
    for (int i = 0; i < kRooms; ++i) {
        const std::string name = folder + "/arranged" + std::to_string(i) + ".env";
        writeAll(name, room + "cube size=0.5,0.5,0.9 at=" + formatDouble(1 + 0.03 * i) +
                           ",2 heading=" + std::to_string(7 * i) + "\n");
        lines.append(name).append("\n");
    }
    writeAll(list, lines);
    return {
        "50 rooms, arrange --batch, 2 lasers",
        "24 ms a room",
        1,
        command(
            {"arrange", "--batch", list, "--sensor", "urg-04lx:2", "-q", "-j", "1", "-o", layouts}),
        [] { return kRooms * kRoomSeconds; },
        [=] { mustBe(!readAll(layouts + "arranged49-0050.3dm").empty(), "a layout is missing"); }};
}

/// One of 100 lasers in 1 840 rooms is moved between two runs: all are measured again.
Day movedLaser(const std::string& folder) {
    const Words words = buildingWith(folder, "moved", "laser fov=180 step=1 range=8", 99);
    const std::string& layout = words[2];
    const std::string text = readAll(layout);
    constexpr double kSeconds = 0.1;
    int edits = 0;
    const auto work = [=]() mutable {
        writeAll(layout, text + "laser fov=180 step=1 range=8 at=2,6 heading=" +
                             std::to_string(++edits) + "\n");
        return command(words)();
    };
    return {
        "1 of 100 lasers moved, 1 840 rooms", "0.1 seconds", 1, work, [] { return kSeconds; }, {}};
}

/// The rooms of sweepOfRooms() with a file each, of which one changes between two runs with a
/// cache.
Day changedRoom(const std::string& folder) {
    constexpr int kRooms = 1'000;
    const std::string list = folder + "/changed.list", cache = folder + "/changed.cache";
    const std::string room = bench::officeText(1, 1);
    const auto name_of = [=](int i) { return folder + "/changed" + std::to_string(i) + ".env"; };
    std::string lines;
    for (int i = 0; i < kRooms; ++i) {
        writeAll(name_of(i), room + "laser fov=180 step=1 range=8 at=2,3\n");
        lines.append(name_of(i)).append("\n");
    }
    writeAll(list, lines);
    const Words all = {"coverage", "--batch", list, "-q", "-j", "1"};
    Words cached = all;
    cached.insert(cached.end(), {"--cache", cache});
    command(cached)();
    int edits = 0;
    const auto work = [=]() mutable {
        writeAll(name_of(7), room + "laser fov=180 step=1 range=8 at=2," +
                                 formatDouble(2 + 0.01 * ++edits) + "\n");
        return command(cached)();
    };
    const auto verify = [=] {
        constexpr std::size_t kReport = 1'000;
        mustBe(readAll(cache).size() > kRooms * kReport, "the cache lacks reports");
    };
    return {"one of 1 000 rooms changed, --cache", "all of them", 0.1, work, command(all), verify};
}

/// Scans at a million poses on a circle, in a corridor's corner of an office.
Day millionPoses(const std::string& folder) {
    constexpr int kPoses = 1'000'000;
    constexpr double kStep = 0.001, kRadius = 0.8;
    const std::string poses = folder + "/poses.tum", scans = folder + "/scans.csv";
    std::string text;
    for (int i = 0; i < kPoses; ++i) {
        const double turn = kStep * i;
        text.append(std::to_string(i));
        for (const double number : {2 + kRadius * std::cos(turn), 6 + kRadius * std::sin(turn)})
            text.append(" ").append(formatDouble(number));
        text.append(" 0.15 0 0 ").append(formatDouble(std::sin(turn / 2)));
        text.append(" ").append(formatDouble(std::cos(turn / 2))).append("\n");
    }
    writeAll(poses, text);
    writeAll(folder + "/office.env", bench::officeText(12, 10));
    const Work copy = [=] {
        return bench::runTool({"/bin/cp", scans, scans + ".copy"}, "/dev/null").processor;
    };
    const auto verify = [=] {
        constexpr std::size_t kBeams = 5, kLine = 30;
        mustBe(readAll(scans).size() > kPoses * kBeams * kLine, "scans are missing");
    };
    return {"a million poses, 5 beams, csv",
            "a copy of the scans",
            40,
            command({"scan", folder + "/office.env", "--model", "laser,fov=180,step=45,range=8",
                     "--poses", poses, "-q", "-j", "1", "-o", scans}),
            copy,
            verify};
}

/// A cube that moves to and fro in a running world.
Work edits(int columns, int rows) {
    return [=] {
        constexpr int kEdits = 200;
        const std::string robot = "robot id=r at=2,6\nlaser on=r fov=180 step=1 rate=10\n";
        World world(std::make_shared<const Scene>(bench::sceneOfText(
                        bench::officeText(columns, rows) + "cube id=c at=1,1 size=0.3\n" + robot)),
                    std::chrono::milliseconds(100));
        Simulation simulation(world, {}, {Clock::Kind::Step, 1}, std::nullopt);
        const WorldEditor editor(simulation, std::make_shared<testing::TextSource>());
        const std::clock_t begin = std::clock();
        for (int i = 0; i < kEdits; ++i) {
            const std::string at = i % 2 == 0 ? "c.at=1,1.2" : "c.at=1,1";
            editor.edit({parseEdit(Edit::Kind::Set, at)}).carryOut();
            world.step();
        }
        return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    };
}

Day editLoop() {
    return {"200 edits among 1 840 rooms", "in 30 rooms", 80, edits(46, 40), edits(6, 5), {}};
}

/// A week of four people in a flat of twenty sensors, with a record of every reading, beside ten
/// seconds.
Day weekAtHome(const std::string& folder) {
    constexpr double kSeconds = 10;
    constexpr std::ptrdiff_t kLabels = 100;
    const std::string home = testing::sourcePath("share/examples/home/");
    const std::string record = folder + "/week";
    const auto verify = [record] {
        const std::string labels = readAll(record + "/activities.csv");
        mustBe(std::count(labels.begin(), labels.end(), '\n') > kLabels,
               "the record lacks activities");
    };
    return {"a week of 4 people, 20 sensors",
            "10 seconds",
            1,
            command({"simrun", home + "flat.env", home + "flat.3dm", "-q", "-j", "1", "--script",
                     home + "week.txt", "--clock", "fast", "--dt", "1", "--until", "168h",
                     "--record", record}),
            [] { return kSeconds; },
            verify};
}

std::vector<Day> allDays(const std::string& folder) {
    return {
        camerasInBuilding(folder),
        manyCamerasInBuilding(folder),
        editLoop(),
        sweepOfRooms(folder),
        arrangedRooms(folder),
        movedLaser(folder),
        changedRoom(folder),
        millionPoses(folder),
        recordedRun(folder, 1, 3600, 1.5),
        recordedRun(folder, 100, 60, 1.5),
        recordedRun(folder, 1000, 10, 1.5),
        weekAtHome(folder),
    };
}

void measure(benchmark::State& state, const Day& day) {
    double work = HUGE_VAL, equal = HUGE_VAL;
    for (auto _ : state) {
        work = std::min(work, day.work());
        equal = std::min(equal, day.equal());
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
                      std::to_string(kRounds) + "\n" +
                      bench::headOf({{"day", -36},
                                     {"equivalent", -28},
                                     {"work", 8},
                                     {"equal", 8},
                                     {"ratio", 8},
                                     {"goal", 8}})}});
    benchmark::RunSpecifiedBenchmarks(&table);
    return 0;
}
