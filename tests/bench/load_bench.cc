// SPDX-License-Identifier: GPL-3.0-or-later
// Time that a tool waits for a compiled environment until it can cast rays, beside the unavoidable:
// a plain read of the file and Embree's build of the same triangles, and beside the records as
// text.
#include <benchmark/benchmark.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>

#include "base/file.h"
#include "base/number.h"
#include "bench_scenes.h"
#include "embree_raw.h"
#include "io/glb/glb_read.h"
#include "io/importers.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "trace/ray_world.h"

namespace {

using namespace ispace;

struct Compiled {
    std::string name;
    std::string file, text;
};

Document reading(const std::string& file) {
    return readDocument(file, ImportOptions(), sceneSchemas());
}

RayWorld worldOf(const Environment& environment, bool level) {
    return level ? RayWorld::ofSlice(environment.slice(kScanHeight))
                 : RayWorld::ofEnvironment(environment);
}

/// The work of tools before their first ray: a level one, or one of any direction.
void load(const std::string& file, bool level) {
    const Scene scene = makeScene(reading(file), nullptr, DeviceCatalogue());
    const RayWorld world = worldOf(scene.environment, level);
    benchmark::DoNotOptimize(&world);
}

void unavoidable(const std::string& file, const bench::RawTriangles& triangles) {
    const std::string bytes = readAll(file);
    benchmark::DoNotOptimize(bytes.data());
    triangles.build();
}

Compiled compile(const std::string& name, const std::string& folder, const Document& document) {
    Compiled compiled{name, folder + '/' + name + ".glb", folder + '/' + name + ".env"};
    const Scene scene = makeScene(document, nullptr, DeviceCatalogue());
    writeAll(compiled.file, writeGlb(scene, document));
    writeAll(compiled.text, writeRecordText(document));
    // The loaded room equals the compiled one.
    const Scene again = makeScene(reading(compiled.file), nullptr, DeviceCatalogue());
    if (again.ids == scene.ids && again.digest() == scene.digest() &&
        again.environment.indoor().area() == scene.environment.indoor().area())
        return compiled;
    std::fprintf(stderr, "load: %s is not what was compiled\n", name.c_str());
    std::exit(1);
}

/// Reads a line of the kernel about this process, in MB; returns 0 without it.
double statusOf(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(name + ':')) return std::stod(line.substr(name.size() + 1)) / 1024;
    return 0;
}

/// How much more memory the process takes while this runs, at most, than before.
double megabytesOf(const std::function<void()>& run) {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << '5';  // the peak counts from here on
    const double before = statusOf("VmRSS");
    run();
    return statusOf("VmHWM") - before;
}

double secondsOf(const std::function<void()>& run) {
    const auto start = std::chrono::steady_clock::now();
    run();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Both in turn, so that whatever else the machine does meets both; the ratio is that of the
/// quickest of each.
void loadBeside(benchmark::State& state, const Compiled& compiled, bool level) {
    state.counters["MB"] = megabytesOf([&] { load(compiled.file, level); });
    const Scene scene = makeScene(reading(compiled.file), nullptr, DeviceCatalogue());
    const bench::RawTriangles triangles =
        level ? bench::RawTriangles(scene.environment.slice(kScanHeight))
              : bench::RawTriangles(scene.environment);
    double quickest = std::numeric_limits<double>::infinity(), beside = quickest, text = quickest;
    // Text names files of meshes, and others read those.
    const bool has_text = !compiled.name.starts_with("mesh");
    for (auto _ : state) {
        beside = std::min(beside, secondsOf([&] { unavoidable(compiled.file, triangles); }));
        if (has_text) text = std::min(text, secondsOf([&] { load(compiled.text, level); }));
        const double seconds = secondsOf([&] { load(compiled.file, level); });
        quickest = std::min(quickest, seconds);
        state.SetIterationTime(seconds);
    }
    state.counters["triangles"] = static_cast<double>(triangles.size());
    state.counters["quickest_ms"] = 1000 * quickest;
    state.counters["beside_ms"] = 1000 * beside;
    const auto kilobytes = [](const std::string& file) {
        return static_cast<double>(std::filesystem::file_size(file)) / 1000;
    };
    state.counters["kB"] = kilobytes(compiled.file);
    std::string label = "ratio " + formatFixed(quickest / beside, 2);
    if (has_text) {
        state.counters["text_ms"] = 1000 * text;
        state.counters["text_kB"] = kilobytes(compiled.text);
        label += ", to text " + formatFixed(quickest / text, 2) + ", its size " +
                 formatFixed(kilobytes(compiled.file) / kilobytes(compiled.text), 1);
    }
    state.SetLabel(label);
}

std::vector<Compiled> scenes(const std::string& folder) {
    std::vector<Compiled> out;
    if (const std::string map = bench::willowMap(); !map.empty())
        out.push_back(compile("willow-full", folder, reading(map)));
    for (const std::size_t walls : {1000U, 10000U}) {
        const bench::Building plan = bench::building(walls);
        out.push_back(compile("walls-" + std::to_string(walls), folder,
                              readRecordText(plan.text, "plan", sceneSchemas())));
    }
    out.push_back(compile("furnished-480", folder,
                          readRecordText(bench::officeText(24, 20), "plan", sceneSchemas())));
    Document room =
        readRecordText("#env 1\nispace size=8,6\nmesh file=globe.stl\n", "room", sceneSchemas());
    room.records[1].setMesh(bench::bumpyGlobe(501, 1000));
    out.push_back(compile("mesh-1000000", folder, room));
    return out;
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    std::string folder = (std::filesystem::temp_directory_path() / "load-bench-XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) return 1;
    for (const Compiled& compiled : scenes(folder))
        for (const bool level : {true, false}) {
            // The cut of a mesh reads all of it, Embree's build of that takes little.
            if (level && compiled.name.starts_with("mesh")) continue;
            benchmark::RegisterBenchmark(
                ("load/" + compiled.name + (level ? "/level" : "/tilted")).c_str(),
                [compiled, level](benchmark::State& state) { loadBeside(state, compiled, level); })
                ->UseManualTime()
                ->Unit(benchmark::kMillisecond);
        }
    benchmark::RunSpecifiedBenchmarks();
    std::filesystem::remove_all(folder);
    return 0;
}
