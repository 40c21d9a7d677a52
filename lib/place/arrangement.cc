// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/arrangement.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <span>

#include "base/error.h"
#include "base/number.h"
#include "cover/coverage.h"
#include "place/any_place.h"
#include "place/candidate_pool.h"
#include "place/model_file.h"
#include "place/refine.h"
#include "place/scene_value.h"
#include "place/whole_units.h"
#include "sense/scan.h"
#include "sense/ultrasound.h"
#include "trace/worlds.h"

namespace ispace {

namespace {

std::vector<SensorDevice> devicesOf(const std::vector<SensorKind>& kinds) {
    std::vector<SensorDevice> devices;
    devices.reserve(kinds.size());
    for (const SensorKind& kind : kinds) devices.push_back(kind.device);
    return devices;
}

bool isReceiver(const SensorDevice& device) { return std::holds_alternative<Receiver>(device); }

/// What is asked for, as numbers for the search, and the way back from what it finds.
class Job {
  public:
    Job(const Scene& scene, const std::vector<SensorGroup>& groups, const ArrangeOptions& options,
        Progress& progress)
        : scene_(scene),
          groups_(groups),
          options_(options),
          progress_(progress),
          worlds_(scene.environment),
          kinds_(kindsOf(groups)) {
        checkBudget();
        if (options.refine) mustBeRefinable(scene, devicesOf(kinds_), options.worth);
        const Coverage before = measureCoverage(scene, worlds_, searching());
        target_ = before.target;
        problem_.weights = wholeUnits(worthOfCells(target_, options.worth));
        total_ = problem_.totalWeight();
        if (total_ == 0)
            throw UnmetError(
                "nothing to cover: no cell of the target lies indoors; use a larger "
                "zone or more cells (--reso)");
        setDemand(before);
        CellWorth worth{CellSet(target_.grid.size()), weightsLeft()};
        for (std::size_t i = 0; i < problem_.cells(); ++i)
            if (problem_.weights[i] > 0) worth.counted.set(i);
        pool_ = std::make_unique<CandidatePool>(scene.environment, worlds_, target_,
                                                std::move(worth), options, progress);
        addKinds();
    }

    Arrangement run(std::ostream* mps) {
        Arrangement result;
        result.is_complete = is_complete_;
        for (const auto& set : sets_) {
            result.candidates += set->size();
            result.bytes += set->bytes();
        }
        if (mps != nullptr) {
            mustFitInModel();
            writeMps(problem_, names(), *mps);
        }
        SearchResult found = find(result);
        takeEachOnce(found.best.chosen);
        result.is_complete = result.is_complete && found.is_complete;
        constexpr double kPerUnit = 1e6;  // of money: sums of decimals round
        result.cost = std::round(costOf(problem_, found.best.chosen) * kPerUnit) / kPerUnit;
        result.has_costs = std::any_of(kinds_.begin(), kinds_.end(),
                                       [](const SensorKind& kind) { return kind.cost != 1; });
        if (!options_.target && !options_.budget)
            result.unplaced = problem_.order.size() - found.best.chosen.size();
        result.candidate_value = share(found.best.value);
        result.candidate_bound = is_complete_ ? share(found.bound) : 1;
        result.bound = result.candidate_bound;
        result.sensors = sensorsOf(found.best.chosen);
        if (options_.refine) refineIn(result, found.best.value);
        measure(result);
        if (options_.wants_curve) {
            result.curve = curveTo(found);
            result.is_complete = result.is_complete && !progress_.stopped();
        }
        if (options_.wants_trace) result.tried = tried(found.best.chosen);
        return result;
    }

  private:
    [[nodiscard]] CoverageOptions searching() const {
        return {.columns = options_.columns,
                .rows = options_.rows,
                .plane = options_.plane,
                .exact = false};
    }

    [[nodiscard]] double share(std::uint64_t value) const {
        return static_cast<double>(value) / static_cast<double>(total_);
    }

    void checkBudget() const {
        if (!options_.budget) return;
        double least = kinds_.front().cost;
        for (const SensorKind& kind : kinds_) least = std::min(least, kind.cost);
        if (*options_.budget < least)
            throw UnmetError("a budget of " + formatDouble(*options_.budget) +
                             " buys nothing: the cheapest sensor costs " + formatDouble(least));
    }

