// SPDX-License-Identifier: GPL-3.0-or-later
// The search is branch and bound over single changes: a trial has a bound of its gain (the rules
// that may be mended, then floor by cells or by ExactGain::mostMore()), trials are measured from
// the largest bound on, and the rest is cut once no bound exceeds the best gain. Among equal gains
// the first trial in the order of the records wins, whatever the order of measuring.
//
// Together is greedy: the change that mends most, again and again, eight at most, and then each
// change without which the others still meet all is left out. So it is minimal under removal, and
// may be longer than the shortest list.
#include "extensions/advice/suggestion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "arrange/arrange.h"
#include "arrange/floor_tiles.h"
#include "arrange/placement_rules.h"
#include "arrange/refine.h"
#include "base/number.h"
#include "coverage/visible_area.h"
#include "env/level.h"
#include "extensions/advice/adviser.h"
#include "extensions/advice/coarse_sight.h"
#include "extensions/camerarules/layout_privacy.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "sense/scan.h"

namespace ispace::advice {

namespace {

constexpr std::size_t kMaxTypes = 3;     ///< of sensors to add
constexpr std::size_t kMaxChanges = 8;   ///< of Together
constexpr double kNearWall = 0.1;        ///< of a sensor on a wall, metres
constexpr double kMaxLattice = 100'000;  ///< sites in the limits: farther apart in large rooms
/// Cells that the candidates of a search look at by rays, at most: some seconds. Beyond, sites lie
/// farther apart, and cells are larger.
constexpr double kMaxLooks = 2e7;
constexpr double kSearchedCells = 40'000, kLeastCells = 2'500;
constexpr double kShifts[] = {0.1, 0.25, 0.5, 1};
constexpr int kDirections = 8;
constexpr int kTurnStep = 15;             ///< degrees; then single degrees about the best
constexpr std::size_t kTrialsAtOnce = 2;  ///< that are measured side by side, if cells bound them

}  // namespace

std::vector<Vec2> displacements(std::span<const double> lengths) {
    std::vector<Vec2> all;
    for (const double distance : lengths)
        for (int i = 0; i < kDirections; ++i) {
            const Angle angle = Angle::degrees(i * 360.0 / kDirections);
            const auto centimetres = [](double metres) { return std::round(100 * metres) / 100; };
            all.push_back({centimetres(distance * cos(angle)), centimetres(distance * sin(angle))});
        }
    return all;
}

Edit moveOf(const std::string& id, Vec2 by) {
    return parseEdit(Edit::Kind::Move, id + ':' + formatDouble(by.x) + ',' + formatDouble(by.y));
}

std::vector<Sensor> standingSensors(const Scene& scene) {
    std::vector<Sensor> sensors;
    for (const Sensor& sensor : scene.sensors)
        if (!sensor.mount && !sensor.person && kindOf(sensor.model).is_arranged)
            sensors.push_back(sensor);
    return sensors;
}

/// Zones of requirements that are not met, if only zones fall short.
FloorWeights Adviser::weightsFor(const MeasuredState& now) const {
    FloorWeights weights;
    for (const Requirement& requirement : options_.requirements) {
        if (checkRequirement(requirement, now.coverage).is_met) continue;
        if (requirement.of != Requirement::Of::Zone) return {};
        weights.targets.push_back(readZone(requirement.zone, now.scene.environment));
    }
    return weights;
}

namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// A pose to try, as an edit.
struct Trial {
    std::size_t sensor;
    int turn = 0;  ///< degrees
    Vec2 by = {};
    FloorGain gain = {};               ///< over the present pose
    FloorGain most = {0, kUnbounded};  ///< a bound of it
    double floor = kUnbounded;         ///< ExactGain::mostMore(), once it was computed
    std::size_t number = 0;
};

Pose3 poseAfter(Pose3 pose, const Trial& trial) {
    pose.position.x += trial.by.x;
    pose.position.y += trial.by.y;
    pose.heading = wrapped(pose.heading + Angle::degrees(trial.turn));
    return pose;
}

/// Returns the same turn from -179 to 180 degrees.
int wholeTurn(int degrees) {
    return degrees > 180 ? degrees - 360 : degrees <= -180 ? degrees + 360 : degrees;
}

/// Lowers the bounds of trials of a sensor to the estimates of cells, with their error.
/// \param present floor that it covers, and private floor that it sees, below 0
void boundByCells(std::vector<Trial>& trials, const Sensor& sensor, const FloorGain& present,
                  CoarseSight& coarse) {
    std::vector<Pose3> poses;
    poses.reserve(trials.size());
    for (const Trial& trial : trials) poses.push_back(poseAfter(sensor.pose, trial));
    const std::vector<FloorGain> estimates = coarse.at(sensor, poses);
    for (std::size_t i = 0; i < trials.size(); ++i) {
        FloorGain& most = trials[i].most;
        most.required =
            std::min(most.required, estimates[i].required - present.required + coarse.error());
        most.gained = std::min(most.gained, estimates[i].gained - present.gained + coarse.error());
    }
}

}  // namespace

