// SPDX-License-Identifier: GPL-3.0-or-later
// Shares are weighted by the lengths of the ways; the longest gap is that within one storey, as a
// person between two storeys is on no way.
#include "extensions/presence/site_presence.h"

#include <algorithm>
#include <map>
#include <string>

namespace ispace::presence {

namespace {

/// Adds figures; the share of the sum is a length.
void addFigures(PresenceFigures& sum, const PresenceFigures& one) {
    sum.length += one.length;
    sum.share += one.share * one.length;
    sum.longest_gap = std::max(sum.longest_gap, one.longest_gap);
}

void turnIntoShare(PresenceFigures& sum) {
    sum.share = sum.length > 0 ? sum.share / sum.length : 0;
}

}  // namespace

void nameWholly(const Storey& storey, bool of_people, Presence& presence) {
    for (SensorPresence& sensor : presence.sensors) sensor.id = wholeId(storey, sensor.id);
    if (!of_people) return;
    for (PresenceFigures& person : presence.people) person.id = wholeId(storey, person.id);
}

Presence sumOverStoreys(std::span<const Presence> storeys) {
    if (storeys.size() == 1) return storeys.front();
    Presence sum;
    std::map<std::string, std::size_t> known;
    for (const Presence& storey : storeys) {
        addFigures(sum.all, storey.all);
        for (const PresenceFigures& person : storey.people) {
            const auto [at, is_new] = known.try_emplace(person.id, sum.people.size());
            if (is_new) sum.people.push_back({.id = person.id});
            addFigures(sum.people[at->second], person);
        }
    }
    for (const Presence& storey : storeys) {
        const double weight = sum.all.length > 0 ? storey.all.length / sum.all.length : 0;
        for (SensorPresence sensor : storey.sensors) {
            sensor.share *= weight;
            sensor.marginal *= weight;
            sum.sensors.push_back(std::move(sensor));
        }
    }
    for (PresenceFigures& person : sum.people) turnIntoShare(person);
    turnIntoShare(sum.all);
    return sum;
}

}  // namespace ispace::presence