    /// Receivers count four together; so others count as four each where there are receivers.
    void setDemand(const Coverage& before) {
        const bool listens = !scene_.receivers.empty() ||
                             std::any_of(kinds_.begin(), kinds_.end(), [](const SensorKind& kind) {
                                 return isReceiver(kind.device);
                             });
        unit_ = listens ? static_cast<int>(kLeastReceivers) : 1;
        problem_.demand = unit_ * options_.redundancy;
        problem_.met.assign(target_.grid.size(), 0);
        problem_.standing = CellSet(target_.grid.size());
        for (const SensorView& view : before.sensors) {
            const int part = view.kind == ViewKind::Receiver ? 1 : unit_;
            view.cells.forEach([&](std::size_t cell) {
                problem_.met[cell] =
                    static_cast<std::uint16_t>(std::min(problem_.met[cell] + part, 0xffff));
            });
            problem_.standing |= view.cells;
        }
        problem_.is_connected = options_.is_connected;
        problem_.budget = options_.budget;
    }

    /// Of cells whose demand nobody meets yet.
    [[nodiscard]] std::vector<std::uint32_t> weightsLeft() const {
        std::vector<std::uint32_t> left = problem_.weights;
        for (std::size_t i = 0; i < left.size(); ++i)
            if (problem_.met[i] >= problem_.demand) left[i] = 0;
        return left;
    }

    void addKinds() {
        for (const SensorKind& kind : kinds_) {
            CandidatePool::Made made = pool_->make(kind);
            is_complete_ = is_complete_ && made.is_complete;
            if (made.set->size() == 0)
                throw UnmetError("stopped before there was any candidate for " + kind.id);
            sets_.push_back(std::move(made.set));
            problem_.kinds.push_back(
                {sets_.back().get(), kind.most, kind.cost, isReceiver(kind.device) ? 1 : unit_});
        }
        if (options_.budget || options_.target) return;
        for (std::size_t g = 0; g < groups_.size(); ++g)
            for (int i = 0; i < groups_[g].most; ++i) problem_.order.push_back(kindOf(g));
    }

    [[nodiscard]] std::size_t kindOf(std::size_t group) const {
        std::size_t kind = 0;
        while (std::find(kinds_[kind].groups.begin(), kinds_[kind].groups.end(), group) ==
               kinds_[kind].groups.end())
            ++kind;
        return kind;
    }

    [[nodiscard]] std::vector<std::string> names() const {
        std::vector<std::string> names;
        names.reserve(kinds_.size());
        for (const SensorKind& kind : kinds_) names.push_back(kind.id);
        return names;
    }

    /// A row for each cell that a candidate sees: some 30 bytes each.
    void mustFitInModel() const {
        constexpr double kMostEntries = 1e8;
        double entries = 0;
        const std::vector<std::uint32_t> ones(problem_.cells(), 1);
        for (const auto& set : sets_) {
            std::vector<std::uint32_t> counts(set->size());
            set->priceAll(CellPrices(ones), counts);
            for (const std::uint32_t count : counts) entries += count;
        }
        if (entries > kMostEntries)
            throw UsageError("--export-mps: the model has " + formatFixed(entries / 1e6, 0) +
                             " million entries, more than " + formatFixed(kMostEntries / 1e6, 0) +
                             ": use fewer candidates (--candidates) or cells (--reso)");
    }

    SearchResult find(Arrangement& result) {
        if (!options_.target) return search(problem_, options_.search, progress_);
        const auto wanted = static_cast<std::uint64_t>(
            std::ceil(*options_.target * static_cast<double>(total_) - 1e-6));
        Fewest fewest = placeFewest(problem_, wanted, options_.search, progress_);
        result.is_reached = fewest.is_reached;
        if (fewest.is_reached) result.least = fewest.least_cost;
        return fewest.result;
    }

    /// Where there are fewer candidates than sensors a search chooses some again, which counts for
    /// nothing; two sensors cannot stand in one another.
    static void takeEachOnce(std::vector<Choice>& chosen) {
        std::set<Choice> taken;
        std::erase_if(chosen,
                      [&taken](const Choice& choice) { return !taken.insert(choice).second; });
    }

