// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated seconds in a second of wall time: robots that wander about an office floor as big as
// the map of Willow Garage, each with a laser of 181 beams and 8 m at 10 Hz, in steps of 5 ms.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "base/number.h"
#include "bench_scenes.h"
#include "crowd.h"

namespace {

using namespace ispace;

constexpr SimTime kStep = std::chrono::milliseconds(5);
constexpr int kStepsASecond = 200;

/// The map robots made of that floor if it is at hand, else rooms of like number and size.
Scene floorPlan(std::string& name) {
    if (const std::string map = bench::willowMap(); !map.empty()) {
        name = "willow-full";
        return bench::loadScene(map);
    }
    name = "office";
    return bench::officeScene(12, 10);
}

Scene withRobots(const Scene& plan, std::size_t count) {
    Scene scene = plan;
    const DeviceCatalogue devices = bench::devices();
    const RobotModel model = withParameters(RobotModel(), *devices.find("pioneer-2dx"));
    scene.robots = testing::crowd(scene.environment, model, count, 0.1, 1);
    if (scene.robots.size() != count) {
        std::fprintf(stderr, "sim_rate: room for %zu robots only\n", scene.robots.size());
        std::exit(1);
    }
    Laser laser;
    laser.max_range = 8;
    testing::mountLasers(scene, laser);
    return scene;
}

void simulateASecond(World& world) {
    for (int i = 0; i < kStepsASecond; ++i) {
        testing::wander(world);
        world.step();
    }
}

/// Robots that stand still or that see nothing would be fast.
void verify(const Scene& scene, const World& world) {
    double way = 0;
    std::size_t returns = 0;
    for (std::size_t i = 0; i < scene.robots.size(); ++i) {
        way += distance(world.status(i).pose.position, scene.robots[i].pose.position);
        for (const float range : world.reading(i).scan().ranges)
            if (range < 8) ++returns;
    }
    const auto count = static_cast<double>(scene.robots.size());
    if (way < 0.2 * count || static_cast<double>(returns) < 30 * count) {
        std::fprintf(stderr, "sim_rate: %g m, %zu returns of %g robots\n", way, returns, count);
        std::exit(1);
    }
}

void simulate(benchmark::State& state, const Scene& plan, const char* stage) {
    const Scene scene = withRobots(plan, static_cast<std::size_t>(state.range(0)));
    World world(scene, kStep);
    for (int i = 0; i < 5; ++i) simulateASecond(world);
    verify(scene, world);
    for (auto _ : state) simulateASecond(world);
    state.counters["sim_s_per_s"] =
        benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
    state.SetLabel(std::string("Stage 4.3: ") + stage);
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    std::string name;
    const Scene plan = floorPlan(name);
    for (const auto& [count, stage] :
         {std::pair(1, "930"), {10, "153"}, {100, "7"}, {1000, "0.26 to 0.5"}})
        benchmark::RegisterBenchmark(
            ("sim_rate/" + name + "/robots").c_str(),
            [&plan, stage = stage](benchmark::State& state) { simulate(state, plan, stage); })
            ->Arg(count)
            ->UseRealTime()
            ->Unit(benchmark::kMillisecond);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