std::vector<Suggestion> Adviser::turnAndShift(const MeasuredState& now) {
    const std::vector<Sensor> sensors = standingSensors(now.scene);
    if (sensors.empty() || !now.coverage.report.exact_missing.empty()) {
        advance(sensors.size());
        return {};
    }
    Scene others = now.scene;
    std::erase_if(others.sensors, [](const Sensor& sensor) {
        return !sensor.mount && !sensor.person && kindOf(sensor.model).is_arranged;
    });
    const VisibleArea own(now.scene.environment, options_.measure.plane);
    const VisibleArea* const known = sightIn(now.scene.environment);
    ExactGain gain(others, known != nullptr ? *known : own, sensors, weightsFor(now), 1);
    if (!gain.prepareAll()) gain.prepareBounds();
    RuleTrials rules_of_cameras(now, options_, privateFloorOf(now.scene.environment));
    std::unique_ptr<CoarseSight> own_coarse;
    CoarseSight* coarse = nullptr;
    if (CoarseSight::estimates(options_)) {
        if (known != nullptr && first_coarse_ == nullptr)
            first_coarse_ = std::make_unique<CoarseSight>(first_sight_->environment, options_,
                                                          CoarseSight::Cells::Many);
        if (known == nullptr)
            own_coarse = std::make_unique<CoarseSight>(now.scene.environment, options_,
                                                       CoarseSight::Cells::Many);
        coarse = known != nullptr ? first_coarse_.get() : own_coarse.get();
        coarse->look(now.scene.sensors);
    }
    const FloorGain worthwhile{0, (1 - kNegligible) * leastGain(now)};
    std::optional<Trial> turn, shift;
    // Measures trials, the most promising ones first, until no other can be the best. The first of
    // several with the same gain is taken.
    // \param enough smaller gains are of no use
    const auto attempt = [&](std::vector<Trial> trials, std::optional<Trial>& best,
                             const FloorGain& enough = {}) {
        const Sensor& sensor = sensors[trials.front().sensor];
        const double most = rules_of_cameras.mostGain(sensor);
        const auto least = [&] { return best ? std::max(best->gain, enough) : enough; };
        for (std::size_t i = 0; i < trials.size(); ++i) {
            trials[i].most.required = most;
            trials[i].number = i;
        }
        // Small gains count, too: whole degrees about the best turn may gain more.
        const auto bound = [&](Trial& trial) {
            if (trial.floor == kUnbounded)
                trial.floor = gain.mostMore(poseAfter(sensor.pose, trial));
            return FloorGain{most, trial.floor};
        };
        const bool may_be_worthwhile = std::any_of(trials.begin(), trials.end(), [&](Trial& trial) {
            return bound(trial) > least() && bound(trial) >= worthwhile;
        });
        if (!may_be_worthwhile) return;
        // Without cells all gains are computed at once: then they are comparable in any case.
        double present = 0;
        const auto is_too_little = [&](const Trial& trial) { return trial.most <= least(); };
        if (coarse) {
            present = gain.gains({&sensor.pose, 1}).front();
            boundByCells(trials, sensor, {-most, present}, *coarse);
            std::erase_if(trials, is_too_little);
        }
        for (Trial& trial : trials)
            trial.most.gained = std::min(trial.most.gained, bound(trial).gained);
        std::erase_if(trials, is_too_little);
        std::stable_sort(trials.begin(), trials.end(),
                         [](const Trial& a, const Trial& b) { return a.most > b.most; });
        const std::size_t at_once = coarse ? kTrialsAtOnce : trials.size();
        bool is_found = false;
        for (std::size_t first = 0; first < trials.size() && !isStopped(); first += at_once) {
            if (trials[first].most < least()) break;
            const std::size_t end = std::min(first + at_once, trials.size());
            // By the rules first, which are less floor, and decide before all other floor.
            std::vector<std::size_t> tried;
            std::vector<Pose3> poses;
            for (std::size_t i = first; i < end; ++i) {
                const Pose3 pose = poseAfter(sensor.pose, trials[i]);
                if (coarse) trials[i].gain.required = rules_of_cameras.gain(sensor, pose);
                if (coarse && FloorGain{trials[i].gain.required, trials[i].most.gained} < least())
                    continue;
                tried.push_back(i);
                poses.push_back(pose);
            }
            if (poses.empty()) continue;
            if (!coarse) poses.push_back(sensor.pose);
            const std::vector<double> gains = gain.gains(poses);
            if (!coarse) present = gains.back();
            for (std::size_t k = 0; k < tried.size(); ++k) {
                Trial& trial = trials[tried[k]];
                trial.gain.gained = gains[k] - present;
                if (!coarse) {
                    if (FloorGain{most, trial.gain.gained} < least()) continue;
                    trial.gain.required = rules_of_cameras.gain(sensor, poses[k]);
                }
                const bool is_before =
                    is_found && trial.gain == best->gain && trial.number < best->number;
                if (!(trial.gain > least() || is_before)) continue;
                best = trial;
                is_found = true;
            }
        }
    };
    for (std::size_t i = 0; i < sensors.size() && !isStopped(); ++i) {
        gain.take(i);
        if (coarse) coarse->count(sensors[i]);
        std::vector<Trial> trials;
        if (gain.turns(i) && coarse && !scansSlice(sensors[i])) {
            // Estimates of all whole degrees cost the rays of one place.
            for (int degrees = 1; degrees <= 180; ++degrees)
                for (const int turned : {degrees, -degrees})
                    if (turned != -180) trials.push_back({i, turned});
            attempt(trials, turn, worthwhile);
        } else if (gain.turns(i)) {
            // Steps, then whole degrees about the best one and about the present heading. Other
            // sensors' turns are compared at the end, so that the order of records is of no matter.
            std::optional<Trial> own;
            for (int degrees = kTurnStep; degrees < 360; degrees += kTurnStep)
                trials.push_back({i, wholeTurn(degrees)});
            attempt(trials, own);
            const int middle = own ? own->turn : 0;
            trials.clear();
            for (int degrees = -kTurnStep + 1; degrees < kTurnStep; ++degrees) {
                if (degrees != 0) trials.push_back({i, wholeTurn(middle + degrees)});
                if (degrees != 0 && middle != 0) trials.push_back({i, degrees});
            }
            attempt(trials, own);
            if (own && (!turn || own->gain > turn->gain)) turn = own;
        }
        SiteRules rules;
        rules.height = sensors[i].pose.position.z;
        const SiteValidity validity(now.scene.environment, rules);
        trials.clear();
        for (const Vec2 by : displacements(kShifts))
            if (validity.isValid(sensors[i].pose.position.onFloor() + by))
                trials.push_back({i, 0, by});
        // No finer shifts follow that might gain more.
        if (!trials.empty()) attempt(trials, shift, worthwhile);
        advance(1);
    }
    std::vector<Suggestion> found;
    if (turn) {
        const std::string& id = sensors[turn->sensor].id;
        found.push_back(
            measured(now, Suggestion::Kind::Turn,
                     "turn " + id + " by " + std::to_string(turn->turn) + " degrees",
                     {parseEdit(Edit::Kind::Rotate, id + ':' + std::to_string(turn->turn))}));
    }
    if (shift) {
        const std::string& id = sensors[shift->sensor].id;
        found.push_back(measured(now, Suggestion::Kind::Shift,
                                 "move " + id + " by (" + formatFixed(shift->by.x, 2) + ", " +
                                     formatFixed(shift->by.y, 2) + ") m",
                                 {moveOf(id, shift->by)}));
    }
    return found;
}