    /// The chosen of a kind go to its groups, in their order.
    [[nodiscard]] std::vector<ArrangedSensor> sensorsOf(const std::vector<Choice>& chosen) const {
        std::vector<std::vector<Pose3>> poses(kinds_.size());
        for (const Choice& choice : chosen)
            poses[choice.kind].push_back(sets_[choice.kind]->pose(choice.candidate));
        std::vector<std::size_t> used(kinds_.size());
        std::vector<ArrangedSensor> sensors;
        std::vector<Record> records = scene_.records;
        std::vector<std::size_t> added;  // sensors without an id
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            const std::size_t kind = kindOf(g);
            for (int i = 0; i < groups_[g].most && used[kind] < poses[kind].size(); ++i) {
                sensors.push_back({g, groups_[g].id, poses[kind][used[kind]++]});
                if (groups_[g].is_pending) continue;
                records.push_back(groups_[g].record);
                added.push_back(sensors.size() - 1);
            }
        }
        const std::vector<std::string> ids = assignIds(records);
        for (std::size_t i = 0; i < added.size(); ++i)
            sensors[added[i]].id = ids[scene_.records.size() + i];
        return sensors;
    }

    /// On the grid of the search.
    [[nodiscard]] Coverage coverageOf(const std::vector<ArrangedSensor>& sensors) {
        return measureCoverage(withArranged(scene_, groups_, sensors), worlds_, searching());
    }

    /// Sensors that were apart stay so by this much, metres: no two are built in one place.
    static constexpr double kApart = 0.05;

    [[nodiscard]] static bool areApart(const std::vector<ArrangedSensor>& before,
                                       const std::vector<Pose3>& poses) {
        for (std::size_t i = 0; i < poses.size(); ++i)
            for (std::size_t k = 0; k < i; ++k) {
                const double least =
                    std::min(kApart, length(before[i].pose.position - before[k].pose.position));
                if (length(poses[i].position - poses[k].position) < least) return false;
            }
        return true;
    }

    void refineIn(Arrangement& result, std::uint64_t before) {
        std::vector<Movable> movables;
        movables.reserve(result.sensors.size());
        for (const ArrangedSensor& sensor : result.sensors)
            movables.push_back({sensor.id, groups_[sensor.group].device, sensor.pose,
                                &pool_->judgeAt(sensor.pose.position.z)});
        const auto with = [&](const std::vector<Pose3>& poses) {
            std::vector<ArrangedSensor> sensors = result.sensors;
            for (std::size_t i = 0; i < sensors.size(); ++i) sensors[i].pose = poses[i];
            return sensors;
        };
        const auto is_kept = [&](const std::vector<Pose3>& poses) {
            const Coverage coverage = coverageOf(with(poses));
            return valueOf(problem_, coverage, unit_) >= before &&
                   (!options_.is_connected || isConnected(problem_, coverage, scene_));
        };
        const RefineOptions refining{.demand = options_.redundancy, .plane = options_.plane};
        const auto apart = [&](const std::vector<Pose3>& poses) {
            return areApart(result.sensors, poses);
        };
        Refined refined =
            ispace::refine(scene_, movables, options_.worth, refining, apart, progress_);
        // What is best in truth may be a cell less on the grid by which results are compared, or
        // hang together no more: then each step is judged by that.
        if (!is_kept(refined.poses))
            refined = ispace::refine(
                scene_, movables, options_.worth, refining,
                [&](const std::vector<Pose3>& poses) { return apart(poses) && is_kept(poses); },
                progress_);
        result.sensors = with(refined.poses);
        result.refined_before = refined.before;
        result.refined_after = refined.after;
        result.is_complete = result.is_complete && !progress_.stopped();
        // A budget might have bought others; else there are as many as there are.
        std::vector<int> most(kinds_.size());
        for (std::size_t k = 0; k < kinds_.size(); ++k)
            if (options_.budget) most[k] = kinds_[k].most;
        if (!options_.budget)
            for (const ArrangedSensor& sensor : result.sensors) ++most[kindOf(sensor.group)];
        result.bound =
            share(mostFromAnyPlace(problem_, target_.grid, devicesOf(kinds_), most, unit_));
    }

    void measure(Arrangement& result) {
        const CoverageOptions usual{.plane = options_.plane, .exact = false};
        const CoverageReport report =
            measureCoverage(withArranged(scene_, groups_, result.sensors), worlds_, usual).report;
        result.coverage = report.coverage.grid.value_or(0);
        result.area = report.total_effective_area.grid.value_or(0);
        const bool is_coverage = options_.worth.isUniform() && options_.redundancy == 1 &&
                                 options_.columns == usual.columns && options_.rows == usual.rows;
        if (!is_coverage)
            result.value = share(valueOf(problem_, coverageOf(result.sensors), unit_));
    }

