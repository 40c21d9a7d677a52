// SPDX-License-Identifier: GPL-3.0-or-later
// The coverage tool as a process, on compiled rooms of three sizes with few sensors and many, and
// the share of its measurement; and with very many, by the number of edges between their regions.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/file.h"
#include "base/number.h"
#include "bench_scenes.h"
#include "bench_table.h"
#include "coverage/visible_area.h"
#include "geom/overlay/overlay.h"
#include "io/glb/glb_read.h"
#include "record/text.h"
#include "report/map/map.h"
#include "scene/placement_schemas.h"
#include "tool_run.h"

namespace {

using namespace ispace;

constexpr int kRounds = 5;
const char* const kModel = "urg-04lx";

/// A room with sensors in its free floor, in memory and on disk.
struct Case {
    std::string name, room_file, layout_file;
    Scene scene;
    std::size_t lines = 0;
};

std::string layoutText(const std::vector<Sensor>& places) {
    std::string text = "#3dm 1\n";
    for (const Sensor& place : places) {
        text += "laser model=" + std::string(kModel);
        text += " at=" + formatDouble(place.pose.position.x) + ',';
        text += formatDouble(place.pose.position.y);
        text += " heading=" + formatDouble(place.pose.heading.degrees()) + '\n';
    }
    return text;
}

Case makeCase(int columns, int rows, std::size_t sensors, const std::string& folder) {
    const Document room =
        readRecordText(bench::officeText(columns, rows), "office.env", sceneSchemas());
    const Scene empty = makeScene(room, nullptr, bench::devices());
    const std::string text = layoutText(bench::fans(empty, sensors, true));
    const Document layout = readRecordText(text, "layout.3dm", sceneSchemas());
    Case test{std::to_string(columns * rows) + " rooms, " + std::to_string(sensors) + " sensors",
              folder + "/room" + std::to_string(columns * rows) + ".glb",
              folder + "/layout" + std::to_string(columns * rows) + "-" + std::to_string(sensors),
              makeScene(room, &layout, bench::devices())};
    test.lines = bench::linesOf(empty);
    writeAll(test.room_file, writeGlb(empty, room));
    writeAll(test.layout_file, text);
    return test;
}

/// Cells and closed forms agree within the length of all boundaries times the size of a cell.
void verify(const Case& test) {
    RayScenes worlds(test.scene.environment);
    const Coverage coverage = measureCoverage(test.scene, worlds, {.cells = CellCount{1000, 1000}});
    double boundary = 0;
    for (const SensorView& view : coverage.sensors) boundary += perimeter(*view.region);
    const Grid& grid = coverage.target.grid;
    const double cell = std::hypot(grid.limits.width(), grid.limits.depth()) / 1000;
    const Metric& area = coverage.report.total_effective_area;
    if (area.grid && area.exact && std::abs(*area.grid - *area.exact) <= boundary * cell) return;
    std::fprintf(stderr, "%s: cells and closed forms differ\n", test.name.c_str());
    std::exit(1);
}

std::vector<std::string> words(const Case& test, const std::vector<std::string>& more) {
    std::vector<std::string> words = {ISPACE_COVERAGE_TOOL, "-q", test.room_file, test.layout_file,
                                      "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

void measure(benchmark::State& state, const Case& test, const std::string& folder) {
    bench::Spent one, two, drawn, fine;
    bench::Contest contest;  // of the measurement within the program, on one thread
    const auto inside = [&test](const CoverageOptions& options) {
        bench::shareOut(1, 1, [&](std::size_t) {
            RayScenes worlds(test.scene.environment);
            benchmark::DoNotOptimize(measureCoverage(test.scene, worlds, options));
        });
    };
    contest.add([&] { inside({.cells = CellCount(), .exact = false}); });
    contest.add([&] { inside({.cells = CellCount()}); });
    for (auto _ : state) {
        one.keepQuicker(bench::runTool(words(test, {"-j", "1", "--grid", "100"}), "/dev/null"));
        two.keepQuicker(bench::runTool(words(test, {"-j", "2", "--grid", "100"}), "/dev/null"));
        drawn.keepQuicker(bench::runTool(
            words(test, {"-j", "1", "--grid", "100", "-o", folder + "/map.png"}), "/dev/null"));
        fine.keepQuicker(bench::runTool(words(test, {"-j", "1", "--grid", "1000"}), "/dev/null"));
        contest.round();
        state.SetIterationTime(one.wall);
    }
    state.SetLabel(bench::leftCell(test.name, 24) +
                   bench::cell(static_cast<double>(test.lines), 0, 8) +
                   bench::cell(1e3 * contest.quickest(0), 1, 8) +
                   bench::cell(1e3 * contest.quickest(1), 1, 8) +
                   bench::cell(1e3 * one.wall, 0, 8) + bench::cell(1e3 * one.processor, 0, 8) +
                   bench::cell(1e3 * two.wall, 0, 8) + bench::cell(1e3 * two.processor, 0, 8) +
                   bench::cell(1e3 * fine.wall, 0, 8) + bench::cell(1e3 * drawn.wall, 0, 8));
}

/// Edges between the faces into which the views of all sensors part the floor.
std::size_t edgesOf(const Case& test) {
    const VisibleArea sight(test.scene.environment, 0);
    std::vector<Layer> layers;
    for (const Sensor& sensor : test.scene.sensors)
        layers.push_back({.curves = *sight.regionOf(sensor),
                          .number = static_cast<std::int64_t>(layers.size()) + 1});
    std::size_t sides = 0;
    forEachArea(layers, [&sides](const LayerLabel&, double) { ++sides; });
    return sides / 2;
}

void measureMany(benchmark::State& state, const Case& test) {
    const double edges = static_cast<double>(edgesOf(test)) / 1e6;
    bench::Spent one, two;
    for (auto _ : state) {
        one.keepQuicker(bench::runTool(words(test, {"-j", "1", "--grid", "100"}), "/dev/null"));
        two.keepQuicker(bench::runTool(words(test, {"-j", "2", "--grid", "100"}), "/dev/null"));
        state.SetIterationTime(one.wall);
    }
    state.SetLabel(bench::leftCell(test.name, 24) + bench::cell(edges, 2, 8) +
                   bench::cell(one.processor, 2, 9) + bench::cell(one.processor / edges, 2, 9) +
                   bench::cell(one.wall, 2, 8) + bench::cell(two.wall, 2, 8) +
                   bench::cell(one.memory, 0, 8));
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const bench::Folder scratch;
    const std::string& folder = scratch.name;
    std::vector<Case> cases;
    for (const std::size_t sensors : {std::size_t{3}, std::size_t{100}})
        for (const auto& [columns, rows] : {std::pair{1, 1}, {4, 3}, {8, 6}, {46, 40}})
            cases.push_back(makeCase(columns, rows, sensors, folder));
    for (const Case& test : cases) {
        if (test.lines < 10'000) verify(test);
        benchmark::RegisterBenchmark(
            ("coverage/" + test.name).c_str(),
            [&test, &folder](benchmark::State& state) { measure(state, test, folder); })
            ->Iterations(kRounds)
            ->UseManualTime();
    }
    std::vector<Case> crowded;
    for (const std::size_t sensors : {std::size_t{1000}, std::size_t{3000}, std::size_t{10000}})
        crowded.push_back(makeCase(8, 6, sensors, folder));
    for (const Case& test : crowded)
        benchmark::RegisterBenchmark(("crowded/" + test.name).c_str(),
                                     [&test](benchmark::State& state) { measureMany(state, test); })
            ->Iterations(1)
            ->UseManualTime();
    bench::TableReporter table(
        {{"crowded",
          "Whole runs with very many sensors, without a map: edges between what they see "
          "(millions),\n"
          "processor seconds with -j 1, those of a million edges, seconds of wall time with -j 1\n"
          "and 2, and megabytes\n" +
              bench::headOf({{"crowded", -24},
                             {"edges", 8},
                             {"cpu", 9},
                             {"an edge", 9},
                             {"-j 1", 8},
                             {"-j 2", 8},
                             {"MB", 8}})},
         {"coverage", "Whole runs of coverage on 100 x 100 cells, " + std::string(kModel) +
                          "; milliseconds\n" +
                          bench::headOf({{"coverage", -24},
                                         {"lines", 8},
                                         {"cells", 8},
                                         {"+ exact", 8},
                                         {"-j 1", 8},
                                         {"cpu", 8},
                                         {"-j 2", 8},
                                         {"cpu", 8},
                                         {"1000^2", 8},
                                         {"map", 8}})}});
    benchmark::RunSpecifiedBenchmarks(&table);
    return 0;
}
