// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/runs/site_run_coverage.h"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "base/message.h"
#include "cli/operands.h"
#include "cli/storey_operands.h"
#include "extensions/runs/run_report.h"
#include "scene/run/run_reader.h"
#include "site/coupling.h"
#include "site/site_sight.h"

namespace ispace::runs {

namespace {

/// Adds shares of an amount to sums.
void addShares(std::vector<double>& sums, const std::vector<double>& shares, double amount) {
    if (sums.size() < shares.size()) sums.resize(shares.size());
    for (std::size_t k = 0; k < shares.size(); ++k) sums[k] += amount * shares[k];
}

/// Adds metrics; the shares of the sum are amounts.
void addMetrics(RunCoverageMetrics& sum, const RunCoverageMetrics& one) {
    addShares(sum.time_shares, one.time_shares, one.duration);
    addShares(sum.way_shares, one.way_shares, one.length);
    sum.duration += one.duration;
    sum.length += one.length;
    sum.losses += one.losses;
    const auto lasts = [](const UnseenInterval& gap) { return gap.end - gap.begin; };
    if (one.longest_gap && (!sum.longest_gap || lasts(*one.longest_gap) > lasts(*sum.longest_gap)))
        sum.longest_gap = one.longest_gap;
}

void turnIntoShares(std::vector<double>& amounts, double all) {
    for (double& amount : amounts) amount = all > 0 ? amount / all : 0;
}

}  // namespace

RunCoverage sumOverStoreys(std::span<const RunCoverage> storeys, std::span<const std::string> ids) {
    RunCoverage sum;
    std::map<std::string, std::size_t> known;  // members by id
    bool is_first = true;
    for (std::size_t i = 0; i < storeys.size(); ++i) {
        const RunCoverage& storey = storeys[i];
        sum.unreached.insert(sum.unreached.end(), storey.unreached.begin(), storey.unreached.end());
        sum.contacts.insert(sum.contacts.end(), storey.contacts.begin(), storey.contacts.end());
        if (storey.members.empty()) continue;
        sum.begin = is_first ? storey.begin : std::min(sum.begin, storey.begin);
        sum.end = std::max(sum.end, storey.end);
        is_first = false;
        for (const RunCoverageMetrics& member : storey.members) {
            const auto [at, is_new] = known.try_emplace(member.id, sum.members.size());
            if (is_new) sum.members.push_back({.id = member.id, .is_person = member.is_person});
            addMetrics(sum.members[at->second], member);
        }
        addMetrics(sum.all, storey.all);
        for (TrackLoss loss : storey.losses) {
            loss.member = known.at(storey.members[loss.member].id);
            loss.room = ids[i];
            sum.losses.push_back(std::move(loss));
        }
    }
    for (RunCoverageMetrics& member : sum.members) {
        turnIntoShares(member.time_shares, member.duration);
        turnIntoShares(member.way_shares, member.length);
    }
    turnIntoShares(sum.all.time_shares, sum.all.duration);
    turnIntoShares(sum.all.way_shares, sum.all.length);
    const auto earlier = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::stable_sort(sum.unreached.begin(), sum.unreached.end(), earlier);
    std::stable_sort(
        sum.losses.begin(), sum.losses.end(),
        [](const TrackLoss& a, const TrackLoss& b) { return a.duration > b.duration; });
    std::stable_sort(sum.contacts.begin(), sum.contacts.end(), earlier);
    return sum;
}

namespace {

/// Fixed sensors of a storey that a run has changed.
struct SensorChange {
    double time = 0;  // seconds: of the step after which it was made
    std::size_t storey = 0;
    std::shared_ptr<const Scene> scene;  // after it
};

/// Returns the changes of sensors that may see other storeys, in order of time.
std::vector<SensorChange> sensorChanges(const SiteScene& building, const std::string& folder,
                                        std::optional<std::uint64_t> max_work) {
    std::vector<SensorChange> found;
    if (floorOpenings(building).empty()) return found;
    const auto unknown = [](const std::string&) { return std::optional<Pose2>(); };
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        std::shared_ptr<const Scene> now = sceneWithWholeIds(building, i);
        RunChanges changes =
            changesOfRun(recordOfStorey(folder, building.document.storeys[i]), *now, max_work);
        while (auto step = changes.next(std::numeric_limits<double>::infinity(), *now, unknown)) {
            auto next = std::make_shared<const Scene>(std::move(step->scene));
            if (looksOtherwise(*now, *next)) found.push_back({step->change.time, i, next});
            now = std::move(next);
        }
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const SensorChange& a, const SensorChange& b) { return a.time < b.time; });
    return found;
}

}  // namespace

SiteRunCoverage measureSiteRun(const SiteScene& building, const std::string& folder,
                               const WatchOptions& watch, std::optional<std::uint64_t> max_work,
                               std::vector<std::string>& warnings) {
    SiteRunCoverage run;
    const std::vector<SensorChange> sensor_changes = sensorChanges(building, folder, max_work);
    std::optional<RoomsAround> rooms(std::in_place, building, watch.plane);
    WatchOptions own_watch = watch;
    std::vector<std::string> ids;
    for (const Storey& storey : building.document.storeys) ids.push_back(storey.id);
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        if (!sensor_changes.empty()) rooms.emplace(building, watch.plane);
        const Storey& storey = building.document.storeys[i];
        if (!building.isRoomAlone())
            own_watch.outside = [&rooms, i](const Scene& scene) {
                return rooms->outside(i, scene);
            };
        const auto advance = [&, next = sensor_changes.begin()](double time) mutable {
            bool is_new = false;
            for (; next != sensor_changes.end() && next->time < time; ++next) {
                rooms->setSensors(next->storey, *next->scene);
                is_new |= next->storey != i;
            }
            return is_new;
        };
        const std::string own = recordOfStorey(folder, storey);
        RunCoverage& measured = run.storeys.emplace_back();
        if (building.isRoomAlone() || RunReader(own).next()) {
            const auto scene = sceneWithWholeIds(building, i);
            RunReader reader(own);
            RunChanges changes = changesOfRun(own, *scene, max_work);
            measured = measureRun(*scene, reader, own_watch, &changes, advance);
            if (!changes.failure().empty()) warnings.push_back(storey.prefix() + changes.failure());
            if (reader.isCut())
                warnings.push_back(storey.prefix() +
                                   "the record ends in the midst of a step, which is left out");
        }
        measured.name = baseName(folder) + (storey.id.empty() ? "" : '/' + storey.id);
    }
    run.sum = sumOverStoreys(run.storeys, ids);
    run.sum.name = baseName(folder);
    return run;
}

void addRun(SiteParts& parts, const SiteScene& building, const SiteRunCoverage& run) {
    parts.storeys.resize(run.storeys.size());
    for (std::size_t i = 0; i < run.storeys.size(); ++i)
        parts.storeys[i].push_back(
            std::make_shared<RunSection>(run.storeys[i], !building.isRoomAlone()));
    parts.sum.push_back(std::make_shared<RunSection>(run.sum));
}

}  // namespace ispace::runs
