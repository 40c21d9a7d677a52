// SPDX-License-Identifier: GPL-3.0-or-later
// Sensors that add no value: which they are, and where they stand instead.
//
// A sensor is idle if no cell of weight falls below the required multiplicity without it, and a
// required connection remains. Candidates for removal are taken from the last to the first, each
// judged after the removals before it, so all that are found may go together; another order may
// find more. Of the sites that see floor an idle sensor moves to the one farthest from all others
// (T. F. Gonzalez, Clustering to minimize the maximum intercluster distance, 1985, for its greedy
// choice), with the heading that sees most floor of low multiplicity.
#include "arrange/coverage_model.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

namespace ispace {

namespace {

/// Multiplicity of each cell.
using Multiplicities = std::vector<int>;

void count(const CountedView& view, int times, Multiplicities& achieved) {
    view.cells.forEach([&](std::size_t cell) { achieved[cell] += times * view.multiplicity; });
}

/// Returns true if some cell of weight falls below the required multiplicity without the view.
bool isNeeded(const Problem& problem, const CountedView& view, const Multiplicities& achieved) {
    bool is_needed = false;
    view.cells.forEach([&](std::size_t cell) {
        is_needed = is_needed || (problem.weights[cell] > 0 && achieved[cell] >= problem.required &&
                                  achieved[cell] - view.multiplicity < problem.required);
    });
    return is_needed;
}

/// Finds views that can all be removed without loss of value, ascending. `allows(left)` returns
/// true if the views still in `left` may remain alone.
std::vector<std::size_t> idleAmong(const Problem& problem, std::span<const CountedView> views,
                                   const std::function<bool(const std::vector<bool>&)>& allows) {
    Multiplicities achieved(problem.achieved.begin(), problem.achieved.end());
    achieved.resize(problem.cells());
    for (const CountedView& view : views) count(view, 1, achieved);
    std::vector<bool> left(views.size(), true);
    std::vector<std::size_t> idle;
    for (std::size_t i = views.size(); i-- > 0;) {
        if (isNeeded(problem, views[i], achieved)) continue;
        left[i] = false;
        if (problem.is_connected && !allows(left)) {
            left[i] = true;
            continue;
        }
        count(views[i], -1, achieved);
        idle.push_back(i);
    }
    std::reverse(idle.begin(), idle.end());
    return idle;
}

CountedView viewOf(const Problem& problem, const Choice& choice) {
    const SensorType& kind = problem.kinds[choice.kind];
    return {kind.candidates->cellsOf(choice.candidate), kind.multiplicity};
}

/// The sites of a kind, as targets of idle sensors.
class SpareSites {
  public:
    SpareSites(const Problem& problem, std::size_t kind,
               const std::function<Point3(const Choice&)>& position_of)
        : candidates_(*problem.kinds[kind].candidates),
          distances_(candidates_.sites(), std::numeric_limits<double>::infinity()),
          sees_(candidates_.sites()) {
        std::vector<std::uint32_t> values(candidates_.size());
        candidates_.weighAll(WeightSums(problem.weights), values);
        for (std::size_t i = 0; i < values.size(); ++i)
            if (values[i] > 0) sees_[candidates_.siteOf(i)] = true;
        for (std::size_t site = 0; site < candidates_.sites(); ++site)
            positions_.push_back(position_of({kind, candidates_.firstOf(site)}));
    }

    /// Marks a site as taken.
    void occupy(Point3 place) {
        for (std::size_t site = 0; site < distances_.size(); ++site)
            distances_[site] = std::min(distances_[site], length(positions_[site] - place));
    }

    /// Finds the site farthest from all sensors, the first among equals; empty if each has a
    /// sensor.
    [[nodiscard]] std::optional<std::size_t> farthest() const {
        std::optional<std::size_t> best;
        for (std::size_t site = 0; site < distances_.size(); ++site)
            if (distances_[site] > 0 && (!best || rank(site) > rank(*best))) best = site;
        return best;
    }

