// SPDX-License-Identifier: GPL-3.0-or-later
// How near the scan comes to what the ray tracer alone can do: the same fans through Embree's
// coherent 16-wide call, through castScan, and through to lines of JSON, in one run.
#include <benchmark/benchmark.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>

#include "bench_scenes.h"
#include "embree_raw.h"
#include "sense/scan_jsonl.h"

namespace {

using namespace ispace;

constexpr std::size_t kSensors = 200;

/// One scene with its fans, ready for both sides.
struct Case {
    std::string name;
    Scene scene;
    std::vector<PlacedLaser> sensors;
    bench::RawEmbree raw;
    Worlds worlds;

    Case(std::string title, Scene loaded, bool level)
        : name(std::move(title)),
          scene(std::move(loaded)),
          sensors(bench::fans(scene, kSensors, level)),
          raw(level ? bench::RawEmbree::ofSlice(scene.environment.slice(kScanHeight))
                    : bench::RawEmbree::ofEnvironment(scene.environment)),
          worlds(scene.environment) {
        raw.prepare(sensors);
        for (const PlacedLaser& sensor : sensors) worlds.prepare(sensor.pose);
    }
    Case(const Case&) = delete;
    Case& operator=(const Case&) = delete;

    [[nodiscard]] double beams() const {
        return static_cast<double>(sensors.size()) * sensors.front().laser.beams;
    }
};

/// Both sides must see the same: no more than one beam in ten thousand may differ by over a
/// millimetre (grazing hits, where float32 alone goes astray).
void verify(const Case& test) {
    const std::vector<float> raw = test.raw.ranges();
    std::size_t beam = 0;
    std::size_t wrong = 0;
    for (const PlacedLaser& sensor : test.sensors) {
        for (const float range : castBeams(test.worlds.at(sensor.pose), sensor)) {
            const float other = raw[beam++];
            if (range != other && !(std::abs(range - other) <= 1e-3F)) ++wrong;
        }
    }
    if (beam == raw.size() && wrong * 10000 <= beam) return;
    std::fprintf(stderr, "%s: %zu of %zu beams differ from Embree's own\n", test.name.c_str(),
                 wrong, beam);
    std::exit(1);
}

void count(benchmark::State& state, const Case& test) {
    state.counters["beams/s"] = benchmark::Counter(
        test.beams(), benchmark::Counter::kIsIterationInvariantRate, benchmark::Counter::kIs1000);
}

void embree(benchmark::State& state, Case& test) {
    for (auto _ : state) test.raw.trace(0, test.raw.packets());
    count(state, test);
}

void scan(benchmark::State& state, const Case& test) {
    for (auto _ : state) {
        for (const PlacedLaser& sensor : test.sensors) {
            benchmark::DoNotOptimize(castScan(test.worlds.at(sensor.pose), sensor));
        }
    }
    count(state, test);
}

void embreeAllCores(benchmark::State& state, Case& test) {
    const std::size_t each = test.raw.packetsPerSensor();
    for (auto _ : state) {
        tbb::parallel_for(std::size_t{0}, test.sensors.size(),
                          [&](std::size_t i) { test.raw.trace(i * each, (i + 1) * each); });
    }
    count(state, test);
}

void scanAllCores(benchmark::State& state, Case& test) {
    for (auto _ : state) benchmark::DoNotOptimize(castScans(test.worlds, test.sensors));
    count(state, test);
}

void scanToJsonl(benchmark::State& state, Case& test) {
    for (auto _ : state) {
        const std::vector<Scan> scans = castScans(test.worlds, test.sensors);
        std::string text = scanHeaderLine({}, 0);
        for (std::size_t i = 0; i < scans.size(); ++i) {
            appendScanLine(text, test.sensors[i], scans[i]);
        }
        benchmark::DoNotOptimize(text.data());
    }
    count(state, test);
}

/// The console's table, and under it what the scan reaches of Embree's own rate.
class RatioReporter : public benchmark::ConsoleReporter {
  public:
    RatioReporter() : ConsoleReporter(OO_Tabular) {}

    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs) {
            const auto rate = run.counters.find("beams/s");
            if (rate == run.counters.end() || run.run_type == Run::RT_Aggregate) continue;
            const std::string name = run.benchmark_name();
            double& best = best_[name.substr(0, name.find("/real_time"))];
            best = std::max(best, rate->second.value);
        }
        ConsoleReporter::ReportRuns(runs);
    }

    void Finalize() override {
        ConsoleReporter::Finalize();
        for (const auto& [name, raw] : best_) {
            const std::size_t slash = name.find('/');
            const std::string side = name.substr(0, slash);
            if (side != "embree" && side != "embree_all_cores") continue;
            const std::string ours = side == "embree" ? "scan" : "scan_all_cores";
            const auto other = best_.find(ours + name.substr(slash));
            if (other == best_.end()) continue;
            std::printf("%-16s %-20s %6.1f M beams/s of Embree's own %6.1f M: %.2f\n", ours.c_str(),
                        name.substr(slash + 1).c_str(), other->second / 1e6, raw / 1e6,
                        other->second / raw);
        }
    }

  private:
    std::map<std::string, double> best_;
};

/// Rates of one thread are by its CPU time, those of all cores by the clock on the wall.
void add(const std::string& side, Case& test, void (*run)(benchmark::State&, Case&)) {
    auto* const added =
        benchmark::RegisterBenchmark((side + '/' + test.name).c_str(),
                                     [run, &test](benchmark::State& state) { run(state, test); });
    added->Unit(benchmark::kMillisecond);
    if (side != "embree" && side != "scan") added->UseRealTime();
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    std::vector<std::unique_ptr<Case>> cases;
    const auto make = [&cases](const std::string& name, auto load) {
        cases.push_back(std::make_unique<Case>(name + "/level", load(), true));
        cases.push_back(std::make_unique<Case>(name + "/tilted", load(), false));
    };
    make("facilities", [] { return bench::loadScene(bench::sceneFile("facilities.env")); });
    make("office_300", [] { return bench::officeScene(20, 15); });
    for (const auto& test : cases) {
        verify(*test);
        add("embree", *test, embree);
        add("scan", *test, [](benchmark::State& state, Case& c) { scan(state, c); });
        add("embree_all_cores", *test, embreeAllCores);
        add("scan_all_cores", *test, scanAllCores);
        add("scan_to_jsonl", *test, scanToJsonl);
    }
    RatioReporter reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
}
