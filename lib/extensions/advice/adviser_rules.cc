// SPDX-License-Identifier: GPL-3.0-or-later
// Suggestions that mend what the rules of cameras miss.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "env/zone.h"
#include "extensions/advice/adviser.h"
#include "extensions/camerarules/camera_rules.h"
#include "extensions/camerarules/facing_cells.h"
#include "extensions/camerarules/private_floor.h"

namespace ispace::advice {

namespace {

/// Returns the floor of a zone in which faces are missing, m2. An unknown share counts as none.
double missingFaces(const camerarules::FacingResult& result) {
    if (isMet(result)) return 0;
    return (*result.rule.required - result.share.value_or(0)) * result.area;
}

double missingFaces(const std::vector<camerarules::FacingResult>& results) {
    double sum = 0;
    for (const camerarules::FacingResult& result : results) sum += missingFaces(result);
    return sum;
}

}  // namespace

double missingFloor(const Scene& scene, const Coverage& coverage, const SuggestOptions& options,
                    camerarules::PrivateFloor& private_floor) {
    double sum = missingFaces(camerarules::measureFacing(scene, coverage, options.facing));
    for (const Requirement& requirement : options.requirements)
        sum += checkRequirement(requirement, coverage).missing;
    if (options.privacy.empty()) return sum;
    // Camera by camera: each that is mended counts, even if another one sees the same floor.
    camerarules::PrivateFloor::Sight seen;
    for (const Sensor& sensor : scene.sensors) {
        const camerarules::PrivateFloor::Sight& sight = private_floor.knownSight(sensor);
        seen.broken += sight.broken;
        seen.all += sight.all;
    }
    if (seen.broken > 0 || seen.all <= kMinPiece) return sum + seen.broken;
    // Small pieces of several cameras.
    for (const camerarules::PrivacyResult& result :
         camerarules::measurePrivacy(scene, options.measure.plane, options.privacy))
        if (!isMet(result)) sum += result.seen.value_or(result.area);
    return sum;
}

double missingFloor(const Scene& scene, const Coverage& coverage, const SuggestOptions& options) {
    camerarules::PrivateFloor private_floor(scene.environment, options.measure.plane,
                                            options.privacy);
    return missingFloor(scene, coverage, options, private_floor);
}

RuleTrials::RuleTrials(const MeasuredState& now, const SuggestOptions& options,
                       camerarules::PrivateFloor& private_floor)
    : options_(options), scene_(now.scene), private_floor_(private_floor) {
    if (options.facing.empty()) return;
    views_ = now.coverage.sensors;
    facing_.emplace(scene_.environment, options.facing);
    faces_ = missingFaces(facing_->measure(views_));
}

double RuleTrials::mostGain(const Sensor& sensor) const {
    if (!sensor.is<Camera>()) return 0;
    return withoutNoise(private_floor_.knownSight(sensor).broken + faces_);
}

double RuleTrials::gain(const Sensor& sensor, const Pose3& pose) {
    if (!sensor.is<Camera>()) return 0;
    Sensor moved = sensor;
    moved.pose = pose;
    double gain = 0;
    if (!options_.privacy.empty())
        gain = private_floor_.knownSight(sensor).broken - private_floor_.seenBy(moved).broken;
    const auto view = std::find_if(views_.begin(), views_.end(),
                                   [&](const SensorView& one) { return one.id == sensor.id; });
    if (options_.facing.empty() || view == views_.end()) return withoutNoise(gain);
    const VisibleArea sight(scene_.environment, options_.measure.plane);
    Camera& camera = std::get<Camera>(moved.model);
    camera = withDensity(camera, options_.measure.density);
    const SensorView before = *view;
    view->pose = pose;
    view->region = sight.regionOf(moved);
    gain += faces_ - missingFaces(facing_->measure(views_));
    *view = before;
    return withoutNoise(gain);
}

std::vector<camerarules::FacingRule> unmetFacing(const MeasuredState& now,
                                                 const SuggestOptions& options) {
    std::vector<camerarules::FacingRule> unmet;
    for (const camerarules::FacingResult& result :
         camerarules::measureFacing(now.scene, now.coverage, options.facing))
        if (!isMet(result)) unmet.push_back(result.rule);
    return unmet;
}

std::vector<ArrangeOptions> Adviser::goalsOf(const MeasuredState& now,
                                             ArrangeOptions options) const {
    std::vector<ArrangeOptions> goals;
    for (const camerarules::FacingRule& rule : unmetFacing(now, options_)) {
        ArrangeOptions& goal = goals.emplace_back(options);
        goal.cover_rule = camerarules::coverRuleOf({rule});
        goal.weights = {};
        for (const camerarules::FacingPart& part : rule.parts)
            goal.weights.targets.push_back(namedZone(rule.zone, part.outline));
    }
    const bool is_for_floor =
        goals.empty() || std::any_of(options_.requirements.begin(), options_.requirements.end(),
                                     [&](const Requirement& requirement) {
                                         return !checkRequirement(requirement, now.coverage).is_met;
                                     });
    if (is_for_floor) goals.push_back(std::move(options));
    return goals;
}

camerarules::PrivateFloor& Adviser::privateFloorOf(const Environment& environment) {
    for (const auto& known : private_floors_)
        if (known && known->environment().digest() == environment.digest()) return *known;
    // The first environment returns, the others are tried once.
    std::unique_ptr<camerarules::PrivateFloor>& made = private_floors_[private_floors_[0] ? 1 : 0];
    made = std::make_unique<camerarules::PrivateFloor>(environment, options_.measure.plane,
                                                       options_.privacy);
    return *made;
}

const VisibleArea* Adviser::sightIn(const Environment& environment) {
    if (first_sight_ == nullptr)
        first_sight_ = std::make_unique<FirstSight>(environment, options_.measure.plane);
    const bool is_first = first_sight_->environment.digest() == environment.digest();
    return is_first ? &first_sight_->sight : nullptr;
}

std::size_t Adviser::intruders(const Scene& scene) {
    camerarules::PrivateFloor& floor = privateFloorOf(scene.environment);
    return static_cast<std::size_t>(
        std::count_if(scene.sensors.begin(), scene.sensors.end(),
                      [&](const Sensor& sensor) { return floor.knownSight(sensor).broken > 0; }));
}

bool Adviser::mayAddingMend(const MeasuredState& now) {
    return !options_.requirements.empty() || !options_.facing.empty() || intruders(now.scene) == 0;
}

std::optional<Suggestion> Adviser::withoutIntruder(const MeasuredState& now) {
    if (options_.privacy.empty() || now.missing == 0) return std::nullopt;
    struct Intruder {
        std::string id;
        double most;  // that its removal can mend
    };
    std::vector<Intruder> all;
    camerarules::PrivateFloor& floor = privateFloorOf(now.scene.environment);
    for (const Sensor& sensor : standingSensors(now.scene))
        if (const double seen = floor.knownSight(sensor).broken; seen > 0)
            all.push_back({sensor.id, withoutNoise(seen)});
    std::stable_sort(all.begin(), all.end(),
                     [](const Intruder& a, const Intruder& b) { return a.most > b.most; });
    std::optional<Suggestion> best;
    for (const Intruder& one : all) {
        if (isStopped() || (best && best->required >= one.most)) break;
        offer(best, measured(now, Suggestion::Kind::Remove, "remove " + one.id,
                             {parseEdit(Edit::Kind::Delete, one.id)}));
    }
    return best;
}

}  // namespace ispace::advice
