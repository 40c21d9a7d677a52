// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/measured_scene.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "arrange/beam_cells.h"
#include "arrange/candidate.h"
#include "arrange/localise_search.h"
#include "arrange/objective.h"
#include "arrange/refine.h"
#include "arrange/search/problem.h"
#include "arrange/sensor_group.h"
#include "base/error.h"
#include "base/number.h"
#include "scene/sensor/ultrasound.h"
#include "sense/motion_sense.h"
#include "sense/scan.h"

namespace ispace {

namespace {

std::vector<SensorModel> devicesOf(const std::vector<SensorClass>& kinds) {
    std::vector<SensorModel> devices;
    devices.reserve(kinds.size());
    for (const SensorClass& kind : kinds) devices.push_back(kind.model);
    return devices;
}

CoverageOptions searching(const ArrangeOptions& options) {
    return {.cells = searchCells(options), .plane = options.plane, .exact = false};
}

CellSet countedCells(const Problem& problem) {
    CellSet counted(problem.cells());
    for (std::size_t i = 0; i < problem.cells(); ++i)
        if (problem.weights[i] > 0) counted.set(i);
    return counted;
}

/// Explains why no floor counts.
/// \pre all cells weigh 0
std::string nothingText(const Target& target, FloorWeights weights) {
    weights.weights.clear();
    const std::vector<double> unweighted = weightsOfCells(target, weights);
    const bool is_weight =
        std::any_of(unweighted.begin(), unweighted.end(), [](double cell) { return cell > 0; });
    return is_weight ? "nothing to cover: all of the target weighs 0 (--weight)"
                     : "nothing to cover: no cell of the target lies indoors; use a larger zone or "
                       "smaller cells (--cell)";
}

}  // namespace

MeasuredScene::MeasuredScene(const Scene& scene, const std::vector<SensorGroup>& groups,
                             const ArrangeOptions& options, Progress& progress)
    : scene_(scene),
      groups_(groups),
      options_(options),
      worlds_(scene.environment),
      sight_(scene.environment, options.plane, &worlds_),
      kinds_(kindsOf(groups, drawsForEach(options))) {
    mustBeAffordable();
    if (options.refine) mustBeRefinable(scene, devicesOf(kinds_), options.weights);
    const Coverage standing = measureCoverage(scene, worlds_, searching(options));
    target_ = standing.target;
    if (!options.judges_inside)
        for (std::size_t i = 0; i < target_.indoor.size(); ++i) target_.indoor.set(i);
    problem_.weights = integerWeights(cellWeights(target_, options));
    total_ = problem_.totalWeight();
    if (total_ == 0) throw UnmetError(nothingText(target_, options.weights));
    CellSet counted = countedCells(problem_);
    setUnits();
    if (!options.facing.empty()) facing_.emplace(scene.environment, target_, options.facing);
    setMultiplicities(standing);
    if (options.ways) countWays();
    rooms_ = caseRoomsOf(scene, options);
    if (!rooms_.empty()) stackRooms();
    if (options.objective.of == ObjectiveChoice::Of::Path) setWays();
    if (options.objective.of == ObjectiveChoice::Of::Localise) total_ *= kNoError;
    pool_ = std::make_unique<CandidatePool>(
        scene.environment, worlds_, target_, CandidateWeights{std::move(counted), weightsLeft()},
        options, progress, rooms_, facing_ ? &*facing_ : nullptr, ways_ ? &*ways_ : nullptr);
    addKinds();
}

void MeasuredScene::mustBeAffordable() const {
    if (!options_.budget) return;
    double least = kinds_.front().cost;
    for (const SensorClass& kind : kinds_) least = std::min(least, kind.cost);
    if (*options_.budget < least)
        throw UnmetError("a budget of " + formatDouble(*options_.budget) +
                         " buys nothing: the cheapest sensor costs " + formatDouble(least));
}

/// Four receivers count as one sensor; in the presence of receivers, others have multiplicity 4.
void MeasuredScene::setUnits() {
    const auto is_partial = [](const auto& sensor) { return isPartial(sensor.model); };
    const bool listens = std::any_of(scene_.sensors.begin(), scene_.sensors.end(), is_partial) ||
                         std::any_of(kinds_.begin(), kinds_.end(), is_partial);
    unit_ = listens ? static_cast<int>(kMinReceivers) : 1;
    problem_.required = unit_ * options_.redundancy;
    problem_.is_connected = options_.is_connected;
    problem_.budget = options_.budget;
}

void MeasuredScene::countStanding(const std::vector<SensorView>& views, std::size_t first,
                                  std::vector<std::uint16_t>& achieved) const {
    for (const SensorView& view : views) {
        const int part = view.isPartial() ? 1 : unit_;
        CellSet cells = view.cells;
        if (facing_)
            facing_->keepFaces(scene_.sensors[view.index].model, view.pose.position.onFloor(),
                               cells);
        cells.forEach([&](std::size_t cell) {
            achieved[first + cell] =
                static_cast<std::uint16_t>(std::min(achieved[first + cell] + part, 0xffff));
        });
    }
}

void MeasuredScene::setMultiplicities(const Coverage& standing) {
    problem_.achieved.assign(target_.grid.size(), 0);
    countStanding(standing.sensors, 0, problem_.achieved);
    problem_.standing = CellSet(target_.grid.size());
    for (const SensorView& view : standing.sensors) problem_.standing |= view.cells;
}

void MeasuredScene::countWays() {
    for (const SensorClass& kind : kinds_)
        if (!detectsMotion(kind.model))
            throw UsageError("--presence: " + kind.id +
                             " detects no motion: give PIR sensors or "
                             "radars");
    const PresenceView& view = ways_.emplace(*options_.ways, options_.plane);
    std::vector<double> lengths;
    lengths.reserve(options_.ways->pieces.size());
    for (const WayPiece& piece : options_.ways->pieces) lengths.push_back(piece.length);
    problem_.weights = integerWeights(lengths);
    total_ = problem_.totalWeight();
    if (total_ == 0) throw UnmetError("nothing to detect: nobody walks in the ways of --presence");
    problem_.achieved.assign(problem_.cells(), 0);
    problem_.standing = CellSet(problem_.cells());
    for (const Sensor& sensor : scene_.sensors) {
        if (!detectsMotion(sensor.model)) continue;
        sight_.prepare(sensor);
        const CellSet pieces = view.detected(sensor, worlds_);
        problem_.standing |= pieces;
        pieces.forEach([&](std::size_t i) {
            problem_.achieved[i] =
                static_cast<std::uint16_t>(std::min(problem_.achieved[i] + unit_, 0xffff));
        });
    }
}

void MeasuredScene::addKinds() {
    for (const SensorClass& kind : kinds_) {
        CandidatePool::Made made = pool_->make(kind);
        is_complete_ = is_complete_ && made.is_complete;
        if (made.set->size() == 0)
            throw UnmetError(made.is_complete && !options_.privacy.empty()
                                 ? "no place for " + kind.id + ": all see zones of --privacy"
                                 : "stopped before there was any candidate for " + kind.id);
        sets_.push_back(std::move(made.set));
        problem_.kinds.push_back(
            {sets_.back().get(), kind.most, kind.cost, isPartial(kind.model) ? 1 : unit_});
    }
    cases_.problem = &problem_;
    if (options_.budget || options_.target) return;
    for (const Placement& sensor : sensorsToPlace(groups_, kinds_))
        problem_.order.push_back(sensor.kind);
}

std::size_t MeasuredScene::candidates() const {
    std::size_t count = 0;
    for (const auto& set : sets_) count += set->size();
    return count;
}

std::size_t MeasuredScene::bytes() const {
    std::size_t bytes = 0;
    for (const auto& set : sets_) bytes += set->bytes();
    return bytes;
}

SearchOptions MeasuredScene::searchOptions() const {
    SearchOptions searching = options_.search;
    const std::size_t taken = std::min(bytes(), options_.max_bytes);
    searching.max_bytes = std::min(searching.max_bytes, options_.max_bytes - taken);
    return searching;
}

double MeasuredScene::share(std::uint64_t value) const {
    return static_cast<double>(value) / static_cast<double>(total_);
}

std::uint64_t MeasuredScene::valueFor(double share) const {
    return static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(total_) - 1e-6));
}

