// SPDX-License-Identifier: GPL-3.0-or-later
// Worlds for learning: steps of an environment in a second of wall time and of processor time, with
// 181 beams, walls and collisions; by number of worlds, people, walls and beams, beside the ray
// kernel alone, and beside a client that steps one world over TCP.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench_scenes.h"
#include "client/test_server.h"
#include "extensions/learning/learning_batch.h"
#include "extensions/learning/vector_segment.h"
#include "ispace_client.h"
#include "record/text.h"
#include "scene/placement_schemas.h"

namespace {

using namespace ispace;

double processorSeconds() {
    return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

struct Case {
    std::string room;
    int worlds = 1024, people = 0, beams = 181, threads = 2;
};

/// A floor of offices, that map of a real one, or an empty hall.
const Scene& roomOf(const std::string& name) {
    static std::map<std::string, Scene> known;
    const auto found = known.find(name);
    if (found != known.end()) return found->second;
    Scene scene = name == "willow-full" ? bench::loadScene(bench::willowMap())
                  : name == "hall"      ? bench::sceneOfText("#env 1\nispace size=20,20\n")
                  : name == "offices-6" ? bench::officeScene(3, 2)
                                        : bench::officeScene(12, 10);
    return known.emplace(name, std::move(scene)).first->second;
}

/// The default robot, with another number of beams over the same half turn.
Scene withBeams(const Scene& scene, const learning::LearningTask& task, int beams) {
    Scene made = learning::learningScene(scene, task);
    for (Sensor& sensor : made.sensors)
        if (Laser* const laser = std::get_if<Laser>(&sensor.model)) {
            laser->beams = beams;
            laser->step = Angle::degrees(180.0 / (beams - 1));
        }
    return made;
}

/// Speeds and turns as of a learner at its beginning.
void drawActions(const learning::BatchArrays& arrays, std::size_t rows,
                 learning::EpisodeRandom& random) {
    for (std::size_t row = 0; row < rows; ++row) {
        arrays.actions[2 * row] = static_cast<float>(random.unit());
        arrays.actions[2 * row + 1] = static_cast<float>(2 * random.unit() - 1);
    }
}

void runBatch(benchmark::State& state, const Case& of) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(of.threads));
    learning::LearningTask task = learning::readTask("", "task");
    task.people = {static_cast<double>(of.people), static_cast<double>(of.people)};
    learning::LearningSetting setting{task, {}};
    setting.rooms.push_back(
        std::make_unique<learning::LearningRoom>(withBeams(roomOf(of.room), task, of.beams), task));
    const auto worlds = static_cast<std::size_t>(of.worlds);
    const learning::VectorSegment segment("ispace-bench-" + std::to_string(getpid()), setting,
                                          worlds, "");
    const learning::BatchArrays& arrays = segment.arrays();
    learning::LearningBatch batch(std::move(setting), worlds, learning::AutoReset::NextStep,
                                  arrays);
    for (std::size_t i = 0; i < worlds; ++i) {
        arrays.seeds[i] = i;
        arrays.masks[i] = static_cast<std::uint8_t>(learning::ResetMask::Seed);
    }
    batch.reset();
    learning::EpisodeRandom random(1);
    constexpr int kWarm = 20;
    for (int i = 0; i < kWarm; ++i) {
        drawActions(arrays, worlds, random);
        batch.step();
    }
    const double before = processorSeconds();
    for (auto _ : state) {
        drawActions(arrays, worlds, random);
        batch.step();
    }
    const double steps = static_cast<double>(state.iterations()) * of.worlds;
    state.counters["steps_per_s"] = benchmark::Counter(steps, benchmark::Counter::kIsRate);
    state.counters["cpu_us_per_step"] = (processorSeconds() - before) / steps * 1e6;
    state.counters["world_bytes"] = static_cast<double>(batch.bytesOfWorld());
}

/// The ray kernel alone: scans of 181 beams from starts of the same room.
void runRays(benchmark::State& state, const std::string& name) {
    const learning::LearningTask task = learning::readTask("", "task");
    const learning::LearningRoom room(learning::learningScene(roomOf(name), task), task);
    const learning::RobotLaser& laser = room.laser(0);
    std::vector<float> ranges(room.beams());
    learning::EpisodeRandom random(1);
    std::size_t scans = 0;
    const double before = processorSeconds();
    for (auto _ : state) {
        const Point2 at =
            room.cells().center(room.robotCells()[random.below(room.robotCells().size())]);
        const Pose3 pose{{at.x, at.y, laser.height}, Angle::degrees(360 * random.unit()), {}, {}};
        laser.world->cast(pose.position, laser.beams->at(pose), laser.sensor.as<Laser>().max_range,
                          ranges);
        benchmark::DoNotOptimize(ranges.data());
        ++scans;
    }
    state.counters["cpu_us_per_scan"] =
        (processorSeconds() - before) / static_cast<double>(scans) * 1e6;
}

/// A client that steps one world of 20 steps of 5 ms: STEP, SCAN and STATUS for each step of the
/// environment.
void runClient(benchmark::State& state) {
    const TestServer server(
        {bench::sceneFile("ispace.env"), bench::sceneFile("ispace.3dm"), "--clock", "step"});
    client::World world(server.address());
    client::Robot robot(server.address(), "r1");
    client::LaserSensor laser(server.address(), "l3");
    for (auto _ : state) {
        world.step(20);
        benchmark::DoNotOptimize(laser.scan());
        benchmark::DoNotOptimize(robot.status());
    }
    state.counters["steps_per_s"] =
        benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void addRow(const std::string& group, const Case& of) {
    const std::string title =
        "vector/" + of.room + '/' + group + "/worlds:" + std::to_string(of.worlds) +
        "/people:" + std::to_string(of.people) + "/beams:" + std::to_string(of.beams) +
        "/threads:" + std::to_string(of.threads);
    benchmark::RegisterBenchmark(title.c_str(),
                                 [of](benchmark::State& state) { runBatch(state, of); })
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const std::string floor = bench::willowMap().empty() ? "offices-120" : "willow-full";
    for (const int threads : {1, 2}) {
        addRow("walls", {.room = floor, .threads = threads});
        addRow("crowd", {.room = floor, .people = 10, .threads = threads});
    }
    for (const int worlds : {1, 16, 256, 4096}) addRow("worlds", {.room = floor, .worlds = worlds});
    for (const int people : {1, 3, 30}) addRow("people", {.room = floor, .people = people});
    for (const int beams : {31, 361, 1081}) addRow("beams", {.room = floor, .beams = beams});
    for (const char* const room : {"hall", "offices-6", "offices-120"})
        addRow("walls", {.room = room});
    benchmark::RegisterBenchmark(("vector/" + floor + "/rays alone").c_str(),
                                 [floor](benchmark::State& state) { runRays(state, floor); })
        ->Unit(benchmark::kMicrosecond);
    benchmark::RegisterBenchmark("vector/ispace/one world over TCP", runClient)
        ->UseRealTime()
        ->Unit(benchmark::kMicrosecond);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
