// SPDX-License-Identifier: GPL-3.0-or-later
// Compares our loops with the ray tracer alone: the same fans through Embree's coherent 16-wide
// call, through RayWorld::cast, and through the whole of a scan in memory.
#include <tbb/enumerable_thread_specific.h>

#include <memory>

#include "bench_scenes.h"
#include "bench_table.h"
#include "embree_raw.h"
#include "sense/scan.h"

namespace {

using namespace ispace;

constexpr std::size_t kSensors = 200;
constexpr int kRounds = 50;

/// One scene with its fans, ready for all ways.
struct Case {
    std::string name;
    bool level;
    Scene scene;
    std::size_t primitives = 0;
    std::vector<Sensor> sensors;
    bench::RawEmbree raw;
    RayScenes worlds;
    MovingBodies nobody;
    std::vector<Directions> directions;

    Case(std::string title, Scene loaded, bool is_level)
        : name(std::move(title)),
          level(is_level),
          scene(std::move(loaded)),
          sensors(bench::fans(scene, kSensors, level)),
          raw(level ? bench::RawEmbree::ofSlice(scene.environment.slice(kScanHeight), kScanHeight)
                    : bench::RawEmbree::ofEnvironment(scene.environment)),
          worlds(scene.environment) {
        const RangeNoise noise = bench::laserOfModel("utm-30lx").noise;
        raw.prepare(sensors);
        directions.reserve(sensors.size());
        for (Sensor& sensor : sensors) {
            worlds.prepare(sensor.pose);
            directions.push_back(Beams(sensor.as<Laser>(), true).at(sensor.pose));
            sensor.as<Laser>().noise = noise;
        }
        primitives = level ? bench::linesOf(scene) : bench::RawTriangles(scene.environment).size();
    }
    Case(const Case&) = delete;
    Case& operator=(const Case&) = delete;

    [[nodiscard]] double beams() const {
        return static_cast<double>(sensors.size()) * sensors.front().as<Laser>().beams;
    }
};

/// The ways, each for one fan at a time; memory is kept from fan to fan.
class EdgeWaypoints {
  public:
    explicit EdgeWaypoints(Case& test)
        : test_(test),
          ranges_([&test] { return std::vector<float>(test.directions.front().size()); }),
          plain_([&test] { return makeCaster(test, {}); }),
          noisy_([&test] { return makeCaster(test, {.noise_seed = 1}); }) {}

    void embree(std::size_t i) {
        const std::size_t each = test_.raw.packetsPerSensor();
        test_.raw.trace(i * each, (i + 1) * each);
    }
    std::span<const float> cast(std::size_t i) {
        std::vector<float>& ranges = ranges_.local();
        const Sensor& sensor = test_.sensors[i];
        test_.worlds.at(sensor.pose)
            .cast(sensor.pose.position, test_.directions[i], sensor.as<Laser>().max_range, ranges);
        return ranges;
    }
    std::span<const float> scan(std::size_t i) { return read(plain_.local(), i); }
    std::span<const float> noisyScan(std::size_t i) { return read(noisy_.local(), i); }

  private:
    struct Reader {
        std::unique_ptr<LaserCaster> caster;
        Scan scan;
    };

    static Reader makeCaster(const Case& test, const ReadingOptions& options) {
        return {std::make_unique<LaserCaster>(test.worlds, test.nobody, test.sensors.front(), true,
                                              options),
                {}};
    }
    std::span<const float> read(Reader& reader, std::size_t i) {
        reader.scan.pose = test_.sensors[i].pose;
        reader.scan.frame = static_cast<int>(i);
        reader.caster->cast(reader.scan);
        return reader.scan.ranges;
    }

