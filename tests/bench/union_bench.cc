// SPDX-License-Identifier: GPL-3.0-or-later
// Floor that k views cover together: computes the area of their union and the area seen by each
// number of them at once, by forEachArea as `coverage` does, beside the bare union by CGAL (exact
// kernel) and by Clipper 6 if installed (libpolyclipping-dev; on a lattice of 2^-30 m). Views of
// lasers (4 m, 180 degrees) at free points of offices: some 26 vertices each and arcs.
//
// union_bench --write FOLDER instead writes the outlines as JSON, for clipper2_union.js, and the
// times of all depths and of an Overlay that stores its edges, in milliseconds of processor time.
#include <CGAL/Boolean_set_operations_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <benchmark/benchmark.h>
#ifdef ISPACE_CLIPPER
#include <clipper.hpp>
#endif

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <limits>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/number.h"
#include "bench_scenes.h"
#include "bench_table.h"
#include "geom/overlay/overlay.h"
#include "geom/visibility/visibility.h"

namespace {

using namespace ispace;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPolygon = CGAL::Polygon_2<Kernel>;

constexpr double kRange = 4;
constexpr std::size_t kViews[] = {3, 10, 30, 100, 300, 1000};
/// CGAL takes seconds for more.
constexpr std::size_t kMaxForCgal = 300;

/// The outlines of k views, with arcs and with chords for them.
struct Case {
    std::string scene;
    std::vector<Layer> layers, chord_layers;
    std::vector<ExactPolygon> polygons;
    std::size_t edges = 0;

    [[nodiscard]] bool isForCgal() const { return polygons.size() <= kMaxForCgal; }
};

/// The union by Clipper, with chords for arcs.
class ByClipper {
  public:
#ifdef ISPACE_CLIPPER
    static constexpr bool kIsThere = true;

    explicit ByClipper(const Case& test) {
        for (const Layer& layer : test.chord_layers) {
            ClipperLib::Path path;
            for (const CurveEdge& edge : layer.curves[0])
                path.emplace_back(std::llround(edge.from.x / kStep),
                                  std::llround(edge.from.y / kStep));
            paths_.push_back(std::move(path));
        }
    }
    [[nodiscard]] double area() const {
        ClipperLib::Clipper clipper;
        clipper.AddPaths(paths_, ClipperLib::ptSubject, true);
        ClipperLib::Paths joined;
        clipper.Execute(ClipperLib::ctUnion, joined, ClipperLib::pftNonZero,
                        ClipperLib::pftNonZero);
        double area = 0;
        for (const ClipperLib::Path& path : joined) area += ClipperLib::Area(path);
        return area * kStep * kStep;
    }

  private:
    static constexpr double kStep = 0x1p-30;
    ClipperLib::Paths paths_;
#else
    static constexpr bool kIsThere = false;

