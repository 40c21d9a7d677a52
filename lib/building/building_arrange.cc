// SPDX-License-Identifier: GPL-3.0-or-later
#include "building/building_arrange.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "arrange/joined_rooms.h"
#include "base/number.h"
#include "building/building_coverage.h"
#include "building/building_sight.h"
#include "building/share_out.h"
#include "building/storey_sight.h"
#include "coverage/outside_view.h"
#include "scene/placement_schemas.h"

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

/// Storeys that are searched together: one, or several that see each other.
struct Part {
    std::vector<std::size_t> storeys;
    std::vector<JoinedLayout> layouts = {};  ///< of several, in [n - 1] that of n sensors
};

StoreyCurve curveOf(const Part& part) {
    StoreyCurve curve{{0}, {0}};
    for (const JoinedLayout& layout : part.layouts) {
        curve.values.push_back(layout.value);
        curve.bounds.push_back(layout.bound);
    }
    return curve;
}

/// Measures the storeys of a building with the sensors of an arrangement, as `coverage` does.
void measureTogether(const BuildingScene& building, const ArrangeOptions& options,
                     BuildingArrangement& result) {
    BuildingScene placed = building;
    for (std::size_t i = 0; i < placed.scenes.size(); ++i)
        placed.scenes[i] = std::make_shared<const Scene>(
            withPlaced(*building.scenes[i], {result.groups[i]}, result.storeys[i].sensors));
    CoverageOptions usual;
    usual.plane = options.plane;
    usual.density = options.pixel_density;
    usual.exact = false;
    const BuildingCoverage coverage = measureBuilding(placed, usual);
    result.coverage = coverage.coverage.grid.value_or(0);
    result.area = coverage.total_effective_area.grid.value_or(0);
    for (std::size_t i = 0; i < result.storeys.size(); ++i) {
        const CoverageReport& report = coverage.storeys[i].report;
        result.storeys[i].coverage = report.coverage.grid.value_or(0);
        result.storeys[i].area = report.total_effective_area.grid.value_or(0);
    }
}

/// Returns the height up to which candidates see floor: of the highest site, and of the plane.
double highestSite(const BuildingScene& building, const ArrangeOptions& options) {
    double highest = options.plane;
    for (const double height : options.mount.heights) highest = std::max(highest, height);
    if (!options.mount.heights.empty()) return highest;
    for (const auto& scene : building.scenes)
        highest = std::max(highest, scene->environment.height());
    return highest;
}

/// Arranges the sensors of a building, part by part.
class BuildingSearch {
  public:
    BuildingSearch(const BuildingScene& building, const SensorSpec& sensor, int count,
                   const ArrangeOptions& options, Progress& progress)
        : building_(building),
          count_(count),
          options_(options),
          progress_(progress),
          coupling_(building),
          scenes_(coupling_.floors(highestSite(building, options))),
          alone_(sensor, building.devices, options, progress) {}

