// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/objective.h"

#include <algorithm>
#include <cstddef>
#include <variant>

#include "arrange/arrange.h"
#include "arrange/coverage_model.h"
#include "arrange/search/problem.h"
#include "scene/sensor/camera.h"

namespace ispace {

namespace {

std::vector<double> floorWeights(const Target& target, const ArrangeOptions& /*options*/) {
    return weightsOfCells(target, {});
}

std::vector<double> zoneWeights(const Target& target, const ArrangeOptions& options) {
    return weightsOfCells(target, options.weights);
}

void limitCamera(SensorModel& model, const ArrangeOptions& options) {
    if (auto* camera = std::get_if<Camera>(&model))
        *camera = withDensity(*camera, options.pixel_density);
}

/// Reports the share of the total weight that is covered at the required multiplicity.
void reportShare(const CoverageModel& model, std::span<const CountedView> views,
                 Arrangement& result) {
    result.value = model.shareOf(views);
}

void reportServed(const CoverageModel& model, std::span<const CountedView> views,
                  Arrangement& result) {
    result.served = model.servedBy(views);
    result.value = model.shareOf(views);
}

void reportCases(const CoverageModel& model, std::span<const CountedView> views,
                 Arrangement& result) {
    result.cases = model.sharesInCases(views, result.sensors);
    result.value = model.isWorstCase() ? result.cases->worst : result.cases->mean;
}

void reportCost(const CoverageModel& model, std::span<const CountedView> /*views*/,
                Arrangement& result) {
    // Few sums, and few roundings, kind by kind.
    std::vector<int> counts(model.kinds().size());
    for (const Placement& placement : result.sensors) ++counts[placement.kind];
    double cost = 0;
    for (std::size_t k = 0; k < counts.size(); ++k) cost += counts[k] * model.kinds()[k].cost;
    result.cost = normaliseCost(cost);
    result.has_costs = std::any_of(model.kinds().begin(), model.kinds().end(),
                                   [](const SensorClass& kind) { return kind.cost != 1; });
}

using Options = const ArrangeOptions&;

constexpr Objective kObjectives[] = {
    {.name = "coverage", .is_asked = [](Options) { return true; }, .weights = floorWeights},
    {.name = "weights",
     .is_asked = [](Options options) { return !options.weights.isUniform(); },
     .weights = zoneWeights,
     .report = reportShare},
    {.name = "density",
     .is_asked = [](Options options) { return options.pixel_density > 0; },
     .limit = limitCamera},
    {.name = "redundancy",
     .is_asked = [](Options options) { return options.redundancy > 1; },
     .report = reportShare},
    {.name = "rule",
     .is_asked = [](Options options) { return bool(options.cover_rule); },
     .report = reportShare},
    {.name = "demand",
     .is_asked = [](Options options) { return options.demand != nullptr; },
     .report = reportServed},
    {.name = "cases",
     .is_asked = [](Options options) { return options.cases != nullptr; },
     .report = reportCases},
    {.name = "cost", .is_asked = [](Options) { return true; }, .report = reportCost}};

}  // namespace

std::span<const Objective> objectives() { return kObjectives; }

std::vector<double> cellWeights(const Target& target, const ArrangeOptions& options) {
    std::vector<double> weights(target.grid.size(), 1.0);
    for (const Objective& row : objectives()) {
        if (row.weights == nullptr || !row.is_asked(options)) continue;
        const std::vector<double> factors = row.weights(target, options);
        for (std::size_t i = 0; i < weights.size(); ++i) weights[i] *= factors[i];
    }
    return weights;
}

void limitCovered(SensorModel& model, const ArrangeOptions& options) {
    for (const Objective& row : objectives())
        if (row.limit != nullptr && row.is_asked(options)) row.limit(model, options);
}

}  // namespace ispace