    explicit ByClipper(const Case&) {}
    [[nodiscard]] static double area() { return 0; }
#endif
};

Case makeCase(const std::string& name, const Scene& scene, std::size_t count) {
    Case out;
    out.scene = name;
    std::vector<Segment2> lines;
    scene.environment.slice(kScanHeight).forEachLine([&](const Segment2& s) {
        lines.push_back(s);
    });
    const VisibilityMap map(lines);
    for (const Sensor& sensor : bench::fans(scene, count, true)) {
        const VisibleRegion whole = map.query(sensor.pose.position.onFloor(), kRange);
        const Angle first = sensor.pose.heading - Angle::degrees(90);
        const Curve curve = outlineOf(sectorOf(whole, first, Angle::degrees(180)));
        const Polygon polygon = chords(curve);
        ExactPolygon exact;
        for (const Point2 p : polygon) {
            if (exact.is_empty() || exact.container().back() != Kernel::Point_2(p.x, p.y))
                exact.push_back({p.x, p.y});
        }
        // Others CGAL refuses.
        if (exact.size() < 3 || !exact.is_simple() || !exact.is_counterclockwise_oriented())
            continue;
        Layer layer;
        layer.number = static_cast<std::int64_t>(out.layers.size());
        layer.curves = {curve};
        out.layers.push_back(layer);
        layer.curves = {curveOf(polygon)};
        out.chord_layers.push_back(std::move(layer));
        out.polygons.push_back(std::move(exact));
        out.edges += polygon.size();
    }
    return out;
}

/// Area seen by k views, of which the first is that of the union.
std::vector<double> depthsOf(const std::vector<Layer>& layers) {
    std::vector<double> areas(layers.size() + 1);
    forEachArea(layers, [&](const LayerLabel& label, double area) {
        areas[static_cast<std::size_t>(label.count)] += area;
    });
    areas[0] = 0;
    for (std::size_t k = 1; k < areas.size(); ++k) areas[0] += areas[k];
    return areas;
}

double areaOfJoin(const std::vector<ExactPolygon>& polygons) {
    std::vector<CGAL::Polygon_with_holes_2<Kernel>> pieces;
    CGAL::join(polygons.begin(), polygons.end(), std::back_inserter(pieces));
    double area = 0;
    for (const auto& piece : pieces) {
        area += CGAL::to_double(piece.outer_boundary().area());
        for (const auto& hole : piece.holes()) area += CGAL::to_double(hole.area());
    }
    return area;
}

void verify(const Case& test) {
    const ByClipper clipper(test);
    const double exact = test.isForCgal() ? areaOfJoin(test.polygons) : clipper.area();
    const double chords = depthsOf(test.chord_layers)[0], arcs = depthsOf(test.layers)[0];
    if (exact == 0) return;  // no peer installed
    const double slack = 1e-8 * exact;
    if (ByClipper::kIsThere && std::abs(clipper.area() - exact) > slack) {
        std::fprintf(stderr, "union: %s of %zu is %.12g m2 by Clipper, wanted %.12g\n",
                     test.scene.c_str(), test.layers.size(), clipper.area(), exact);
        std::exit(1);
    }
    if (std::abs(chords - exact) <= slack && arcs >= chords - slack && arcs <= 1.0001 * chords)
        return;
    std::fprintf(stderr,
                 "union: %s of %zu is %.12g m2 by CGAL, %.12g m2 by layers, %.12g with arcs\n",
                 test.scene.c_str(), test.layers.size(), exact, chords, arcs);
    std::exit(1);
}

void measure(benchmark::State& state, const Case& test) {
    static double share_before = 0;
    bench::Contest contest;
    contest.add([&test] { benchmark::DoNotOptimize(depthsOf(test.layers)); });
    const ByClipper clipper(test);
    std::size_t ways = 1;
    const std::size_t by_clipper = ByClipper::kIsThere ? ways++ : 0;
    if (ByClipper::kIsThere) contest.add([&] { benchmark::DoNotOptimize(clipper.area()); });
    const std::size_t by_cgal = test.isForCgal() ? ways++ : 0;
    if (test.isForCgal())
        contest.add([&test] { benchmark::DoNotOptimize(areaOfJoin(test.polygons)); });
    for (auto _ : state) {
        contest.round();
        state.SetIterationTime(contest.last(0));
    }
    const double ours = contest.quickest(0);
    const auto edges = static_cast<double>(test.edges);
    const double share = ours / (edges * std::log(edges));
    if (test.layers.size() <= kViews[0]) share_before = share;
    state.counters["ours_ms"] = 1000 * ours;
    const auto other = [&](std::size_t way, const char* name) {
        if (way == 0) return bench::cell("-", 10) + bench::cell("-", 8);
        const double taken = contest.quickest(way);
        state.counters[name] = 1000 * taken;
        return bench::cell(1000 * taken, 3, 10) + bench::cell(taken / ours, 2, 8);
    };
    std::string row = bench::leftCell(test.scene, 12) +
                      bench::cell(static_cast<double>(test.layers.size()), 0, 6) +
                      bench::cell(edges, 0, 8) + bench::cell(1000 * ours, 3, 9);
    row += other(by_cgal, "join_ms");
    row += other(by_clipper, "clipper_ms");
    state.SetLabel(row + bench::cell(share / share_before, 2, 9));
}

/// Processor time of a call, milliseconds: the least of some.
template <typename F>
double millisecondsOf(F f) {
    double least = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 8; ++round) {
        const std::clock_t start = std::clock();
        f();
        least = std::min(least, 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return least;
}

void write(const Case& test, const std::string& folder) {
    std::string outlines;
    for (const Layer& layer : test.chord_layers) {
        std::string numbers;
        for (const CurveEdge& edge : layer.curves[0])
            numbers += (numbers.empty() ? "" : ",") + formatDouble(edge.from.x) + ',' +
                       formatDouble(edge.from.y);
        outlines += (outlines.empty() ? "[" : ",\n[") + numbers + ']';
    }
    const double ours = millisecondsOf([&] { benchmark::DoNotOptimize(depthsOf(test.layers)); });
    const double kept = millisecondsOf([&] {
        const Overlay overlay(test.layers);
        benchmark::DoNotOptimize(overlay.edges().data());
    });
    writeAll(folder + '/' + test.scene + '-' + std::to_string(test.layers.size()) + ".json",
             "{\"depths_ms\":" + formatDouble(ours) + ",\"overlay_ms\":" + formatDouble(kept) +
                 ",\"area\":" + formatDouble(depthsOf(test.chord_layers)[0]) + ",\"outlines\":[\n" +
                 outlines + "]}\n");
}

std::vector<Case> makeCases() {
    std::vector<Case> cases;
    for (const int side : {5, 2}) {
        const Scene scene = bench::officeScene(side, side);
        for (const std::size_t count : kViews)
            cases.push_back(makeCase("office-" + std::to_string(side * side), scene, count));
    }
    return cases;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 3 && std::strcmp(argv[1], "--write") == 0) {
        for (const Case& test : makeCases()) write(test, argv[2]);
        return 0;
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const std::vector<Case> cases = makeCases();
    for (const Case& test : cases) {
        verify(test);
        benchmark::RegisterBenchmark(
            ("union/" + test.scene + '/' + std::to_string(test.layers.size())).c_str(),
            [&test](benchmark::State& state) { measure(state, test); })
            ->UseManualTime()
            ->Iterations(20)
            ->Unit(benchmark::kMillisecond);
    }
    bench::TableReporter reporter(
        {{"union",
          "Union of k views (4 m, 180 degrees): milliseconds for its area and that of all depths\n"
          "by forEachArea, for the union alone by CGAL::join and by Clipper 6, their ratios, and\n"
          "how the time grows beside n log n of the edges (chords included)\n" +
              bench::leftCell("scene", 12) + bench::cell("k", 6) + bench::cell("edges", 8) +
              bench::cell("layers", 9) + bench::cell("CGAL", 10) + bench::cell("ratio", 8) +
              bench::cell("Clipper", 10) + bench::cell("ratio", 8) + bench::cell("growth", 9)}});
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
}
