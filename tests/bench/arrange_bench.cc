// SPDX-License-Identifier: GPL-3.0-or-later
// Placement: the thesis' tables 4.1 and 5.2 on scenes like its own, twelve plans with the bound of
// each result, and how work grows with candidates and cells. One thread, but for the plans with
// many sensors.
#include <ctime>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "arrange/arrange.h"
#include "base/number.h"
#include "bench_scenes.h"
#include "bench_table.h"
#include "coverage/coverage.h"
#include "random_plan.h"
#include "scene/placement_schemas.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor_spec.h"

namespace {

using namespace ispace;

constexpr int kRounds = 3;
/// Seconds of processor time after which a proof is given up; with many sensors that is five
/// seconds of two threads.
constexpr double kPatience = 3, kLongPatience = 10;

double processorSeconds() {
    return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

/// Tells set-up from search by their phases.
class Stopwatch final : public Progress {
  public:
    explicit Stopwatch(double patience) : patience_(patience) {}
    void begin(std::string_view phase, std::int64_t /*total*/) override {
        is_setup_ = phase == "checking places" || phase == "scanning candidates";
        start_ = processorSeconds();
    }
    void advance(std::int64_t /*count*/) override {}
    void end() override {
        if (is_setup_) setup += processorSeconds() - start_;
        is_setup_ = false;
    }
    /// Asked up to a million times a second, while the processor clock is a system call: it is read
    /// once a millisecond.
    [[nodiscard]] bool stopped() const override {
        const auto now = std::chrono::steady_clock::now().time_since_epoch();
        const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
        if (read_.exchange(ms, std::memory_order_relaxed) != ms &&
            processorSeconds() > born_ + patience_)
            is_over_ = true;
        return is_over_;
    }
    double setup = 0;

  private:
    double patience_;
    bool is_setup_ = false;
    mutable std::atomic<std::int64_t> read_ = 0;  // when the clock was
    mutable std::atomic<bool> is_over_ = false;
    double start_ = 0, born_ = processorSeconds();
};

/// A run of arrange on a scene in memory.
struct Job {
    const Scene* scene = nullptr;
    std::string sensors;
    ArrangeOptions how;
    double patience = kPatience;
    std::size_t threads = 1;
};

struct Result {
    Arrangement arrangement;
    double setup = 0, all = 0;  ///< seconds of processor time
};

std::vector<SensorGroup> groupsOf(const Job& job) {
    const std::vector<SensorSpec> added = {readSensorSpec(
        job.sensors, keywordsOf(&SensorKind::is_arranged), sceneSchemas(), bench::devices())};
    return groupsToPlace(*job.scene, added, bench::devices(), job.how.target.has_value());
}

Result run(const Job& job) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, job.threads);
    const std::vector<SensorGroup> groups = groupsOf(job);
    Stopwatch watch(job.patience);
    const double start = processorSeconds();
    Result result{arrange(*job.scene, groups, job.how, watch), watch.setup, 0};
    result.all = processorSeconds() - start;
    return result;
}

/// The reported value is coverage's measurement, and at most the bound.
void verify(const Job& job, const Arrangement& found) {
    const Scene placed = withPlaced(*job.scene, groupsOf(job), found.sensors);
    RayScenes worlds(placed.environment);
    const double measured =
        measureCoverage(placed, worlds, {.density = job.how.pixel_density, .exact = false})
            .report.coverage.grid.value_or(0);
    if (measured == found.coverage && found.candidate_value <= found.candidate_bound &&
        found.value.value_or(measured) <= found.bound)
        return;
    std::fprintf(stderr, "coverage %g, measured %g, bound %g\n", found.coverage, measured,
                 found.bound);
    std::exit(1);
}

Result quickest(benchmark::State& state, const Job& job) {
    Result best;
    bool is_first = true;
    for (auto _ : state) {
        Result result = run(job);
        state.SetIterationTime(result.all);
        if (is_first || result.all < best.all) best = std::move(result);
        is_first = false;
    }
    verify(job, best.arrangement);
    return best;
}

