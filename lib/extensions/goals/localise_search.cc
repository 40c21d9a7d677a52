// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/goals/localise_search.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "arrange/arrange.h"
#include "arrange/coverage_model.h"
#include "arrange/search/search.h"
#include "arrange/sensor_group.h"
#include "base/error.h"
#include "base/number.h"
#include "extensions/goals/localisation.h"
#include "sense/dilution.h"

namespace ispace::goals {

namespace {

using Spots = std::vector<SpotInformation>;

/// The worth of one spot, in kNoError.
using Worth = std::uint64_t (*)(const SpotInformation&, double limit);

std::uint64_t worthOf(const SpotInformation& spot, double limit) {
    const double error = spot.error();
    return error < limit
               ? static_cast<std::uint64_t>(static_cast<double>(kNoError) * (1 - error / limit))
               : 0;
}

constexpr std::uint64_t kWorthRounding = 2;  // upwards() adds less

/// Rounds up, and against the rounding of sums of information.
std::uint64_t upwards(double share) {
    constexpr double kRounding = 1e-9;
    return static_cast<std::uint64_t>(
        std::ceil(static_cast<double>(kNoError) * std::min(1.0, share + kRounding)));
}

double traceOf(const SpotInformation& spot) {
    return spot.seen.trace() + spot.ranged.trace() + atKnownHeight(spot.heard).trace();
}

/// Bounds the worth of information with this trace.
std::uint64_t mostWorth(double trace, double limit) {
    const double share = 1 - 2 / (limit * std::sqrt(trace));
    return share > 0 ? upwards(share) : 0;
}

/// The least concave function above mostWorth(), which has its tangent from 0 at 9/4 of its root.
std::uint64_t concaveWorth(const SpotInformation& spot, double limit) {
    const double times = traceOf(spot) * limit * limit / 4;  // of the root of mostWorth()
    if (!(times > 0)) return 0;
    return upwards(times < 2.25 ? 4 * times / 27 : 1 - 1 / std::sqrt(times));
}

/// Ends work when the search is to stop, or some time later: a bound is worth a short wait.
class Grace {
  public:
    using Clock = std::chrono::steady_clock;

    /// \param sites visited at most, of each kind
    explicit Grace(const Progress& progress, Clock::duration time = {},
                   std::size_t sites = std::numeric_limits<std::size_t>::max())
        : progress_(progress), time_(time), sites_(sites) {}

    [[nodiscard]] std::size_t sites() const { return sites_; }

    /// Thread-safe.
    [[nodiscard]] bool isOver() const {
        if (!progress_.stopped()) return false;
        const auto now = Clock::now().time_since_epoch().count();
        Clock::rep none = 0;
        const bool is_first = since_.compare_exchange_strong(none, now);
        return now - (is_first ? now : none) >= time_.count();
    }

  private:
    const Progress& progress_;
    Clock::duration time_;
    std::size_t sites_;
    mutable std::atomic<Clock::rep> since_ = 0;  // when it was first asked after the end
};

class LocaliseSearch {
  public:
    LocaliseSearch(const CoverageModel& model, double limit)
        : model_(model),
          problem_(model.problem()),
          limit_(limit),
          plane_(model.options().plane),
          standing_(problem_.cells()) {
        std::vector<SiteSensor> sensors;
        for (std::size_t room = 0; room < model.site().rooms.size(); ++room) {
            if (!model.hasRoom(room)) continue;
            const Grid& grid = model.room(room).target().grid;
            for (std::size_t i = 0; i < grid.size(); ++i) centers_.push_back(grid.center(i));
            for (const Sensor& sensor : model.room(room).scene().sensors)
                if (kindOf(sensor.model).perceives) sensors.push_back({room, sensor});
        }
        const std::vector<CountedView> views = model.viewsOf(std::span<const SiteSensor>(sensors));
        for (std::size_t i = 0; i < sensors.size(); ++i)
            add(sensors[i].sensor, views[i].cells, standing_);
    }

    void add(const Sensor& sensor, const CellSet& cells, Spots& spots) const {
        cells.forEach([&](std::size_t cell) {
            if (problem_.weights[cell] > 0) addAt(sensor, cell, spots[cell]);
        });
    }

    [[nodiscard]] const Spots& standing() const { return standing_; }

    [[nodiscard]] std::uint64_t valueOf(const Spots& spots, Worth worth = worthOf) const {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < spots.size(); ++i)
            if (problem_.weights[i] > 0) value += problem_.weights[i] * worth(spots[i], limit_);
        return value;
    }

    [[nodiscard]] Spots spotsOf(const std::vector<Choice>& chosen) const {
        Spots spots = standing_;
        for (const Choice& choice : chosen) {
            const Sensor sensor = sensorOf(choice);
            problem_.kinds[choice.kind].candidates->forEachRun(
                choice.candidate, [&](const CellRun& run) {
                    for (std::uint32_t i = run.first; i < run.end; ++i)
                        if (problem_.weights[i] > 0) addAt(sensor, i, spots[i]);
                });
        }
        return spots;
    }

