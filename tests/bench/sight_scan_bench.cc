// SPDX-License-Identifier: GPL-3.0-or-later
// Two ways to read a level laser: the beam kernels of FlatWorld, and samples of the visibility
// region about the sensor (one query, one merge of its edges with the beams by angle).
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>

#include "base/simd.h"
#include "bench_scenes.h"
#include "bench_table.h"
#include "geom/visibility/visibility.h"
#include "sense/scan.h"
#include "trace/flat_kernels.h"
#include "trace/flat_world.h"

namespace {

using namespace ispace;

constexpr int kRounds = 30;
constexpr std::size_t kPoses = 400, kFixed = 8;
/// Padding beyond the last beam, so that loops need no remainder.
constexpr std::size_t kLanes = 8;

/// Beams from that of (ahead) to where each edge begins, counter-clockwise.
ISPACE_SIMD_CLONES
void measureTurns(const VisibilityEdge* edges, std::size_t count, Point2 viewpoint, Vec2 ahead,
                  double beams_per_radian, double* turns) {
    for (std::size_t i = 0; i < count; ++i) {
        const double x = edges[i].from.x - viewpoint.x, y = edges[i].from.y - viewpoint.y;
        const double angle = angleOf(x * ahead.x + y * ahead.y, y * ahead.x - x * ahead.y);
        turns[i] = (angle < 0 ? angle + 2 * std::numbers::pi : angle) * beams_per_radian;
    }
}

/// Writes inverse ranges to a line in whole vectors: later lines overwrite the padding.
ISPACE_SIMD_CLONES
void drawLine(double* out, const double* x, const double* y, std::size_t count, double ux,
              double uy) {
    for (std::size_t begin = 0; begin < count; begin += kLanes)
        ISPACE_LANES for (std::size_t i = 0; i < kLanes; ++i) out[begin + i] =
            x[begin + i] * uy - y[begin + i] * ux;
}

ISPACE_SIMD_CLONES
void invert(const double* inverse, std::size_t count, float limit, float* ranges) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto range = static_cast<float>(1 / inverse[i]);
        ranges[i] = range;
        if (!(range <= limit && range >= 0)) ranges[i] = kNoReturn;
    }
}

/// Samples a region along beams at equal steps counter-clockwise.
class Sampler {
  public:
    Sampler(std::span<const Segment2> lines, std::span<const Ellipse> rounds)
        : tree_(lines, rounds), first_round_(lines.size()) {}

    void sample(const VisibleRegion& region, const Directions& directions, double max_range,
                std::span<float> ranges) {
        const std::size_t beams = ranges.size(), count = region.edges.size();
        if (count == 0) return std::fill(ranges.begin(), ranges.end(), kNoReturn);
        x_ = directions.x.data();
        y_ = directions.y.data();
        const double step = directions.arc->step.radians();
        turns_.resize(count);
        inverse_range_.resize(beams + kLanes);
        measureTurns(region.edges.data(), count, region.viewpoint, {x_[0], y_[0]}, 1 / step,
                     turns_.data());
        const auto least = std::min_element(turns_.begin(), turns_.end());
        std::size_t edge = static_cast<std::size_t>(least - turns_.begin());
        std::size_t begin = firstBeam(region, edge, step, beams);
        draw(region, edge == 0 ? count - 1 : edge - 1, 0, begin);
        for (std::size_t k = 0; k < count && begin < beams; ++k) {
            const std::size_t next = edge + 1 < count ? edge + 1 : 0;
            const std::size_t end = k + 1 == count ? beams : firstBeam(region, next, step, beams);
            draw(region, edge, begin, end);
            begin = std::max(begin, end);
            edge = next;
        }
        invert(inverse_range_.data(), beams, static_cast<float>(max_range), ranges.data());
    }

  private:
    /// Not before an edge's begin: decided exactly where the angle is too coarse for that.
    [[nodiscard]] std::size_t firstBeam(const VisibleRegion& region, std::size_t edge, double step,
                                        std::size_t beams) const {
        constexpr double kSlack = 2.5e-5;  // radians
        const double at = turns_[edge], nearest = std::round(at);
        if (std::fabs(at - nearest) > kSlack / step)
            return std::min(static_cast<std::size_t>(std::ceil(at)), beams);
        const auto beam = static_cast<std::size_t>(nearest);
        if (beam >= beams) return beams;
        const Vec2 way = region.edges[edge].from - region.viewpoint;
        return way.x * y_[beam] - way.y * x_[beam] < 0 ? beam + 1 : beam;
    }
    void draw(const VisibleRegion& region, std::size_t index, std::size_t begin, std::size_t end) {
        if (begin >= end) return;
        const VisibilityEdge& edge = region.edges[index];
        if (edge.line == VisibilityEdge::kArc) {
            std::fill_n(inverse_range_.data() + begin, end - begin, -1.0);
        } else if (edge.line >= first_round_) {
            const RoundFrom round(tree_.rounds[edge.line - first_round_], region.viewpoint.x,
                                  region.viewpoint.y, kRayEpsilon);
            for (std::size_t i = begin; i < end; ++i)
                inverse_range_[i] = round.meet<false>(x_[i], y_[i]).inverse_range;
        } else {
            const Vec2 a = edge.from - region.viewpoint, along = edge.to - edge.from;
            const double over = 1 / cross(a, along);
            drawLine(inverse_range_.data() + begin, x_ + begin, y_ + begin, end - begin,
                     along.x * over, along.y * over);
        }
    }

