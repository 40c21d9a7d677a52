// SPDX-License-Identifier: GPL-3.0-or-later
// How much of a floor k views cover together: the area of their union and the area seen by each
// number of them at once, by Overlay, beside the bare union by CGAL (exact kernel). Views of
// lasers (4 m, 180 degrees) at free places of offices: some 26 vertices each and arcs.
#include <CGAL/Boolean_set_operations_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench_scenes.h"
#include "bench_table.h"
#include "geom/overlay.h"
#include "geom/visibility.h"

namespace {

using namespace ispace;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPolygon = CGAL::Polygon_2<Kernel>;

constexpr double kRange = 4;
constexpr std::size_t kViews[] = {3, 10, 30, 100, 300};

/// What k views see, with arcs and with chords for them.
struct Case {
    std::string scene;
    std::vector<Layer> layers, chord_layers;
    std::vector<ExactPolygon> polygons;
    std::size_t edges = 0;
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
    Overlay(layers).addAreas([&](const LayerLabel& label, double area) {
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
    const double exact = areaOfJoin(test.polygons);
    const double chords = depthsOf(test.chord_layers)[0], arcs = depthsOf(test.layers)[0];
    const double slack = 1e-8 * exact;
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
    contest.add([&test] { benchmark::DoNotOptimize(areaOfJoin(test.polygons)); });
    for (auto _ : state) {
        contest.round();
        state.SetIterationTime(contest.last(0));
    }
    const double ours = contest.quickest(0), join = contest.quickest(1);
    const auto edges = static_cast<double>(test.edges);
    const double share = ours / (edges * std::log(edges));
    if (test.layers.size() <= kViews[0]) share_before = share;
    state.counters["ours_ms"] = 1000 * ours;
    state.counters["join_ms"] = 1000 * join;
    state.SetLabel(bench::leftCell(test.scene, 12) +
                   bench::cell(static_cast<double>(test.layers.size()), 0, 6) +
                   bench::cell(edges, 0, 8) + bench::cell(1000 * ours, 3, 9) +
                   bench::cell(1000 * join, 3, 10) + bench::cell(join / ours, 1, 8) +
                   bench::cell(share / share_before, 2, 9));
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    std::vector<Case> cases;
    for (const int side : {5, 2}) {
        const Scene scene = bench::officeScene(side, side);
        for (const std::size_t count : kViews)
            cases.push_back(makeCase("office-" + std::to_string(side * side), scene, count));
    }
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
          "Union of k views (4 m, 180 degrees): milliseconds for its area and that of all depths "
          "by\n"
          "Overlay, for the union alone by CGAL::join, their ratio, and how the time grows\n"
          "beside n log n of the edges (chords included)\n" +
              bench::leftCell("scene", 12) + bench::cell("k", 6) + bench::cell("edges", 8) +
              bench::cell("layers", 9) + bench::cell("CGAL", 10) + bench::cell("ratio", 8) +
              bench::cell("growth", 9)}});
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
}
