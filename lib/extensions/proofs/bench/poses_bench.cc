// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of coverage over all poses, by the program: the area that a layout sees, the bound, its
// gap, and the time. Plans are those in the folder plans of ISPACE_TEST_DATA. A layout above the
// bound is an error.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/number.h"
#include "bench_scenes.h"
#include "bench_table.h"
#include "geom/arrangement.h"
#include "scene/scene.h"
#include "tool_run.h"

namespace {

using namespace ispace;

struct PosesCase {
    std::string plan;  ///< empty: a hall of 12 m x 8 m
    int lasers = 1;
    int redundancy = 1;
    int seconds = 60;          ///< limit of time
    const char* gap = "0.5%";  ///< the default
};

/// Returns the number after `key=` in a layout's result; the program ends without it.
double resultOf(const std::string& layout, const std::string& key) {
    const std::size_t line = layout.find("\nresult ");
    const std::size_t at = line == std::string::npos ? line : layout.find(' ' + key + '=', line);
    if (at == std::string::npos) {
        std::fprintf(stderr, "poses_bench: no %s in the result\n", key.c_str());
        std::exit(1);
    }
    const std::size_t begin = at + key.size() + 2;
    return parseDouble(layout.substr(begin, layout.find_first_of("% \n", begin) - begin)).value();
}

/// Area of the indoor region, m2; the rooms have no bodies.
double floorOf(const std::string& room) {
    const Document document = bench::readRoom(room);
    const Scene scene = makeScene(document, nullptr, DeviceCatalogue());
    return totalArea(scene.environment.indoor().parts);
}

void measurePoses(benchmark::State& state, const std::string& room, const PosesCase& test) {
    const bench::Folder folder;
    const std::string output = folder.name + "/layout.3dm";
    std::vector<std::string> words = {std::string(ISPACE_TOOLS) + "/arrange",
                                      room,
                                      "--sensor",
                                      "laser,range=4,fov=240:" + std::to_string(test.lasers),
                                      "--proof",
                                      "poses",
                                      "--time-limit",
                                      std::to_string(test.seconds),
                                      "--gap",
                                      test.gap,
                                      "-q"};
    if (test.redundancy > 1)
        words.insert(words.end(), {"--redundancy", std::to_string(test.redundancy)});
    bench::Spent spent;
    for (auto _ : state) {
        spent = bench::runTool(words, output);
        state.SetIterationTime(spent.wall);
    }
    const std::string layout = readAll(output);
    const double value = resultOf(layout, "value"), bound = resultOf(layout, "bound");
    if (value > bound * (1 + 1e-9)) std::exit(1);
    const double percent = floorOf(room) / 100;
    state.SetLabel(bench::leftCell(test.plan.empty() ? "hall" : test.plan, 18) +
                   bench::cell(test.lasers, 0, 7) + bench::cell(test.redundancy, 0, 7) +
                   bench::cell(value * percent, 2, 10) + bench::cell(bound * percent, 2, 10) +
                   bench::cell(100 * (1 - value / bound), 2, 8) + bench::cell(spent.wall, 1, 9) +
                   bench::cell(spent.processor, 1, 9));
}

std::vector<PosesCase> cases() {
    std::vector<PosesCase> all = {{"", 4, 3, 20}, {"", 4, 2, 20}, {"", 3, 2, 20}};
    for (const char* plan : {"", "he_0a1b29db_raw", "syn_10", "syn_15"})
        for (int lasers = 3; lasers > 0; --lasers) {
            all.push_back({plan, lasers});
            // The bound stays near the whole floor: a limit of time would measure the machine.
            if (lasers != 3 || *plan != '\0') continue;
            all.back() = {plan, lasers, 1, 600, "2%"};
            all.push_back({plan, lasers, 1, 600, "1%"});
        }
    return all;
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const char* data = std::getenv("ISPACE_TEST_DATA");
    if (data == nullptr) std::fprintf(stderr, "poses_bench: ISPACE_TEST_DATA is not set\n");
    const bench::Folder folder;
    const std::string hall = folder.name + "/hall.env";
    writeAll(hall, "#env 1\nispace size=12,8\n");
    for (const PosesCase& test : cases()) {
        if (!test.plan.empty() && data == nullptr) continue;
        const std::string room =
            test.plan.empty() ? hall : std::string(data) + "/plans/" + test.plan + ".json";
        const std::string name = "poses/" + (test.plan.empty() ? "hall" : test.plan) + '/' +
                                 std::to_string(test.lasers) + '/' +
                                 std::to_string(test.redundancy) + '/' + test.gap;
        benchmark::RegisterBenchmark(
            name.c_str(),
            [room, test](benchmark::State& state) { measurePoses(state, room, test); })
            ->UseManualTime()
            ->Iterations(1)
            ->Unit(benchmark::kSecond);
    }
    bench::TableReporter reporter(
        {{"poses",
          "Lasers of 4 m and 240 degrees over all poses: area that a layout sees, and "
          "bound, m2; gap, %; seconds, and those of processors\n" +
              bench::leftCell("plan", 18) + bench::cell("lasers", 7) + bench::cell("times", 7) +
              bench::cell("sees", 10) + bench::cell("bound", 10) + bench::cell("gap", 8) +
              bench::cell("seconds", 9) + bench::cell("proc.", 9)}});
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
}