std::string percent(double share) { return formatFixed(100 * share, 2) + "%"; }
std::string milliseconds(double seconds) { return formatFixed(1e3 * seconds, 1); }
double gapOf(const Arrangement& found) {
    return 1 - found.candidate_value / std::max(found.candidate_bound, 1e-9);
}

// ---- The thesis' tables

struct ThesisRow {
    std::string name, parameters, theirs;
    Job job;
};

std::vector<ThesisRow> thesisRows(const Scene& facilities, const Scene& tracking) {
    const std::string three = "laser,range=4,fov=180:3", two = "laser,range=3,fov=180:2";
    const auto with = [](Strategy strategy, Optimizer optimizer) {
        ArrangeOptions how;
        how.strategy = strategy;
        how.cells = CellCount{100, 100};
        how.search.optimizer = optimizer;
        return how;
    };
    ArrangeOptions grid = with(Strategy::Grid, Optimizer::Greedy);
    grid.x = grid.y = 11;
    grid.headings = 8;
    ArrangeOptions random = with(Strategy::Random, Optimizer::Greedy);
    random.headings = 8;
    const ArrangeOptions wall = with(Strategy::Wall, Optimizer::Greedy);
    ArrangeOptions few = wall;
    few.times = 11;
    ArrangeOptions best = with(Strategy::All, Optimizer::Exact), refined = best;
    refined.refine = true;
    return {{"4.1 grid", "X=11 Y=11 Deg=8", "80.8% 520 s", {&facilities, three, grid}},
            {"4.1 random", "R1=20 R2=5 Deg=8", "73.9% 230 s", {&facilities, three, random}},
            {"4.1 wall", "dist=0.05 times=21", "80.6% 110 s", {&facilities, three, wall}},
            {"    exact", "0.25,0.25,16", "", {&facilities, three, best}},
            {"    refined", "0.25,0.25,16", "", {&facilities, three, refined}},
            {"5.2 wall", "dist=0.05 times=11", "97.4%  70 s", {&tracking, two, few}},
            {"    exact", "0.25,0.25,16", "", {&tracking, two, best}},
            {"    refined", "0.25,0.25,16", "", {&tracking, two, refined}}};
}

void thesis(benchmark::State& state, const ThesisRow& row) {
    const Result result = quickest(state, row.job);
    const Arrangement& found = result.arrangement;
    const bool is_thesis = !row.theirs.empty();
    if (is_thesis && result.all > 0.05) state.SkipWithError("a thesis strategy takes over 0.05 s");
    state.SetLabel(bench::leftCell(row.name, 13) + bench::leftCell(row.parameters, 20) +
                   bench::leftCell(row.theirs, 14) + bench::cell(percent(found.coverage), 8) +
                   bench::cell(percent(found.bound), 9) + bench::cell(milliseconds(result.all), 9));
}

// ---- Plans

struct Plan {
    std::string name;
    Scene scene;
};

std::vector<Plan> plans() {
    constexpr std::uint64_t kPlans = 10;  // at least, with data or without
    std::vector<Plan> all;
    std::uint64_t seed = 1;
    for (const double area : {45.0, 80.0, 120.0, 180.0, 245.0}) {
        const bool is_askew = seed % 2 == 0;
        const std::string text =
            testing::randomPlan({.seed = seed++, .area = area, .is_askew = is_askew});
        all.push_back({"made, " + formatFixed(area, 0) + " m2" + (is_askew ? ", askew" : ""),
                       bench::sceneOfText(text)});
    }
    const char* const folder = std::getenv("ISPACE_TEST_DATA");
    for (const char* name :
         {"plans/he_0a1b29db_raw.json", "plans/syn_03.json", "plans/syn_10.json",
          "plans/syn_15.json", "willow-full.yaml", "turtlebot3.yaml", "plans/syn_20.json"}) {
        const std::string file = folder == nullptr ? "" : std::string(folder) + '/' + name;
        if (!file.empty() && std::filesystem::exists(file))
            all.push_back({std::filesystem::path(name).stem().string(), bench::loadScene(file)});
        else if (seed <= kPlans)
            all.push_back({"made, seed " + std::to_string(seed),
                           bench::sceneOfText(testing::randomPlan(
                               {.seed = seed, .area = 60.0 * static_cast<double>(seed - 5)}))});
        ++seed;
    }
    return all;
}

