// SPDX-License-Identifier: GPL-3.0-or-later
// Small kernels with a large share of the time: PNG, beside libpng's own choice of filters and
// level, which is Cairo's, too; random numbers of noise, beside plain C++ for any processor;
// welding equal corners of mesh files, beside sorting; and level fans in small plans, beside a
// kernel in float32.
#include <png.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <random>

#include "base/number.h"
#include "base/random.h"
#include "bench_scenes.h"
#include "bench_table.h"
#include "embree_raw.h"
#include "fan_prototype.h"
#include "geom/planar_map.h"
#include "raster/codec.h"
#include "report/map/map.h"
#include "report/reading_picture.h"
#include "sense/depth.h"
#include "sense/photo.h"
#include "sense/scan.h"
#include "trace/flat_world.h"
#include "trace/render/render.h"

namespace {

using namespace ispace;

constexpr int kRounds = 5, kFanRounds = 100;

void fail(const std::string& name) {
    std::fprintf(stderr, "%s: both ways differ\n", name.c_str());
    std::exit(1);
}

/// Prints both times, how much quicker ours is, and more.
void measure(benchmark::State& state, bench::Contest& contest, const std::string& name, double unit,
             const std::string& more) {
    for (auto _ : state) {
        contest.round();
        state.SetIterationTime(contest.last(0));
    }
    const double ours = contest.quickest(0), other = contest.quickest(1);
    state.counters["ours"] = ours;
    state.counters["other"] = other;
    state.SetLabel(bench::leftCell(name, 34) + bench::cell(ours / unit, 2, 9) +
                   bench::cell(other / unit, 2, 9) + bench::cell(other / ours, 2, 8) + more);
}

/// A picture with libpng's defaults.
std::string pngByDefault(const Image& image) {
    std::string bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &bytes,
        [](png_structp to, png_bytep data, std::size_t size) {
            static_cast<std::string*>(png_get_io_ptr(to))
                ->append(reinterpret_cast<const char*>(data), size);
        },
        [](png_structp) {});
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
                 static_cast<png_uint_32>(image.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    png_set_filler(png, 0, PNG_FILLER_AFTER);
    png_set_bgr(png);
    for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y)
        png_write_row(png, reinterpret_cast<png_const_bytep>(
                               &image.pixels[y * static_cast<std::size_t>(image.width)]));
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

/// A picture, and how it is written.
struct Drawn {
    std::string name;
    Image image;
    bool has_light = false;

