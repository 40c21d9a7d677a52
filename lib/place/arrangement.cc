// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/arrangement.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/number.h"
#include "cover/coverage.h"
#include "place/refine_arranged.h"
#include "place/scene_problem.h"
#include "place/tried_poses.h"
#include "solve/coverage_state.h"
#include "solve/mps_file.h"

namespace ispace {

namespace {

/// A row for each cell that a candidate sees: some 30 bytes each.
void mustFitInModel(const Problem& problem) {
    constexpr double kMostEntries = 1e8;
    double entries = 0;
    const std::vector<std::uint32_t> ones(problem.cells(), 1);
    for (const Kind& kind : problem.kinds) {
        std::vector<std::uint32_t> counts(kind.candidates->size());
        kind.candidates->weighAll(WeightSums(ones), counts);
        for (const std::uint32_t count : counts) entries += count;
    }
    if (entries > kMostEntries)
        throw UsageError("--export-mps: the model has " + formatFixed(entries / 1e6, 0) +
                         " million entries, more than " + formatFixed(kMostEntries / 1e6, 0) +
                         ": use fewer candidates (--candidates) or larger cells (--cell)");
}

void writeModel(const SceneProblem& model, std::ostream& mps) {
    mustFitInModel(model.problem());
    std::vector<std::string> names;
    names.reserve(model.kinds().size());
    for (const SensorClass& kind : model.kinds()) names.push_back(kind.id);
    const auto pose_text = [&model](const Choice& choice) {
        const Pose3 pose = model.poseOf(choice);
        std::string text;
        for (const double number : {pose.position.x, pose.position.y, pose.position.z,
                                    pose.heading.degrees(), pose.tilt.degrees()})
            text.append(text.empty() ? "" : " ").append(formatDouble(number));
        return text;
    };
    writeMps(model.problem(), names, "x y z (m) heading tilt (degrees)", pose_text, mps);
}

SearchResult find(const SceneProblem& model, Arrangement& result, Progress& progress) {
    const ArrangeOptions& options = model.options();
    if (!options.target) return search(model.problem(), model.searchOptions(), progress);
    MinimumCostCover cover = minimumCostCover(model.problem(), model.valueFor(*options.target),
                                              model.searchOptions(), progress);
    result.is_reached = cover.is_reached;
    result.is_exhausted = cover.is_all;
    if (cover.is_reached) result.least = cover.cost_bound;
    return cover.result;
}

/// Where there are fewer candidates than sensors a search chooses some again, which counts for
/// nothing; two sensors cannot stand in one another.
void takeEachOnce(std::vector<Choice>& chosen) {
    std::set<Choice> taken;
    std::erase_if(chosen, [&taken](const Choice& choice) { return !taken.insert(choice).second; });
}

/// A bound over all places. A budget might have bought others; else there are as many as there are.
double boundOfAnyPlace(const SceneProblem& model, const std::vector<ArrangedSensor>& sensors) {
    const bool buys = model.options().budget.has_value();
    std::vector<int> most(model.kinds().size());
    for (std::size_t k = 0; k < most.size(); ++k)
        if (buys) most[k] = model.kinds()[k].most;
    if (!buys)
        for (const ArrangedSensor& sensor : sensors) ++most[kindOf(model.kinds(), sensor.group)];
    return model.share(model.mostFromAnyPlace(most));
}

/// Nothing is known of candidates that were not made.
double boundOf(const SearchResult& result, const SceneProblem& model) {
    return model.isComplete() ? model.share(result.bound) : 1;
}

void refineIn(Arrangement& result, SceneProblem& model, std::uint64_t before, Progress& progress) {
    const Refined refined = refineArranged(model, result.sensors, before, progress);
    result.is_refined = true;
    result.refined_before = refined.before;
    result.refined_after = refined.after;
    result.is_complete = result.is_complete && !progress.stopped();
    if (!(refined.after > refined.before)) return;  // all stand on candidates
    result.sensors = movedTo(std::move(result.sensors), refined.poses);
    result.bound = boundOfAnyPlace(model, result.sensors);
}

void measure(Arrangement& result, SceneProblem& model) {
    const ArrangeOptions& options = model.options();
    const CoverageOptions usual{.plane = options.plane, .exact = false};
    const Scene whole = withArranged(model.scene(), model.groups(), result.sensors);
    const Coverage measured = measureCoverage(whole, model.worlds(), usual);
    const CoverageReport& report = measured.report;
    result.coverage = report.coverage.grid.value_or(0);
    result.area = report.total_effective_area.grid.value_or(0);
    const bool is_coverage = options.worth.isUniform() && options.redundancy == 1 &&
                             model.target().grid == measured.target.grid;
    const Coverage searched = model.coverageOf(result.sensors);
    if (!is_coverage) result.value = model.share(model.valueOf(searched));
    result.idle = model.idleIn(searched);
}

/// Worth of the first n of these sensors, each placed where it adds most of them: [n]. Where views
/// have to hang together part of them need not: then only all are worth something. O(n^2 * runs)
std::vector<std::uint64_t> valuesOfFirst(const Problem& problem, std::vector<Choice> chosen) {
    const std::vector<std::uint32_t> partial_weights = partialWeights(problem);
    CoverageState state(problem, partial_weights);
    std::vector<std::uint64_t> values(chosen.size() + 1, state.value());
    values.back() = valueOf(problem, chosen);
    if (problem.is_connected) return values;
    for (std::size_t n = 1; !chosen.empty(); ++n) {
        std::uint64_t best = 0;
        std::size_t next = 0;
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            state.add(chosen[i]);
            if (state.value() > best) {
                best = state.value();
                next = i;
            }
            state.removeAt(n - 1);
        }
        state.add(chosen[next]);
        chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(next));
        values[n] = state.value();
    }
    return values;
}