/// To within 1 % of the bound, with many sensors 0.5 %, or as near as it gets.
Job jobOn(const Scene& scene, int sensors, int fov) {
    ArrangeOptions how;
    how.cells = CellCount{100, 100};
    how.search.optimizer = Optimizer::Exact;
    const bool is_many = sensors > 3;
    how.search.gap = is_many ? 0.005 : 0.01;
    return {&scene, "laser,range=4,fov=" + std::to_string(fov) + ":" + std::to_string(sensors), how,
            is_many ? kLongPatience : kPatience, is_many ? 2U : 1U};
}

std::string figures(const Result& result) {
    const Arrangement& found = result.arrangement;
    return bench::cell(static_cast<double>(found.candidates), 0, 9) +
           bench::cell(percent(found.candidate_value), 9) + bench::cell(percent(found.bound), 9) +
           bench::cell(percent(gapOf(found)), 8) + bench::cell(milliseconds(result.setup), 10) +
           bench::cell(milliseconds(result.all - result.setup), 10) +
           bench::cell(static_cast<double>(found.bytes) / 1e6, 1, 8) +
           (found.is_complete ? "" : "  given up");
}

void onPlan(benchmark::State& state, const Plan& plan, int sensors, int fov) {
    const Result result = quickest(state, jobOn(plan.scene, sensors, fov));
    const double area = plan.scene.environment.indoor().area();
    state.SetLabel(bench::leftCell(plan.name, 22) + bench::cell(area, 0, 6) +
                   bench::cell(sensors, 0, 3) + bench::cell(fov, 0, 5) + figures(result));
    if (sensors == 3 && area <= 250 && (gapOf(result.arrangement) > 0.01 || result.all > 1))
        state.SkipWithError("3 sensors are not within 1 % in a second");
    if (gapOf(result.arrangement) > 0.025) state.SkipWithError("the gap is above 2.5 %");
}

void growing(benchmark::State& state, const Scene& scene, const CandidateDensity& density,
             int cells) {
    Job job = jobOn(scene, 3, 180);
    job.how.density = density;
    job.how.cells = CellCount{cells, cells};
    Result result = quickest(state, job);
    state.SetLabel(bench::leftCell(formatDouble(density.lattice_step) + "," +
                                       formatDouble(density.wall_step) + "," +
                                       std::to_string(density.headings),
                                   16) +
                   bench::cell(std::to_string(cells) + "^2", 8) + figures(result));
}

/// Sensors that hang from the ceiling of an office and look down in three tilts.
struct CameraRow {
    std::string name, sensors;
    CandidateDensity density;
    double pixel_density = 0;
    std::optional<double> target = {};
};

void overhead(benchmark::State& state, const Scene& office, const CameraRow& row) {
    Job job{&office, row.sensors, {}};
    job.how.mount.on = MountOn::Ceiling;
    for (const double tilt : {-90.0, -60.0, -30.0})
        job.how.mount.tilts.push_back(Angle::degrees(tilt));
    job.how.density = row.density;
    job.how.pixel_density = row.pixel_density;
    job.how.target = row.target;
    job.how.search.optimizer = Optimizer::Exact;
    const Result result = quickest(state, job);
    state.SetLabel(bench::leftCell(row.name, 28) +
                   bench::cell(static_cast<double>(result.arrangement.sensors.size()), 0, 3) +
                   figures(result));
}