std::vector<std::uint32_t> MeasuredScene::weightsLeft() const {
    std::vector<std::uint32_t> left = problem_.weights;
    for (std::size_t i = 0; i < left.size(); ++i)
        if (problem_.achieved[i] >= problem_.required) left[i] = 0;
    return left;
}

std::vector<Placement> MeasuredScene::placementsOf(const std::vector<Choice>& chosen) const {
    std::vector<std::vector<Pose3>> poses(kinds_.size());
    for (const Choice& choice : chosen) poses[choice.kind].push_back(poseOf(choice));
    return ispace::placementsOf(scene_, groups_, kinds_, poses);
}

std::vector<CountedView> MeasuredScene::viewsOf(std::span<const Sensor> sensors) const {
    std::vector<CountedView> views(sensors.size());
    for (const Sensor& sensor : sensors) {
        sight_.prepare(sensor);
        for (const auto& room : rooms_) room->sight.prepare(room->mounted(sensor));
    }
    tbb::parallel_for(std::size_t{0}, sensors.size(), [&](std::size_t i) {
        // A thread that waits for a level in here must not begin with another sensor.
        tbb::this_task_arena::isolate([&] {
            views[i] = {ways_            ? ways_->detected(sensors[i], worlds_)
                        : rooms_.empty() ? sight_.cellsOf(target_.grid, sensors[i])
                                         : stackedCellsOf(sensors[i]),
                        isPartial(sensors[i].model) ? 1 : unit_};
            if (facing_)
                facing_->keepFaces(sensors[i].model, sensors[i].pose.position.onFloor(),
                                   views[i].cells);
        });
    });
    return views;
}

