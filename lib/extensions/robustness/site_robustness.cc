// SPDX-License-Identifier: GPL-3.0-or-later
// Samples of a building perturb all storeys at once, each with its own seed, and measure the whole
// building: sensors see through openings. A room alone takes the path of perturbMounting() and
// measureCrowds(), which keep the sight of its walls from sample to sample.
#include "extensions/robustness/site_robustness.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "site/storey_people.h"

namespace ispace::robustness {

namespace {

/// Returns the report of a building whose storeys were changed.
Coverage measured(const SiteScene& changed, const CoverageOptions& options) {
    Coverage sum;
    sum.report = sumOfStoreys(measureSite(changed, options));
    return sum;
}

/// The options of samples, of which shares alone count.
CoverageOptions sharesOf(CoverageOptions options) {
    options.keep_depths = false;
    options.parallax.reset();
    return options;
}

}  // namespace

SampledFigures perturbSite(const SiteScene& building, const SiteCoverage& planned,
                           const CoverageOptions& measure, const MountingTolerance& tolerance,
                           int mountings, std::uint64_t seed,
                           std::span<const Requirement> requirements, Progress& progress) {
    if (building.isRoomAlone())  // with the sight of its walls from one mounting to the next
        return perturbMounting(*building.scenes.front(), planned.storeys.front().report, measure,
                               tolerance, mountings, seed, requirements, progress);
    const CoverageOptions options = sharesOf(measure);
    progress.begin("mountings", mountings);
    const auto mounted = [&](int mounting) {
        SiteScene changed = building;
        for (std::size_t i = 0; i < changed.scenes.size(); ++i) {
            const Scene& planned_scene = *building.scenes[i];
            if (planned_scene.sensors.empty()) continue;
            Scene scene = planned_scene;
            const RandomKey key{.seed = seedOfStorey(seed, i),
                                .frame = static_cast<std::uint64_t>(mounting)};
            for (Sensor& sensor : scene.sensors)
                sensor.pose = mountedPose(scene.environment, sensor, tolerance, key);
            changed.scenes[i] = std::make_shared<const Scene>(std::move(scene));
        }
        return measured(changed, options);
    };
    SampledFigures sampled =
        sampleFigures(sumOfStoreys(planned), requirements, mountings, mounted, progress);
    progress.end();
    return sampled;
}

SampledFigures crowdSite(const SiteScene& building, const SiteCoverage& planned,
                         const CoverageOptions& measure, std::span<const SiteCrowd> crowds,
                         std::span<const Requirement> requirements, Progress& progress) {
    if (building.isRoomAlone()) {
        std::vector<Crowd> in_room;
        in_room.reserve(crowds.size());
        for (const SiteCrowd& crowd : crowds) in_room.push_back(crowd.front());
        return measureCrowds(*building.scenes.front(), planned.storeys.front().report, measure,
                             in_room, requirements, progress);
    }
    const CoverageOptions options = sharesOf(measure);
    progress.begin("crowds", static_cast<std::int64_t>(crowds.size()));
    const auto crowded = [&](int sample) {
        SiteScene changed = building;
        const SiteCrowd& crowd = crowds[static_cast<std::size_t>(sample)];
        for (std::size_t i = 0; i < changed.scenes.size(); ++i)
            if (!crowd[i].empty())
                changed.scenes[i] =
                    std::make_shared<const Scene>(withCrowd(*building.scenes[i], crowd[i]));
        return measured(changed, options);
    };
    SampledFigures sampled = sampleFigures(sumOfStoreys(planned), requirements,
                                           static_cast<int>(crowds.size()), crowded, progress);
    progress.end();
    return sampled;
}

std::vector<FigureLoss> worstFailuresOfSite(const SiteCoverage& coverage, int count,
                                            std::span<const Requirement> requirements) {
    std::vector<FailingRoom> rooms;
    rooms.reserve(coverage.storeys.size());
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i)
        rooms.push_back({*coverage.floors[i], coverage.storeys[i]});
    return worstFailures(rooms, sumOfStoreys(coverage), count, requirements);
}

}  // namespace ispace::robustness
