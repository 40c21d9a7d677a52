// SPDX-License-Identifier: GPL-3.0-or-later
// Rules of facing of building_coverage.h.
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/glob.h"
#include "building/building_coverage.h"
#include "coverage/camera_rules.h"
#include "env/zone.h"

namespace ispace {

namespace {

bool hasZone(const Environment& room, const std::string& zone) {
    if (zone.starts_with(kDoorPrefix)) {
        const Glob doors(zone.substr(kDoorPrefix.size(), zone.rfind(',') - kDoorPrefix.size()));
        for (const Doorway& door : doorwaysOf(room))
            if (doors.matches(door.id)) return true;
        return false;
    }
    const Glob zones(zone);
    for (const Element& element : room.elements())
        if (element.record.keyword() == "zone" && zones.matches(element.id)) return true;
    return false;
}

/// Lists the doors of all storeys, or the zones, for a rule that no storey has.
/// \param own the rule's zone without its storeys
std::string unknownRule(const std::string& zone, const std::string& own,
                        const BuildingScene& building) {
    const bool is_of_doors = own.starts_with(kDoorPrefix);
    std::string list, doors_named;
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        const Storey& storey = building.document.storeys[i];
        const Environment& room = building.scenes[i]->environment;
        if (is_of_doors) {
            if (const std::string doors = doorList(room, storey.id + '/'); !doors.empty())
                list += (list.empty() ? "" : ", ") + doors;
            continue;
        }
        if (hasZone(room, std::string(kDoorPrefix) + own + ",1"))
            doors_named = "; doors have this name: " + zone.substr(0, zone.size() - own.size()) +
                          std::string(kDoorPrefix) + own;
        for (const Element& element : room.elements())
            if (element.record.keyword() == "zone")
                list += (list.empty() ? "" : ", ") + wholeId(storey, element.id);
    }
    const std::string kind = is_of_doors ? "door" : "zone";
    return "--facing: " + excerpt(zone) + " meets no " + kind + doors_named +
           (list.empty() ? ": the building has none"
                         : "; the " + kind + "s of the building: " + list);
}

}  // namespace

std::vector<CameraRules> measureBuildingFacing(const BuildingScene& building,
                                               const BuildingCoverage& coverage,
                                               std::span<const FacingRule> rules) {
    std::vector<CameraRules> measured(building.scenes.size());
    for (const FacingRule& rule : rules) {
        const auto [storeys, zone] = splitStoreys(building.document, "--facing", rule.zone);
        bool is_met = false;
        for (const std::size_t i : storeys) {
            const Scene& floor = *coverage.floors[i];
            if (!hasZone(floor.environment, zone)) continue;
            is_met = true;
            FacingRule own = rule;
            own.zone = zone;
            std::vector<FacingResult> results =
                measureFacing(floor, coverage.storeys[i], {&own, 1});
            measured[i].facing.insert(measured[i].facing.end(),
                                      std::make_move_iterator(results.begin()),
                                      std::make_move_iterator(results.end()));
        }
        if (!is_met) throw UsageError(unknownRule(rule.zone, zone, building));
    }
    return measured;
}

std::vector<JudgedRule> judgedInBuilding(const BuildingScene& building,
                                         std::span<const CameraRules> rules) {
    std::vector<JudgedRule> all;
    for (std::size_t i = 0; i < rules.size(); ++i)
        for (JudgedRule& rule : judgedRules(rules[i])) {
            rule.rule.insert(0, building.document.storeys[i].id + ": ");
            all.push_back(std::move(rule));
        }
    return all;
}

}  // namespace ispace
