// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <variant>

#include "base/number.h"
#include "coverage/metrics.h"
#include "coverage/robustness.h"
#include "env/level.h"
#include "geom/predicates.h"
#include "record/schema.h"
#include "sense/scan.h"

namespace ispace {

namespace {

constexpr int kAttempts = 8;

/// Returns true if the open segments cross, each with its ends strictly on both sides of the other.
bool cross(const Segment2& s, const Segment2& t) {
    const auto divides = [](const Segment2& line, const Segment2& ends) {
        const Turn a = orientation(line.a, line.b, ends.a), b = orientation(line.a, line.b, ends.b);
        return a != Turn::Straight && b != Turn::Straight && a != b;
    };
    return divides(s, t) && divides(t, s);
}

bool canShift(const Level& level, Point2 from, Point2 to) {
    if (!level.isFree(to)) return false;
    bool is_clear = true;
    const Segment2 way{from, to};
    const Box2 box = bounds(way);
    level.slice().forEachLine([&](const Segment2& line) {
        if (is_clear && box.meets(bounds(line)) && cross(way, line)) is_clear = false;
    });
    return is_clear;
}

}  // namespace

MountingTolerance parseTolerance(std::string_view text) {
    const auto number = [](std::string_view word, Unit unit, double most) {
        KeySpec key;
        key.unit = unit;
        const double value = std::get<double>(parseValue(key, std::string(word)));
        if (!(value >= 0 && value <= most))
            throw UsageError('`' + std::string(word) + "` is not from 0 to " + formatDouble(most) +
                             (unit == Unit::Angle ? " degrees" : " m"));
        return value;
    };
    const auto comma = text.find(',');
    if (comma == std::string_view::npos)
        throw UsageError('`' + std::string(text) + "` is not M,DEG, such as 5cm,3deg");
    return {number(text.substr(0, comma), Unit::Length, 1),
            Angle::degrees(number(text.substr(comma + 1), Unit::Angle, 180))};
}

Pose3 mountedPose(const Environment& environment, const Sensor& sensor,
                  const MountingTolerance& tolerance, RandomKey key) {
    Pose3 pose = sensor.pose;
    if (sensor.mount || sensor.person) return pose;
    // Element 0 turns, 1 tilts, then two for each displacement.
    std::vector<float> random(2 + 2 * kAttempts);
    key.purpose = Purpose::Mounting;
    key.sensor = hashOf(sensor.id);
    draw(key, 0, {.uniform = random});
    const auto within = [&](float share) {
        return (2 * static_cast<double>(share) - 1) * tolerance.angle;
    };
    pose.heading = wrapped(pose.heading + within(random[0]));
    if (!scansSlice(sensor)) pose.tilt = pose.tilt + within(random[1]);
    if (tolerance.distance <= 0) return pose;
    const auto level = environment.level(pose.position.z);
    for (std::size_t k = 2; k < random.size(); k += 2) {
        const double distance = tolerance.distance * std::sqrt(static_cast<double>(random[k]));
        const Angle angle = Angle::degrees(360 * static_cast<double>(random[k + 1]));
        const Point2 from = pose.position.onFloor();
        const Point2 to = from + distance * Vec2{cos(angle), sin(angle)};
        if (!canShift(*level, from, to)) continue;
        pose.position.x = to.x;
        pose.position.y = to.y;
        break;
    }
    return pose;
}

double FigureSpread::quantile(double share) const {
    const auto count = static_cast<double>(values.size());
    const double rank = std::clamp(std::ceil(share * count - 1e-9), 1.0, count);
    return values[static_cast<std::size_t>(rank) - 1];
}

double FigureSpread::mean() const {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double FigureSpread::standardError() const {
    const auto count = static_cast<double>(values.size());
    if (values.size() < 2) return 0;
    double squares = 0;
    for (const double value : values) squares += (value - mean()) * (value - mean());
    return std::sqrt(squares / (count - 1) / count);
}

std::vector<Requirement> figuresOf(const CoverageReport& report,
                                   std::span<const Requirement> requirements) {
    std::vector<Requirement> figures = {{Requirement::Of::Indoor}, {Requirement::Of::Free}};
    for (const ZoneMetrics& zone : report.zones)
        figures.push_back({Requirement::Of::Zone, zone.id});
    for (Requirement requirement : requirements) {
        requirement.share = 0;
        if (std::find(figures.begin(), figures.end(), requirement) == figures.end())
            figures.push_back(requirement);
    }
    return figures;
}

SampledFigures sampleFigures(const CoverageReport& planned,
                             std::span<const Requirement> requirements, int samples,
                             const std::function<Coverage(int)>& measured, Progress& progress) {
    SampledFigures sampled{0, {}, std::vector<int>(requirements.size())};
    for (const Requirement& figure : figuresOf(planned, requirements)) {
        RequiredFigure known = figureOf(figure, planned);
        if (!known.share.exact && !known.share.grid) continue;
        sampled.figures.push_back({figure, std::move(known.name),
                                   known.share.exact ? *known.share.exact : *known.share.grid,
                                   known.share.exact.has_value()});
    }
    for (int k = 0; k < samples && (k == 0 || !progress.stopped()); ++k) {
        const Coverage now = measured(k);
        for (FigureSpread& figure : sampled.figures) {
            const Metric share = figureOf(figure.figure, now.report).share;
            // The overlay of a sample may have too many crossings; cells are left, then.
            figure.is_exact &= share.exact.has_value();
            figure.values.push_back(share.exact.value_or(share.grid.value_or(0)));
        }
        for (std::size_t i = 0; i < requirements.size(); ++i)
            sampled.met[i] += checkRequirement(requirements[i], now).is_met ? 1 : 0;
        ++sampled.samples;
        progress.advance(1);
    }
    for (FigureSpread& figure : sampled.figures)
        std::sort(figure.values.begin(), figure.values.end());
    return sampled;
}

SampledFigures perturbMounting(const Scene& scene, const CoverageReport& planned,
                               const CoverageOptions& measure, const MountingTolerance& tolerance,
                               int mountings, std::uint64_t seed,
                               std::span<const Requirement> requirements, Progress& progress) {
    CoverageOptions options = measure;
    options.keep_depths = false;
    options.parallax.reset();
    RayScenes worlds(scene.environment);
    Scene mounted = scene;
    progress.begin("mountings", mountings);
    const auto measured = [&](int mounting) {
        const RandomKey key{.seed = seed, .frame = static_cast<std::uint64_t>(mounting)};
        for (std::size_t i = 0; i < scene.sensors.size(); ++i)
            mounted.sensors[i].pose =
                mountedPose(scene.environment, scene.sensors[i], tolerance, key);
        return measureCoverage(mounted, worlds, options);
    };
    SampledFigures sampled = sampleFigures(planned, requirements, mountings, measured, progress);
    progress.end();
    return sampled;
}

}  // namespace ispace