    /// Of 1, 2, ... sensors of these kinds, whatever they cost.
    [[nodiscard]] std::vector<CurvePoint> curveTo(const SearchResult& found) {
        const auto last = static_cast<int>(found.best.chosen.size());
        std::vector<CurvePoint> curve;
        Problem fewer = problem_;
        fewer.order.clear();
        for (Kind& kind : fewer.kinds) kind.cost = 1;
        for (int n = 1; n <= last && !progress_.stopped(); ++n) {
            fewer.budget = n;
            const bool is_found = n == last && !options_.budget && !options_.target;
            const SearchResult best = is_found ? found : search(fewer, options_.search, progress_);
            curve.push_back({n, share(best.best.value), share(best.bound)});
        }
        // What is known anyway.
        const bool is_cut = curve.size() < found.best.chosen.size();
        if (is_cut && !options_.budget && !options_.target)
            curve.push_back({last, share(found.best.value), share(found.bound)});
        return curve;
    }

    /// By the thesis' scan of each pose.
    void addSliceAreas(const Laser& laser, std::span<TriedPose> poses) {
        for (const TriedPose& tried : poses) worlds_.prepare(tried.pose);
        tbb::parallel_for(std::size_t{0}, poses.size(), [&](std::size_t i) {
            const PlacedLaser placed{"", laser, poses[i].pose};
            poses[i].slice_area = sliceArea(laser, castBeams(worlds_.at(placed.pose), placed));
        });
    }

    /// Every candidate with what it would add to what stands.
    [[nodiscard]] std::vector<TriedPose> tried(const std::vector<Choice>& chosen) {
        const CellPrices prices(weightsLeft());
        std::vector<TriedPose> all;
        for (std::size_t k = 0; k < kinds_.size(); ++k) {
            const CandidateSet& set = *sets_[k];
            std::vector<std::uint32_t> values(set.size());
            set.priceAll(prices, values);
            const double part = static_cast<double>(problem_.kinds[k].share) / problem_.demand;
            const std::size_t first = all.size();
            all.reserve(first + set.size());
            for (std::size_t i = 0; i < set.size(); ++i)
                all.push_back({kinds_[k].id, set.pose(i), part * share(values[i]), false});
            for (const Choice& choice : chosen)
                if (choice.kind == k) all[first + choice.candidate].is_chosen = true;
            if (const auto* laser = std::get_if<Laser>(&kinds_[k].device))
                addSliceAreas(*laser, std::span(all).subspan(first));
        }
        return all;
    }

    const Scene& scene_;
    const std::vector<SensorGroup>& groups_;
    const ArrangeOptions& options_;
    Progress& progress_;
    Worlds worlds_;
    std::vector<SensorKind> kinds_;
    Target target_;
    Problem problem_;
    std::uint64_t total_ = 0;
    int unit_ = 1;
    std::unique_ptr<CandidatePool> pool_;
    std::vector<std::unique_ptr<CandidateSet>> sets_;
    bool is_complete_ = true;  ///< all candidates were made
};

}  // namespace

Arrangement arrange(const Scene& scene, const std::vector<SensorGroup>& groups,
                    const ArrangeOptions& options, Progress& progress, std::ostream* mps) {
    return Job(scene, groups, options, progress).run(mps);
}

Record placedRecord(const SensorGroup& group, const ArrangedSensor& sensor) {
    Record record = group.record;
    const Point3& p = sensor.pose.position;
    record.set("id", Value(sensor.id));
    record.set("at", Value(Tuple{p.x, p.y, p.z}));
    record.set("heading", Value(sensor.pose.heading.degrees()));
    if (!(record.angle("tilt") == sensor.pose.tilt))
        record.set("tilt", Value(sensor.pose.tilt.degrees()));
    return record;
}

Scene withArranged(const Scene& scene, const std::vector<SensorGroup>& groups,
                   const std::vector<ArrangedSensor>& sensors) {
    Scene whole = scene;
    for (const auto& [group, id, pose] : sensors) {
        const SensorDevice& device = groups[group].device;
        if (const auto* laser = std::get_if<Laser>(&device))
            whole.lasers.push_back({id, *laser, pose});
        else if (const auto* ranger = std::get_if<Ranger>(&device))
            whole.rangers.push_back({id, *ranger, pose});
        else
            whole.receivers.push_back({id, std::get<Receiver>(device), pose});
    }
    return whole;
}

}  // namespace ispace
