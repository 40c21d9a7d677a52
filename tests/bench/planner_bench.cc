// SPDX-License-Identifier: GPL-3.0-or-later
// The waits of a planner: searches of cameras, suggestions, views and reports of an office and a
// house of three storeys, as processes. Each row is set against the first in the same run, so that
// runs on different machines compare.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "base/file.h"
#include "bench_scenes.h"
#include "bench_table.h"
#include "support/test_paths.h"
#include "tool_run.h"

namespace {

using namespace ispace;

constexpr int kRuns = 3;

struct Case {
    std::string name, command;
};

/// Returns the text of a storey of 52 m2 with three rooms.
std::string storeyText(const std::string& door) {
    return "#env 1\nfence id=shell path=0,0;8.6,0;8.6,6.1;0,6.1 closed=yes height=2.6\n"
           "wall id=p1 from=0,3.6 to=5.2,3.6 height=2.6\n"
           "wall id=p2 from=5.2,3.6 to=5.2,6.1 height=2.6\n"
           "wall id=p3 from=3,0 to=3,3.6 height=2.6\n"
           "door id=" +
           door +
           " wall=shell at=6.5,0 size=1 height=2.1\n"
           "door id=inner wall=p1 at=4,3.6 size=0.9 height=2.1 open=yes\n"
           "door id=side wall=p3 at=3,1.5 size=0.8 height=2.1\n"
           "window id=w1 wall=shell at=8.6,3 size=1.6 height=1.3\n"
           "inside at=4,1\ninside at=1,1\ninside at=1,5\n";
}

void writeHouse(const std::string& folder) {
    for (const char* const storey : {"ground", "upper", "attic"})
        writeAll(folder + '/' + storey + ".env", storeyText(std::string(storey) + "_door"));
    writeAll(folder + "/house.env",
             "#env 1\nstorey id=ground file=ground.env height=2.9\n"
             "storey id=upper file=upper.env z=2.9 height=2.9\n"
             "storey id=attic file=attic.env z=5.8 height=2.8\n"
             "stairs id=s1 storeys=ground,upper at=8,2 heading=90 size=1,3.6\n"
             "stairs id=s2 storeys=upper,attic at=6.6,2 heading=90 size=1,3.6\n");
}

/// Runs a line of the shell in the folder; a requirement that is not met is no failure.
bench::Spent runIn(const std::string& folder, const std::string& command) {
    const std::string line = "cd '" + folder + "' && PATH=" ISPACE_TOOLS ":$PATH && { " + command +
                             "; s=$?; test $s = 0 || test $s = 3; } 2>/dev/null";
    return bench::runTool({"/bin/sh", "-c", line}, "/dev/null");
}

void measure(benchmark::State& state, const Case& test, const std::string& folder, double& unit) {
    bench::Spent least;
    for (auto _ : state) {
        const bench::Spent spent = runIn(folder, test.command);
        least.keepQuicker(spent);
        state.SetIterationTime(spent.wall);
    }
    if (unit == 0) unit = least.processor;
    state.SetLabel(bench::leftCell(test.name, 44) + bench::cell(least.wall, 2, 8) +
                   bench::cell(least.processor, 2, 11) + bench::cell(least.processor / unit, 2, 8));
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const bench::Folder scratch;
    writeHouse(scratch.name);
    writeAll(scratch.name + "/office.env",
             readAll(testing::sourcePath("share/scenes/open-office.env")));
    static_cast<void>(runIn(scratch.name, "envc -q house.env -o house.glb"));
    const std::vector<Case> cases = {
        {"arrange: 6 cameras, sites 1 m apart",
         "arrange -q office.env --sensor dome-2.8-1080p:6 --candidates 1,1,8 -o domes.3dm"},
        {"arrange: 4 cameras in a house, identify",
         "arrange -q house.glb --sensor dome-2.8-4k:4 --density identify -o h.3dm"},
        {"arrange: zones at doors, --target 100%",
         "arrange -q ground.env --sensor dome-2.8-1080p:4 --zone 'door:*,1.5' --target 100% "
         "-o z.3dm"},
        {"arrange --curve: 12 lasers",
         "arrange -q office.env --sensor urg-04lx:12 --curve c.csv -o c.3dm"},
        {"coverage --suggest: 6 cameras", "coverage -q office.env domes.3dm --suggest"},
        {"coverage --suggest --privacy",
         "coverage -q office.env domes.3dm --privacy meeting,recognise --suggest"},
        {"coverage --report: 6 cameras", "coverage -q office.env domes.3dm --report r.html"},
        {"scan --view orbit", "scan -q house.glb --view orbit -o v.png"},
        {"scan --view orbit --samples 1", "scan -q house.glb --view orbit --samples 1 -o v.png"}};
    double unit = 0;
    for (const Case& test : cases)
        benchmark::RegisterBenchmark(
            ("planner/" + test.name).c_str(),
            [&](benchmark::State& state) { measure(state, test, scratch.name, unit); })
            ->Iterations(kRuns)
            ->UseManualTime();
    bench::TableReporter table(
        {{"planner",
          "Waits of a planner, the quickest of " + std::to_string(kRuns) +
              "; seconds, and processor time over that of the first row\n" +
              bench::headOf({{"command", -44}, {"wall", 8}, {"processor", 11}, {"ratio", 8}})}});
    benchmark::RunSpecifiedBenchmarks(&table);
    return 0;
}