    /// Finds the candidate of a site that sees most by these weights.
    [[nodiscard]] std::size_t bestAt(std::size_t site, const WeightSums& weights) const {
        const std::size_t first = candidates_.firstOf(site);
        std::vector<std::uint32_t> values(candidates_.firstOf(site + 1) - first);
        candidates_.weighSite(site, weights, values);
        return first + static_cast<std::size_t>(std::max_element(values.begin(), values.end()) -
                                                values.begin());
    }

  private:
    [[nodiscard]] std::pair<bool, double> rank(std::size_t site) const {
        return {sees_[site], distances_[site]};
    }

    const CandidateSet& candidates_;
    std::vector<Point3> positions_;
    std::vector<double> distances_;
    std::vector<bool> sees_;
};

/// Returns the weights of the cells with less than twice the required multiplicity.
std::vector<std::uint32_t> weightsOfFew(const Problem& problem, const Multiplicities& achieved) {
    std::vector<std::uint32_t> weights = problem.weights;
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (achieved[i] >= 2 * problem.required) weights[i] = 0;
    return weights;
}

/// Positions of the sensors and their common coverage.
class IdleSpread {
  public:
    IdleSpread(const Problem& problem, std::span<const Point3> standing,
               const std::function<Point3(const Choice&)>& position_of,
               std::span<const Choice> busy)
        : problem_(problem),
          position_of_(position_of),
          achieved_(problem.achieved.begin(), problem.achieved.end()) {
        achieved_.resize(problem.cells());
        sites_.reserve(problem.kinds.size());
        for (std::size_t kind = 0; kind < problem.kinds.size(); ++kind)
            sites_.emplace_back(problem, kind, position_of);
        for (const Point3& place : standing) occupy(place);
        for (const Choice& choice : busy) take(choice);
    }

    void take(const Choice& choice) {
        count(viewOf(problem_, choice), 1, achieved_);
        occupy(position_of_(choice));
    }

    /// Finds a candidate for one more sensor of this kind.
    [[nodiscard]] std::optional<Choice> next(std::size_t kind) const {
        const auto site = sites_[kind].farthest();
        if (!site) return std::nullopt;
        return Choice{kind,
                      sites_[kind].bestAt(*site, WeightSums(weightsOfFew(problem_, achieved_)))};
    }

  private:
    void occupy(Point3 place) {
        for (SpareSites& sites : sites_) sites.occupy(place);
    }

    const Problem& problem_;
    const std::function<Point3(const Choice&)>& position_of_;
    Multiplicities achieved_;
    std::vector<SpareSites> sites_;  // by kind
};

}  // namespace

std::vector<std::size_t> idleChoices(const Problem& problem, std::span<const Choice> chosen) {
    std::vector<CountedView> views;
    views.reserve(chosen.size());
    for (const Choice& choice : chosen) views.push_back(viewOf(problem, choice));
    return idleAmong(problem, views, [&](const std::vector<bool>& left) {
        std::vector<Choice> rest;
        for (std::size_t i = 0; i < chosen.size(); ++i)
            if (left[i]) rest.push_back(chosen[i]);
        return isConnected(problem, rest);
    });
}

std::vector<std::size_t> idleViews(const CoverageModel& model, std::span<const CountedView> views) {
    return idleAmong(model.problem(), views, [&](const std::vector<bool>& left) {
        std::vector<CountedView> rest;
        for (std::size_t i = 0; i < views.size(); ++i)
            if (left[i]) rest.push_back(views[i]);
        return model.isConnected(rest);
    });
}

void spreadRedundant(const Problem& problem, std::span<const Point3> standing,
                     const std::function<Point3(const Choice&)>& position_of,
                     std::vector<Choice>& chosen) {
    const std::vector<std::size_t> idle = idleChoices(problem, chosen);
    if (idle.empty()) return;
    std::vector<Choice> busy;
    for (std::size_t i = 0; i < chosen.size(); ++i)
        if (!std::binary_search(idle.begin(), idle.end(), i)) busy.push_back(chosen[i]);
    IdleSpread spread(problem, standing, position_of, busy);
    for (const std::size_t i : idle) {
        const Choice before = chosen[i];
        if (const auto next = spread.next(before.kind)) {
            chosen[i] = *next;
            if (problem.is_connected && !isConnected(problem, chosen)) chosen[i] = before;
        }
        spread.take(chosen[i]);
    }
}

}  // namespace ispace
