// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of 640 x 480 as light makes them: the rays of the pixels' centres (labels and depths)
// beside Embree alone, and whole pictures with soft light.
#include <algorithm>
#include <memory>

#include "bench_scenes.h"
#include "bench_table.h"
#include "embree_raw.h"
#include "trace/render/render.h"

namespace {

using namespace ispace;

constexpr std::size_t kPictures = 4;
constexpr int kRounds = 6;

struct Case {
    std::string name;
    Scene scene;
    std::size_t triangles;
    std::vector<CameraView> views;
    bench::RawEmbree raw;
    RenderScene prepared;

    Case(std::string title, Scene loaded)
        : name(std::move(title)),
          scene(std::move(loaded)),
          triangles(bench::RawTriangles(scene.environment).size()),
          raw(bench::RawEmbree::ofEnvironment(scene.environment)),
          prepared(scene) {
        std::vector<Point3> origins;
        std::vector<RayGrid> grids;
        for (const Sensor& laser : bench::fans(scene, kPictures, false)) {
            views.emplace_back(Camera(), laser.pose);
            const EvenPixelRays lines = *views.back().evenPixelRays();
            origins.push_back(lines.origin);
            grids.push_back({lines.direction, lines.right, lines.down, views.back().columns(),
                             views.back().rows()});
        }
        raw.prepare(origins, grids, 1e6);
    }
    Case(const Case&) = delete;
    Case& operator=(const Case&) = delete;

    [[nodiscard]] Rendering measures(std::size_t i) const {
        RenderOptions options;
        options.colors = false;
        options.labels = options.depths = true;
        return render(prepared, views[i], options);
    }
};

void verify(const Case& test) {
    const std::vector<float> raw = test.raw.ranges();
    for (std::size_t i = 0; i < kPictures; ++i) {
        const std::vector<float> depths = test.measures(i).depths;
        bench::mustAgree(test.name, depths,
                         std::span(raw).subspan(i * depths.size(), depths.size()));
    }
}

void measure(benchmark::State& state, Case& test, int threads) {
    bench::Contest contest;
    const auto add = [&](auto way) {
        contest.add([threads, way] { bench::shareOut(threads, kPictures, way); });
    };
    const std::size_t each = test.raw.packetsPerSensor();
    add([&test, each](std::size_t i) { test.raw.trace(i * each, (i + 1) * each); });
    add([&test](std::size_t i) { benchmark::DoNotOptimize(test.measures(i)); });
    for (const int samples : {1, 4})
        add([&test, samples](std::size_t i) {
            RenderOptions options;
            options.samples = samples;
            benchmark::DoNotOptimize(render(test.prepared, test.views[i], options));
        });
    const bench::Others others;
    for (auto _ : state) {
        contest.round();
        state.SetIterationTime(contest.last(3));
    }
    const auto milliseconds = [&](std::size_t way) {
        return 1000 * contest.quickest(way) / static_cast<double>(kPictures);
    };
    const char* const names[] = {"embree", "primary", "samples1", "samples4"};
    for (std::size_t way = 0; way < 4; ++way) state.counters[names[way]] = milliseconds(way);
    state.counters["others"] = others.cores();
    std::string row =
        bench::leftCell(test.name, 12) + bench::cell(static_cast<double>(test.triangles), 0, 8) +
        bench::cell(threads, 0, 4) + bench::cell(milliseconds(0), 2, 8) +
        bench::cell(milliseconds(1), 2, 9) + bench::cell(milliseconds(0) / milliseconds(1), 2, 6);
    for (std::size_t way = 2; way < 4; ++way) row.append(bench::cell(milliseconds(way), 0, 9));
    state.SetLabel(row + bench::cell(others.cores(), 1, 8));
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    std::vector<std::unique_ptr<Case>> cases;
    cases.push_back(std::make_unique<Case>("walls-6", bench::sceneOfText(bench::building(6).text)));
    cases.push_back(
        std::make_unique<Case>("crowded", bench::loadScene(bench::sceneFile("crowded.env"))));
    cases.push_back(std::make_unique<Case>("office-100", bench::officeScene(10, 10)));
    for (const auto& test : cases)
        for (const int threads : {1, 2})
            benchmark::RegisterBenchmark(
                ("render/" + test->name + '/' + std::to_string(threads)).c_str(),
                [&test, threads](benchmark::State& state) {
                    if (threads == 1) test->raw.trace(0, kPictures * test->raw.packetsPerSensor());
                    if (threads == 1) verify(*test);
                    measure(state, *test, threads);
                })
                ->UseManualTime()
                ->Iterations(kRounds)
                ->Unit(benchmark::kMillisecond);
    std::string heading =
        "Pictures of 640 x 480: milliseconds each of Embree alone, of labels and depths with "
        "their\n"
        "share of Embree's rate, and of whole pictures with 1 and 4 samples a pixel\n" +
        bench::leftCell("scene", 12) + bench::cell("triang.", 8) + bench::cell("-j", 4) +
        bench::cell("Embree", 8) + bench::cell("primary", 9) + bench::cell("ratio", 6);
    for (const char* const way : {"1", "4"}) heading += bench::cell(way, 9);
    bench::TableReporter reporter({{"render", heading + bench::cell("others", 8)}});
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
}