/// Widens the steps of a search for a sensor whose views are cast by rays, each cell by its own.
void bound(ArrangeOptions& options, const Sensor& like, const Box2& limits) {
    if (scansSlice(like)) return;
    const double area = limits.width() * limits.depth();
    const double range = maxRange(like.model);
    const double seen = std::min(1.0, std::numbers::pi * range * range / area);
    const double step = options.density.lattice_step;
    const double looks = area / (step * step) * seen * kSearchedCells;
    if (looks <= kMaxLooks) return;
    const double wider = std::pow(looks / kMaxLooks, 0.25);
    options.density.lattice_step *= wider;
    options.density.wall_step *= wider;
    const double cells = std::max(kLeastCells, kSearchedCells / (wider * wider));
    options.cells = CellSize{std::max(0.1, std::sqrt(area / cells))};
}

/// Returns the options of a search for one more sensor like this one, with its height and support.
ArrangeOptions Adviser::optionsFor(const MeasuredState& now, const Scene& home,
                                   const Sensor& like) const {
    ArrangeOptions options;
    options.search.optimizer = Optimizer::Greedy;
    options.weights = weightsFor(now);
    options.plane = options_.measure.plane;
    options.pixel_density = options_.measure.density;
    RoomGoals goals;  // which a room alone takes from the options
    const Environment* const room = &now.scene.environment;
    camerarules::askPrivacy({options_.privacy}, {&room, 1}, options, {&goals, 1});
    options.seed = 0;
    options.is_for_gain_alone = true;
    const Box2& limits = home.environment.limits();
    CandidateDensity& density = options.density;
    density.lattice_step =
        std::max(density.lattice_step, std::sqrt(limits.width() * limits.depth() / kMaxLattice));
    density.wall_step = std::max(density.wall_step, density.lattice_step);
    bound(options, like, limits);
    const double z = like.pose.position.z;
    SiteRules rules;
    rules.height = z;
    rules.wall_within = kNearWall;
    const SiteValidity on_wall(home.environment, rules);
    options.mount.on =
        on_wall.isValid(like.pose.position.onFloor()) ? MountOn::Wall : MountOn::Floor;
    options.mount.heights = {z};
    return options;
}