    /// Computes the gain of one more sensor on each candidate of a kind, site by site: the
    /// information about a cell does not depend on the heading. Those of sites after the end of
    /// `grace` are 0.
    /// \param rounding subtracted from the worth that cells have without it
    [[nodiscard]] std::vector<std::uint64_t> gainsOf(std::size_t kind, const Spots& spots,
                                                     Worth worth, const Grace& grace,
                                                     std::uint64_t rounding = 0) const {
        std::vector<std::uint64_t> before(spots.size());
        for (std::size_t i = 0; i < spots.size(); ++i) {
            before[i] = worth(spots[i], limit_);
            before[i] -= std::min(before[i], rounding);
        }
        const CandidateSet& set = *problem_.kinds[kind].candidates;
        std::vector<std::uint64_t> gains(set.size());
        forEachSite(kind, grace.sites(), [&](std::size_t site, std::vector<std::uint64_t>& sums) {
            if (grace.isOver()) return;
            const Sensor sensor = sensorOf({kind, set.firstOf(site)});
            std::fill(sums.begin(), sums.end(), 0);
            forEachSeen(set, site, [&](std::uint32_t cell) {
                if (sums[cell + 1] > 0 || problem_.weights[cell] == 0) return;
                SpotInformation spot = spots[cell];
                addAt(sensor, cell, spot);
                const std::uint64_t after = worth(spot, limit_);
                if (after > before[cell])
                    sums[cell + 1] = problem_.weights[cell] * (after - before[cell]);
            });
            for (std::size_t i = 1; i < sums.size(); ++i) sums[i] += sums[i - 1];
            for (std::size_t k = set.firstOf(site); k < set.firstOf(site + 1); ++k)
                set.forEachRun(
                    k, [&](const CellRun& run) { gains[k] += sums[run.end] - sums[run.first]; });
        });
        return gains;
    }

    /// Adds sensors one by one, the best first; where none gains, the one with the most
    /// information. After the end of `grace` others anywhere.
    [[nodiscard]] std::vector<Choice> greedy(const Grace& grace) const {
        std::vector<Choice> chosen;
        while (!grace.isOver()) {
            const Spots spots = spotsOf(chosen);
            std::uint64_t most = 0;
            std::optional<Choice> best = bestOf(chosen, spots, worthOf, grace, most);
            if (!best) best = bestOf(chosen, spots, concaveWorth, grace, most);
            if (!best) break;
            chosen.push_back(*best);
        }
        if (grace.isOver()) fillUp(chosen);
        return chosen;
    }

    /// Moves single sensors while the value grows.
    void improve(Solution& solution, const Progress& progress) const {
        const Grace grace(progress);
        for (bool moves = true; moves;) {
            moves = false;
            for (std::size_t i = 0; i < solution.chosen.size() && !progress.stopped(); ++i) {
                std::vector<Choice> others = solution.chosen;
                const std::size_t kind = others[i].kind;
                others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
                const Spots spots = spotsOf(others);
                std::vector<std::uint64_t> gains = gainsOf(kind, spots, worthOf, grace);
                for (const Choice& other : others)
                    if (other.kind == kind) gains[other.candidate] = 0;
                const auto best = static_cast<std::size_t>(
                    std::max_element(gains.begin(), gains.end()) - gains.begin());
                const std::uint64_t value = valueOf(spots) + gains[best];
                if (value <= solution.value) continue;
                solution.chosen[i].candidate = best;
                solution.value = value;
                moves = true;
            }
        }
    }

    /// Bounds the value of all layouts by the gains of this one; by total() after the end of
    /// `grace`.
    [[nodiscard]] std::uint64_t boundBeside(const std::vector<Choice>& chosen,
                                            const Grace& grace) const {
        const Spots spots = spotsOf(chosen);
        std::uint64_t bound = valueOf(spots, concaveWorth);
        for (std::size_t k = 0; k < problem_.kinds.size(); ++k) {
            std::vector<std::uint64_t> gains =
                gainsOf(k, spots, concaveWorth, grace, kWorthRounding);
            if (grace.isOver()) return total();
            const auto most =
                std::min(gains.size(), static_cast<std::size_t>(problem_.kinds[k].most));
            std::partial_sort(gains.begin(), gains.begin() + static_cast<std::ptrdiff_t>(most),
                              gains.end(), std::greater<>());
            for (std::size_t i = 0; i < most; ++i) bound += gains[i];
        }
        return bound;
    }

