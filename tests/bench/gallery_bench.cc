// SPDX-License-Identifier: GPL-3.0-or-later
// Art galleries in the folder agp of ISPACE_TEST_DATA: guards and bound over all points, beside the
// known least number and the published seconds. A bound above the known number, or a cover below
// it, is an error.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "arrange/gallery/gallery.h"
#include "base/file.h"
#include "base/number.h"
#include "bench_table.h"
#include "io/importers.h"
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

void measure(benchmark::State& state, const std::string& folder, const KnownGallery& known) {
    const Document document = readDocument(folder + '/' + known.file, {}, sceneSchemas());
    const Scene scene = makeScene(document, nullptr, DeviceCatalogue());
    const std::vector<Region>& floor = scene.environment.indoor().parts;
    GalleryCover cover;
    double seconds = 0;
    for (auto _ : state) {
        GalleryDeadline progress;
        const auto start = Clock::now();
        cover = guardGallery(floor, progress);
        seconds = std::chrono::duration<double>(Clock::now() - start).count();
        state.SetIterationTime(seconds);
    }
    const auto guards = static_cast<double>(cover.guards.size());
    const auto bound = static_cast<double>(cover.bound);
    if (bound > known.guards || (guards > 0 && guards < known.guards)) std::exit(1);
    state.SetLabel(bench::leftCell(known.file, 24) + bench::cell(known.guards, 0, 6) +
                   bench::cell(guards, 0, 6) + bench::cell(bound, 0, 6) +
                   bench::cell(seconds, 3, 9) + bench::cell(known.seconds, 3, 9));
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const char* data = std::getenv("ISPACE_TEST_DATA");
    if (data == nullptr) {
        std::fprintf(stderr, "gallery_bench: ISPACE_TEST_DATA is not set\n");
        return 0;
    }
    const std::string folder = std::string(data) + "/agp";
    for (const KnownGallery& known : knownGalleries(folder))
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
