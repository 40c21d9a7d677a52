// SPDX-License-Identifier: GPL-3.0-or-later
#include "site/site_run_coverage.h"

#include <memory>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "report/run_report.h"

namespace ispace {

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

void addRun(SiteParts& parts, const SiteScene& building, const SiteRunCoverage& run) {
    parts.storeys.resize(run.storeys.size());
    for (std::size_t i = 0; i < run.storeys.size(); ++i)
        parts.storeys[i].push_back(
            std::make_shared<RunSection>(run.storeys[i], !building.isRoomAlone()));
    parts.sum.push_back(std::make_shared<RunSection>(run.sum));
}

}  // namespace ispace
