// SPDX-License-Identifier: GPL-3.0-or-later
// Art galleries in the folder agp of ISPACE_TEST_DATA: guards and bound over all points, beside the
// known least number and the published seconds. A bound above the known number, or a cover below
// it, is an error. Then larger ones, and with holes, that grew by a seed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/number.h"
#include "bench_table.h"
#include "extensions/cad/cad.h"
#include "extensions/proofs/gallery/gallery.h"
#include "geom/predicates.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"

namespace {

using namespace ispace;
using Clock = std::chrono::steady_clock;

/// A row of known.csv.
struct KnownGallery {
    std::string file;
    double corners = 0, guards = 0, seconds = 0;
};

class GalleryDeadline final : public Progress {
  public:
    void begin(std::string_view /*phase*/, std::int64_t /*total*/) override {}
    void advance(std::int64_t /*count*/) override {}
    void end() override {}
    [[nodiscard]] bool stopped() const override { return Clock::now() > end_; }

  private:
    Clock::time_point end_ = Clock::now() + std::chrono::minutes(1);
};

std::vector<KnownGallery> knownGalleries(const std::string& folder) {
    std::vector<KnownGallery> all;
    const std::string text = readAll(folder + "/known.csv");
    for (std::size_t begin = text.find('\n') + 1; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::vector<std::string> cells(1);
        for (const char c : text.substr(begin, end - begin)) {
            if (c == ',')
                cells.emplace_back();
            else if (c != '\r')
                cells.back() += c;
        }
        begin = end + 1;
        if (cells.size() == 4)
            all.push_back({cells[0], parseDouble(cells[1]).value(), parseDouble(cells[2]).value(),
                           parseDouble(cells[3]).value()});
    }
    return all;
}

/// A simple polygon that grew from a triangle: a point beside a random edge replaces it by two, if
/// the triangle between them holds and touches no other part. Holes are small triangles.
Region grownGallery(std::size_t corners, std::size_t holes, unsigned seed) {
    std::mt19937_64 random(seed);
    const auto share = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
    Region region{{{0, 0}, {100, 0}, {45, 90}}, {}};
    Polygon& outline = region.outline;
    const auto is_free = [&](const Polygon& triangle, std::size_t edge) {
        for (std::size_t i = 0; i < outline.size(); ++i) {
            const Point2 p = outline[i], q = outline[(i + 1) % outline.size()];
            const bool is_end = p == triangle[0] || p == triangle[2];
            if (!is_end && locate(triangle, p) != Side::Outside) return false;
            if (i == edge) continue;
            for (const Segment2& side :
                 {Segment2{triangle[0], triangle[1]}, Segment2{triangle[1], triangle[2]}})
                if (p != side.a && p != side.b && q != side.a && q != side.b &&
                    intersects({p, q}, side))
                    return false;
        }
        return true;
    };
    while (outline.size() < corners) {
        const auto edge = static_cast<std::size_t>(random() % outline.size());
        const Point2 a = outline[edge], b = outline[(edge + 1) % outline.size()];
        if (length(b - a) < 0.3) continue;
        const Point2 p =
            a + (0.2 + 0.6 * share()) * (b - a) + (1.6 * share() - 0.8) * perpendicular(b - a);
        if (orientation(a, b, p) == Turn::Straight || !is_free({a, p, b}, edge)) continue;
        outline.insert(outline.begin() + static_cast<std::ptrdiff_t>(edge) + 1, p);
    }
    while (region.holes.size() < holes) {
        const Box2 box = bounds(outline);
        const Point2 at{box.low.x + share() * box.width(), box.low.y + share() * box.depth()};
        if (region.locate(at) != Side::Inside) continue;
        double off = 10;
        region.forEachEdge([&](const Segment2& wall) { off = std::min(off, distance(at, wall)); });
        if (off < 0.5) continue;
        const double turn = 6 * share(), far = off * (0.3 + 0.5 * share());
        Polygon hole;
        for (const double corner : {0.0, -2.3, -4.1})
            hole.push_back(
                {at.x + far * std::cos(turn + corner), at.y + far * std::sin(turn + corner)});
        region.holes.push_back(std::move(hole));
    }
    return region;
}

/// Guards a floor, and prints a row. \param known 0: unknown, as the published seconds
void measureFloor(benchmark::State& state, std::span<const Region> floor,
                  const KnownGallery& known) {
    proofs::GalleryCover cover;
    double seconds = 0;
    for (auto _ : state) {
        GalleryDeadline progress;
        const auto start = Clock::now();
        cover = proofs::guardGallery(floor, progress);
        seconds = std::chrono::duration<double>(Clock::now() - start).count();
        state.SetIterationTime(seconds);
    }
    const auto guards = static_cast<double>(cover.guards.size());
    const auto bound = static_cast<double>(cover.bound);
    if (known.guards > 0 && (bound > known.guards || (guards > 0 && guards < known.guards)))
        std::exit(1);
    const bool is_known = known.guards > 0;
    state.SetLabel(bench::leftCell(known.file, 24) +
                   (is_known ? bench::cell(known.guards, 0, 6) : bench::cell("-", 6)) +
                   bench::cell(guards, 0, 6) + bench::cell(bound, 0, 6) +
                   bench::cell(seconds, 3, 9) +
                   (is_known ? bench::cell(known.seconds, 3, 9) : bench::cell("-", 9)));
}

void measure(benchmark::State& state, const std::string& folder, const KnownGallery& known) {
    const Document document = readDocument(folder + '/' + known.file, {}, sceneSchemas());
    const Scene scene = makeScene(document, nullptr, DeviceCatalogue());
    measureFloor(state, scene.environment.indoor().parts, known);
}

/// Larger galleries than the instances, and with holes: by seed.
void registerGrown() {
    struct Size {
        std::size_t corners, holes;
    };
    for (const Size size : {Size{500, 0}, {1000, 0}, {2500, 0}, {200, 5}, {500, 10}, {1000, 20}})
        for (unsigned seed = 1; seed <= 2; ++seed) {
            const std::string name = "grown-" + std::to_string(size.corners) + '-' +
                                     std::to_string(size.holes) + '-' + std::to_string(seed);
            benchmark::RegisterBenchmark(("gallery/" + name).c_str(),
                                         [size, seed, name](benchmark::State& state) {
                                             const Region region =
                                                 grownGallery(size.corners, size.holes, seed);
                                             measureFloor(state, {&region, 1}, {name, 0, 0, 0});
                                         })
                ->UseManualTime()
                ->Iterations(1)
                ->Unit(benchmark::kSecond);
        }
}

}  // namespace

int main(int argc, char** argv) {
    addImporters(cad::cadImporters());
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    registerGrown();
    const char* data = std::getenv("ISPACE_TEST_DATA");
    if (data == nullptr) std::fprintf(stderr, "gallery_bench: ISPACE_TEST_DATA is not set\n");
    const std::string folder = data == nullptr ? "" : std::string(data) + "/agp";
    for (const KnownGallery& known :
         data == nullptr ? std::vector<KnownGallery>() : knownGalleries(folder))
        benchmark::RegisterBenchmark(
            ("gallery/" + known.file).c_str(),
            [&folder, known](benchmark::State& state) { measure(state, folder, known); })
            ->UseManualTime()
            ->Iterations(1)
            ->Unit(benchmark::kSecond);
    bench::TableReporter reporter(
        {{"gallery",
          "Art galleries: known least number, guards, bound, seconds, published seconds\n" +
              bench::leftCell("instance", 24) + bench::cell("known", 6) + bench::cell("ours", 6) +
              bench::cell("bound", 6) + bench::cell("seconds", 9) + bench::cell("publ.", 9)}});
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
}
