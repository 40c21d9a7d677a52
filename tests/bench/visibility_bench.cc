// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility regions a second, beside CGAL's triangular expansion in exact numbers. Both sides give
// corners as doubles: CGAL's are read, which makes it compute some of them.
//
// visibility_bench --check DIR instead looks around the plans and maps in a folder, from anywhere,
// and compares with CGAL.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <set>

#include "base/number.h"
#include "bench_scenes.h"
#include "bench_table.h"
#include "geom/predicates.h"
#include "geom/visibility/visibility.h"
#include "support/test_plans.h"

namespace {

using namespace ispace;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kShortRange = 4, kMiddleRange = 8, kLongRange = 30;  // metres
constexpr std::size_t kViewpoints = 2000;
constexpr int kRounds = 8;

/// One plan and the viewpoints, the same for all ways.
struct Case {
    std::string name;
    std::vector<Segment2> lines;
    std::vector<Point2> viewpoints;
    std::unique_ptr<VisibilityMap> map;
    std::unique_ptr<test::VisibilityOracle> cgal;  // attached once
    std::vector<std::size_t> faces;                // of the viewpoints, found beforehand
    double build_seconds = 0;

    Case(std::string title, std::vector<Segment2> plan, std::vector<Point2> from, bool with_cgal)
        : name(std::move(title)), lines(std::move(plan)), viewpoints(std::move(from)) {
        const auto start = std::chrono::steady_clock::now();
        map = std::make_unique<VisibilityMap>(lines);
        build_seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (!with_cgal) return;
        cgal = std::make_unique<test::VisibilityOracle>(lines);
        faces.reserve(viewpoints.size());
        std::erase_if(viewpoints, [this](Point2 p) {
            const auto face = cgal->faceOf(p);
            if (face) faces.push_back(*face);
            return !face;
        });
    }
};

std::unique_ptr<Case> generated(const std::string& name, const test::PlanSize& size,
                                bool with_cgal) {
    const Region plan = test::makePlan(1, size);
    std::mt19937_64 random(2);
    std::vector<Point2> viewpoints;
    viewpoints.reserve(kViewpoints);
    while (viewpoints.size() < kViewpoints) viewpoints.push_back(test::randomInside(random, plan));
    return std::make_unique<Case>(name, test::linesOf(plan), std::move(viewpoints), with_cgal);
}

std::vector<Segment2> linesOf(const Scene& scene) {
    std::vector<Segment2> lines;
    scene.environment.slice(kScanHeight).forEachLine([&lines](const Segment2& line) {
        lines.push_back(line);
    });
    return lines;
}

std::unique_ptr<Case> loaded(const std::string& name, const std::string& file) {
    const Scene scene = bench::loadScene(file);
    std::vector<Point2> viewpoints;
    viewpoints.reserve(kViewpoints);
    for (const Sensor& sensor : bench::fans(scene, kViewpoints, true))
        viewpoints.push_back(sensor.pose.position.onFloor());
    return std::make_unique<Case>(name, linesOf(scene), std::move(viewpoints), true);
}

void fail(const std::string& name, Point2 p, const char* what, double ours, double wanted) {
    std::fprintf(stderr, "%s from %.17g,%.17g: %s %.17g, wanted %.17g\n", name.c_str(), p.x, p.y,
                 what, ours, wanted);
    std::exit(1);
}

bool isEnclosed(const VisibleRegion& region) {
    return std::none_of(region.edges.begin(), region.edges.end(),
                        [](const VisibilityEdge& end) { return end.line == VisibilityEdge::kArc; });
}

/// Ends the program unless a part of the regions has the areas that CGAL says.
void verify(const Case& test) {
    constexpr std::size_t kCompared = 100;
    VisibleRegion region;
    for (std::size_t i = 0; i < test.viewpoints.size(); ++i) {
        const Point2 p = test.viewpoints[i];
        test.map->query(p, kInfinity, region);
        const double whole = area(region);
        if (i < kCompared && test.cgal != nullptr && isEnclosed(region) && region.viewpoint == p) {
            const double wanted = test.cgal->areaFrom(p);
            if (!(std::abs(whole - wanted) <= 1e-9 * wanted))
                fail(test.name, p, "area", whole, wanted);
        }
        test.map->query(p, kShortRange, region);
        const double most = std::numbers::pi * kShortRange * kShortRange * (1 + 1e-12);
        if (!(area(region) <= std::min(whole * (1 + 1e-9), most)))
            fail(test.name, p, "short range", area(region), whole);
    }
}

void measure(benchmark::State& state, const Case& test) {
    bench::Contest contest;
    VisibleRegion region;
    std::size_t ends = 0, seen = 0;
    for (const double range : {kInfinity, kShortRange, kMiddleRange, kLongRange}) {
        contest.add([&, range] {
            ends = 0;
            for (const Point2 p : test.viewpoints) {
                test.map->query(p, range, region);
                ends += region.edges.size();
            }
            if (std::isinf(range)) seen = ends;
        });
    }
    if (test.cgal != nullptr) {
        contest.add([&] {
            for (std::size_t i = 0; i < test.viewpoints.size(); ++i)
                benchmark::DoNotOptimize(test.cgal->query(test.viewpoints[i], test.faces[i]));
        });
    }
    const bench::Others others;
    for (auto _ : state) {
        contest.round();
        state.SetIterationTime(contest.last(0));
    }
    const auto count = static_cast<double>(test.viewpoints.size());
    const auto rate = [&](std::size_t way) { return count / contest.quickest(way); };
    const auto lines = static_cast<double>(test.lines.size());
    state.counters["whole"] = rate(0);
    state.counters["short"] = rate(1);
    state.counters["middle"] = rate(2);
    state.counters["long"] = rate(3);
    std::string row = bench::leftCell(test.name, 14) + bench::cell(lines, 0, 8) +
                      bench::cell(static_cast<double>(seen) / count, 1, 7) +
                      bench::cell(1e3 * test.build_seconds, 1, 9) +
                      bench::cell(rate(0) / 1e3, 0, 9) + bench::cell(rate(1) / 1e3, 0, 9) +
                      bench::cell(rate(2) / 1e3, 0, 9) + bench::cell(rate(3) / 1e3, 0, 9);
    if (test.cgal != nullptr) {
        state.counters["cgal"] = rate(4);
        row.append(bench::cell(rate(4) / 1e3, 1, 9))
            .append(bench::cell(rate(0) / rate(4), 1, 8))
            .append(bench::cell(rate(1) / rate(4), 1, 8));
    }
    state.SetLabel(row + bench::cell(others.cores(), 1, 8));
}

std::vector<std::string> realPlans(const std::string& folder) {
    std::set<std::string> files;  // in order
    for (const std::string& part : {folder, folder + "/plans"}) {
        if (!std::filesystem::is_directory(part)) continue;
        for (const auto& entry : std::filesystem::directory_iterator(part)) {
            const std::string extension = entry.path().extension();
            if (extension == ".json" || extension == ".yaml") files.insert(entry.path());
        }
    }
    return {files.begin(), files.end()};
}

std::string stemOf(const std::string& file) { return std::filesystem::path(file).stem(); }

/// Ends the program unless the ends go round, once, counter-clockwise and without gaps.
void mustGoRound(const std::string& name, const VisibleRegion& region) {
    const Point2 v = region.viewpoint;
    double turned = 0;
    for (std::size_t i = 0; i < region.edges.size(); ++i) {
        const VisibilityEdge& end = region.edges[i];
        const Vec2 from = end.from - v, to = end.to - v;
        const Vec2 next = region.edges[(i + 1) % region.edges.size()].from - v;
        if (!(cross(from, to) > 0)) fail(name, v, "turn of an end", cross(from, to), 1);
        turned += std::atan2(cross(from, to), dot(from, to));
        const double gap = std::atan2(cross(to, next), dot(to, next));
        if (!(std::abs(gap) <= 1e-6)) fail(name, v, "gap", gap, 0);
    }
    if (!(std::abs(turned - 2 * std::numbers::pi) <= 1e-6))
        fail(name, v, "turned", turned, 2 * std::numbers::pi);
}

/// Anywhere, and one time in four each on a vertex and on a wall.
Point2 anyViewpoint(std::mt19937_64& random, const std::vector<Segment2>& lines, const Box2& box) {
    const int kind = std::uniform_int_distribution<int>(0, 3)(random);
    if (kind > 1) return test::randomIn(random, box);
    const Segment2& line =
        lines[std::uniform_int_distribution<std::size_t>(0, lines.size() - 1)(random)];
    if (kind == 0) return line.a;
    return line.a + std::uniform_real_distribution<double>()(random) * (line.b - line.a);
}

void check(const std::string& file) {
    constexpr int kLooks = 10'000, kCompared = 200;
    const std::vector<Segment2> lines = linesOf(bench::loadScene(file));
    const VisibilityMap map(lines);
    const test::VisibilityOracle cgal(lines);
    const Box2 box = test::boxOf(lines);
    std::mt19937_64 random(3);
    VisibleRegion region;
    int compared = 0;
    for (int i = 0; i < kLooks; ++i) {
        const Point2 p = anyViewpoint(random, lines, box);
        map.query(p, kInfinity, region);
        mustGoRound(file, region);
        const bool is_enclosed = isEnclosed(region);
        const double whole = is_enclosed ? area(region) : kInfinity;
        const bool is_clear = std::none_of(lines.begin(), lines.end(), [p](const Segment2& line) {
            return distance(p, line) <= kRayEpsilon;
        });
        if (compared < kCompared && is_enclosed && is_clear) {
            ++compared;
            const double wanted = cgal.areaFrom(p);
            if (!(std::abs(whole - wanted) <= 1e-9 * wanted)) fail(file, p, "area", whole, wanted);
        }
        double last = 0;
        for (const double range : {0.01, 0.5, 4.0, 30.0}) {
            map.query(p, range, region);
            mustGoRound(file, region);
            const double here = area(region);
            const double most = std::min(whole, std::numbers::pi * range * range);
            if (!(here >= last * (1 - 1e-9) && here <= most * (1 + 1e-9)))
                fail(file, p, "area within range", here, most);
            last = here;
        }
    }
    std::printf("%s: %zu lines, %d looks, %d compared\n", stemOf(file).c_str(), lines.size(),
                kLooks, compared);
}

void registerCase(const std::string& group, std::unique_ptr<Case> test) {
    verify(*test);
    const std::string name = group + '/' + test->name;
    const std::shared_ptr<const Case> shared = std::move(test);
    benchmark::RegisterBenchmark(name.c_str(),
                                 [shared](benchmark::State& state) { measure(state, *shared); })
        ->UseManualTime()
        ->Iterations(kRounds)
        ->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 3 && std::strcmp(argv[1], "--check") == 0) {
        for (const std::string& file : realPlans(argv[2])) check(file);
        return 0;
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    registerCase("plans", generated("20/4", {1, 1, 4, 4, 4}, true));
    registerCase("plans", generated("62/0", {1, 1, 0, 0, 62}, true));
    registerCase("plans", generated("192/17", {2, 2, 9, 12, 52}, true));
    registerCase("plans", generated("1663/162", {5, 5, 82, 14, 195}, true));
    registerCase("plans", generated("4805/549", {9, 9, 261, 13, 260}, true));
    if (const char* const folder = std::getenv("ISPACE_TEST_DATA"); folder != nullptr)
        for (const std::string& file : realPlans(folder))
            registerCase("plans", loaded(stemOf(file), file));
    for (const int rooms : {4, 14, 44})
        registerCase("growth", generated(std::to_string(rooms * rooms) + " rooms",
                                         {rooms, rooms, 3 * rooms * rooms, 12, 8 * rooms}, false));
    const auto heading = [](const std::string& what) {
        return what + ", thousand regions a second, one thread\n" + bench::leftCell("plan", 14) +
               bench::cell("lines", 8) + bench::cell("ends", 7) + bench::cell("build ms", 9) +
               bench::cell("whole", 9) + bench::cell("4 m", 9) + bench::cell("8 m", 9) +
               bench::cell("30 m", 9);
    };
    bench::TableReporter reporter(
        {{"plans", heading("Plans (vertices/holes, or names)") + bench::cell("CGAL", 9) +
                       bench::cell("ratio", 8) + bench::cell("4 m", 8) + bench::cell("others", 8)},
         {"growth", heading("Growth") + bench::cell("others", 8)}});
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
}
