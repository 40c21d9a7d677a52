// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/robustness/figure_samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "coverage/metrics.h"
#include "scene/run/run_reader.h"
#include "trace/ray_world.h"

namespace ispace::robustness {

namespace {

double meanOf(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

double standardErrorOf(std::span<const double> values) {
    if (values.size() < 2) return 0;
    const auto count = static_cast<double>(values.size());
    const double middle = meanOf(values);
    double squares = 0;
    for (const double value : values) squares += (value - middle) * (value - middle);
    return std::sqrt(squares / (count - 1) / count);
}

double FigureSpread::quantile(double share) const {
    const auto count = static_cast<double>(values.size());
    const double rank = std::clamp(std::ceil(share * count - 1e-9), 1.0, count);
    return values[static_cast<std::size_t>(rank) - 1];
}

double FigureSpread::mean() const { return meanOf(values); }

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

Crowd crowdOf(const Scene& scene) {
    Crowd crowd;
    for (const PlacedPerson& person : scene.people)
        crowd.push_back({person.pose.position, person.height});
    return crowd;
}

std::vector<Crowd> crowdsOfRun(const std::string& folder, const Scene& scene, std::size_t most) {
    std::size_t moments = 0;
    RunReader counted(folder);
    while (counted.next()) ++moments;
    if (moments == 0) throw FormatError({counted.name(), 0, 0, "the record has no moment"});
    const auto height_of = [&scene](const std::string& id) {
        for (const PlacedPerson& person : scene.people)
            if (person.id == id) return person.height;
        return kUsualHeight;
    };
    const std::size_t count = std::min(most, moments);
    std::vector<Crowd> crowds;
    RunReader reader(folder);
    for (std::size_t moment = 0; reader.next() && crowds.size() < count; ++moment) {
        const std::size_t wanted = count == 1 ? 0 : crowds.size() * (moments - 1) / (count - 1);
        if (moment < wanted) continue;
        Crowd& crowd = crowds.emplace_back();
        for (const RunState& state : reader.states())
            if (const RunMember& member = reader.members()[state.member]; member.is_person)
                crowd.push_back({state.pose.position, height_of(member.id)});
    }
    return crowds;
}

SampledFigures measureCrowds(const Scene& scene, const CoverageReport& planned,
                             const CoverageOptions& measure, std::span<const Crowd> crowds,
                             std::span<const Requirement> requirements, Progress& progress) {
    CoverageOptions options = measure;
    options.keep_depths = false;
    options.parallax.reset();
    progress.begin("crowds", static_cast<std::int64_t>(crowds.size()));
    const auto measured = [&](int sample) {
        const Scene filled = withCrowd(scene, crowds[static_cast<std::size_t>(sample)]);
        RayScenes worlds(filled.environment);
        return measureCoverage(filled, worlds, options);
    };
    SampledFigures sampled =
        sampleFigures(planned, requirements, static_cast<int>(crowds.size()), measured, progress);
    progress.end();
    return sampled;
}

}  // namespace ispace::robustness
