// SPDX-License-Identifier: GPL-3.0-or-later
// The problem of a robust search: the cells of all cases, one after another.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "arrange/coverage_model.h"
#include "arrange/objective.h"
#include "arrange/search/case_values.h"
#include "base/error.h"

namespace ispace {

namespace {

/// Largest total weight that failureProblem() takes.
constexpr double kMaxTotal = 1 << 25;

std::uint64_t totalOf(const std::vector<std::uint32_t>& weights) {
    return std::accumulate(weights.begin(), weights.end(), std::uint64_t{0});
}

}  // namespace

void CoverageModel::stackCases() {
    if (site_.isOneRoom()) return stackOneRoom();
    // Failures of sensors in any room: the cells of all rooms are those of the one case.
    cases_.blocks.push_back({0, problem_.cells()});
    for (std::size_t i = 0; i < rooms_.size(); ++i) {
        std::vector<SiteSensor> sensors;
        for (const Sensor& sensor : site_.rooms[i].scene->sensors)
            if (kindOf(sensor.model).perceives) sensors.push_back({i, sensor});
        for (CountedView& view : viewsOf(std::span<const SiteSensor>(sensors)))
            cases_.standing.push_back(std::move(view.cells));
        for (const SiteSensor& sensor : sensors)
            standing_ids_.push_back(site_.rooms[i].id + '/' + sensor.sensor.id);
    }
    stackFailures();
    cases_.problem = &problem_;
    total_ = isWorstCase() ? cases_.totalOf(0) : problem_.totalWeight();
}

void CoverageModel::stackOneRoom() {
    RoomModel& model = only();
    model.makeCases();
    std::vector<double> weights;
    std::vector<std::uint16_t> achieved;
    double first_total = 0;
    for (const auto& room : model.cases()) {
        const std::size_t first = weights.size();
        const Coverage standing = measureCoverage(
            room->scene, room->worlds,
            {.cells = searchCells(options_), .plane = options_.plane, .exact = false});
        room->target = standing.target;
        std::vector<double> own = cellWeights(room->target, model.options());
        const double total = std::accumulate(own.begin(), own.end(), 0.0);
        if (total <= 0) throw UnmetError("nothing to cover in " + room->name);
        if (first == 0) first_total = total;
        room->counted = CellSet(own.size());
        for (std::size_t i = 0; i < own.size(); ++i)
            if (own[i] > 0) room->counted.set(i);
        // Rooms count the same, however large they are.
        if (total != first_total)
            for (double& weight : own) weight *= first_total / total;
        weights.insert(weights.end(), own.begin(), own.end());
        achieved.resize(weights.size());
        model.countStanding(standing.sensors, first, achieved);
        room->firsts = {first};
        cases_.blocks.push_back({first, weights.size()});
        if (options_.robust.of == RobustChoice::Of::Failures)
            for (const SensorView& view : standing.sensors) {
                cases_.standing.push_back(view.cells);
                standing_ids_.push_back(view.id);
            }
    }
    problem_.weights = integerWeights(weights);
    problem_.achieved = std::move(achieved);
    problem_.standing = CellSet(problem_.cells());
    if (options_.robust.of == RobustChoice::Of::Failures) stackFailures();
    cases_.problem = &problem_;
    total_ = isWorstCase() ? cases_.totalOf(0) : problem_.totalWeight();
}

void CoverageModel::stackFailures() {
    if (unit_ > 1)
        throw UsageError("--robust failures: receivers hear a tag together; leave them out");
    const auto failures = static_cast<std::size_t>(options_.robust.failures);
    const std::size_t sensors = cases_.standing.size() + sensorsToPlace(groups_, kinds_).size();
    if (failures >= sensors)
        throw UsageError(
            "--robust failures:" + std::to_string(failures) + ": there " +
            (sensors == 1 ? "is one sensor" : "are " + std::to_string(sensors) + " sensors") +
            ", and one at least has to work");
    if (const auto total = static_cast<double>(totalOf(problem_.weights)); total > kMaxTotal)
        for (std::uint32_t& weight : problem_.weights)
            weight = static_cast<std::uint32_t>(std::ceil(weight * (kMaxTotal / total)));
    const std::size_t cells = problem_.cells();
    FailureProblem made = failureProblem(problem_, problem_.achieved, sensors, failures);
    problem_ = std::move(made.problem);
    problem_.standing = CellSet(problem_.cells());
    cases_.failures = options_.robust.failures;
    cases_.least_total = made.least_total;
    const auto copy_at = [&](std::vector<std::size_t>& firsts) {
        const std::size_t first = firsts.front();
        for (std::size_t m = 1; m <= failures; ++m) firsts.push_back(m * cells + first);
    };
    if (site_.isOneRoom())
        copy_at(only().cases().front()->firsts);
    else
        for (Room& room : rooms_) copy_at(room.firsts);
    for (CellSet& view : cases_.standing) {
        CellSet stack(problem_.cells());
        for (std::size_t m = 0; m <= failures; ++m)
            view.forEach([&](std::size_t cell) { stack.set(m * cells + cell); });
        view = std::move(stack);
    }
}

RobustValues CoverageModel::robustValuesOf(std::span<const CountedView> views,
                                           std::span<const Placement> sensors) const {
    std::vector<SensorCells> cells;
    for (const CountedView& view : views) cells.push_back({&view.cells, view.multiplicity});
    const CaseValues values(cases_, cells);
    const CaseValue worst = values.worst();
    const auto unit = static_cast<double>(cases_.totalOf(0));
    RobustValues robust;
    robust.worst = static_cast<double>(worst.value) / unit;
    robust.mean = static_cast<double>(valueOf(views)) / static_cast<double>(problem_.totalWeight());
    if (cases_.failures > 0) {
        robust.shares = {robust.worst};
    } else {
        for (const std::uint64_t value : values.ofBlocks())
            robust.shares.push_back(static_cast<double>(value) / unit);
        for (const auto& room : only().cases()) robust.names.push_back(room->name);
    }
    for (const std::size_t failed : worst.failed)
        robust.failed.push_back(failed < standing_ids_.size()
                                    ? standing_ids_[failed]
                                    : wholeId(site_, sensors[failed - standing_ids_.size()]));
    return robust;
}

}  // namespace ispace
