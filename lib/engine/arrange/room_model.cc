// SPDX-License-Identifier: GPL-3.0-or-later
// Cells, weights and standing coverage of one room, on the search's grid. Views of standing sensors
// come from measureCoverage(), those of candidates from CandidateViews: both count the same cells.
#include "arrange/room_model.h"

#include <algorithm>
#include <utility>

#include "arrange/objective.h"

namespace ispace {

ArrangeOptions optionsOf(const RoomGoals& goals, ArrangeOptions options) {
    options.weights = goals.weights;
    options.mount.keep_out = goals.keep_out;
    options.mount.keep_in = goals.keep_in;
    options.mount.forbidden = goals.forbidden;
    options.unseen = goals.unseen;
    options.cover_rule = goals.cover_rule;
    options.list = goals.places;
    options.demand = goals.demand;
    return options;
}

RoomGoals goalsOf(const ArrangeOptions& options) {
    RoomGoals goals;
    goals.weights = options.weights;
    goals.keep_out = options.mount.keep_out;
    goals.keep_in = options.mount.keep_in;
    goals.forbidden = options.mount.forbidden;
    goals.unseen = options.unseen;
    goals.cover_rule = options.cover_rule;
    goals.places = options.list;
    goals.demand = options.demand;
    return goals;
}

RoomModel::RoomModel(const SiteRoom& room, const ArrangeOptions& options,
                     std::span<const SensorClass> kinds, int unit)
    : scene_(room.scene),
      options_(optionsOf(room.goals, options)),
      unit_(unit),
      worlds_(scene_->environment),
      sight_(scene_->environment, options_.plane, &worlds_),
      counted_(0),
      standing_(0) {
    const Coverage standing =
        measureCoverage(*scene_, worlds_,
                        {.cells = searchCells(options_), .plane = options_.plane, .exact = false});
    target_ = standing.target;
    if (!options_.indoor_only)
        for (std::size_t i = 0; i < target_.indoor.size(); ++i) target_.indoor.set(i);
    weights_ = cellWeights(target_, options_);
    if (!room.goals.counts) std::fill(weights_.begin(), weights_.end(), 0);
    counted_ = CellSet(weights_.size());
    for (std::size_t i = 0; i < weights_.size(); ++i)
        if (weights_[i] > 0) counted_.set(i);
    if (options_.cover_rule) rule_ = options_.cover_rule(scene_->environment, target_);
    achieved_.assign(target_.grid.size(), 0);
    countStanding(standing.sensors, 0, achieved_);
    standing_ = CellSet(target_.grid.size());
    for (const SensorView& view : standing.sensors) standing_ |= view.cells;
    if (options_.demand) countDemand(kinds);
}

CaseRoom& RoomModel::addCase(const Scene& scene, std::size_t room) {
    cases_.push_back(std::make_unique<CaseRoom>(scene, options_, room, cases_.size()));
    return *cases_.back();
}

double RoomModel::areaOfCell(const Scene& scene, const Target& target) const {
    if (options_.demand) return 1;
    const Grid& grid = target.grid;
    const std::size_t indoor = target.indoor.count();
    if (!options_.indoor_only || indoor == 0)
        return grid.limits.width() * grid.limits.depth() / static_cast<double>(grid.size());
    return scene.environment.indoor().area() / static_cast<double>(indoor);
}

void RoomModel::countStanding(const std::vector<SensorView>& views, std::size_t first,
                              std::vector<std::uint16_t>& achieved) const {
    for (const SensorView& view : views) {
        const int part = view.isPartial() ? 1 : unit_;
        CellSet cells = view.cells;
        if (rule_)
            rule_->keepCovered(scene_->sensors[view.index].model, view.pose.position.onFloor(),
                               cells);
        cells.forEach([&](std::size_t cell) {
            achieved[first + cell] =
                static_cast<std::uint16_t>(std::min(achieved[first + cell] + part, 0xffff));
        });
    }
}

/// Standing sensors serve first; what they achieve is capped at 65535.
void RoomModel::countDemand(std::span<const SensorClass> kinds) {
    const Demand& demand = *options_.demand;
    for (const SensorClass& kind : kinds) demand.mustServe(kind.model, kind.id);
    weights_ = demand.weights();
    counted_ = CellSet(weights_.size());
    achieved_.assign(weights_.size(), 0);
    standing_ = CellSet(weights_.size());
    for (const Sensor& sensor : scene_->sensors) {
        if (!demand.isServedBy(sensor)) continue;
        prepare(sensor);
        const int part = isPartial(sensor.model) ? 1 : unit_;
        const CellSet served = demand.servedBy(sensor, worlds_);
        standing_ |= served;
        served.forEach([&](std::size_t i) {
            achieved_[i] = static_cast<std::uint16_t>(std::min(achieved_[i] + part, 0xffff));
        });
    }
}

void RoomModel::prepare(const Sensor& sensor) {
    sight_.prepare(sensor);
    if (options_.demand) worlds_.prepare(sensor.pose);
    for (const auto& room : cases_) room->sight.prepare(room->mounted(sensor));
}

CellSet RoomModel::cellsOf(const Sensor& sensor, std::size_t all) const {
    CellSet cells = options_.demand  ? options_.demand->servedBy(sensor, worlds_)
                    : cases_.empty() ? sight_.cellsOf(target_.grid, sensor)
                                     : CellSet(all);
    for (const auto& room : cases_)
        room->sight.cellsOf(room->target.grid, room->mounted(sensor))
            .forEach([&](std::size_t cell) { cells.set(room->first + cell); });
    if (rule_) rule_->keepCovered(sensor.model, sensor.pose.position.onFloor(), cells);
    return cells;
}

void RoomModel::keepFromBeyond(CellParts& parts) const {
    if (rule_) rule_->removeAll(parts);
}

void RoomModel::makePool(std::vector<std::uint32_t> left, Progress& progress) {
    CellSet counted = counted_;
    for (std::size_t i = 0; options_.is_for_gain_alone && i < left.size(); ++i)
        if (left[i] == 0) counted.reset(i);
    pool_ = std::make_unique<CandidatePool>(scene_->environment, worlds_, target_,
                                            CandidateWeights{std::move(counted), std::move(left)},
                                            options_, progress, cases_, rule_.get(),
                                            options_.demand.get());
}

}  // namespace ispace
