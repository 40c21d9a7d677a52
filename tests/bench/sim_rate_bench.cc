// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated seconds in a second of wall time: robots that wander about an office floor as big as
// the map of Willow Garage, each with a laser of 181 beams and 8 m at 10 Hz, in steps of 5 ms; and
// people that walk about a hall. With one thread and two, and in seconds of processor time, which
// other work on the machine changes little.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <string_view>
#include <vector>

#include "base/number.h"
#include "bench_scenes.h"
#include "crowd.h"
#include "record/text.h"
#include "scene/placement_schemas.h"

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

/// Robots of this model, wandering by themselves or driven by their scans.
Scene withRobots(const Scene& plan, std::size_t count, bool by_scans) {
    Scene scene = plan;
    const DeviceCatalogue devices = bench::devices();
    RobotModel model = withParameters(RobotModel(), *devices.find("pioneer-2dx"));
    // Ten thousand Pioneers do not fit.
    if (count > 1000) model = withParameters(RobotModel(), *devices.find("turtlebot3-burger"));
    scene.robots = testing::crowd(scene.environment, model, count, count > 1000 ? 0.02 : 0.1, 1);
    if (scene.robots.size() != count) {
        std::fprintf(stderr, "sim_rate: room for %zu robots only\n", scene.robots.size());
        std::exit(1);
    }
    for (PlacedRobot& robot : scene.robots) robot.course.wander = !by_scans;
    Laser laser;
    laser.max_range = 8;
    testing::mountLasers(scene, laser);
    return scene;
}

/// A hall of 50 m x 50 m with wandering people, and lasers on its walls.
Scene hallOfPeople(std::size_t count) {
    std::string lines = "#3dm 1\n";
    for (const char* place : {"-24.9,0,0.15 heading=0", "24.9,0,0.15 heading=180",
                              "0,-24.9,0.15 heading=90", "0,24.9,0.15 heading=-90"})
        lines += "laser at=" + std::string(place) + " fov=180 step=0.5 range=30 rate=20\n";
    const Document room = readRecordText("#env 1\nispace size=50,50\n", "hall.env", sceneSchemas());
    const Document layout = readRecordText(lines, "hall.3dm", sceneSchemas());
    Scene scene = makeScene(room, &layout, bench::devices());
    testing::addPeople(scene, count, 0.1, 1);
    for (PlacedPerson& person : scene.people) person.course.wander = true;
    return scene;
}

/// Robots and people that wander about that hall; each robot has a spinning laser.
Scene spinningLasers(std::size_t count) {
    Scene scene = bench::sceneOfText("#env 1\nispace size=50,50\n");
    const DeviceCatalogue devices = bench::devices();
    const RobotModel model = withParameters(RobotModel(), *devices.find("pioneer-2dx"));
    scene.robots = testing::crowd(scene.environment, model, count, 0.1, 1);
    testing::addPeople(scene, count, 0.1, 1);
    for (PlacedRobot& robot : scene.robots) robot.course.wander = true;
    for (PlacedPerson& person : scene.people) person.course.wander = true;
    testing::mountLasers(scene, bench::laserOfModel("urg-04lx"));
    return scene;
}

/// The same, each scan at one moment.
Scene atOnce(Scene scene) {
    for (Sensor& sensor : scene.sensors) sensor.as<Laser>().spin = 0;
    return scene;
}

void simulateASecond(World& world, bool by_scans) {
    for (int i = 0; i < kStepsASecond; ++i) {
        if (by_scans) testing::wander(world);
        world.step();
    }
}

/// Robots that stand still or see no body would be fast.
void verify(const Scene& scene, const World& world) {
    double way = 0;
    std::size_t returns = 0;
    for (std::size_t i = 0; i < scene.robots.size(); ++i) {
        way += distance(world.status(i).pose.position, scene.robots[i].pose.position);
        for (const float range : world.reading(i).scan().ranges)
            if (range < 8) ++returns;
    }
    const auto count = static_cast<double>(scene.robots.size());
    const double speed = scene.robots.front().model.speed;
    if (way < 0.4 * speed * count || static_cast<double>(returns) < 30 * count) {
        std::fprintf(stderr, "sim_rate: %g m, %zu returns of %g robots\n", way, returns, count);
        std::exit(1);
    }
}

struct Case {
    const char* what;
    bool by_scans;
    int count, threads;
};

double processorSeconds() {
    return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

void run(benchmark::State& state, const Scene& scene, const Case& of) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(of.threads));
    World world(scene, kStep);
    for (int i = 0; i < 5; ++i) simulateASecond(world, of.by_scans);
    if (!scene.robots.empty()) verify(scene, world);
    const double before = processorSeconds();
    for (auto _ : state) simulateASecond(world, of.by_scans);
    const auto seconds = static_cast<double>(state.iterations());
    state.counters["sim_s_per_s"] = benchmark::Counter(seconds, benchmark::Counter::kIsRate);
    state.counters["cpu_s_per_sim_s"] = (processorSeconds() - before) / seconds;
}

/// Cost of beams that follow one another, in turn with scans of one moment.
void runSpinning(benchmark::State& state) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 1);
    const Scene spinning = spinningLasers(static_cast<std::size_t>(state.range(0)));
    const Scene still = atOnce(spinning);
    World spins(spinning, kStep), stands(still, kStep);
    for (World* world : {&spins, &stands}) simulateASecond(*world, false);
    double with_spin = 0, without = 0;
    const auto time = [](World& world) {
        const double before = processorSeconds();
        simulateASecond(world, false);
        return processorSeconds() - before;
    };
    for (auto _ : state) {
        with_spin += time(spins);
        without += time(stands);
    }
    const auto seconds = static_cast<double>(state.iterations());
    state.counters["cpu_s_per_sim_s"] = with_spin / seconds;
    state.counters["at_once"] = without / seconds;
    state.counters["ratio"] = with_spin / without;
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    std::string name;
    const Scene plan = floorPlan(name);
    std::vector<Case> cases;
    for (const int threads : {1, 2}) {
        for (const int count : {1, 10, 100, 1000}) cases.push_back({"scans", true, count, threads});
        for (const int count : {1, 10, 100, 1000, 10000})
            cases.push_back({"wander", false, count, threads});
        for (const int count : {100, 1000}) cases.push_back({"people", false, count, threads});
    }
    for (const Case& of : cases) {
        const bool people = std::string_view(of.what) == "people";
        const std::string title = "sim_rate/" + (people ? "hall" : name) + "/" + of.what + "/" +
                                  std::to_string(of.count) +
                                  "/threads:" + std::to_string(of.threads);
        benchmark::RegisterBenchmark(
            title.c_str(),
            [&plan, of, people](benchmark::State& state) {
                const auto count = static_cast<std::size_t>(of.count);
                run(state, people ? hallOfPeople(count) : withRobots(plan, count, of.by_scans), of);
            })
            ->UseRealTime()
            ->Unit(benchmark::kMillisecond);
    }
    benchmark::RegisterBenchmark("sim_rate/hall/spinning", runSpinning)
        ->Arg(100)
        ->Unit(benchmark::kMillisecond);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
