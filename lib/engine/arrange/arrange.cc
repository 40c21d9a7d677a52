// SPDX-License-Identifier: GPL-3.0-or-later
// The order of a search: candidates, choice, refinement, proof, and the figures of the result.
//
// The search chooses by cells of its own grid; coverage and area are then measured anew, as
// `coverage` measures them, for the written poses. Sensors that
// add no value are spread over the floor after the search, not left where greedy search put them.
// Privacy is a loop about all this: cells may miss parts of a zone that the exact region of a
// camera meets, so poses that do are forbidden, and the search begins again.
#include "arrange/arrange.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "arrange/coverage_model.h"
#include "arrange/objective.h"
#include "arrange/prover.h"
#include "arrange/refine.h"
#include "arrange/search/alternatives.h"
#include "arrange/search/greedy_search.h"
#include "arrange/search/problem.h"
#include "arrange/search/set_cover.h"
#include "arrange/search_parts.h"
#include "base/error.h"
#include "base/number.h"
#include "base/packed.h"
#include "base/stops_with.h"
#include "coverage/coverage.h"
#include "scene/placement_schemas.h"

namespace ispace {

std::string needsOneRoom(const ArrangeOptions& options) {
    return options.prover ? "--proof " + std::string(options.prover->name()) : "";
}

namespace {

/// The model has a row for each cell that a candidate sees: some 30 bytes each.
void mustFitInModel(const Problem& problem) {
    constexpr double kMaxEntries = 1e8;
    double entries = 0;
    const std::vector<std::uint32_t> ones(problem.cells(), 1);
    for (const SensorType& kind : problem.kinds) {
        std::vector<std::uint32_t> counts(kind.candidates->size());
        kind.candidates->weighAll(WeightSums(ones), counts);
        for (const std::uint32_t count : counts) entries += count;
    }
    if (entries > kMaxEntries)
        throw UsageError("--export-mps: the model has " + formatFixed(entries / 1e6, 0) +
                         " million entries, more than " + formatFixed(kMaxEntries / 1e6, 0) +
                         ": use fewer candidates (--candidates) or larger cells (--cell)");
}

/// Writes the problem as MPS, with the pose of each candidate as a comment.
void writeModel(const CoverageModel& model, std::ostream& mps) {
    mustFitInModel(model.problem());
    std::vector<std::string> names;
    names.reserve(model.kinds().size());
    for (const SensorClass& kind : model.kinds()) names.push_back(model.nameOf(kind));
    const auto pose_text = [&model](const Choice& choice) {
        const Pose3 pose = model.poseOf(choice);
        std::string text = model.site().rooms[model.roomOf(choice)].id;
        for (const double number : {pose.position.x, pose.position.y, pose.position.z,
                                    pose.heading.degrees(), pose.tilt.degrees()})
            text.append(text.empty() ? "" : " ").append(formatDouble(number));
        return text;
    };
    const std::string head = model.site().rooms.front().id.empty() ? "" : "room ";
    writeMps(model.problem(), names, head + "x y z (m) heading tilt (degrees)", pose_text, mps);
}

/// \param by_number receives results of 1, 2, ... sensors if they are found on the way
SearchResult find(const CoverageModel& model, Arrangement& result,
                  std::vector<SearchResult>& by_number, Progress& progress) {
    const ArrangeOptions& options = model.options();
    if (isSearchedByParts(model)) {
        by_number = searchParts(model, progress);
        return by_number.back();
    }
    if (model.objective() != nullptr) return model.objective()->find(progress);
    if (model.isWorstCase()) return searchWorstCase(model.cases(), model.searchOptions(), progress);
    if (!options.target) return search(model.problem(), model.searchOptions(), progress);
    MinimumCostCover cover = minimumCostCover(model.problem(), model.valueFor(*options.target),
                                              model.searchOptions(), progress);
    result.is_reached = cover.is_reached;
    result.is_exhausted = cover.is_all;
    if (cover.is_reached) result.least = cover.cost_bound;
    return cover.result;
}

/// With fewer candidates than sensors a search chooses some twice, without gain; two sensors cannot
/// stand at one point.
void takeEachOnce(std::vector<Choice>& chosen) {
    std::set<Choice> taken;
    std::erase_if(chosen, [&taken](const Choice& choice) { return !taken.insert(choice).second; });
}

/// Computes a bound over all poses: for any sensors that a budget buys, else for the number of each
/// kind found.
double boundOfAnyPlace(const CoverageModel& model, const std::vector<Placement>& placements) {
    const bool buys = model.options().budget.has_value();
    std::vector<int> most(model.kinds().size());
    for (std::size_t k = 0; k < most.size(); ++k)
        if (buys) most[k] = model.kinds()[k].most;
    if (!buys)
        for (const Placement& placement : placements) ++most[placement.kind];
    return model.shareBound(model.maxFromAnyPlace(most));
}

/// If some candidates are missing, the search's bound does not hold.
double boundOf(const SearchResult& result, const CoverageModel& model) {
    return model.isComplete() ? model.shareBound(result.bound) : 1;
}

/// Moves the sensors off their candidates. If one moves, the bound of the candidates holds no
/// longer: that of any poses replaces it.
void refineIn(Arrangement& result, CoverageModel& model, std::uint64_t before, Progress& progress) {
    const Refined refined = refine(model, result.sensors, before, progress);
    result.is_refined = true;
    result.refined_before = refined.before;
    result.refined_after = refined.after;
    result.is_complete = result.is_complete && !progress.stopped();
    if (!(refined.after > refined.before)) return;  // all stand on candidates
    for (std::size_t i = 0; i < refined.poses.size(); ++i)
        result.sensors[i].pose = refined.poses[i];
    result.bound = boundOfAnyPlace(model, result.sensors);
}

/// Figures as `coverage` reports them.
struct Measured {
    Metric coverage, area;
    double free_share = 1;  ///< the free floor, as a share of the indoor area
    bool is_same_grid = false;
};

Measured measuredRoom(const Arrangement& result, CoverageModel& model,
                      const CoverageOptions& usual) {
    RoomModel& room = model.only();
    const Scene whole = withPlaced(room.scene(), model.groups(), result.sensors);
    const Coverage measured = measureCoverage(whole, room.worlds(), usual);
    const CoverageReport& report = measured.report;
    return {report.coverage, report.total_effective_area, report.free_area / report.indoor_area,
            room.target().grid == measured.target.grid};
}

Measured measuredSite(Arrangement& result, const CoverageModel& model, CoverageOptions usual) {
    const ArrangeSite& site = model.site();
    std::vector<std::vector<Sensor>> added(site.rooms.size());
    for (const Placement& placement : result.sensors)
        added[placement.room].push_back(sensorOf(model.groups(), placement));
    usual.density = model.options().pixel_density;
    const SiteFigures figures = site.sight->measure(added, usual);
    result.rooms.clear();
    for (std::size_t i = 0; i < site.rooms.size(); ++i)
        result.rooms.push_back({site.rooms[i].id, added[i].size(),
                                figures.rooms[i].grid.value_or(0), model.hasRoom(i)});
    return {figures.coverage, figures.effective_area, figures.free_area / figures.indoor_area,
            false};
}

/// Sets the figures of the written layout: coverage, area, value, and those of the objectives.
/// Exact shares are computed only with a target of the whole floor.
void measure(Arrangement& result, CoverageModel& model) {
    const ArrangeOptions& options = model.options();
    const bool is_whole_floor = options.target && options.weights.isUniform() && !options.cases &&
                                options.redundancy == 1 && options.indoor_only &&
                                !options.beam_step && !options.demand;
    const CoverageOptions usual{.plane = options.plane, .exact = is_whole_floor};
    const Measured measured = model.site().isOneRoom() ? measuredRoom(result, model, usual)
                                                       : measuredSite(result, model, usual);
    result.coverage = measured.coverage.grid.value_or(0);
    result.area = measured.area.grid.value_or(0);
    if (is_whole_floor) {
        result.exact_share = measured.coverage.exact;
        result.free_share = measured.free_share;
    }
    if (options.target == 1 && result.exact_share && *result.exact_share < 1 - kMissedShare)
        result.is_reached = false;
    const std::vector<CountedView> views =
        model.viewsOf(std::span<const Placement>(result.sensors));
    if (!options.cases && !options.objective && (!options.indoor_only || !measured.is_same_grid))
        result.value = model.shareOf(std::span<const CountedView>(views));
    result.is_value_by_cells = result.value && options.indoor_only && !options.beam_step &&
                               options.weights.isUniform() && options.redundancy == 1 &&
                               !options.cases && !options.cover_rule && !options.demand &&
                               !options.objective;
    for (const Objective& row : objectives())
        if (row.report != nullptr && row.is_asked(options)) row.report(model, views, result);
    if (model.objective() != nullptr) model.objective()->report(views, result);
    if (options.beam_step) result.value = result.candidate_value;
    if (options.objective) return;
    for (const std::size_t i : idleViews(model, views))
        result.idle.push_back(wholeId(model.site(), result.sensors[i]));
}

/// Returns in [n] the best n of these sensors, chosen greedily, with their value. If coverage must
/// be connected, a subset may not be: then only the full set counts, others are empty. O(n^2 *
/// runs)
std::vector<Solution> bestSubsets(const Problem& problem, std::vector<Choice> chosen) {
    const std::vector<std::uint32_t> partial_weights = partialWeights(problem);
    CoverageState state(problem, partial_weights);
    std::vector<Solution> subsets(chosen.size() + 1, {{}, state.value()});
    subsets.back() = {chosen, valueOf(problem, chosen)};
    if (problem.is_connected) return subsets;
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
        subsets[n] = {state.chosen(), state.value()};
    }
    return subsets;
}

/// Points of a curve up to this number of sensors are searched even if no time is left: greedy
/// search and a quick bound take time in proportion to the candidates' size.
std::size_t quickPoints(const CoverageModel& model) {
    constexpr std::size_t kMaxBytes = std::size_t{64} << 20U;
    constexpr std::size_t kBytesPerCell = 8;
    return kMaxBytes / (model.bytes() + kBytesPerCell * model.problem().cells() + 1);
}

/// Returns true if the number of sensors was the only limit of the search.
bool isByNumber(const CoverageModel& model) {
    if (!model.options().budget && !model.options().target) return true;
    const std::vector<SensorType>& kinds = model.problem().kinds;
    return std::all_of(kinds.begin(), kinds.end(),
                       [&](const SensorType& kind) { return kind.cost == kinds[0].cost; });
}

/// Computes the value of 1, 2, ... sensors of these kinds, at any cost, with bounds. Once the time
/// is used up: the value of that many of the sensors found, without a bound.
std::vector<SearchResult> searchByNumber(const SearchResult& found, const CoverageModel& model,
                                         Progress& progress) {
    const std::vector<Solution> part = bestSubsets(model.problem(), found.best.chosen);
    const std::size_t last = part.size() - 1, quick = quickPoints(model);
    Problem fewer = model.problem();
    fewer.order.clear();
    for (SensorType& kind : fewer.kinds) kind.cost = 1;
    std::vector<SearchResult> results;
    results.reserve(last);
    // One phase for all searches.
    progress.begin("curve", static_cast<std::int64_t>(last));
    StopsWith stops(progress);
    // One sensor more than before, or one less than later, is near the best, and so are
    // multipliers.
    SimilarSearch similar;
    SearchOptions options = model.searchOptions();
    // The proofs that shards have are of the first search.
    if (options.share.joined > 0 && options.share.what == Shared::Tree)
        options.share = SearchShare();
    options.similar = &similar;
    for (std::size_t n = 1; n <= last; ++n) {
        fewer.budget = static_cast<double>(n);
        if (fewer.is_connected)
            similar.starts.clear();
        else if (n > 1)
            similar.starts.push_back(part[n].chosen);
        SearchResult result;
        result.bound = fewer.totalWeight();
        if (n == last && isByNumber(model))
            result = found;
        else if (n <= quick || !progress.stopped())
            result = search(fewer, options, stops);
        if (part[n].value > result.best.value) result.best = part[n];
        results.push_back(std::move(result));
        progress.advance(1);
    }
    // Back again: the best of one sensor more, less one.
    const bool goes_back = options.optimizer != Optimizer::Greedy && !fewer.is_connected;
    for (std::size_t n = last - 1; goes_back && n > 0 && !progress.stopped(); --n) {
        SearchResult& result = results[n - 1];
        if (result.best.value >= result.bound) continue;
        fewer.budget = static_cast<double>(n);
        SwapOptions swap = options.swap;
        swap.starts = 0;
        swap.enough = result.bound;
        const Solution better =
            improveBySwaps(fewer, bestSubsets(fewer, results[n].best.chosen)[n], swap, stops);
        if (better.value > result.best.value) result.best = better;
    }
    progress.end();
    return results;
}

std::vector<CurvePoint> curveTo(const SearchResult& found, std::vector<SearchResult> by_number,
                                const CoverageModel& model, Progress& progress) {
    // With fewer candidates than sensors there are fewer points.
    by_number.resize(std::min(by_number.size(), found.best.chosen.size()));
    std::vector<SearchResult> results =
        by_number.empty() ? searchByNumber(found, model, progress) : std::move(by_number);
    // One more sensor never covers less; a bound for n sensors holds for fewer.
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

/// Returns true if sensors on both candidates count as the same, see kApart. Headings of round
/// views do not count.
bool areNear(const CoverageModel& model, const Choice& a, const Choice& b) {
    if (!(model.kinds()[a.kind].model == model.kinds()[b.kind].model)) return false;
    if (model.roomOf(a) != model.roomOf(b)) return false;
    const Pose3 one = model.poseOf(a), other = model.poseOf(b);
    if (length(one.position - other.position) >= kApart) return false;
    const auto is_round = [&model](const Choice& choice) {
        const CandidateSet& set = *model.problem().kinds[choice.kind].candidates;
        return set.rangeOf(choice.candidate).count ==
               set.directedParts(set.siteOf(choice.candidate));
    };
    const auto apart = [](Angle angle) { return std::abs(wrapped(angle).degrees()); };
    return apart(one.tilt - other.tilt) < kTurnedApart.degrees() &&
           (apart(one.heading - other.heading) < kTurnedApart.degrees() ||
            (is_round(a) && is_round(b)));
}

/// Adds further layouts. Each is measured like the first, without refinement.
void addAlternatives(Arrangement& result, CoverageModel& model, const Solution& best,
                     Progress& progress) {
    const NearChoices are_near = [&model](const Choice& a, const Choice& b) {
        return areNear(model, a, b);
    };
    SearchOptions options = model.searchOptions();
    options.share = SearchShare();  // stored steps are those of the first search
    for (Solution& solution : alternativesTo(model.problem(), best, are_near,
                                             static_cast<std::size_t>(model.options().alternatives),
                                             options, progress)) {
        takeEachOnce(solution.chosen);
        Arrangement& other = result.alternatives.emplace_back();
        other.candidates = result.candidates;
        other.grid = result.grid;
        other.is_complete = model.isComplete() && !progress.stopped();
        other.candidate_value = model.shareOf(solution.chosen, solution.value);
        other.rounding = result.rounding;
        other.bound = other.candidate_bound = result.candidate_bound;
        other.sensors = model.placementsOf(solution.chosen);
        measure(other, model);
    }
}

/// One search, from candidates to figures. A shard returns early, once its own steps are stored.
Arrangement arrangeLimited(const ArrangeSite& site, const std::vector<SensorGroup>& groups,
                           const ArrangeOptions& options, Progress& progress, std::ostream* mps) {
    CoverageModel model(site, groups, options, progress);
    const Problem& problem = model.problem();
    if (mps != nullptr) writeModel(model, *mps);

    Arrangement result;
    result.is_complete = model.isComplete();
    const SearchShare& share = options.search.share;
    if (share.own && !model.isComplete())
        throw UnmetError("stopped before all candidates were made: there is nothing to share");
    if (share.isOwn(Shared::Candidates)) return result;
    std::vector<SearchResult> by_number;
    SearchResult found = find(model, result, by_number, progress);
    if (share.own && !share.isOwn(Shared::Poses)) return result;
    std::vector<Choice>& chosen = found.best.chosen;
    takeEachOnce(chosen);
    if (found.best.value > 0 && !options.objective) {
        model.spreadRedundant(chosen);
        found.best.value = model.isWorstCase() ? worstCase(model.cases(), chosen).value
                                               : ispace::valueOf(problem, chosen);
    }
    result.is_complete = model.isComplete() && found.is_complete;
    result.candidates = model.candidates();
    result.bytes = model.bytes();
    if (site.isOneRoom()) result.grid = model.only().target().grid;
    result.cells = problem.cells();
    if (!options.target && !options.budget) result.unplaced = problem.order.size() - chosen.size();
    result.candidate_value = model.shareOf(chosen, found.best.value);
    result.rounding = model.rounding();
    result.candidate_bound = boundOf(found, model);
    result.bound = result.candidate_bound;
    result.sensors = model.placementsOf(chosen);
    if (options.refine) refineIn(result, model, found.best.value, progress);
    if (options.prover) options.prover->prove(model, result, progress);
    if (share.own) return {};
    measure(result, model);
    // Candidates whose views of other rooms were not computed in time see more than they know of.
    if (!model.isComplete() && !site.isOneRoom() && result.value)
        result.candidate_value = *result.value;
    if (options.wants_curve) {
        result.curve = curveTo(found, std::move(by_number), model, progress);
        result.is_complete = result.is_complete && !progress.stopped();
    }
    if (options.wants_trace) result.tried = model.triedPoses(chosen);
    if (options.wants_gains) result.gains = model.gainMaps(chosen);
    if (options.alternatives > 0) addAlternatives(result, model, found.best, progress);
    return result;
}

}  // namespace

namespace {

/// Arranges as arrangeLimited(). \throws FormatError with the file of results that are incomplete
Arrangement arrangeFromResults(const ArrangeSite& site, const std::vector<SensorGroup>& groups,
                               const ArrangeOptions& options, Progress& progress,
                               std::ostream* mps) {
    try {
        return arrangeLimited(site, groups, options, progress, mps);
    } catch (const PackedError&) {
        const SearchShare& share = options.search.share;
        if (share.results == nullptr) throw;
        if (share.joined > 0)
            throw FormatError({share.results->file(), 0, 0,
                               "this part, or another one of the merge, is incomplete: delete it "
                               "and run its shard again"});
        throw FormatError(
            {share.results->file(), 0, 0, "the part of an earlier run is incomplete: delete it"});
    }
}

std::size_t countForbidden(const ArrangeSite& site) {
    std::size_t count = 0;
    for (const SiteRoom& room : site.rooms) count += room.goals.forbidden.size();
    return count;
}

/// Returns the site with its sensors limited to the floor that they cover by the options.
ArrangeSite limitedSite(const ArrangeSite& site, const ArrangeOptions& options) {
    ArrangeSite limited = site;
    std::map<const Scene*, std::shared_ptr<const Scene>> known;  // equal rooms stay equal
    for (SiteRoom& room : limited.rooms) {
        std::shared_ptr<const Scene>& scene = known[room.scene.get()];
        if (scene == nullptr) {
            Scene own = *room.scene;
            for (Sensor& sensor : own.sensors) limitCovered(sensor.model, options);
            scene = std::make_shared<const Scene>(std::move(own));
        }
        room.scene = scene;
    }
    return limited;
}

}  // namespace

Arrangement arrange(const ArrangeSite& site, const std::vector<SensorGroup>& groups,
                    const ArrangeOptions& options, Progress& progress, std::ostream* mps) {
    // Candidates, bounds and all results are computed for sensors with limited coverage.
    ArrangeSite limited = limitedSite(site, options);
    std::vector<SensorGroup> limited_groups = groups;
    for (SensorGroup& group : limited_groups) {
        group.whole = group.model;
        limitCovered(group.model, options);
    }
    if (options.prover) {
        if (!site.isOneRoom()) throw UsageError(needsOneRoom(options) + " needs one room");
        if (std::optional<Arrangement> found = options.prover->arrange(
                *limited.rooms.front().scene, limited_groups, options, progress))
            return std::move(*found);
    }
    if (!options.rejected)
        return arrangeFromResults(limited, limited_groups, options, progress, mps);
    constexpr std::size_t kMaxRounds = 100;
    for (std::size_t round = 1;; ++round) {
        const std::size_t before = countForbidden(limited);
        Arrangement found = arrangeFromResults(limited, limited_groups, options, progress, mps);
        const auto forbid = [&](const Arrangement& layout) {
            for (const auto& [room, pose] : options.rejected(site, groups, layout))
                limited.rooms[room].goals.forbidden.push_back(pose);
        };
        forbid(found);
        for (const Arrangement& other : found.alternatives) forbid(other);
        if (countForbidden(limited) == before || progress.stopped() || round == kMaxRounds)
            return found;
    }
}

ArrangeSite siteOf(const Scene& scene, const ArrangeOptions& options) {
    // Not owned.
    const std::shared_ptr<const Scene> only(std::shared_ptr<const Scene>(), &scene);
    ArrangeSite site;
    site.rooms.push_back({"", only, goalsOf(options)});
    return site;
}

Arrangement arrange(const Scene& scene, const std::vector<SensorGroup>& groups,
                    const ArrangeOptions& options, Progress& progress, std::ostream* mps) {
    return arrange(siteOf(scene, options), groups, options, progress, mps);
}

namespace {

Record resultRecord(const LayoutParts& parts, const Arrangement& arrangement) {
    Record result(*sceneSchemas().find("result"));
    result.set("coverage", Value(roundSignificant(arrangement.coverage)));
    result.set("area", Value(roundSignificant(arrangement.area)));
    const Proof* const proof = arrangement.proof.get();
    // The value beside the bound of a proof is by the measure of the proof.
    const std::optional<double> of_proof = proof != nullptr ? proof->value() : std::nullopt;
    const std::optional<double> value = of_proof ? of_proof : arrangement.value;
    if (value) result.set("value", Value(roundSignificant(*value)));
    if (!parts.objective.empty()) result.set("objective", Value(parts.objective));
    result.set("bound", Value(roundSignificant(arrangement.bound)));
    if (arrangement.is_refined)
        result.set("candidates_bound", Value(roundSignificant(arrangement.candidate_bound)));
    result.set("strategy", Value(parts.strategy));
    result.set("optimize", Value(parts.optimize));
    result.set("candidates", Value(static_cast<double>(arrangement.candidates)));
    if (arrangement.least) result.set("least", Value(*arrangement.least));
    if (proof != nullptr) {
        result.set("proof", Value(std::string(proof->name())));
        TupleList witnesses;
        for (const Point2 p : proof->witnesses()) witnesses.push_back({p.x, p.y});
        if (!witnesses.empty()) result.set("witnesses", Value(std::move(witnesses)));
    }
    if (!arrangement.is_complete) result.set("complete", Value(false));
    return result;
}

}  // namespace

Document layoutDocument(const LayoutParts& parts, const Document* before,
                        const std::vector<SensorGroup>& groups, const Arrangement& arrangement) {
    Document document{DocumentKind::Layout, parts.history, {}};
    Record environment(*sceneSchemas().find("environment"));
    if (!parts.environment_file.empty()) environment.set("file", Value(parts.environment_file));
    environment.set("digest", Value(parts.environment_digest));
    document.records.push_back(environment);

    const std::vector<Placement>& sensors = arrangement.sensors;
    std::vector<bool> is_written(sensors.size());
    const auto write = [&](std::size_t i) {
        Record record = placedRecord(groups[sensors[i].group], sensors[i]);
        if (parts.whole)
            record = parts.whole(sensors[i].room, std::move(record), sensors[i].sensor);
        document.records.push_back(std::move(record));
        is_written[i] = true;
    };
    const auto is_of = [&](const Placement& sensor, const Record& record) {
        const SensorGroup& group = groups[sensor.group];
        if (!group.is_pending) return false;
        return (parts.whole ? parts.whole(sensor.room, group.record, group.id) : group.record) ==
               record;
    };
    const auto place_of = [&](const Record& record) {
        std::size_t i = 0;
        while (i < sensors.size() && (is_written[i] || !is_of(sensors[i], record))) ++i;
        return i;
    };
    if (before != nullptr) {
        for (const Record& record : before->records) {
            if (record.schema().type == RecordType::Meta) continue;
            if (const std::size_t i = place_of(record); i < sensors.size())
                write(i);
            else
                document.records.push_back(record);
        }
    }
    for (std::size_t i = 0; i < sensors.size(); ++i)
        if (!is_written[i]) write(i);
    document.records.push_back(resultRecord(parts, arrangement));
    return document;
}

}  // namespace ispace