/// Up to so many sensors a point of a curve is searched for even if there is no time left: what
/// greedy and a quick bound take is about in proportion to what is looked through.
std::size_t quickPoints(const SceneProblem& model) {
    constexpr std::size_t kMostBytes = std::size_t{64} << 20U;
    constexpr std::size_t kBytesPerCell = 8;
    return kMostBytes / (model.bytes() + kBytesPerCell * model.problem().cells() + 1);
}

/// True if what was found is also the most that so many sensors are known to be worth.
bool isByNumber(const SceneProblem& model) {
    if (!model.options().budget && !model.options().target) return true;
    const std::vector<Kind>& kinds = model.problem().kinds;
    return std::all_of(kinds.begin(), kinds.end(),
                       [&](const Kind& kind) { return kind.cost == kinds[0].cost; });
}

/// What 1, 2, ... sensors of these kinds are worth, whatever they cost, and at most. Where there is
/// no time left for a search it is what so many of the sensors found are worth, and no bound.
std::vector<SearchResult> searchByNumber(const SearchResult& found, const SceneProblem& model,
                                         Progress& progress) {
    const std::vector<std::uint64_t> part = valuesOfFirst(model.problem(), found.best.chosen);
    const std::size_t last = part.size() - 1, quick = quickPoints(model);
    Problem fewer = model.problem();
    fewer.order.clear();
    for (Kind& kind : fewer.kinds) kind.cost = 1;
    std::vector<SearchResult> results;
    results.reserve(last);
    for (std::size_t n = 1; n <= last; ++n) {
        fewer.budget = static_cast<double>(n);
        SearchResult result;
        result.bound = fewer.totalWeight();
        if (n == last && isByNumber(model))
            result = found;
        else if (n <= quick || !progress.stopped())
            result = search(fewer, model.searchOptions(), progress);
        result.best.value = std::max(result.best.value, part[n]);
        results.push_back(std::move(result));
    }
    return results;
}

std::vector<CurvePoint> curveTo(const SearchResult& found, const SceneProblem& model,
                                Progress& progress) {
    std::vector<SearchResult> results = searchByNumber(found, model, progress);
    // One sensor more costs nothing and is worth no less; what more cannot cover fewer cannot.
    for (std::size_t i = 1; i < results.size(); ++i)
        results[i].best.value = std::max(results[i].best.value, results[i - 1].best.value);
    for (std::size_t i = results.size(); i-- > 1;)
        results[i - 1].bound = std::min(results[i - 1].bound, results[i].bound);
    std::vector<CurvePoint> curve;
    curve.reserve(results.size());
    for (const SearchResult& result : results)
        curve.push_back({static_cast<int>(curve.size()) + 1, model.share(result.best.value),
                         boundOf(result, model)});
    return curve;
}

}  // namespace

Arrangement arrange(const Scene& scene, const std::vector<SensorGroup>& groups,
                    const ArrangeOptions& options, Progress& progress, std::ostream* mps) {
    SceneProblem model(scene, groups, options, progress);
    const Problem& problem = model.problem();
    if (mps != nullptr) writeModel(model, *mps);

    Arrangement result;
    SearchResult found = find(model, result, progress);
    std::vector<Choice>& chosen = found.best.chosen;
    takeEachOnce(chosen);
    if (found.best.value > 0) {
        model.spreadIdle(chosen);
        found.best.value = ispace::valueOf(problem, chosen);
    }
    result.is_complete = model.isComplete() && found.is_complete;
    result.candidates = model.candidates();
    result.bytes = model.bytes();
    result.grid = model.target().grid;
    result.cost = normaliseCost(costOf(problem, chosen));
    result.has_costs = std::any_of(problem.kinds.begin(), problem.kinds.end(),
                                   [](const Kind& kind) { return kind.cost != 1; });
    if (!options.target && !options.budget) result.unplaced = problem.order.size() - chosen.size();
    result.candidate_value = model.share(found.best.value);
    result.candidate_bound = boundOf(found, model);
    result.bound = result.candidate_bound;
    result.sensors = model.sensorsOf(chosen);
    if (options.refine) refineIn(result, model, found.best.value, progress);
    measure(result, model);
    if (options.wants_curve) {
        result.curve = curveTo(found, model, progress);
        result.is_complete = result.is_complete && !progress.stopped();
    }
    if (options.wants_trace) result.tried = triedPoses(model, chosen);
    return result;
}

}  // namespace ispace