/// Finds the best pose of one more sensor; empty without a valid site.
std::optional<Suggestion> Adviser::addition(const MeasuredState& now,
                                            const std::vector<SensorGroup>& groups,
                                            const ArrangeOptions& options) {
    StopsWith stops(progress_);
    Arrangement found;
    try {
        found = arrange(now.scene, groups, options, stops);
    } catch (const UnmetError&) {
        return std::nullopt;
    }
    if (found.sensors.empty()) return std::nullopt;
    const Record added = placedRecord(groups[0], found.sensors[0]);
    const Pose3& pose = found.sensors[0].pose;
    const std::string device = deviceName(groups[0].model);
    return measured(now, Suggestion::Kind::Add,
                    "add a " + (device.empty() ? added.keyword() : device) + " at (" +
                        formatFixed(pose.position.x, 2) + ", " + formatFixed(pose.position.y, 2) +
                        "), heading " + formatFixed(pose.heading.degrees(), 0) + " degrees",
                    {parseEdit(Edit::Kind::Add, formatRecord(added))});
}

namespace {

/// A sensor, another one of which may be added.
struct Example {
    const Scene* home;
    Sensor sensor;
};

std::vector<Example> examplesIn(const Scene& scene, const SuggestOptions& options) {
    std::vector<Example> examples;
    for (Sensor& sensor : standingSensors(scene)) examples.push_back({&scene, std::move(sensor)});
    for (const Scene* const other : options.others)
        for (Sensor& sensor : standingSensors(*other))
            examples.push_back({other, std::move(sensor)});
    return examples;
}

}  // namespace