std::uint64_t MeasuredScene::valueOf(std::span<const CountedView> views) const {
    std::vector<int> met(problem_.achieved.begin(), problem_.achieved.end());
    for (const CountedView& view : views)
        view.cells.forEach([&](std::size_t cell) { met[cell] += view.multiplicity; });
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < met.size(); ++i)
        if (met[i] >= problem_.required) value += problem_.weights[i];
    return value;
}

bool MeasuredScene::isConnected(std::span<const CountedView> views) const {
    const CellSet counted = countedCells(problem_);
    std::vector<CellSet> waiting;
    CellSet reached = problem_.standing;
    reached &= counted;
    for (const CountedView& view : views) {
        waiting.push_back(view.cells);
        waiting.back() &= counted;
    }
    if (reached.empty() && !waiting.empty()) {
        reached = waiting.back();
        waiting.pop_back();
    }
    // Merges views that share a cell with the merged ones until the set stops growing.
    for (bool grows = true; grows;) {
        grows = false;
        for (std::size_t i = 0; i < waiting.size(); ++i) {
            if (countCommon(waiting[i], reached) == 0) continue;
            reached |= waiting[i];
            waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(i--));
            grows = true;
        }
    }
    return waiting.empty();
}

void MeasuredScene::spreadRedundant(std::vector<Choice>& chosen) const {
    std::vector<Point3> standing;
    for (const Sensor& sensor : scene_.sensors)
        if (kindOf(sensor.model).perceives) standing.push_back(sensor.pose.position);
    const auto position_of = [this](const Choice& choice) { return poseOf(choice).position; };
    ispace::spreadRedundant(problem_, standing, position_of, chosen);
}