    FlatTree tree_;
    std::size_t first_round_;
    std::vector<double> turns_, inverse_range_;
    const double *x_ = nullptr, *y_ = nullptr;
};

struct Beamed {
    std::string name;
    int beams;
    double first, step, range;  // degrees, metres
};
const Beamed kLasers[] = {{"1081, 30 m", 1081, -135, 0.25, 30}, {"181, 8 m", 181, -90, 1, 8},
                          {"181, 2 m", 181, -90, 1, 2},         {"10, 30 m", 10, -45, 10, 30},
                          {"10, 4 m", 10, -45, 10, 4},          {"1, 4 m", 1, 0, 1, 4}};

/// A slice with or without its round bodies, ready for both ways.
struct Plan {
    std::string name;
    std::vector<Segment2> lines;
    std::vector<Ellipse> rounds;
    std::vector<Sensor> places;
    std::optional<FlatWorld> world;
    std::optional<VisibilityMap> sight;
    double world_bytes = 0, sight_bytes = 0;

    Plan(std::string title, const Scene& scene, bool has_rounds)
        : name(std::move(title)), places(bench::fans(scene, kPoses, true)) {
        const Slice slice = scene.environment.slice(places.front().pose.position.z);
        lines = slice.straightLines();
        if (has_rounds) rounds = slice.curves();
        const auto used = [] {
            const auto info = mallinfo2();
            return static_cast<double>(info.uordblks + info.hblkhd);
        };
        const double begin = used();
        world.emplace(lines, rounds);
        const double between = used();
        sight.emplace(lines, rounds);
        world_bytes = between - begin;
        sight_bytes = used() - between;
    }
    [[nodiscard]] std::string cells() const {
        return bench::leftCell(name, 12) + bench::cell(static_cast<double>(lines.size()), 0, 7) +
               bench::cell(static_cast<double>(rounds.size()), 0, 7);
    }
};

/// A laser at points of a plan, read in every way.
class Reader {
  public:
    Reader(const Plan& plan, const Beamed& laser)
        : plan_(plan),
          range_(laser.range),
          ranges_(static_cast<std::size_t>(laser.beams)),
          tree_(plan.lines, plan.rounds),
          sampler_(plan.lines, plan.rounds) {
        for (Sensor sensor : plan.places) {
            sensor.as<Laser>().beams = laser.beams;
            sensor.as<Laser>().first = Angle::degrees(laser.first);
            sensor.as<Laser>().step = Angle::degrees(laser.step);
            Directions directions = Beams(sensor.as<Laser>(), true).at(sensor.pose);
            for (auto* part : {&directions.x, &directions.y, &directions.z})
                part->reserve(part->size() + kLanes);
            directions_.push_back(std::move(directions));
            const Point2 place = sensor.pose.position.onFloor();
            std::vector<Point2>& moving = moving_.emplace_back(ranges_.size(), place);
            for (std::size_t k = 0; k < moving.size(); ++k)
                moving[k].x += 2.5e-5 * static_cast<double>(k);
        }
    }
    [[nodiscard]] Point2 place(std::size_t i) const {
        return plan_.places[i].pose.position.onFloor();
    }
    const std::vector<float>& cast(std::size_t i) {
        plan_.world->cast(place(i), directions_[i], range_, kRayEpsilon, ranges_, {});
        return ranges_;
    }
    void castMoving(std::size_t i) {
        plan_.world->cast(moving_[i], directions_[i], range_, kRayEpsilon, ranges_, {});
    }
    void castMovingSingly(std::size_t i) {
        for (std::size_t k = 0; k < ranges_.size(); ++k) {
            const FlatView view{moving_[i][k].x, moving_[i][k].y, kRayEpsilon};
            const FlatHit hit =
                firstLine(tree_, view, directions_[i].x[k], directions_[i].y[k], 1 / range_);
            ranges_[k] = static_cast<float>(1 / hit.inverse_range);
        }
    }
    void query(std::size_t i) { plan_.sight->query(place(i), range_, region_); }
    const std::vector<float>& sample(std::size_t i) {
        query(i);
        sampler_.sample(region_, directions_[i], range_, ranges_);
        return ranges_;
    }

