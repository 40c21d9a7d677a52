// SPDX-License-Identifier: GPL-3.0-or-later
// The problem of a search in several cases: the cells of all of them, one after another.
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
    if (options_.cases->failures())
        stackFailures();
    else
        stackRooms();
    cases_.problem = &problem_;
    total_ = isWorstCase() ? cases_.totalOf(0) : problem_.totalWeight();
}

void CoverageModel::stackRooms() {
    const LayoutCases& cases = *options_.cases;
    view_cases_ = cases.sites();
    for (Room& room : rooms_) {
        if (room.model == nullptr) continue;
        room.copies.clear();
        room.cells = 0;
    }
    /// The cells of a room in a case, and the area of each.
    struct Stacked {
        CellBlock cells;
        double area = 0;
    };
    std::vector<Stacked> stack;
    std::vector<double> weights;
    std::vector<std::uint16_t> achieved;
    bool is_even = true;  // the cells of all rooms are of equal size
    std::vector<std::vector<SiteSensor>> sensors(view_cases_);
    for (std::size_t number = 0; number < view_cases_; ++number) {
        const std::size_t begin = weights.size(), first = stack.size();
        const SiteCase site = cases.siteIn(site_, number);
        case_sights_.push_back(site.sight);
        sensors[number] = standingIn(site);
        for (std::size_t i = 0; i < rooms_.size(); ++i) {
            if (rooms_[i].model == nullptr) continue;
            RoomModel& model = *rooms_[i].model;
            CaseRoom& in = model.addCase(*site.rooms[i], i);
            const Coverage standing = measureCoverage(
                in.scene, in.worlds,
                {.cells = searchCells(options_), .plane = options_.plane, .exact = false});
            in.target = standing.target;
            std::vector<double> own = cellWeights(in.target, model.options());
            in.counted = CellSet(own.size());
            for (std::size_t cell = 0; cell < own.size(); ++cell) {
                if (!site_.rooms[i].goals.counts) own[cell] = 0;
                if (own[cell] > 0) in.counted.set(cell);
            }
            in.first = rooms_[i].cells;
            rooms_[i].cells += own.size();
            rooms_[i].copies.push_back({{in.first, rooms_[i].cells}, weights.size()});
            stack.push_back({{weights.size(), weights.size() + own.size()},
                             model.areaOfCell(in.scene, in.target)});
            is_even = is_even && stack.back().area == stack[first].area;
            achieved.resize(weights.size() + own.size());
            model.countStanding(standing.sensors, weights.size(), achieved);
            weights.insert(weights.end(), own.begin(), own.end());
        }
        cases_.blocks.push_back({begin, weights.size()});
    }
    if (!is_even)
        for (const auto& [cells, area] : stack)
            for (std::size_t cell = cells.first; cell < cells.end; ++cell) weights[cell] *= area;
    // Cases count the same, however large they are.
    double first_total = 0;
    for (std::size_t number = 0; number < view_cases_; ++number) {
        const auto own = std::span(weights).subspan(
            cases_.blocks[number].first, cases_.blocks[number].end - cases_.blocks[number].first);
        const double total = std::accumulate(own.begin(), own.end(), 0.0);
        if (total <= 0) throw UnmetError("nothing to cover in " + cases.nameOf(number));
        if (number == 0) first_total = total;
        if (total != first_total)
            for (double& weight : own) weight *= first_total / total;
    }
    if (is_even)
        problem_.weights = integerWeights(weights);
    else
        setAreas(std::move(weights));
    problem_.achieved = std::move(achieved);
    problem_.standing = CellSet(problem_.cells());
    for (std::size_t number = 0; joinsRooms() && number < view_cases_; ++number)
        countStandingBeyond(number, sensors[number]);
}

void CoverageModel::stackFailures() {
    // Failures of sensors in any room: the cells of all rooms are those of the one case.
    cases_.blocks.push_back({0, problem_.cells()});
    for (std::size_t i = 0; i < rooms_.size(); ++i) {
        std::vector<SiteSensor> sensors;
        for (const Sensor& sensor : site_.rooms[i].scene->sensors)
            if (kindOf(sensor.model).perceives) sensors.push_back({i, sensor});
        for (CountedView& view : viewsOf(std::span<const SiteSensor>(sensors)))
            cases_.standing.push_back(std::move(view.cells));
        for (const SiteSensor& sensor : sensors)
            standing_ids_.push_back(wholeId(site_, i, sensor.sensor.id));
    }
    const std::string option(options_.cases->option());
    if (unit_ > 1) throw UsageError(option + ": receivers hear a tag together; leave them out");
    const auto failures = static_cast<std::size_t>(*options_.cases->failures());
    const std::size_t sensors = cases_.standing.size() + sensorsToPlace(groups_, kinds_).size();
    if (failures >= sensors)
        throw UsageError(
            option + ':' + std::to_string(failures) + ": there " +
            (sensors == 1 ? "is one sensor" : "are " + std::to_string(sensors) + " sensors") +
            ", and one at least has to work");
    if (const auto total = static_cast<double>(totalOf(problem_.weights)); total > kMaxTotal)
        for (std::uint32_t& weight : problem_.weights)
            weight = static_cast<std::uint32_t>(std::ceil(weight * (kMaxTotal / total)));
    const std::size_t cells = problem_.cells();
    FailureProblem made = failureProblem(problem_, problem_.achieved, sensors, failures);
    problem_ = std::move(made.problem);
    problem_.standing = CellSet(problem_.cells());
    cases_.failures = static_cast<int>(failures);
    cases_.least_total = made.least_total;
    for (std::size_t m = 1; m <= failures; ++m)
        for (Room& room : rooms_) {
            Copy copy = room.copies.front();
            copy.first += m * cells;
            room.copies.push_back(copy);
        }
    for (CellSet& view : cases_.standing) {
        CellSet stack(problem_.cells());
        for (std::size_t m = 0; m <= failures; ++m)
            view.forEach([&](std::size_t cell) { stack.set(m * cells + cell); });
        view = std::move(stack);
    }
}

CaseShares CoverageModel::sharesInCases(std::span<const CountedView> views,
                                        std::span<const Placement> sensors) const {
    std::vector<SensorCells> cells;
    for (const CountedView& view : views) cells.push_back({&view.cells, view.multiplicity});
    const CaseValues values(cases_, cells);
    const CaseValue worst = values.worst();
    const auto unit = static_cast<double>(cases_.totalOf(0));
    CaseShares in;
    in.worst = static_cast<double>(worst.value) / unit;
    in.mean = static_cast<double>(valueOf(views)) / static_cast<double>(problem_.totalWeight());
    if (cases_.failures > 0)
        in.shares = {in.worst};
    else
        for (const std::uint64_t value : values.ofBlocks())
            in.shares.push_back(static_cast<double>(value) / unit);
    for (const std::size_t failed : worst.failed)
        in.failed.push_back(failed < standing_ids_.size()
                                ? standing_ids_[failed]
                                : wholeId(site_, sensors[failed - standing_ids_.size()]));
    return in;
}

}  // namespace ispace
