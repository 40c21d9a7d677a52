// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/door_zones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/glob.h"
#include "base/message.h"
#include "base/number.h"
#include "env/openings.h"
#include "env/walls.h"

namespace ispace {

namespace {

constexpr std::string_view kDoor = "door:";
constexpr int kChords = 16;  // to a quarter of a circle

/// A door's id, and the rectangle in the floor that its opening is.
struct Doorway {
    std::string id;
    Segment2 line;
    double thickness = 0;
};

std::vector<Doorway> doorwaysOf(const Environment& environment) {
    const std::vector<Element>& elements = environment.elements();
    Diagnostics findings;  // stays empty: the environment would not be there
    WallPlan plan;
    for (std::size_t i = 0; i < elements.size(); ++i)
        for (const WallLine& wall : wallLinesOf(elements[i].record, findings)) plan.add(wall, i);
    std::vector<Doorway> doors;
    for (const Opening& opening : placeOpenings(elements, plan, findings)) {
        const Element& element = elements[opening.element];
        if (element.record.keyword() != "door") continue;
        const Segment2 wall = plan.lines[opening.line];
        const Vec2 along = 1 / distance(wall.a, wall.b) * (wall.b - wall.a);
        doors.push_back({element.id,
                         {wall.a + opening.from * along, wall.a + opening.to * along},
                         plan.walls[opening.line].thickness});
    }
    return doors;
}

/// All points within the distance of the doorway, counter-clockwise.
Polygon around(const Doorway& door, double distance_from_it) {
    const Vec2 way = door.line.b - door.line.a;
    const Vec2 along = 1 / length(way) * way, across = perpendicular(along);
    const Vec2 aside = door.thickness / 2 * across;
    const std::array<Point2, 4> corners{door.line.b - aside, door.line.b + aside,
                                        door.line.a + aside, door.line.a - aside};
    Polygon outline;
    for (std::size_t quarter = 0; quarter < corners.size(); ++quarter)
        for (int i = 0; i <= kChords; ++i) {
            const double angle =
                std::numbers::pi / 2 *
                (static_cast<double>(quarter) - 1 + static_cast<double>(i) / kChords);
            outline.push_back(corners[quarter] + distance_from_it * (std::cos(angle) * along +
                                                                     std::sin(angle) * across));
        }
    const auto are_one = [](Point2 a, Point2 b) { return distance(a, b) < 1e-9; };
    outline.erase(std::unique(outline.begin(), outline.end(), are_one), outline.end());
    if (are_one(outline.front(), outline.back())) outline.pop_back();
    return outline;
}

/// \throws UsageError
std::pair<std::string, double> parsedDoors(std::string_view text) {
    constexpr double kFarthest = 100;
    const KeySpec key{.name = "distance",
                      .type = KeyType::Number,
                      .unit = Unit::Length,
                      .help = "",
                      .lower = 0.001,
                      .upper = kFarthest};
    const std::string_view words = text.substr(kDoor.size());
    const std::size_t comma = words.rfind(',');
    if (comma == std::string_view::npos || comma == 0)
        throw UsageError(excerpt(text) + " is no zone: wanted door:GLOB,M, such as door:*,0.8");
    try {
        return {std::string(words.substr(0, comma)),
                std::get<double>(parseValue(key, words.substr(comma + 1)))};
    } catch (const FormatError& error) {
        throw UsageError(excerpt(text) + " is no zone: " + error.diagnostics().front().message);
    }
}

/// One zone of a door.
struct DoorZone {
    std::string door;
    NamedZone zone;
};

std::vector<DoorZone> doorZones(std::string_view text, const Environment& environment) {
    const auto [glob, metres] = parsedDoors(text);
    const Glob doors(glob);
    std::vector<DoorZone> zones;
    std::vector<std::string> known;
    for (const Doorway& door : doorwaysOf(environment)) {
        known.push_back(door.id);
        if (!doors.matches(door.id)) continue;
        zones.push_back(
            {door.id,
             {std::string(kDoor) + door.id + ',' + formatDouble(metres), around(door, metres),
              door.line.a + 0.5 * (door.line.b - door.line.a), false}});
    }
    if (zones.empty())
        throw UsageError(known.empty()
                             ? "the room has no doors, which " + excerpt(text) + " is about"
                             : "the room has no door " + excerpt(glob) + didYouMean(glob, known));
    return zones;
}

}  // namespace

std::vector<NamedZone> readZones(std::string_view text, const Environment& environment) {
    if (!text.starts_with(kDoor)) return {readZone(text, environment)};
    std::vector<NamedZone> zones;
    for (DoorZone& at : doorZones(text, environment)) zones.push_back(std::move(at.zone));
    return zones;
}

std::vector<Record> zoneRecords(std::span<const std::string> texts, const Environment& environment,
                                const Schemas& schemas) {
    std::set<std::string> ids;
    for (const Element& element : environment.elements()) ids.insert(element.id);
    std::vector<Record> records;
    const auto add = [&](const Polygon& outline, std::string id) {
        Record& record = records.emplace_back(*schemas.find("zone"));
        if (!id.empty()) record.set("id", std::move(id));
        TupleList path;
        for (const Point2 p : outline)
            path.push_back({std::round(p.x * 1e6) / 1e6, std::round(p.y * 1e6) / 1e6});
        record.set("path", std::move(path));
    };
    for (const std::string& text : texts) {
        if (!text.starts_with(kDoor)) {
            const NamedZone zone = readZone(text, environment);
            if (ids.count(text) == 0) add(zone.outline, "");
            continue;
        }
        for (const auto& [door, zone] : doorZones(text, environment)) {
            std::string id = door + "-zone";
            for (int i = 2; !ids.insert(id).second; ++i) id = door + "-zone-" + std::to_string(i);
            add(zone.outline, id);
        }
    }
    return records;
}

}  // namespace ispace
