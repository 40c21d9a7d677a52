// SPDX-License-Identifier: GPL-3.0-or-later
#include "building/building_arrange.h"

#include <algorithm>
#include <map>
#include <utility>

#include "base/number.h"
#include "building/building_sight.h"
#include "building/share_out.h"

namespace ispace {

namespace {

/// Searches storeys, equal ones once.
class StoreySearch {
  public:
    StoreySearch(const SensorSpec& sensor, const DeviceCatalogue& devices,
                 const ArrangeOptions& options, Progress& progress)
        : sensor_(sensor), devices_(devices), options_(options), progress_(progress) {}

    /// Returns shares of the storey's floor times its area. \param count largest number of sensors
    StoreyCurve curve(const Scene& scene, int count) {
        ArrangeOptions options = options_;
        options.wants_curve = true;
        const Arrangement& most = run(scene, count, options);
        StoreyCurve curve{{0}, {0}};
        const double area = scene.environment.indoor().area();
        for (const CurvePoint& point : most.curve) {
            curve.values.push_back(area * point.value);
            curve.bounds.push_back(area * point.bound);
        }
        // A search that was cut may know no sensors.
        if (most.curve.empty()) curve.bounds.push_back(area);
        return curve;
    }

    /// Returns the layout of a number of sensors above 0.
    const Arrangement& layout(const Scene& scene, int count) { return run(scene, count, options_); }

    [[nodiscard]] SensorGroup groupFor(const Scene& scene, int count) const {
        SensorSpec spec = sensor_;
        spec.count = count;
        return groupsToPlace(scene, std::span(&spec, 1), devices_, false).front();
    }

  private:
    const Arrangement& run(const Scene& scene, int count, const ArrangeOptions& options) {
        const auto [known, is_new] = done_.try_emplace({&scene, count});
        if (is_new) known->second = arrange(scene, {groupFor(scene, count)}, options, progress_);
        return known->second;
    }

    const SensorSpec& sensor_;
    const DeviceCatalogue& devices_;
    const ArrangeOptions& options_;
    Progress& progress_;
    std::map<std::pair<const Scene*, int>, Arrangement> done_;
};

}  // namespace

BuildingArrangement arrangeBuilding(const BuildingScene& building, const SensorSpec& sensor,
                                    int count, const ArrangeOptions& options, Progress& progress) {
    const auto scenes = scenesOfFloors(building);
    StoreySearch search(sensor, building.devices, options, progress);
    std::vector<StoreyCurve> curves;
    double whole = 0;
    for (const auto& scene : scenes) {
        curves.push_back(search.curve(*scene, count));
        whole += scene->environment.indoor().area();
    }
    const SharedSensors shared = shareOut(curves, count);
    BuildingArrangement result;
    result.counts = shared.counts;
    result.bound = whole > 0 ? std::min(1.0, shared.bound / whole) : 0;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const Scene& scene = *scenes[i];
        const double area = scene.environment.indoor().area();
        result.groups.push_back(search.groupFor(scene, std::max(1, shared.counts[i])));
        result.storeys.emplace_back();
        if (shared.counts[i] == 0) continue;
        Arrangement& storey = result.storeys.back();
        storey = search.layout(scene, shared.counts[i]);
        result.coverage += area * storey.coverage;
        result.area += storey.area;
        result.value += area * storey.candidate_value;
        result.candidates += storey.candidates;
        result.is_complete = result.is_complete && storey.is_complete;
    }
    if (whole > 0) {
        result.coverage /= whole;
        result.value /= whole;
    }
    return result;
}

Document buildingLayout(const LayoutParts& parts, const BuildingScene& building,
                        const BuildingArrangement& arrangement) {
    Document document{DocumentKind::Layout, parts.history, {}};
    Record environment(*sceneSchemas().find("environment"));
    if (!parts.environment_file.empty()) environment.set("file", Value(parts.environment_file));
    environment.set("digest", Value(parts.environment_digest));
    document.records.push_back(std::move(environment));
    for (std::size_t i = 0; i < arrangement.storeys.size(); ++i)
        for (const Placement& placement : arrangement.storeys[i].sensors)
            document.records.push_back(inBuilding(building.document.storeys[i],
                                                  placedRecord(arrangement.groups[i], placement),
                                                  placement.sensor));
    Record result(*sceneSchemas().find("result"));
    result.set("coverage", Value(roundSignificant(arrangement.coverage)));
    result.set("area", Value(roundSignificant(arrangement.area)));
    if (arrangement.value != arrangement.coverage)
        result.set("value", Value(roundSignificant(arrangement.value)));
    result.set("bound", Value(roundSignificant(arrangement.bound)));
    result.set("strategy", Value(parts.strategy));
    result.set("optimize", Value(parts.optimize));
    result.set("candidates", Value(static_cast<double>(arrangement.candidates)));
    if (!arrangement.is_complete) result.set("complete", Value(false));
    document.records.push_back(std::move(result));
    return document;
}

}  // namespace ispace