    Case& test_;
    tbb::enumerable_thread_specific<std::vector<float>> ranges_;
    tbb::enumerable_thread_specific<Reader> plain_, noisy_;
};

void verify(Case& test) {
    EdgeWaypoints ways(test);
    std::vector<float> cast, scanned;
    for (std::size_t i = 0; i < test.sensors.size(); ++i) {
        for (const float range : ways.cast(i)) cast.push_back(range);
        for (const float range : ways.scan(i)) scanned.push_back(range);
    }
    bench::mustAgree(test.name, cast, test.raw.ranges());
    bench::mustAgree(test.name, scanned, cast);
}

void measure(benchmark::State& state, Case& test, int threads) {
    EdgeWaypoints ways(test);
    bench::Contest contest;
    const auto add = [&](auto way) {
        contest.add([&test, threads, way] { bench::shareOut(threads, test.sensors.size(), way); });
    };
    add([&ways](std::size_t i) { ways.embree(i); });
    add([&ways](std::size_t i) { ways.cast(i); });
    add([&ways](std::size_t i) { ways.scan(i); });
    add([&ways](std::size_t i) { ways.noisyScan(i); });
    const bench::Others others;
    for (auto _ : state) {
        contest.round();
        state.SetIterationTime(contest.last(3));
    }
    const auto rate = [&](std::size_t way) { return test.beams() / contest.quickest(way); };
    const double embree = rate(0);
    state.counters["embree"] = embree;
    state.counters["cast"] = rate(1);
    state.counters["scan"] = rate(2);
    state.counters["noisy"] = rate(3);
    state.counters["primitives"] = static_cast<double>(test.primitives);
    std::string row = bench::leftCell(test.name, 12) +
                      bench::cell(static_cast<double>(test.primitives), 0, 8) +
                      bench::cell(threads, 0, 4) + bench::cell(embree / 1e6, 1, 9);
    for (std::size_t way = 1; way <= 3; ++way)
        row.append(bench::cell(rate(way) / 1e6, 1, 9))
            .append(bench::cell(rate(way) / embree, 2, 7));
    state.counters["others"] = others.cores();
    state.SetLabel(row + bench::cell(others.cores(), 1, 8));
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    std::vector<std::unique_ptr<Case>> cases;
    const auto make = [&cases](const std::string& name, Scene scene, bool level) {
        cases.push_back(std::make_unique<Case>(name, std::move(scene), level));
    };
    const auto shipped = [](const std::string& name) {
        return bench::loadScene(bench::sceneFile(name + ".env"));
    };
    make("hall", shipped("hall"), true);
    make("crowded", shipped("crowded"), true);
    make("office-48", bench::officeScene(8, 6), true);
    make("office-1840", bench::officeScene(46, 40), true);
    make("walls-6", bench::sceneOfText(bench::building(6).text), false);
    make("crowded", shipped("crowded"), false);
    make("office-100", bench::officeScene(10, 10), false);
    for (const auto& test : cases) {
        verify(*test);
        for (const int threads : {1, 2}) {
            const std::string name = std::string(test->level ? "level/" : "tilted/") + test->name +
                                     '/' + std::to_string(threads);
            benchmark::RegisterBenchmark(
                name.c_str(),
                [&test, threads](benchmark::State& state) { measure(state, *test, threads); })
                ->UseManualTime()
                ->Iterations(kRounds)
                ->Unit(benchmark::kMillisecond);
        }
    }
    const auto heading = [](const std::string& what, const std::string& primitives) {
        return what + ", million beams a second and that of Embree's own rate\n" +
               bench::leftCell("scene", 12) + bench::cell(primitives, 8) + bench::cell("-j", 4) +
               bench::cell("Embree", 9) + bench::cell("cast", 9) + bench::cell("ratio", 7) +
               bench::cell("scan", 9) + bench::cell("ratio", 7) + bench::cell("noisy", 9) +
               bench::cell("ratio", 7) + bench::cell("others", 8);
    };
    bench::TableReporter reporter(
        {{"level", heading("Level fans", "lines")}, {"tilted", heading("Tilted fans", "triang.")}});
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
}
