// SPDX-License-Identifier: GPL-3.0-or-later
// Suggestions that mend what the rules of cameras miss.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arrange/adviser.h"
#include "coverage/camera_rules.h"
#include "env/zone.h"

namespace ispace {

namespace {

/// Returns the floor of a zone in which faces are missing, m2. An unknown share counts as none.
double missingFaces(const FacingResult& result) {
    if (isMet(result)) return 0;
    return (*result.rule.required - result.share.value_or(0)) * result.area;
}

double missingFaces(const Scene& scene, const Coverage& coverage,
                    const std::vector<FacingRule>& rules) {
    double sum = 0;
    for (const FacingResult& result : measureFacing(scene, coverage, rules))
        sum += missingFaces(result);
    return sum;
}

/// Returns the private floor that the sensors of a scene see, m2. Zones of unknown sight count as
/// seen.
double intrusion(const Scene& scene, const SuggestOptions& options) {
    double sum = 0;
    for (const PrivacyResult& result :
         measurePrivacy(scene, options.measure.plane, options.privacy))
        if (!isMet(result)) sum += result.seen.value_or(result.area);
    return sum;
}

/// Returns the private floor that a camera sees; `alone` holds the scene's other content.
double intrusionOf(Scene& alone, const Sensor& camera, const SuggestOptions& options) {
    alone.sensors = {camera};
    return intrusion(alone, options);
}

}  // namespace

double missingFloor(const Scene& scene, const Coverage& coverage, const SuggestOptions& options) {
    double sum = missingFaces(scene, coverage, options.facing);
    for (const Requirement& requirement : options.requirements)
        sum += checkRequirement(requirement, coverage).missing;
    if (options.privacy.empty()) return sum;
    // Camera by camera: each that is mended counts, even if another one sees the same floor.
    Scene alone = scene;
    double seen = 0;
    for (const Sensor& sensor : scene.sensors)
        if (sensor.is<Camera>()) seen += intrusionOf(alone, sensor, options);
    return sum + (seen > 0 ? seen : intrusion(scene, options));
}

RuleTrials::RuleTrials(const MeasuredState& now, const SuggestOptions& options)
    : options_(options), alone_(now.scene) {
    if (options.facing.empty() && options.privacy.empty()) return;
    views_.sensors = now.coverage.sensors;
    faces_ = missingFaces(now.scene, views_, options.facing);
    if (options.privacy.empty()) return;
    for (const Sensor& sensor : now.scene.sensors)
        if (sensor.is<Camera>()) seen_ += intrusionOf(alone_, sensor, options);
    alone_.sensors = now.scene.sensors;
}

double RuleTrials::gain(const Sensor& sensor, const Pose3& pose) {
    if (!sensor.is<Camera>()) return 0;
    Sensor moved = sensor;
    moved.pose = pose;
    double gain = 0;
    if (!options_.privacy.empty()) {
        std::vector<Sensor> all = alone_.sensors;
        gain = intrusionOf(alone_, sensor, options_) - intrusionOf(alone_, moved, options_);
        alone_.sensors = std::move(all);
    }
    const auto view = std::find_if(views_.sensors.begin(), views_.sensors.end(),
                                   [&](const SensorView& one) { return one.id == sensor.id; });
    if (options_.facing.empty() || view == views_.sensors.end()) return withoutNoise(gain);
    const VisibleArea sight(alone_.environment, options_.measure.plane);
    Camera& camera = std::get<Camera>(moved.model);
    camera = withDensity(camera, options_.measure.density);
    const SensorView before = *view;
    view->pose = pose;
    view->region = sight.regionOf(moved);
    gain += faces_ - missingFaces(alone_, views_, options_.facing);
    *view = before;
    return withoutNoise(gain);
}

std::vector<FacingRule> unmetFacing(const MeasuredState& now, const SuggestOptions& options) {
    std::vector<FacingRule> unmet;
    for (const FacingResult& result : measureFacing(now.scene, now.coverage, options.facing))
        if (!isMet(result)) unmet.push_back(result.rule);
    return unmet;
}

std::vector<ArrangeOptions> Adviser::goalsOf(const MeasuredState& now,
                                             ArrangeOptions options) const {
    std::vector<ArrangeOptions> goals;
    for (const FacingRule& rule : unmetFacing(now, options_)) {
        ArrangeOptions& goal = goals.emplace_back(options);
        goal.facing = {rule};
        goal.weights = {};
        goal.weights.targets = {readZone(rule.zone, now.scene.environment)};
    }
    const bool is_for_floor =
        goals.empty() || std::any_of(options_.requirements.begin(), options_.requirements.end(),
                                     [&](const Requirement& requirement) {
                                         return !checkRequirement(requirement, now.coverage).is_met;
                                     });
    if (is_for_floor) goals.push_back(std::move(options));
    return goals;
}

std::vector<Suggestion> Adviser::withoutIntruders(const MeasuredState& now) {
    std::vector<Suggestion> found;
    if (options_.privacy.empty() || now.missing == 0) return found;
    Scene alone = now.scene;
    for (const Sensor& sensor : standingSensors(now.scene))
        if (sensor.is<Camera>() && intrusionOf(alone, sensor, options_) > 0 && !isStopped())
            found.push_back(measured(now, Suggestion::Kind::Remove, "remove " + sensor.id,
                                     {parseEdit(Edit::Kind::Delete, sensor.id)}));
    return found;
}

}  // namespace ispace