    /// Searches for coverage by weights that bound the worth of covered cells; its bound holds for
    /// this problem, too.
    [[nodiscard]] SearchResult searchCover(Progress& progress, const Grace& grace) const {
        Problem cover = problem_;
        const std::uint64_t times =
            std::clamp<std::uint64_t>(0xffffffffU / problem_.totalWeight(), 1, 1024);
        const std::vector<std::uint64_t> most = mostByCell(grace);
        if (grace.isOver()) {
            SearchResult found;
            found.bound = total();
            return found;
        }
        for (std::size_t i = 0; i < most.size(); ++i)
            cover.weights[i] = static_cast<std::uint32_t>(
                (problem_.weights[i] * times * most[i] + kNoError - 1) / kNoError);
        SearchResult found = search(cover, model_.searchOptions(), progress);
        found.bound = (found.bound * kNoError + times - 1) / times;
        return found;
    }

    /// Returns the number of sites of the kind with the most.
    [[nodiscard]] std::size_t mostSites() const {
        std::size_t most = 0;
        for (const auto& kind : problem_.kinds) most = std::max(most, kind.candidates->sites());
        return most;
    }

    [[nodiscard]] std::uint64_t total() const { return problem_.totalWeight() * kNoError; }

  private:
    [[nodiscard]] Sensor sensorOf(const Choice& choice) const {
        return {"", model_.kinds()[choice.kind].model, model_.poseOf(choice)};
    }

    void addAt(const Sensor& sensor, std::size_t cell, SpotInformation& spot) const {
        const Point3 at = spotFor(sensor, centers_[cell], plane_);
        spot.add(sensor, informationOf(sensor.model, sensor.pose.position, at));
    }

    /// Adds candidates that lie far apart until all sensors are placed.
    void fillUp(std::vector<Choice>& chosen) const {
        for (std::size_t k = 0; k < problem_.kinds.size(); ++k) {
            const std::size_t count = problem_.kinds[k].candidates->size();
            auto placed = static_cast<std::size_t>(std::count_if(
                chosen.begin(), chosen.end(), [k](const Choice& c) { return c.kind == k; }));
            for (std::size_t i = 0;
                 i < count && placed < static_cast<std::size_t>(problem_.kinds[k].most); ++i) {
                const Choice choice{k, scattered(i, count)};
                if (std::find(chosen.begin(), chosen.end(), choice) != chosen.end()) continue;
                chosen.push_back(choice);
                ++placed;
            }
        }
    }

    /// Returns the i-th of `count` numbers in an order in which each part is spread over all.
    static std::size_t scattered(std::size_t i, std::size_t count) {
        auto step = static_cast<std::size_t>(0.618 * static_cast<double>(count)) | 1U;
        while (std::gcd(step, count) != 1) step += 2;
        return i * step % count;
    }

    /// Calls visit(site, buffer of cells + 1) in parallel, for sites far apart one after the other:
    /// visits that are cut short have been all over the room.
    template <typename Visit>
    void forEachSite(std::size_t kind, std::size_t most, Visit visit) const {
        const CandidateSet& set = *problem_.kinds[kind].candidates;
        tbb::enumerable_thread_specific<std::vector<std::uint64_t>> buffers(
            std::vector<std::uint64_t>(problem_.cells() + 1));
        tbb::parallel_for(std::size_t{0}, std::min(most, set.sites()), [&](std::size_t i) {
            visit(scattered(i, set.sites()), buffers.local());
        });
    }

    /// Calls visit(cell) for the cells that any candidate of a site sees, some repeatedly.
    template <typename Visit>
    static void forEachSeen(const CandidateSet& set, std::size_t site, Visit visit) {
        for (std::size_t part = 0; part <= set.directedParts(site); ++part)
            for (const CellRun& run : set.runsOf(site, part))
                for (std::uint32_t i = run.first; i < run.end; ++i) visit(i);
    }

    [[nodiscard]] std::optional<Choice> bestOf(const std::vector<Choice>& chosen,
                                               const Spots& spots, Worth worth, const Grace& grace,
                                               std::uint64_t& most) const {
        std::optional<Choice> best;
        for (std::size_t k = 0; k < problem_.kinds.size(); ++k) {
            const auto placed = std::count_if(chosen.begin(), chosen.end(),
                                              [k](const Choice& c) { return c.kind == k; });
            if (placed >= problem_.kinds[k].most) continue;
            const std::vector<std::uint64_t> gains = gainsOf(k, spots, worth, grace);
            for (std::size_t i = 0; i < gains.size(); ++i) {
                const Choice choice{k, i};
                if (gains[i] <= most ||
                    std::find(chosen.begin(), chosen.end(), choice) != chosen.end())
                    continue;
                most = gains[i];
                best = choice;
            }
        }
        return best;
    }

