// SPDX-License-Identifier: GPL-3.0-or-later
// The scan tool as a process, from a file of poses to /dev/null, in each of its formats.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>

#include "base/file.h"
#include "base/number.h"
#include "bench_scenes.h"
#include "bench_table.h"
#include "embree_raw.h"
#include "geom/rotation.h"
#include "sense/depth.h"
#include "sense/trajectory.h"
#include "tool_run.h"

namespace {

using namespace ispace;

constexpr int kRounds = 3;
constexpr std::size_t kPlaces = 500;
constexpr std::size_t kChecked = 200;  // poses

using bench::Folder;
using bench::Spent;

Spent runScan(std::vector<std::string> words, const std::string& output) {
    words.insert(words.begin(), {ISPACE_SCAN_TOOL, "-q"});
    return bench::runTool(std::move(words), output);
}

/// A scene on disk, and files of poses in its free floor.
class Case {
  public:
    Case(std::string title, std::string scene_file, const std::string& folder)
        : name(std::move(title)), file(std::move(scene_file)), prefix_(folder + '/' + name) {
        const Scene scene = bench::loadScene(file);
        lines = bench::linesOf(scene);
        triangles = bench::RawTriangles(scene.environment).size();
        level_ = bench::fans(scene, kPlaces, true);
        tilted_ = bench::fans(scene, kPlaces, false);
    }

    /// A file of so many poses, drawn from a fixed seed; made when first asked for.
    [[nodiscard]] std::string poses(std::size_t count, bool level) const {
        std::string file_name =
            prefix_ + (level ? "-level-" : "-tilted-") + std::to_string(count) + ".tum";
        if (std::filesystem::exists(file_name)) return file_name;
        const std::vector<Sensor>& places = level ? level_ : tilted_;
        std::mt19937_64 random(7);
        std::uniform_real_distribution<double> heading(-180, 180);
        std::string text;
        for (std::size_t i = 0; i < count; ++i) {
            Pose3 pose = places[i % kPlaces].pose;
            pose.heading = Angle::degrees(heading(random));
            const Eigen::Quaterniond turn = quaternionOf(pose);
            text += std::to_string(i);
            for (const double number : {pose.position.x, pose.position.y, pose.position.z, turn.x(),
                                        turn.y(), turn.z(), turn.w()})
                text.append(" ").append(formatDouble(number));
            text += '\n';
        }
        writeAll(file_name, text);
        return file_name;
    }

    std::string name, file;
    std::size_t lines = 0, triangles = 0;

  private:
    std::string prefix_;
    std::vector<Sensor> level_, tilted_;
};

/// One way to use the tool.
struct Use {
    std::string format;
    bool noisy = true;
    std::size_t poses = 0;  ///< as many as one core does in a few tenths of a second
    std::string model = "utm-30lx";
    bool level = true;

    [[nodiscard]] std::vector<std::string> words(const Case& test, std::size_t count,
                                                 int threads) const {
        const std::string noise = noisy ? "--noise" : "--no-noise";
        return {test.file, "--poses", test.poses(count, level), "--model", model, "--to", format,
                noise,     "-j",      std::to_string(threads)};
    }
};

/// The tool writes, bit by bit, the readings of a caster at the poses of the file.
void verify(const Case& test, const std::string& folder) {
    for (const bool noisy : {false, true}) {
        const Use use{"raw", noisy, kChecked};
        const std::string output = folder + "/checked";
        runScan(use.words(test, kChecked, 2), output);
        const std::string bytes = readAll(output);
        const Scene scene = bench::loadScene(test.file);
        const Sensor sensor{"laser1", bench::laserOfModel(use.model), {}};
        RayScenes worlds(scene.environment);
        const MovingBodies nobody;
        ReadingOptions options;
        if (noisy) options.noise_seed = 0;
        LaserCaster caster(worlds, nobody, sensor, true, options);
        std::string expected;
        Scan scan;
        const std::string text = readAll(test.poses(kChecked, true));
        for (std::size_t begin = 0; begin < text.size(); begin = text.find('\n', begin) + 1) {
            const std::string_view line =
                std::string_view(text).substr(begin, text.find('\n', begin) - begin);
            scan.pose = parseTumLine(line)->pose;
            worlds.prepare(scan.pose);
            caster.cast(scan);
            expected.append(reinterpret_cast<const char*>(scan.ranges.data()),
                            scan.ranges.size() * sizeof(float));
            ++scan.frame;
        }
        if (bytes == expected) continue;
        std::fprintf(stderr, "%s: scan writes other ranges than its library gives\n",
                     test.name.c_str());
        std::exit(1);
    }
}

/// The quickest of some runs each with one thread and two, and of those with one pose.
struct Times {
    Spent start[2], whole[2];
    double others = 0;  ///< cores that others had during the quickest run with two threads