std::int64_t Adviser::stepsOfMoves(const Scene& scene) const {
    return static_cast<std::int64_t>(standingSensors(scene).size() +
                                     examplesIn(scene, options_).size());
}

/// Bounds the floor that another sensor like this one gains, by the uncovered cells in reach of a
/// point, and all floor that cells miss; +infinity where they are not known.
double Adviser::mostAdded(const MeasuredState& now, const Sensor& like) {
    const Target& target = now.coverage.target;
    if (target.indoor.size() != target.grid.size() || !now.coverage.report.coverage.grid)
        return std::numeric_limits<double>::infinity();
    CellSet uncovered = target.indoor;
    uncovered -= coveredCells(now.coverage);
    const double missed = uncoveredFloor(now.coverage) -
                          static_cast<double>(uncovered.count()) * target.grid.cellArea();
    return mostWithin(maxRange(like.model), uncovered, target.grid) + std::max(0.0, missed);
}

std::vector<Suggestion> Adviser::additions(const MeasuredState& now) {
    std::vector<SensorModel> types;
    std::optional<Suggestion> best;
    for (const auto& [home, sensor] : examplesIn(now.scene, options_)) {
        advance(1);
        if (types.size() == kMaxTypes || isStopped()) continue;
        if (isPartial(sensor.model) ||
            std::find(types.begin(), types.end(), sensor.model) != types.end())
            continue;
        types.push_back(sensor.model);
        if (mostAdded(now, sensor) < leastGain(now)) continue;
        const auto at = std::find(home->ids.begin(), home->ids.end(), sensor.id);
        if (at == home->ids.end()) continue;
        Record record = home->records[static_cast<std::size_t>(at - home->ids.begin())];
        const bool is_carried = record.schema().find("on") != nullptr && record.has("on");
        if (is_carried && home != &now.scene) continue;  // its carrier is elsewhere
        for (const char* key : {"id", "at", "heading"})
            if (record.has(key)) record.erase(key);
        const std::vector<SensorGroup> groups = {{record, sensor.model, "", false, 1}};
        for (const ArrangeOptions& options : goalsOf(now, optionsFor(now, *home, sensor)))
            if (auto added = addition(now, groups, options)) offer(best, *std::move(added));
    }
    if (!best) return {};
    return {std::move(*best)};
}

namespace {

std::vector<Edit> editsOf(const std::vector<Suggestion>& steps) {
    std::vector<Edit> edits;
    for (const Suggestion& step : steps)
        edits.insert(edits.end(), step.edits.begin(), step.edits.end());
    return edits;
}

}  // namespace

/// Leaves out each change without which the others still meet all.
void Adviser::leaveOutNeedless(const MeasuredState& now, std::vector<Suggestion>& steps) {
    for (std::size_t i = 0; i < steps.size() && steps.size() > 1 && !isStopped();) {
        std::vector<Suggestion> fewer = steps;
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
        bool is_enough = false;
        try {
            is_enough = after(now, editsOf(fewer)).missing == 0;
        } catch (const UsageError&) {  // a later change is of the sensor that this one adds
        }
        if (is_enough)
            steps = std::move(fewer);
        else
            ++i;
    }
}