    [[nodiscard]] std::string encoded() const {
        return has_light ? pngOfShades(image.width, image.height, image.pixels) : encodePng(image);
    }
};

Image mapOf(int width) {
    Scene scene = bench::officeScene(8, 6);
    scene.sensors = bench::fans(scene, 24, true);
    for (std::size_t i = 0; i < scene.sensors.size(); ++i)
        scene.sensors[i].id = "l" + std::to_string(i);
    RayScenes worlds(scene.environment);
    const Coverage coverage = measureCoverage(scene, worlds, {});
    return decodePng(drawCoverageMap(scene, coverage, {.width = width}));
}

Image depthsOf(bool noisy) {
    const Scene scene = bench::loadScene(bench::sceneFile("crowded.env"));
    const Sensor ranger{"r1", bench::rangerOfModel("kinect-v1"), {}};
    const RayWorld world = RayWorld::ofEnvironment(scene.environment);
    ReadingOptions options;
    if (noisy) options.noise_seed = 0;
    const DepthFrame frame = castDepth(world, MovingBodies(), ranger,
                                       bench::fans(scene, 1, false).front().pose, 0, options);
    return decodePng(colorDepthPng(ranger, frame, {}));
}

Image photoOf(bool noisy) {
    const Scene scene = bench::loadScene(bench::sceneFile("open-office.env"));
    const Photographer photographer(scene, {.with_noise = noisy});
    Camera camera;
    camera.columns = 640;
    camera.rows = 480;
    camera.fx = camera.fy = 400;
    camera.cx = 319.5;
    camera.cy = 239.5;
    const Photo photo = photographer.take({"c1", camera, {}}, {{0, 0, 1.2}, {}, {}, {}}, 0);
    Image image{camera.columns, camera.rows, {}};
    for (std::size_t i = 0; i < photo.rgb.size(); i += 3)
        image.pixels.push_back(std::uint32_t{photo.rgb[i]} << 16U |
                               std::uint32_t{photo.rgb[i + 1]} << 8U | photo.rgb[i + 2]);
    return image;
}

void measurePng(benchmark::State& state, const Drawn& drawn) {
    const std::string ours = drawn.encoded(), other = pngByDefault(drawn.image);
    if (decodePng(ours).pixels != drawn.image.pixels) fail(drawn.name);
    bench::Contest contest;
    contest.add([&] { benchmark::DoNotOptimize(drawn.encoded()); });
    contest.add([&] { benchmark::DoNotOptimize(pngByDefault(drawn.image)); });
    const auto size = static_cast<double>(ours.size());
    measure(
        state, contest, drawn.name, 1e-3,
        bench::cell(size / 1000, 0, 8) +
            bench::cell(formatFixed(100 * (size / static_cast<double>(other.size()) - 1), 1) + " %",
                        10));
}

void measureDraws(benchmark::State& state, std::size_t function) {
    using namespace random_loops;
    constexpr std::size_t kCount = 1U << 20U;
    const std::span<const GroupFunction> functions = groupFunctions();
    const Philox philox{1, 2, 3, 4, 5};
    using Words = std::vector<std::uint32_t>;
    const auto compute = [&](GroupFunction group, Words& a, Words& b, Words& c) {
        for (std::uint32_t i = 0; i < a.size(); i += kGroup) group(philox, i, &a[i], &b[i], &c[i]);
    };
    Words words[6];
    for (Words& list : words) list.resize(kCount);
    bench::Contest contest;
    contest.add([&] { compute(functions[function], words[0], words[1], words[2]); });
    contest.add([&] { compute(functions.back(), words[3], words[4], words[5]); });
    const std::string name =
        "words, " +
        (function + 1 == functions.size() ? "plain C++" : "way " + std::to_string(function + 1));
    measure(state, contest, name, 1e-9 * kCount, "");
    for (std::size_t i = 0; i < 3; ++i)
        if (words[i] != words[i + 3]) fail(name);
}

/// By sorting, as firstAtPlace() does it by hashing.
std::vector<std::uint32_t> firstBySorting(const std::vector<FloatPlace>& places) {
    std::vector<std::uint32_t> order(places.size()), first(places.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t k) {
        return places[i] == places[k] ? i < k : places[i] < places[k];
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool repeats = i > 0 && places[order[i]] == places[order[i - 1]];
        first[order[i]] = repeats ? first[order[i - 1]] : order[i];
    }
    return first;
}

void measureWelding(benchmark::State& state) {
    const auto globe = bench::bumpyGlobe(500, 1000);
    std::vector<FloatPlace> corners;  // as STL has them
    for (const auto& triangle : globe->triangles)
        for (const std::uint32_t corner : triangle) corners.push_back(globe->vertices[corner]);
    if (firstAtPlace(corners) != firstBySorting(corners)) fail("corners");
    bench::Contest contest;
    contest.add([&] { benchmark::DoNotOptimize(firstAtPlace(corners)); });
    contest.add([&] { benchmark::DoNotOptimize(firstBySorting(corners)); });
    measure(state, contest, std::to_string(corners.size()) + " corners of triangles", 1e-3, "");
}

/// A room of 20 m x 15 m with this many boxes, and fans of one heading at points all over it: their
/// directions are the same and stay in the caches.
class FansInARoom {
  public:
    FansInARoom(int boxes, int beams)
        : scene_(bench::sceneOfText(textOf(boxes))),
          slice_(scene_.environment.slice(kScanHeight)),
          lines_(slice_.straightLines()),
          world_(lines_),
          prototype_(lines_),
          raw_(bench::RawEmbree::ofSlice(slice_, kScanHeight)),
          sensors_(bench::fans(scene_, 200, true)),
          ranges_(static_cast<std::size_t>(beams) + bench::FanPrototype::Fan::kBlock) {
        for (Sensor& sensor : sensors_) {
            sensor.pose.heading = {};
            auto& laser = sensor.as<Laser>();
            laser.beams = beams;
            if (beams < 1000) {
                laser.first = Angle::degrees(-90);
                laser.step = Angle::degrees(180.0 / (beams - 1));
            }
        }
        raw_.prepare(sensors_);
        directions_ = Beams(sensors_.front().as<Laser>(), false).at(sensors_.front().pose);
        fan_.emplace(directions_);
        verify();
    }

    [[nodiscard]] std::size_t lines() const { return lines_.size(); }
    /// Of all fans.
    [[nodiscard]] double beams() const {
        return static_cast<double>(sensors_.size() * directions_.size());
    }
    void castAll() {
        for (std::size_t i = 0; i < sensors_.size(); ++i) cast(i);
    }
    void castAllByPrototype() {
        for (std::size_t i = 0; i < sensors_.size(); ++i) castByPrototype(i);
    }
    void castAllByEmbree() { raw_.trace(0, raw_.packets()); }

