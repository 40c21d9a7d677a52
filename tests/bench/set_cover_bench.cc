// SPDX-License-Identifier: GPL-3.0-or-later
// Set covers of the OR-Library, in the folder scp of ISPACE_TEST_DATA: cost and bound after ten
// seconds, or a minute where the best known cost has been proven.
#include <cstdio>
#include <cstdlib>

#include "bench_table.h"
#include "support/test_set_cover.h"

namespace {

using namespace ispace;
using Clock = std::chrono::steady_clock;

class Deadline final : public Progress {
  public:
    explicit Deadline(double seconds)
        : end_(Clock::now() + std::chrono::milliseconds(static_cast<int>(1e3 * seconds))) {}
    void begin(std::string_view /*phase*/, std::int64_t /*total*/) override {}
    void advance(std::int64_t /*count*/) override {}
    void end() override {}
    [[nodiscard]] bool stopped() const override { return Clock::now() > end_; }

  private:
    Clock::time_point end_;
};

void measure(benchmark::State& state, const std::string& folder, const KnownCover& known) {
    const SetCover problem = readSetCover(folder + '/' + known.file);
    SetCoverOptions options;
    if (!known.is_proven) options.steps = 20'000'000;
    SetCoverResult result;
    double seconds = 0;
    for (auto _ : state) {
        Deadline progress(known.is_proven ? 60 : 10);
        const auto start = Clock::now();
        result = minimumSetCover(problem, options, progress);
        seconds = std::chrono::duration<double>(Clock::now() - start).count();
        state.SetIterationTime(seconds);
    }
    if (result.cost < known.cost || (known.is_proven && result.bound > known.cost)) std::exit(1);
    const auto count = [](std::uint64_t n) { return bench::cell(static_cast<double>(n), 0, 8); };
    state.SetLabel(bench::leftCell(known.file, 16) + count(known.cost) + count(result.cost) +
                   count(result.bound) + bench::cell(seconds, 2, 9));
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const char* data = std::getenv("ISPACE_TEST_DATA");
    if (data == nullptr) {
        std::fprintf(stderr, "set_cover_bench: ISPACE_TEST_DATA is not set\n");
        return 0;
    }
    const std::string folder = std::string(data) + "/scp";
    for (const KnownCover& known : kKnownCovers)
        benchmark::RegisterBenchmark(
            (std::string("set_cover/") + known.file).c_str(),
            [&folder, &known](benchmark::State& state) { measure(state, folder, known); })
            ->UseManualTime()
            ->Iterations(1)
            ->Unit(benchmark::kSecond);
    bench::TableReporter reporter(
        {{"set_cover", "Set covers: best known cost, ours, its bound, seconds\n" +
                           bench::leftCell("instance", 16) + bench::cell("known", 8) +
                           bench::cell("ours", 8) + bench::cell("bound", 8) +
                           bench::cell("seconds", 9)}});
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
}
