// SPDX-License-Identifier: GPL-3.0-or-later
// Time to start the tools: to report their version, and to do the work of a small room, as
// processes on one core, beside an empty one; and the saving of one process over many.
#include <sched.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "base/file.h"
#include "bench_table.h"
#include "tool_run.h"

namespace {

using namespace ispace;

constexpr int kRuns = 200;
constexpr int kRooms = 1000;

struct Case {
    std::string name;
    std::vector<std::string> words;
};

std::string tool(const std::string& name) { return ISPACE_TOOLS "/" + name; }

/// This process, and those it starts, keep to one core.
void pin() {
    cpu_set_t cores;
    if (sched_getaffinity(0, sizeof cores, &cores) != 0) return;
    int last = CPU_SETSIZE - 1;
    while (last > 0 && !CPU_ISSET(static_cast<std::size_t>(last), &cores)) --last;
    CPU_ZERO(&cores);
    CPU_SET(static_cast<std::size_t>(last), &cores);
    static_cast<void>(sched_setaffinity(0, sizeof cores, &cores));
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void measureStart(benchmark::State& state, const Case& test) {
    std::vector<double> wall, processor, nothing;
    for (auto _ : state) {
        nothing.push_back(bench::runTool({"/bin/true"}, "/dev/null").wall);
        const bench::Spent spent = bench::runTool(test.words, "/dev/null");
        wall.push_back(spent.wall);
        processor.push_back(spent.processor);
        state.SetIterationTime(spent.wall);
    }
    state.SetLabel(bench::leftCell(test.name, 36) + bench::cell(1e3 * median(wall), 2, 8) +
                   bench::cell(1e3 * median(processor), 2, 11) +
                   bench::cell(1e3 * median(nothing), 2, 11));
}

/// So many rooms by one process, and by one each, milliseconds a room.
void measureBatch(benchmark::State& state, const std::vector<std::string>& operands,
                  const std::string& list) {
    bench::Spent one, many;
    for (auto _ : state) {
        one = bench::runTool({tool("coverage"), "--batch", list}, "/dev/null");
        many = {0, 0, 0};
        for (int i = 0; i < kRooms; ++i) {
            std::vector<std::string> words = {tool("coverage"), "--json"};
            words.insert(words.end(), operands.begin(), operands.end());
            const bench::Spent spent = bench::runTool(words, "/dev/null");
            many.wall += spent.wall;
            many.processor += spent.processor;
        }
        state.SetIterationTime(one.wall);
    }
    const double each = 1e3 / kRooms;
    state.SetLabel(bench::leftCell(std::to_string(kRooms) + " rooms", 36) +
                   bench::cell(each * one.wall, 2, 8) + bench::cell(each * many.wall, 2, 11) +
                   bench::cell(many.wall / one.wall, 2, 11));
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    pin();
    const bench::Folder scratch;
    const std::string room = scratch.name + "/room.env", layout = scratch.name + "/layout.3dm",
                      list = scratch.name + "/list", product = scratch.name + "/product";
    writeAll(room, "#env 1\nfence path=-2,-2;2,-2;2,2;-2,2 closed=yes\n");
    writeAll(layout, "#3dm 1\nlaser id=l at=0,0 range=10 fov=180 step=1\n");
    std::string lines;
    for (int i = 0; i < kRooms; ++i) lines.append(room).append(1, ' ').append(layout) += '\n';
    writeAll(list, lines);

    std::vector<Case> cases;
    for (const char* name : {"envc", "arrange", "scan", "coverage", "simrun", "golden-diff"})
        cases.push_back({std::string(name) + " --version", {tool(name), "--version"}});
    cases.push_back({"envc room.env -o room.glb", {tool("envc"), room, "-o", product + ".glb"}});
    cases.push_back({"scan room.env layout.3dm", {tool("scan"), room, layout}});
    cases.push_back({"coverage room.env layout.3dm", {tool("coverage"), room, layout}});
    cases.push_back(
        {"coverage -o map.png", {tool("coverage"), room, layout, "-o", product + ".png"}});
    cases.push_back(
        {"arrange room.env --sensor laser", {tool("arrange"), "-q", room, "--sensor", "laser"}});
    cases.push_back({"simrun --clock fast --until 0",
                     {tool("simrun"), room, layout, "--clock", "fast", "--until", "0"}});
    for (const Case& test : cases)
        benchmark::RegisterBenchmark(
            ("start/" + test.name).c_str(),
            [&test](benchmark::State& state) { measureStart(state, test); })
            ->Iterations(kRuns)
            ->UseManualTime();
    benchmark::RegisterBenchmark("batch/rooms",
                                 [&](benchmark::State& state) {
                                     measureBatch(state, {room, layout}, list);
                                 })
        ->Iterations(1)
        ->UseManualTime();
    bench::TableReporter table(
        {{"start",
          "Starts on one core, medians of " + std::to_string(kRuns) + "; milliseconds\n" +
              bench::headOf({{"command", -36}, {"wall", 8}, {"processor", 11}, {"/bin/true", 11}})},
         {"batch",
          "Small rooms by coverage; milliseconds a room\n" +
              bench::headOf({{"rooms", -36}, {"--batch", 8}, {"processes", 11}, {"ratio", 11}})}});
    benchmark::RunSpecifiedBenchmarks(&table);
    return 0;
}