    /// Bounds the worth of each cell if all sensors stand on its best candidate; no bounds if
    /// `grace` ends before.
    [[nodiscard]] std::vector<std::uint64_t> mostByCell(const Grace& grace) const {
        std::vector<double> traces(problem_.cells());
        for (std::size_t i = 0; i < traces.size(); ++i) traces[i] = traceOf(standing_[i]);
        for (std::size_t k = 0; k < problem_.kinds.size(); ++k) {
            const CandidateSet& set = *problem_.kinds[k].candidates;
            tbb::enumerable_thread_specific<std::vector<double>> best(
                std::vector<double>(problem_.cells()));
            tbb::parallel_for(std::size_t{0}, set.sites(), [&](std::size_t site) {
                if (grace.isOver()) return;
                const Sensor sensor = sensorOf({k, set.firstOf(site)});
                std::vector<double>& own = best.local();
                forEachSeen(set, site, [&](std::uint32_t cell) {
                    if (problem_.weights[cell] == 0) return;
                    SpotInformation spot;
                    addAt(sensor, cell, spot);
                    own[cell] = std::max(own[cell], traceOf(spot));
                });
            });
            std::vector<double> all(problem_.cells());
            for (const std::vector<double>& own : best)
                for (std::size_t i = 0; i < all.size(); ++i) all[i] = std::max(all[i], own[i]);
            for (std::size_t i = 0; i < all.size(); ++i)
                traces[i] += problem_.kinds[k].most * all[i];
        }
        std::vector<std::uint64_t> most(traces.size());
        for (std::size_t i = 0; i < traces.size(); ++i)
            most[i] = traces[i] > 0 ? mostWorth(traces[i], limit_) : 0;
        return most;
    }

    const CoverageModel& model_;
    const Problem& problem_;
    double limit_, plane_;
    std::vector<Point2> centers_;  // of the cells, each in the frame of its room
    Spots standing_;
};

SearchResult searchLocalised(const CoverageModel& model, double limit, Progress& progress) {
    const LocaliseSearch search(model, limit);
    constexpr std::chrono::milliseconds kForBounds(300);
    const Grace grace(progress, kForBounds);
    // Of some sites first, for the case that there is no time for all, nor for bounds.
    constexpr std::chrono::milliseconds kForLayout(300);
    constexpr std::size_t kSome = 1000;
    std::vector<Choice> greedy = search.greedy(Grace(progress, kForLayout, kSome));
    if (search.mostSites() > kSome && !progress.stopped()) {
        std::vector<Choice> of_all = search.greedy(Grace(progress));
        if (!progress.stopped()) greedy = std::move(of_all);
    }
    SearchResult result = search.searchCover(progress, grace);
    const bool moves = model.options().search.optimizer != Optimizer::Greedy;
    Solution best;
    for (std::vector<Choice> chosen : {result.best.chosen, std::move(greedy)}) {
        std::set<Choice> once;
        std::erase_if(chosen, [&once](const Choice& one) { return !once.insert(one).second; });
        Solution solution{std::move(chosen), 0};
        solution.value = search.valueOf(search.spotsOf(solution.chosen));
        if (moves) search.improve(solution, progress);
        if (solution.value > best.value || best.chosen.empty()) best = std::move(solution);
    }
    result.best = std::move(best);
    result.bound =
        std::min({result.bound, search.total(), search.boundBeside(result.best.chosen, grace)});
    result.is_complete = result.is_complete && !progress.stopped();
    return result;
}

class LocaliseIn final : public ObjectiveSearch {
  public:
    LocaliseIn(const CoverageModel& model, double within) : model_(model), within_(within) {}

    [[nodiscard]] std::uint64_t total() const override {
        return model_.problem().totalWeight() * kNoError;
    }
    [[nodiscard]] SearchResult find(Progress& progress) const override {
        return searchLocalised(model_, within_, progress);
    }
    void report(std::span<const CountedView> views, Arrangement& result) const override {
        const LocaliseSearch search(model_, within_);
        Spots spots = search.standing();
        for (std::size_t i = 0; i < views.size(); ++i)
            search.add(sensorOf(model_.groups(), result.sensors[i]), views[i].cells, spots);
        result.value = model_.share(search.valueOf(spots));
        result.whole = within_;
    }

  private:
    const CoverageModel& model_;
    double within_;
};

}  // namespace

std::unique_ptr<ObjectiveSearch> LocaliseObjective::searchIn(const CoverageModel& model) const {
    return std::make_unique<LocaliseIn>(model, within_);
}

std::string LocaliseObjective::finding(const Arrangement& found) const {
    constexpr int kDigits = 4;
    return "by cells the mean error of positions is " +
           formatFixed((1 - *found.value) * *found.whole, kDigits) + " m, none above " +
           formatDouble(*found.whole) + " m; no layout of these candidates makes it less than " +
           formatFixed((1 - found.candidate_bound) * *found.whole, kDigits) + " m";
}

}  // namespace ispace::goals