std::uint64_t MeasuredScene::maxFromAnyPlace(const std::vector<int>& most) const {
    return ispace::maxFromAnyPlace(problem_, target_.grid, devicesOf(kinds_), most);
}

namespace {

void addSliceAreas(Worlds& worlds, const Laser& laser, std::span<TriedPose> poses) {
    for (const TriedPose& tried : poses) worlds.prepare(tried.pose);
    tbb::parallel_for(std::size_t{0}, poses.size(), [&](std::size_t i) {
        const Sensor placed{"", laser, poses[i].pose};
        poses[i].slice_area = sliceArea(laser, castBeams(worlds.at(placed.pose), placed));
    });
}

}  // namespace

std::vector<TriedPose> MeasuredScene::triedPoses(const std::vector<Choice>& chosen) {
    const WeightSums weights(weightsLeft());
    std::vector<TriedPose> all;
    all.reserve(candidates());
    for (std::size_t k = 0; k < problem_.kinds.size(); ++k) {
        const CandidateSet& set = *problem_.kinds[k].candidates;
        const SensorClass& kind = kinds_[k];
        std::vector<std::uint32_t> values(set.size());
        set.weighAll(weights, values);
        const double part = static_cast<double>(problem_.kinds[k].multiplicity) / problem_.required;
        const std::size_t first = all.size();
        for (std::size_t i = 0; i < set.size(); ++i)
            all.push_back({kind.id, poseOf({k, i}), part * share(values[i]), false});
        for (const Choice& choice : chosen)
            if (choice.kind == k) all[first + choice.candidate].is_chosen = true;
        if (const auto* laser = std::get_if<Laser>(&kind.model))
            addSliceAreas(worlds_,
                          options_.beam_step ? withBeamStep(*laser, *options_.beam_step) : *laser,
                          std::span(all).subspan(first));
    }
    return all;
}

std::vector<GainMap> MeasuredScene::gainMaps(std::vector<Choice> chosen) const {
    std::vector<Placement> placements = placementsOf(chosen);
    std::vector<std::uint32_t> times(problem_.cells());
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = problem_.achieved[i];
    std::vector<GainMap> maps;
    std::vector<Placement> before;
    while (!chosen.empty()) {
        std::vector<std::uint32_t> left = problem_.weights;
        for (std::size_t i = 0; i < left.size(); ++i)
            if (times[i] >= static_cast<std::uint32_t>(problem_.required)) left[i] = 0;
        const WeightSums weights(left);
        const auto gain_of = [&](const Choice& choice) {
            return problem_.kinds[choice.kind].candidates->weigh(choice.candidate, weights);
        };
        const auto next = std::max_element(
            chosen.begin(), chosen.end(),
            [&](const Choice& a, const Choice& b) { return gain_of(a) < gain_of(b); });
        const auto [kind, candidate] = *next;
        const Pose3 pose = poseOf(*next);
        const auto placed = std::find_if(
            placements.begin(), placements.end(), [&, kind = kind](const Placement& placement) {
                return placement.kind == kind && placement.pose == pose;
            });
        GainMap& map = maps.emplace_back(GainMap{placed->sensor, before});
        const CandidateSet& set = *problem_.kinds[kind].candidates;
        std::vector<std::uint32_t> values(set.size());
        set.weighAll(weights, values);
        const double part =
            static_cast<double>(problem_.kinds[kind].multiplicity) / problem_.required;
        for (std::size_t i = 0; i < set.size(); ++i)
            map.poses.push_back(
                {map.sensor, poseOf({kind, i}), part * share(values[i]), i == candidate});
        const auto added = static_cast<std::uint32_t>(problem_.kinds[kind].multiplicity);
        set.cellsOf(candidate).forEach([&](std::size_t cell) { times[cell] += added; });
        before.push_back(*placed);
        placements.erase(placed);
        chosen.erase(next);
    }
    return maps;
}

}  // namespace ispace
