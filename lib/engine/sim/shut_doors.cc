// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/shut_doors.h"

#include <algorithm>
#include <map>
#include <string_view>

#include "env/zone.h"
#include "geom/predicates.h"
#include "scene/thing_kind.h"

namespace ispace {

namespace {

bool isShutDoor(const Record& record) { return record.keyword() == "door" && !record.flag("open"); }

}  // namespace

std::vector<ShutDoor> shutDoorsOf(const Scene& scene) {
    std::vector<ShutDoor> doors;
    if (std::none_of(scene.records.begin(), scene.records.end(), isShutDoor)) return doors;
    std::map<std::string_view, const Record*> records;
    for (std::size_t i = 0; i < scene.records.size(); ++i)
        if (isShutDoor(scene.records[i])) records.emplace(scene.ids[i], &scene.records[i]);
    for (Doorway& doorway : doorwaysOf(scene.environment)) {
        const auto found = records.find(doorway.id);
        if (found == records.end()) continue;
        doors.push_back({std::move(doorway.id), *found->second, doorway.line, doorway.thickness});
    }
    return doors;
}

Environment withOpen(const Scene& scene, std::span<const ShutDoor> doors) {
    if (doors.empty()) return scene.environment;
    std::vector<Record> records = scene.records;
    for (std::size_t i = 0; i < records.size(); ++i)
        if (std::any_of(doors.begin(), doors.end(),
                        [&](const ShutDoor& door) { return door.id == scene.ids[i]; }))
            records[i].set("open", Value(true));
    return {records, scene.ids, scene.environment};
}

std::vector<DoorCrossing> crossings(Point2 from, std::span<const Point2> way,
                                    std::span<const ShutDoor> doors) {
    std::vector<DoorCrossing> found;
    for (std::size_t i = 0; i < way.size(); ++i) {
        const Segment2 leg{i == 0 ? from : way[i - 1], way[i]};
        const std::size_t first = found.size();
        for (std::size_t k = 0; k < doors.size(); ++k)
            if (intersects(leg, doors[k].line)) found.push_back({k, i});
        const auto off = [&](const DoorCrossing& crossing) {
            return distance(nearestPoint(doors[crossing.door].line, leg.a), leg.a);
        };
        std::stable_sort(
            found.begin() + static_cast<std::ptrdiff_t>(first), found.end(),
            [&](const DoorCrossing& a, const DoorCrossing& b) { return off(a) < off(b); });
    }
    return found;
}

std::string barrierText(const ShutDoor& door) {
    const std::string_view word = barrierOf(door.record);
    std::string text = door.id;
    return text.append(" is ").append(word.empty() ? "shut" : word);
}

std::string barriersText(Point2 from, std::span<const Point2> way,
                         std::span<const ShutDoor> doors) {
    std::string text;
    for (const DoorCrossing& crossing : crossings(from, way, doors))
        text.append(text.empty() ? "" : ", ").append(barrierText(doors[crossing.door]));
    return text;
}

}  // namespace ispace