    BuildingArrangement run() {
        findParts();
        std::vector<StoreyCurve> curves;
        double whole = 0;
        for (const Part& part : parts_)
            curves.push_back(part.layouts.empty()
                                 ? alone_.curve(*scenes_[part.storeys.front()], count_)
                                 : curveOf(part));
        for (const auto& scene : scenes_) whole += scene->environment.indoor().area();
        const SharedSensors shared = shareOut(curves, count_);
        BuildingArrangement result;
        result.counts.resize(scenes_.size());
        result.storeys.resize(scenes_.size());
        result.bound = whole > 0 ? std::min(1.0, shared.bound / whole) : 0;
        for (const auto& scene : scenes_) {
            result.groups.push_back(alone_.groupFor(*scene, 1));
            result.has_floor.push_back(hasFloor(*scene));
        }
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            if (shared.counts[i] == 0) continue;
            if (parts_[i].layouts.empty())
                addStorey(parts_[i].storeys.front(), shared.counts[i], result);
            else
                addPart(parts_[i], shared.counts[i], result);
        }
        if (whole > 0) {
            result.coverage /= whole;
            result.value /= whole;
            result.rounding /= whole;
        }
        if (joined_) measureTogether(building_, options_, result);
        return result;
    }

  private:
    /// Storeys whose candidates see each other are one part, the others one each.
    void findParts() {
        const StoreySight sight(coupling_, options_.plane);
        const SensorGroup group = alone_.groupFor(*scenes_.front(), 1);
        if (sight.hasOpenings() && seesOutside({"", group.model, {}})) {
            std::vector<JoinedRooms::Room> rooms;
            for (const auto& scene : scenes_)
                rooms.push_back(
                    hasFloor(*scene)
                        ? JoinedRooms::Room{scene.get(), {alone_.groupFor(*scene, count_)}}
                        : JoinedRooms::Room());
            joined_ = std::make_unique<JoinedRooms>(std::move(rooms), options_, sight, progress_);
            for (auto& storeys : joined_->parts()) parts_.push_back({std::move(storeys)});
        } else {
            for (std::size_t i = 0; i < scenes_.size(); ++i) parts_.push_back({{i}});
        }
        const auto is_open = [this](const Part& part) {
            return part.storeys.size() == 1 && !hasFloor(*scenes_[part.storeys.front()]);
        };
        if (!std::all_of(parts_.begin(), parts_.end(), is_open)) std::erase_if(parts_, is_open);
        for (Part& part : parts_) {
            if (part.storeys.size() == 1) continue;
            if (options_.is_connected)
                throw UsageError(
                    "--connected: the sensors would see other storeys through openings; choose one "
                    "with --storey (" +
                    building_.document.storeyList() + ')');
            part.layouts = joined_->layouts(part.storeys, count_);
        }
        if (joined_ && joined_->parts().size() == scenes_.size()) joined_.reset();
    }

    void addStorey(std::size_t i, int count, BuildingArrangement& result) {
        const double area = scenes_[i]->environment.indoor().area();
        result.counts[i] = count;
        result.groups[i] = alone_.groupFor(*scenes_[i], count);
        Arrangement& storey = result.storeys[i];
        storey = alone_.layout(*scenes_[i], count);
        result.coverage += area * storey.coverage;
        result.area += storey.area;
        result.value += area * storey.candidate_value;
        result.candidates += storey.candidates;
        result.is_complete = result.is_complete && storey.is_complete;
    }

    void addPart(const Part& part, int count, BuildingArrangement& result) {
        const JoinedLayout& layout = part.layouts[static_cast<std::size_t>(count) - 1];
        std::size_t placed = 0;
        for (std::size_t k = 0; k < part.storeys.size(); ++k) {
            const std::size_t i = part.storeys[k];
            const std::vector<Placement>& sensors = layout.rooms[k];
            result.counts[i] = static_cast<int>(sensors.size());
            result.groups[i] = alone_.groupFor(*scenes_[i], std::max(1, result.counts[i]));
            result.storeys[i].sensors = sensors;
            placed += sensors.size();
            result.candidates += joined_->candidates(i);
        }
        result.storeys[part.storeys.front()].unplaced = static_cast<std::size_t>(count) - placed;
        result.value += layout.value;
        result.rounding += layout.rounding;
        result.is_complete = result.is_complete && layout.is_complete;
    }

    const BuildingScene& building_;
    int count_;
    const ArrangeOptions& options_;
    Progress& progress_;
    Coupling coupling_;
    std::vector<std::shared_ptr<const Scene>> scenes_;
    StoreySearch alone_;
    std::vector<Part> parts_;
    std::unique_ptr<JoinedRooms> joined_;  // if storeys see each other
};

}  // namespace

BuildingArrangement arrangeBuilding(const BuildingScene& building, const SensorSpec& sensor,
                                    int count, const ArrangeOptions& options, Progress& progress) {
    return BuildingSearch(building, sensor, count, options, progress).run();
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