    /// Of the readings alone.
    [[nodiscard]] double wall(int threads) const {
        return whole[threads - 1].wall - start[threads - 1].wall;
    }
    [[nodiscard]] double processor(int threads) const {
        return whole[threads - 1].processor - start[threads - 1].processor;
    }
};

Times timesOf(benchmark::State& state, const Case& test, const Use& use) {
    Times times;
    for (auto _ : state) {
        for (const int threads : {1, 2}) {
            times.start[threads - 1].keepQuicker(runScan(use.words(test, 1, threads), "/dev/null"));
            const bench::Others others;
            const Spent spent = runScan(use.words(test, use.poses, threads), "/dev/null");
            if (threads == 2 && spent.wall < times.whole[1].wall) times.others = others.cores();
            times.whole[threads - 1].keepQuicker(spent);
        }
        state.SetIterationTime(times.whole[1].wall);
    }
    return times;
}

/// Bytes of output for each reading.
double bytesOf(const Case& test, const Use& use, const std::string& folder) {
    const std::string output = folder + "/counted";
    const std::size_t count = use.poses / 100 + 1;
    runScan(use.words(test, count, 2), output);
    return static_cast<double>(std::filesystem::file_size(output)) / static_cast<double>(count);
}

/// Rates are of `parts` of each reading, in units of `unit`.
void measure(benchmark::State& state, const Case& test, const Use& use, double parts, double unit,
             double bytes) {
    const Times times = timesOf(state, test, use);
    const double all = parts * static_cast<double>(use.poses);
    const double one = all / times.wall(1), two = all / times.wall(2);
    const double core = all / times.processor(2);
    state.counters["one_thread"] = one;
    state.counters["two_threads"] = two;
    state.counters["a_core"] = core;
    state.counters["others"] = times.others;
    state.counters["megabytes"] = times.whole[1].memory;
    state.counters["start_seconds"] = times.start[0].wall;
    const std::size_t primitives = use.level ? test.lines : test.triangles;
    state.counters["primitives"] = static_cast<double>(primitives);
    state.SetLabel(
        bench::leftCell(test.name, 12) + bench::cell(static_cast<double>(primitives), 0, 8) + "  " +
        bench::leftCell(use.format, 7) + bench::leftCell(use.noisy ? "noise" : "", 6) +
        bench::cell(one / unit, 1, 8) + bench::cell(two / unit, 1, 8) +
        bench::cell(two / one, 2, 6) + bench::cell(core / unit, 1, 8) +
        bench::cell(bytes / parts, 1, 10) + bench::cell(1e-6 * one * bytes / parts, 0, 6) +
        bench::cell(1000 * times.start[0].wall, 0, 7) + bench::cell(times.whole[1].memory, 0, 8) +
        bench::cell(times.others, 1, 8));
}

std::string heading(const std::string& what, const std::string& primitives) {
    return what + "\n" + bench::leftCell("scene", 12) + bench::cell(primitives, 8) + "  " +
           bench::leftCell("format", 7) + bench::leftCell("noise", 6) + bench::cell("-j 1", 8) +
           bench::cell("-j 2", 8) + bench::cell("times", 6) + bench::cell("a core", 8) +
           bench::cell("bytes", 10) + bench::cell("MB/s", 6) + bench::cell("start", 7) +
           bench::cell("memory", 8) + bench::cell("others", 8);
}

void add(const std::string& group, const Case& test, const Use& use, double parts, double unit,
         const std::string& folder) {
    const std::string name =
        group + '/' + test.name + '/' + use.format + (use.noisy ? "/noise" : "");
    benchmark::RegisterBenchmark(name.c_str(),
                                 [&test, use, parts, unit, folder](benchmark::State& state) {
                                     measure(state, test, use, parts, unit,
                                             bytesOf(test, use, folder));
                                 })
        ->UseManualTime()
        ->Iterations(kRounds)
        ->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const Folder folder;
    const auto made = [&folder](const std::string& name, const std::string& text) {
        const std::string file = folder.name + '/' + name + ".env";
        writeAll(file, text);
        return Case(name, file, folder.name);
    };
    const auto shipped = [&folder](const std::string& name) {
        return Case(name, bench::sceneFile(name + ".env"), folder.name);
    };
    const Case level[] = {shipped("hall"), made("office-48", bench::officeText(8, 6)),
                          made("office-1840", bench::officeText(46, 40))};
    const Case high[] = {made("walls-6", bench::building(6).text), shipped("crowded"),
                         made("office-100", bench::officeText(10, 10))};
    const double beams = bench::laserOfModel("utm-30lx").beams;
    for (const Case& test : level) {
        verify(test, folder.name);
        for (const Use& use :
             {Use{"raw", false, 60000}, Use{"raw", true, 40000}, Use{"jsonl", false, 10000},
              Use{"jsonl", true, 16000}, Use{"csv", true, 2000}, Use{"carmen", true, 16000},
              Use{"pcd", true, 6000}, Use{"ply", true, 6000}})
            add("scan", test, use, beams, 1e6, folder.name);
    }
    for (const Case& test : high)
        add("tilted", test, Use{"raw", true, 16000, "utm-30lx", false}, beams, 1e6, folder.name);
    for (const Case& test : high)
        add("depth", test, Use{"raw", true, 60, "kinect-v1", false}, 1, 1, folder.name);
    bench::TableReporter reporter(
        {{"scan", heading("scan --poses to /dev/null, level: million beams a second, bytes a beam, "
                          "start in milliseconds, memory of two threads in megabytes",
                          "lines")},
         {"tilted", heading("The same tilted", "triang.")},
         {"depth", heading("Depth pictures of 640 x 480 (kinect-v1): pictures a second, bytes a "
                           "picture",
                           "triang.")}});
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
}