  private:
    static std::string textOf(int boxes) {
        std::mt19937_64 random(5);
        std::uniform_real_distribution<double> x(0.5, 19.5), y(0.5, 14.5), side(0.2, 0.7),
            turn(0, 90);
        std::string text = "#env 1\nfence path=0,0;20,0;20,15;0,15 closed=yes\n";
        for (int i = 0; i < boxes; ++i) {
            text += "cube at=" + formatDouble(x(random)) + ',' + formatDouble(y(random));
            text += " size=" + formatDouble(side(random)) + ',' + formatDouble(side(random));
            text += " heading=" + formatDouble(turn(random)) + '\n';
        }
        return text;
    }
    [[nodiscard]] Point2 place(std::size_t i) const { return sensors_[i].pose.position.onFloor(); }
    void cast(std::size_t i) {
        world_.cast(place(i), directions_, kRange, kRayEpsilon, std::span(ranges_).first(size()),
                    {});
    }
    void castByPrototype(std::size_t i) { prototype_.cast(place(i), *fan_, kRange, ranges_); }
    [[nodiscard]] std::size_t size() const { return directions_.size(); }
    void verify() {
        std::vector<float> ours, others;
        for (std::size_t i = 0; i < sensors_.size(); ++i) {
            cast(i);
            for (std::size_t k = 0; k < size(); ++k) ours.push_back(ranges_[k]);
            castByPrototype(i);
            for (std::size_t k = 0; k < size(); ++k) others.push_back(ranges_[k]);
        }
        bench::mustAgree("prototype of fans", ours, others);
        bench::mustAgree("fans", ours, raw_.ranges());
    }

    static constexpr float kRange = 30;
    Scene scene_;
    Slice slice_;
    std::vector<Segment2> lines_;
    FlatWorld world_;
    bench::FanPrototype prototype_;
    bench::RawEmbree raw_;
    std::vector<Sensor> sensors_;
    Directions directions_;
    std::optional<bench::FanPrototype::Fan> fan_;
    std::vector<float> ranges_;
};

void measureFans(benchmark::State& state, int boxes, int beams) {
    FansInARoom fans(boxes, beams);
    bench::Contest contest;
    contest.add([&] { fans.castAll(); });
    contest.add([&] { fans.castAllByPrototype(); });
    contest.add([&] { fans.castAllByEmbree(); });
    for (auto _ : state) {
        contest.round();
        state.SetIterationTime(contest.last(0));
    }
    const auto rate = [&](std::size_t way) { return fans.beams() / contest.quickest(way) / 1e6; };
    state.counters["ours"] = rate(0);
    state.counters["prototype"] = rate(1);
    state.counters["embree"] = rate(2);
    state.SetLabel(
        bench::leftCell(
            std::to_string(fans.lines()) + " lines, " + std::to_string(beams) + " beams", 34) +
        bench::cell(rate(0), 1, 9) + bench::cell(rate(1), 1, 9) +
        bench::cell(rate(0) / rate(1), 2, 8) + bench::cell(rate(2), 1, 9) +
        bench::cell(rate(0) / rate(2), 2, 8));
}

std::string heading(const std::string& what, const std::string& other, const std::string& more) {
    return bench::leftCell(what, 34) + bench::cell("ours", 9) + bench::cell(other, 9) +
           bench::cell("ratio", 8) + more;
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const auto add = [](const std::string& name, std::function<void(benchmark::State&)> run) {
        return benchmark::RegisterBenchmark(name.c_str(), std::move(run))
            ->Iterations(kRounds)
            ->UseManualTime();
    };
    const Drawn pictures[] = {
        {"map of 1200 pixels", mapOf(1200)},    {"map of 4000 pixels", mapOf(4000)},
        {"depths in colours", depthsOf(false)}, {"noisy depths in colours", depthsOf(true)},
        {"photograph", photoOf(false), true},   {"noisy photograph", photoOf(true), true}};
    for (const Drawn& drawn : pictures)
        add("png/" + drawn.name, [&](benchmark::State& state) { measurePng(state, drawn); });
    for (std::size_t i = 0; i < random_loops::groupFunctions().size(); ++i)
        add("random/" + std::to_string(i),
            [i](benchmark::State& state) { measureDraws(state, i); });
    add("weld/globe", measureWelding);
    for (const int boxes : {11, 71, 300})
        for (const int beams : {181, 1081})
            add("fans/" + std::to_string(boxes) + '/' + std::to_string(beams),
                [=](benchmark::State& state) { measureFans(state, boxes, beams); })
                ->Iterations(kFanRounds);
    bench::TableReporter table(
        {{"png", heading("PNG, milliseconds", "default",
                         bench::cell("kB", 8) + bench::cell("larger", 10))},
         {"random", heading("Philox, nanoseconds an element", "plain", "")},
         {"weld", heading("Welding, milliseconds", "sorting", "")},
         {"fans", heading("Level fans, million beams a second", "float32",
                          bench::cell("Embree", 9) + bench::cell("ratio", 8))}});
    benchmark::RunSpecifiedBenchmarks(&table);
    return 0;
}
