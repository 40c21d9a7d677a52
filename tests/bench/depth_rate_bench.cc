// SPDX-License-Identifier: GPL-3.0-or-later
// Depth pictures of 640 x 480: Embree's coherent 16-wide call on tiles of 4 x 4, RayWorld::cast of
// the same rays, and the whole of a picture in memory, with and without the device's noise.
#include <algorithm>
#include <memory>

#include "bench_scenes.h"
#include "bench_table.h"
#include "embree_raw.h"
#include "sense/depth.h"

namespace {

using namespace ispace;

constexpr std::size_t kPictures = 16;
constexpr int kRounds = 12;

struct Case {
    std::string name;
    Scene scene;
    std::size_t triangles;
    Sensor ranger{"r1", bench::rangerOfModel("kinect-v1"), {}};
    std::vector<Pose3> poses;
    std::vector<RayGrid> grids;
    bench::RawEmbree raw;
    RayWorld world;
    MovingBodies nobody;

    Case(std::string title, Scene loaded)
        : name(std::move(title)),
          scene(std::move(loaded)),
          triangles(bench::RawTriangles(scene.environment).size()),
          raw(bench::RawEmbree::ofEnvironment(scene.environment)),
          world(RayWorld::ofEnvironment(scene.environment)) {
        std::vector<Point3> origins;
        for (const Sensor& laser : bench::fans(scene, kPictures, false)) {
            poses.push_back(laser.pose);
            origins.push_back(laser.pose.position);
            grids.push_back(gridAt(laser.pose));
        }
        raw.prepare(origins, grids, ranger.as<Ranger>().max_range);
    }
    Case(const Case&) = delete;
    Case& operator=(const Case&) = delete;

    /// The rays that castDepth casts.
    [[nodiscard]] RayGrid gridAt(const Pose3& pose) const {
        const Ranger& r = ranger.as<Ranger>();
        const Vec3 forward = pose.beam({}), left = pose.beam(Angle::degrees(90));
        const Vec3 up = cross(forward, left);
        const auto in_world = [&](Vec3 v) {
            return Vec3{v.x * forward.x + v.y * left.x + v.z * up.x,
                        v.x * forward.y + v.y * left.y + v.z * up.y,
                        v.x * forward.z + v.y * left.z + v.z * up.z};
        };
        return {.corner = in_world(r.ray(0, 0)),
                .right = in_world({0, -1 / r.fx(), 0}),
                .down = in_world({0, 0, -1 / r.fy()}),
                .columns = r.columns,
                .rows = r.rows};
    }
    void cast(std::size_t i, std::span<float> depths) const {
        world.cast(poses[i].position, grids[i], ranger.as<Ranger>().max_range, depths);
    }
    [[nodiscard]] DepthFrame picture(std::size_t i, const ReadingOptions& options) const {
        return castDepth(world, nobody, ranger, poses[i], static_cast<int>(i), options);
    }
};

void verify(const Case& test) {
    std::vector<float> depths(test.ranger.as<Ranger>().pixels());
    const auto least = static_cast<float>(test.ranger.as<Ranger>().min_range);
    const std::vector<float> raw = test.raw.ranges();
    for (std::size_t i = 0; i < test.poses.size(); ++i) {
        test.cast(i, depths);
        bench::mustAgree(test.name, depths,
                         std::span(raw).subspan(i * depths.size(), depths.size()));
        for (float& depth : depths)
            if (depth < least) depth = std::numeric_limits<float>::infinity();
        bench::mustAgree(test.name, test.picture(i, {}).depths, depths);
    }
}

void measure(benchmark::State& state, Case& test, int threads) {
    bench::Contest contest;
    const auto add = [&](auto way) {
        contest.add([&test, threads, way] { bench::shareOut(threads, test.poses.size(), way); });
    };
    std::vector<std::vector<float>> depths(kPictures,
                                           std::vector<float>(test.ranger.as<Ranger>().pixels()));
    const std::size_t each = test.raw.packetsPerSensor();
    add([&test, each](std::size_t i) { test.raw.trace(i * each, (i + 1) * each); });
    add([&test, &depths](std::size_t i) { test.cast(i, depths[i]); });
    add([&test](std::size_t i) { benchmark::DoNotOptimize(test.picture(i, {})); });
    add([&test](std::size_t i) { benchmark::DoNotOptimize(test.picture(i, {.noise_seed = 1})); });
    const bench::Others others;
    for (auto _ : state) {
        contest.round();
        state.SetIterationTime(contest.last(3));
    }
    const auto rate = [&](std::size_t way) {
        return static_cast<double>(kPictures) / contest.quickest(way);
    };
    const char* const names[] = {"embree", "cast", "picture", "noisy"};
    for (std::size_t way = 0; way < 4; ++way) state.counters[names[way]] = rate(way);
    std::string row = bench::leftCell(test.name, 12) +
                      bench::cell(static_cast<double>(test.triangles), 0, 8) +
                      bench::cell(threads, 0, 4);
    for (std::size_t way = 0; way < 4; ++way) {
        row.append(bench::cell(1000 / rate(way), 2, 8)).append(bench::cell(rate(way), 0, 6));
        if (way > 0) row.append(bench::cell(rate(way) / rate(0), 2, 6));
    }
    state.counters["others"] = others.cores();
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
    for (const auto& test : cases) {
        verify(*test);
        for (const int threads : {1, 2}) {
            benchmark::RegisterBenchmark(
                ("depth/" + test->name + '/' + std::to_string(threads)).c_str(),
                [&test, threads](benchmark::State& state) { measure(state, *test, threads); })
                ->UseManualTime()
                ->Iterations(kRounds)
                ->Unit(benchmark::kMillisecond);
        }
    }
    std::string heading =
        "Depth pictures of 640 x 480 (kinect-v1): milliseconds each, pictures a second, and that\n"
        "of Embree's own rate\n" +
        bench::leftCell("scene", 12) + bench::cell("triang.", 8) + bench::cell("-j", 4) +
        bench::cell("Embree", 8) + bench::cell("/s", 6);
    for (const char* const way : {"cast", "picture", "noisy"})
        heading += bench::cell(way, 8) + bench::cell("/s", 6) + bench::cell("ratio", 6);
    bench::TableReporter reporter({{"depth", heading + bench::cell("others", 8)}});
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
}