  private:
    const Plan& plan_;
    double range_;
    std::vector<Directions> directions_;
    std::vector<std::vector<Point2>> moving_;
    std::vector<float> ranges_;
    FlatTree tree_;
    Sampler sampler_;
    VisibleRegion region_;
};

void verify(const Plan& plan, const Beamed& laser) {
    Reader reader(plan, laser);
    for (std::size_t i = 0; i < kPoses; ++i) {
        const std::vector<float> kernel = reader.cast(i);
        bench::mustAgree(plan.name + ' ' + laser.name, reader.sample(i), kernel);
    }
}

void measureScans(benchmark::State& state, const Plan& plan, const Beamed& laser, bool is_fixed) {
    Reader reader(plan, laser);
    const std::size_t poses = is_fixed ? kFixed : kPoses;
    bench::Contest contest;
    const auto add = [&](auto way) {
        contest.add([=] {
            for (std::size_t i = 0; i < kPoses; ++i) way(i % poses);
        });
    };
    add([&reader](std::size_t i) { reader.cast(i); });
    add([&reader](std::size_t i) { reader.sample(i); });
    add([&reader](std::size_t i) { reader.query(i); });
    add([&reader](std::size_t i) { reader.castMoving(i); });
    add([&reader](std::size_t i) { reader.castMovingSingly(i); });
    for (auto _ : state) {
        contest.round();
        state.SetIterationTime(contest.last(0));
    }
    std::string row = plan.cells() + "  " + bench::leftCell(laser.name, 11) +
                      bench::leftCell(is_fixed ? "fixed" : "moving", 6);
    for (std::size_t way = 0; way < 5; ++way)
        row += bench::cell(contest.quickest(way) / kPoses * 1e6, 2, 8);
    state.SetLabel(row + bench::cell(contest.quickest(1) / contest.quickest(0), 2, 7));
}

void measureSetUp(benchmark::State& state, const Plan& plan) {
    bench::Contest contest;
    contest.add([&plan] { const FlatWorld world(plan.lines, plan.rounds); });
    contest.add([&plan] { const VisibilityMap sight(plan.lines, plan.rounds); });
    for (auto _ : state) {
        contest.round();
        state.SetIterationTime(contest.last(0));
    }
    state.SetLabel(plan.cells() + bench::cell(contest.quickest(0) * 1e3, 2, 8) +
                   bench::cell(contest.quickest(1) * 1e3, 2, 8) +
                   bench::cell(plan.world_bytes / 1e6, 2, 8) +
                   bench::cell(plan.sight_bytes / 1e6, 2, 8));
}

void addScans(const Plan& plan) {
    for (const Beamed& laser : kLasers) {
        verify(plan, laser);
        for (const bool is_fixed : {true, false})
            benchmark::RegisterBenchmark(("scan/" + plan.name).c_str(),
                                         [&plan, &laser, is_fixed](benchmark::State& state) {
                                             measureScans(state, plan, laser, is_fixed);
                                         })
                ->UseManualTime()
                ->Iterations(kRounds);
    }
}

void addSetUp(const Plan& plan) {
    benchmark::RegisterBenchmark(("set-up/" + plan.name).c_str(),
                                 [&plan](benchmark::State& state) { measureSetUp(state, plan); })
        ->UseManualTime()
        ->Iterations(5);
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    std::vector<std::unique_ptr<Plan>> plans;
    const auto make = [&plans](const std::string& name, const Scene& scene) {
        for (const bool has_rounds : {false, true})
            plans.push_back(std::make_unique<Plan>(name, scene, has_rounds));
    };
    make("hall", bench::loadScene(bench::sceneFile("hall.env")));
    make("office-48", bench::officeScene(8, 6));
    make("office-1840", bench::officeScene(46, 40));
    for (const auto& plan : plans) addScans(*plan);
    for (const auto& plan : plans) addSetUp(*plan);
    const std::string first =
        bench::leftCell("plan", 12) + bench::cell("lines", 7) + bench::cell("rounds", 7);
    bench::TableReporter reporter(
        {{"scan",
          "Microseconds a scan: beam kernel, region sampled, its query alone; from a moving "
          "sensor in packets and ray by ray; region / kernel\n" +
              first + "  " +
              bench::headOf({{"laser", -11},
                             {"poses", -6},
                             {"kernel", 8},
                             {"region", 8},
                             {"query", 8},
                             {"packets", 8},
                             {"single", 8},
                             {"ratio", 7}})},
         {"set-up",
          "Set-up, ms and MB\n" + first +
              bench::headOf({{"kernel", 8}, {"region", 8}, {"kernel", 8}, {"region", 8}})}});
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
}