std::optional<Suggestion> Adviser::together(const MeasuredState& now,
                                            std::vector<Suggestion> first) {
    MeasuredState state = now;
    std::vector<Suggestion> steps, choices = std::move(first);
    // One change for each camera that sees private zones, at least.
    progress_.begin("changes for all requirements",
                    static_cast<std::int64_t>(std::clamp<std::size_t>(
                        intruders(now.scene), std::size_t{1}, kMaxChanges)));
    while (state.missing > 0) {
        // A change mends one of the cameras that see private zones.
        const std::size_t left = kMaxChanges - steps.size();
        if (left == 0 || intruders(state.scene) > left || isStopped()) return std::nullopt;
        const auto best = std::max_element(
            choices.begin(), choices.end(),
            [](const Suggestion& a, const Suggestion& b) { return a.required < b.required; });
        if (best == choices.end() || best->required <= 0) return std::nullopt;
        steps.push_back(*best);
        state = after(state, best->edits);
        progress_.advance(1);
        is_repeating_ = true;
        if (state.missing > 0) choices = moves(state);
        is_repeating_ = false;
    }
    leaveOutNeedless(now, steps);
    std::string text;
    for (const Suggestion& step : steps) text += (text.empty() ? "" : ", ") + step.text;
    return measured(now, Suggestion::Kind::Together, std::move(text), editsOf(steps));
}

std::string_view nameOf(Suggestion::Kind kind) {
    constexpr std::string_view kNames[] = {"add",     "turn",   "shift",   "furniture",
                                           "replace", "remove", "together"};
    return kNames[static_cast<std::size_t>(kind)];
}

std::vector<Suggestion> suggestChanges(const Scene& scene, const Coverage& coverage,
                                       const SuggestOptions& options,
                                       const DeviceCatalogue& devices, Progress& progress) {
    Adviser adviser(options, devices, progress);
    const MeasuredState now{
        scene, coverage,
        missingFloor(scene, coverage, options, adviser.privateFloorOf(scene.environment))};
    const double least = kWorthwhile * coverage.report.indoor_area;
    // No change gains more floor than is missing.
    const bool may_gain = now.missing > 0 || uncoveredFloor(coverage) >= least;
    std::vector<Suggestion> gains;
    if (may_gain) {
        progress.begin("poses of sensors", adviser.stepsOfMoves(scene));
        gains = adviser.moves(now);
    }
    std::optional<Suggestion> whole;
    if (now.missing > 0 && !progress.stopped()) whole = adviser.together(now, gains);
    if (may_gain && !progress.stopped())
        if (auto piece = adviser.furniture(now)) gains.push_back(std::move(*piece));
    std::erase_if(gains, [&](const Suggestion& suggestion) {
        // Removals are for `whole`.
        return suggestion.kind == Suggestion::Kind::Remove || suggestion.required < 0 ||
               std::max(suggestion.gained, suggestion.required) < least;
    });
    std::stable_sort(gains.begin(), gains.end(), [](const Suggestion& a, const Suggestion& b) {
        return std::pair(a.required, a.gained) > std::pair(b.required, b.gained);
    });
    if (whole) {  // told once if it is a single change
        std::erase_if(gains, [&](const Suggestion& one) { return one.text == whole->text; });
        gains.insert(gains.begin(), std::move(*whole));
    }
    if (auto cheaper = adviser.replacement(now)) gains.push_back(std::move(*cheaper));
    if (auto useless = progress.stopped() ? std::nullopt : adviser.removal(now))
        gains.push_back(std::move(*useless));
    progress.end();
    if (gains.size() > options.most) gains.resize(options.most);
    return gains;
}

}  // namespace ispace::advice
