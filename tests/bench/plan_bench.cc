// SPDX-License-Identifier: GPL-3.0-or-later
// envc compiling a plan, from the bytes of its file to those of the model: buildings of 1 000, 10
// 000 and 100 000 walls, drawings of a million lines without and with doors, the map of Willow
// Garage, and a mesh of a million triangles.
#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "base/file.h"
#include "base/memory.h"
#include "base/number.h"
#include "bench_scenes.h"
#include "extensions/cad/cad.h"
#include "extensions/meshes/meshes.h"
#include "io/glb/glb_read.h"
#include "scene/placement_schemas.h"

namespace {

using namespace ispace;

struct Outcome {
    double indoor_area = 0;
    double seconds[3] = {};  // reading, the scene, the model
};

/// \param sink takes the bytes of the model
Outcome compile(const std::function<Document()>& read, const ByteSink& sink) {
    Outcome out;
    auto last = std::chrono::steady_clock::now();
    const auto lap = [&last] {
        const auto now = std::chrono::steady_clock::now();
        return std::chrono::duration<double>(now - std::exchange(last, now)).count();
    };
    const Document document = read();
    out.seconds[0] = lap();
    const Scene scene = makeScene(document, nullptr, DeviceCatalogue());
    out.seconds[1] = lap();
    writeGlb(scene, document, sink);
    out.seconds[2] = lap();
    out.indoor_area = scene.environment.indoor().area();
    return out;
}

void verify(const std::string& name, const std::function<Document()>& read, double area) {
    std::string glb;
    const Outcome out = compile(read, [&glb](std::string_view bytes) { glb += bytes; });
    const Document again = readGlb(glb, name, sceneSchemas());
    const double loaded = makeScene(again, nullptr, DeviceCatalogue()).environment.indoor().area();
    if (std::abs(out.indoor_area - area) <= 1e-6 * area && loaded == out.indoor_area) return;
    std::fprintf(stderr, "plan: %s encloses %g m2, loaded %g m2, wanted %g m2\n", name.c_str(),
                 out.indoor_area, loaded, area);
    std::exit(1);
}

/// \return seconds a run
double measure(benchmark::State& state, const std::function<Document()>& read) {
    double seconds[3] = {};
    for (auto _ : state) {
        const Outcome out =
            compile(read, [](std::string_view bytes) { benchmark::DoNotOptimize(bytes); });
        for (int i = 0; i < 3; ++i) seconds[i] += out.seconds[i];
    }
    const auto runs = static_cast<double>(state.iterations());
    state.counters["read_ms"] = 1000 * seconds[0] / runs;
    state.counters["scene_ms"] = 1000 * seconds[1] / runs;
    state.counters["model_ms"] = 1000 * seconds[2] / runs;
    return (seconds[0] + seconds[1] + seconds[2]) / runs;
}

/// Time by n log n of the number of walls, beside that of the smallest building.
void compileBuilding(benchmark::State& state, const bench::Building& plan) {
    static double smallest = 0;
    const auto walls = static_cast<double>(plan.walls);
    const double share =
        measure(
            state,
            [&] { return parseDocument(plan.text, "plan.env", ImportOptions(), sceneSchemas()); }) /
        (walls * std::log(walls));
    if (smallest == 0) smallest = share;
    state.SetLabel("grows as n log n x " + formatFixed(share / smallest, 2));
}

/// Binary STL: a header, the number of triangles, and for each its normal, corners and two bytes.
std::string stlOf(const TriangleMesh& mesh) {
    constexpr std::size_t kHeader = 80;
    std::string out(kHeader, ' ');
    const auto append = [&out](const auto& item) {
        out.append(reinterpret_cast<const char*>(&item), sizeof item);
    };
    append(static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& corners : mesh.triangles) {
        append(std::array<float, 3>{});
        for (const std::uint32_t corner : corners) append(mesh.vertices[corner]);
        append(std::uint16_t{0});
    }
    return out;
}

/// Compiles a document as envc does. CPU is the processor time of all threads.
void registerPlan(const std::string& name, const std::function<Document()>& read, double area) {
    benchmark::RegisterBenchmark(("plan/" + name).c_str(),
                                 [=](benchmark::State& state) {
                                     verify(name, read, area);
                                     measure(state, read);
                                 })
        ->MeasureProcessCPUTime()
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
}

void registerFile(const std::string& name, const std::string& file, double area) {
    registerPlan(
        name, [file] { return readDocument(file, ImportOptions(), sceneSchemas()); }, area);
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    keepFreedMemory();  // as envc does
    addImporters(cad::cadImporters());
    for (const std::size_t walls : {1000U, 10000U, 100000U}) {
        const bench::Building plan = bench::building(walls);
        const std::string name = "walls-" + std::to_string(walls);
        const auto read = [&plan] {
            return parseDocument(plan.text, "plan.env", ImportOptions(), sceneSchemas());
        };
        verify(name, read, plan.indoor_area);
        benchmark::RegisterBenchmark(
            ("plan/" + name).c_str(),
            [plan](benchmark::State& state) { compileBuilding(state, plan); })
            ->UseRealTime()
            ->Unit(benchmark::kMillisecond);
    }
    for (const bool doors : {false, true}) {
        const bench::Building plan = bench::drawnCubicles(1'000'000, doors);
        registerPlan(
            doors ? "lines-and-doors-1000000" : "lines-1000000",
            [text = plan.text] {
                return parseDocument(text, "plan.dxf", ImportOptions(), sceneSchemas());
            },
            plan.indoor_area);
    }
    if (const std::string map = bench::willowMap(); !map.empty()) {
        const Document plan = readDocument(map, ImportOptions(), sceneSchemas());
        registerFile("willow-full", map,
                     makeScene(plan, nullptr, DeviceCatalogue()).environment.indoor().area());
    }
    std::string folder = (std::filesystem::temp_directory_path() / "plan-bench-XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) return 1;
    meshes::addMeshes();
    writeAll(folder + "/globe.stl", stlOf(*bench::bumpyGlobe(501, 1000)));
    writeAll(folder + "/room.env", "#env 1\nispace size=8,6\nmesh file=globe.stl\n");
    registerFile("mesh-1000000", folder + "/room.env", 48);
    benchmark::RunSpecifiedBenchmarks();
    std::filesystem::remove_all(folder);
    return 0;
}
