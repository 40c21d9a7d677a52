// SPDX-License-Identifier: GPL-3.0-or-later
// Dijkstra's algorithm over the two zones and all landings, by the length that is seen, then by the
// length; edges are ways on a storey, computed once each, and passages, which are not seen.
#include "extensions/goals/least_seen_trip.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/zone.h"

namespace ispace::goals {

namespace {

/// A zone at an end of the way, or the floor before a stop.
struct Stop {
    std::size_t storey = 0;
    std::string zone;                    ///< as readZone() takes it
    std::string name;                    ///< across the building
    std::optional<std::size_t> passage;  ///< index of its link
};

std::string textOf(const Box2& box) {
    return "rect:" + formatDouble(box.low.x) + ',' + formatDouble(box.low.y) + ',' +
           formatDouble(box.high.x) + ',' + formatDouble(box.high.y);
}

/// The ways on all storeys between stops, and the shortest of them end to end.
class TripFinder {
  public:
    TripFinder(const SiteScene& building, const SiteCoverage& coverage, const PathChoice& of,
               int times)
        : coverage_(coverage), times_(times) {
        for (const std::string* text : {&of.from, &of.to}) {
            const StoreyZone at = zoneOfStorey(building, "--path", *text);
            const std::string& id = building.document.storeys[at.storey].id;
            stops_.push_back({at.storey, at.zone, id + '/' + at.zone, {}});
        }
        const std::vector<passages::SitePassage> passages = passages::sitePassages(building);
        for (std::size_t i = 0; i < passages.size(); ++i)
            for (const passages::SitePassage::Landing& landing : passages[i].landings)
                stops_.push_back({landing.room, textOf(landing.floor), passages[i].id, i});
    }

    [[nodiscard]] PathChoice ends() const { return {stops_[0].name, stops_[1].name}; }

    /// Dijkstra's algorithm over the stops, by the length that is seen, then by the length.
    void find(LeastSeenTrip& trip) {
        constexpr double kInfinite = std::numeric_limits<double>::infinity();
        using Cost = std::pair<double, double>;
        std::vector<Cost> costs(stops_.size(), {kInfinite, kInfinite});
        std::vector<std::size_t> before(stops_.size(), 0);
        std::vector<bool> is_done(stops_.size(), false);
        costs[0] = {0, 0};
        while (!is_done[1]) {
            std::optional<std::size_t> next;
            for (std::size_t i = 0; i < stops_.size(); ++i)
                if (!is_done[i] && costs[i].first < kInfinite && (!next || costs[i] < costs[*next]))
                    next = i;
            if (!next) {
                trip.whole.exists = false;
                return;
            }
            is_done[*next] = true;
            for (std::size_t i = 1; i < stops_.size(); ++i) {
                if (is_done[i]) continue;
                const auto cost = costBetween(*next, i);
                if (!cost) continue;
                const Cost sum{costs[*next].first + cost->first,
                               costs[*next].second + cost->second};
                if (!(sum < costs[i])) continue;
                costs[i] = sum;
                before[i] = *next;
            }
        }
        trip.whole.seen = 0;
        for (std::size_t at = 1; at != 0; at = before[at]) {
            if (stops_[at].storey != stops_[before[at]].storey) continue;
            const LeastSeenPath& way = wayBetween(before[at], at);
            trip.whole.length += way.length;
            if (!way.seen) trip.whole.seen.reset();
            if (trip.whole.seen) *trip.whole.seen += *way.seen;
            trip.parts.push_back({stops_[at].storey, way});
        }
        std::reverse(trip.parts.begin(), trip.parts.end());
    }

  private:
    /// Returns what is seen on the way, and its length; empty if there is none.
    std::optional<std::pair<double, double>> costBetween(std::size_t from, std::size_t to) {
        const Stop &a = stops_[from], &b = stops_[to];
        if (a.storey != b.storey)
            return a.passage && a.passage == b.passage ? std::optional(std::pair(0.0, 0.0))
                                                       : std::nullopt;
        const LeastSeenPath& way = wayBetween(from, to);
        if (!way.exists) return std::nullopt;
        return std::pair(way.seen.value_or(0), way.length);
    }

    /// Searched once for each pair: costs and the trip ask for it.
    const LeastSeenPath& wayBetween(std::size_t from, std::size_t to) {
        const auto [known, is_new] = ways_.try_emplace({from, to});
        if (!is_new) return known->second;
        const std::size_t storey = stops_[from].storey;
        LeastSeenPath& way = known->second;
        try {
            way = findLeastSeenPath(*coverage_.floors[storey], coverage_.storeys[storey],
                                    {stops_[from].zone, stops_[to].zone}, times_);
        } catch (const UsageError&) {
            // A landing under a beam, say, has no floor at the height of the coverage.
            if (!stops_[from].passage && !stops_[to].passage) throw;
            way.exists = false;
        }
        way.of = {stops_[from].name, stops_[to].name};
        return way;
    }

    const SiteCoverage& coverage_;
    int times_;
    std::vector<Stop> stops_;  // the zones come first
    std::map<std::pair<std::size_t, std::size_t>, LeastSeenPath> ways_;
};

}  // namespace

StoreyZone zoneOfStorey(const SiteScene& building, std::string_view option,
                        const std::string& text) {
    const std::string head = std::string(option) + ": ";
    const StoreyText named = splitStoreys(building.document, option, text);
    std::vector<std::size_t> found;
    std::string first;
    for (const std::size_t storey : named.storeys) {
        try {
            static_cast<void>(readZone(named.text, building.scenes[storey]->environment));
            found.push_back(storey);
        } catch (const UsageError& error) {
            if (first.empty()) first = building.document.storeys[storey].id + ": " + error.what();
        }
    }
    if (found.empty()) throw UsageError(head + first);
    if (found.size() > 1)
        throw UsageError(head + "several storeys have the zone " + excerpt(named.text) +
                         ": name one, as in " + building.document.storeys[found.front()].id + '/' +
                         named.text);
    return {found.front(), named.text};
}

LeastSeenTrip findLeastSeenTrip(const SiteScene& building, const SiteCoverage& coverage,
                                const PathChoice& of, int times) {
    if (building.isRoomAlone()) {
        const LeastSeenPath way =
            findLeastSeenPath(*coverage.floors.front(), coverage.storeys.front(), of, times);
        return {way, {{0, way}}};
    }
    TripFinder finder(building, coverage, of, times);
    LeastSeenTrip trip{{finder.ends()}};
    finder.find(trip);
    return trip;
}

SiteObjectives measureObjectives(const SiteScene& building, const SiteCoverage& coverage,
                                 std::span<const PathChoice> ways, int times,
                                 std::optional<double> localise_to) {
    SiteObjectives figures;
    figures.storeys.resize(coverage.storeys.size());
    for (const PathChoice& way : ways) {
        LeastSeenTrip trip = findLeastSeenTrip(building, coverage, way, times);
        for (LeastSeenTrip::Part& part : trip.parts)
            figures.storeys[part.storey].ways.push_back(std::move(part.way));
        figures.all.ways.push_back(std::move(trip.whole));
    }
    if (!localise_to) return figures;
    std::vector<Localisation> storeys;
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i) {
        storeys.push_back(localise(*coverage.floors[i], coverage.storeys[i], *localise_to));
        figures.storeys[i].localisation = storeys.back();
    }
    figures.all.localisation = localisedOver(storeys, coverage.storeys);
    return figures;
}

}  // namespace ispace::goals