template <typename Run>
void add(const std::string& name, int rounds, Run run) {
    benchmark::RegisterBenchmark(name.c_str(), run)->Iterations(rounds)->UseManualTime();
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const Scene facilities = bench::loadScene(bench::sceneFile("facilities.env"));
    const Scene tracking = bench::loadScene(bench::sceneFile("tracking.env"));
    const std::vector<ThesisRow> rows = thesisRows(facilities, tracking);
    for (std::size_t i = 0; i < rows.size(); ++i)
        add("thesis/" + std::to_string(i), kRounds,
            [&row = rows[i]](benchmark::State& state) { thesis(state, row); });
    const std::vector<Plan> all = plans();
    for (const int sensors : {3, 8, 16})
        for (const Plan& plan : all)
            for (const int fov : {180, 270})
                add((sensors == 3 ? "plans/" : "many/") + plan.name + '/' +
                        std::to_string(sensors) + '/' + std::to_string(fov),
                    sensors == 3 ? kRounds : 1, [&plan, sensors, fov](benchmark::State& state) {
                        onPlan(state, plan, sensors, fov);
                    });
    const Scene& middle = all[2].scene;
    const std::pair<CandidateDensity, int> sizes[] = {
        {{1, 1, 8}, 100},        {{0.5, 0.5, 16}, 100},   {{0.25, 0.25, 16}, 100},
        {{0.1, 0.1, 16}, 100},   {{0.1, 0.1, 64}, 100},   {{0.25, 0.25, 16}, 200},
        {{0.25, 0.25, 16}, 500}, {{0.25, 0.25, 16}, 1000}};
    for (const auto& [density, cells] : sizes)
        add("growth/" + std::to_string(density.lattice_step) + '/' + std::to_string(cells) + '/' +
                std::to_string(density.headings),
            kRounds, [&middle, density = density, cells = cells](benchmark::State& state) {
                growing(state, middle, density, cells);
            });
    const Scene office = bench::loadScene(bench::sceneFile("open-office.env"));
    const std::string dome = "dome-2.8-1080p,fov=110";
    const CameraRow of_cameras[] = {{"domes", dome + ":4", {1, 1, 8}},
                                    {"domes, 90 %", dome, {1, 1, 8}, 0, 0.9},
                                    {"domes, 90 % recognised", dome, {1, 1, 8}, 125, 0.9},
                                    {"pinholes", "camera,fov=110,62:4", {1, 1, 8}},
                                    {"rangers", "ranger,fov=110,62,range=20:4", {1, 1, 8}}};
    for (const CameraRow& row : of_cameras)
        add("cameras/" + row.name, kRounds,
            [&office, &row](benchmark::State& state) { overhead(state, office, row); });
    const std::string columns = bench::headOf({{"cand.", 9},
                                               {"coverage", 9},
                                               {"bound", 9},
                                               {"gap", 8},
                                               {"set-up,ms", 10},
                                               {"search,ms", 10},
                                               {"MB", 8}});
    const std::string of_plans =
        bench::headOf({{"plan", -22}, {"m2", 6}, {"k", 3}, {"fov", 5}}) + columns;
    bench::TableReporter table(
        {{"thesis",
          "Tables 4.1 and 5.2 of the thesis on scenes like its own (not the same: those are "
          "lost)\n" +
              bench::headOf({{"table", -13},
                             {"parameters", -20},
                             {"thesis", -14},
                             {"coverage", 8},
                             {"bound", 9},
                             {"ms", 9}})},
         {"plans",
          "4 m lasers on candidates 0.25,0.25,16, to within 1 % of the bound or for 3 s; one "
          "thread, "
          "processor time\n" +
              of_plans},
         {"many",
          "8 and 16 of them, to within 0.5 % of the bound or for 10 s; two threads, processor time "
          "of both\n" +
              of_plans},
         {"cameras", "Cameras in an open-plan office of 14 m x 9 m, proven or for 3 s\n" +
                         bench::headOf({{"cameras", -28}, {"k", 3}}) + columns},
         {"growth", "3 lasers of 180 degrees in the third plan\n" +
                        bench::headOf({{"candidates", -16}, {"cells", 8}}) + columns}});
    benchmark::RunSpecifiedBenchmarks(&table);
    return 0;
}
