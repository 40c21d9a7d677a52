// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/zone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/glob.h"
#include "base/message.h"
#include "base/number.h"
#include "env/body.h"
#include "env/door_floor.h"
#include "env/openings.h"
#include "env/walls.h"
#include "record/schema.h"

namespace ispace {

namespace {

constexpr std::string_view kRectangle = "rect:", kPolygon = "poly:";

/// Returns the key of coordinates: with units, and within 1000 km.
KeySpec coordinates(std::string_view prefix) {
    constexpr double kMaxDistance = 1e6;
    KeySpec key{.name = std::string(prefix),
                .type = KeyType::Tuple,
                .unit = Unit::Length,
                .help = "",
                .min_count = 4,
                .max_count = 4,
                .lower = -kMaxDistance,
                .upper = kMaxDistance};
    if (prefix == kPolygon) {
        key.type = KeyType::TupleList;
        key.min_count = key.max_count = 2;
    }
    return key;
}

Polygon rectangleOf(const Tuple& corners) {
    const auto [left, right] = std::minmax({corners[0], corners[2]});
    const auto [low, high] = std::minmax({corners[1], corners[3]});
    return {{left, low}, {right, low}, {right, high}, {left, high}};
}

Polygon polygonOf(const TupleList& corners) {
    Polygon polygon;
    polygon.reserve(corners.size());
    for (const Tuple& corner : corners) polygon.push_back({corner[0], corner[1]});
    if (signedArea(polygon) < 0) std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

/// \throws UsageError
Polygon parsedOutline(std::string_view text) {
    try {
        if (text.starts_with(kRectangle))
            return rectangleOf(std::get<Tuple>(
                parseValue(coordinates(kRectangle), text.substr(kRectangle.size()))));
        return polygonOf(
            std::get<TupleList>(parseValue(coordinates(kPolygon), text.substr(kPolygon.size()))));
    } catch (const FormatError& error) {
        throw UsageError(excerpt(text) + " is no zone: " + error.diagnostics().front().message);
    }
}

/// \throws UsageError for an outline without area or one that crosses itself
void mustEnclose(const Polygon& outline, std::string_view text) {
    const auto refuse = [text](const std::string& what) {
        throw UsageError("zone " + excerpt(text) + ' ' + what);
    };
    if (outline.size() < 3)
        refuse("has " + std::to_string(outline.size()) + " corners, wanted at least 3");
    if (const auto crossing = selfCrossing(outline))
        refuse("crosses itself near (" + formatFixed(crossing->x, 2) + ", " +
               formatFixed(crossing->y, 2) + ')');
    if (!(signedArea(outline) > 0)) refuse("has no area");
}

/// Returns the centre of gravity of the area. \pre the area is above 0
Point2 centerOfGravity(const Polygon& polygon) {
    // Relative to the first vertex, so that a small polygon far from the origin keeps its digits.
    double twice = 0;
    Vec2 sum{0, 0};
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        const Vec2 a = polygon[i - 1] - polygon[0], b = polygon[i] - polygon[0];
        const double part = cross(a, b);
        twice += part;
        sum = sum + (part / 3) * (a + b);
    }
    return polygon[0] + (1 / twice) * sum;
}

const Element* zoneRecord(std::string_view id, const Environment& environment) {
    for (const Element& element : environment.elements())
        if (element.record.keyword() == "zone" && element.id == id) return &element;
    return nullptr;
}

constexpr std::size_t kMaxListed = 20;  // doors or zones in a message

/// Returns "a, b and 3 more"; "" for no things.
std::string listed(const std::vector<std::string>& things) {
    std::string list;
    for (std::size_t i = 0; i < std::min(kMaxListed, things.size()); ++i)
        list += (i == 0 ? "" : ", ") + things[i];
    if (things.size() > kMaxListed)
        list += " and " + std::to_string(things.size() - kMaxListed) + " more";
    return list;
}

/// Returns true if the id of a door matches.
bool namesDoors(std::string_view glob, const Environment& environment) {
    const Glob wanted(glob);
    const std::vector<Doorway> doors = doorwaysOf(environment);
    return std::any_of(doors.begin(), doors.end(),
                       [&wanted](const Doorway& door) { return wanted.matches(door.id); });
}

/// Returns a hint if a text names a zone behind the id of a storey, else "".
std::string withoutStorey(std::string_view text, const std::vector<std::string>& zones) {
    const std::size_t slash = text.find('/');
    if (slash == std::string_view::npos) return "";
    const std::string_view rest = text.substr(slash + 1);
    if (!rest.starts_with(kDoorPrefix) &&
        std::find(zones.begin(), zones.end(), rest) == zones.end())
        return "";
    return ": of one storey alone it is " + excerpt(rest);
}

}  // namespace

std::string inLowerCase(std::string_view pattern, std::span<const std::string> names) {
    std::string lower(pattern);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (lower == pattern) return "";
    const Glob glob(lower);
    const bool is_met = std::any_of(names.begin(), names.end(),
                                    [&](const std::string& name) { return glob.matches(name); });
    return is_met ? ", did you mean " + excerpt(lower) + "?" : "";
}

std::string unknownZoneText(std::string_view text, const Environment& environment) {
    std::vector<std::string> known;
    for (const Element& element : environment.elements())
        if (element.record.keyword() == "zone") known.push_back(element.id);
    std::string meant = withoutStorey(text, known);
    if (meant.empty()) meant = inLowerCase(text, known);
    if (meant.empty()) meant = didYouMean(text, known);
    return "the room has no zone " + excerpt(text) + meant +
           (namesDoors(text, environment)
                ? "; its doors of this name: " + std::string(kDoorPrefix) + printable(text)
                : "") +
           (known.empty() ? "" : "; its zones: " + listed(known));
}

NamedZone readZone(std::string_view text, const Environment& environment) {
    if (const Element* const element = zoneRecord(text, environment))
        return namedZone(text, zoneOutline(element->record));
    if (text.starts_with(kRectangle) || text.starts_with(kPolygon))
        return namedZone(text, parsedOutline(text));
    throw UsageError(unknownZoneText(text, environment) +
                     "; write the id of a zone, rect:X,Y,X,Y, poly:X,Y;X,Y;X,Y or door:GLOB[,M]");
}

NamedZone namedZone(std::string_view text, Polygon outline) {
    NamedZone zone;
    zone.name = text;
    zone.outline = std::move(outline);
    mustEnclose(zone.outline, text);
    zone.inside = centerOfGravity(zone.outline);
    zone.is_center_outside = locate(zone.outline, zone.inside) != Side::Inside;
    if (!zone.is_center_outside) return zone;
    try {
        zone.inside = interiorPoint({zone.outline, {}});
    } catch (const std::invalid_argument& /*too thin*/) {
        throw UsageError("zone " + excerpt(text) + " is too thin: no point lies between its edges");
    }
    return zone;
}

namespace {

constexpr int kChords = 16;  // per quarter circle

}  // namespace

std::vector<Doorway> doorwaysOf(const Environment& environment, std::string_view keyword) {
    const std::vector<Element>& elements = environment.elements();
    Diagnostics findings;  // stays empty: an environment has none
    WallPlan plan;
    for (std::size_t i = 0; i < elements.size(); ++i)
        for (const WallLine& wall : wallLinesOf(elements[i].record, findings)) plan.add(wall, i);
    std::vector<Doorway> doors;
    for (const Opening& opening : placeOpenings(elements, plan, findings)) {
        const Element& element = elements[opening.element];
        if (element.record.keyword() != keyword) continue;
        const Segment2 wall = plan.lines[opening.line];
        const Vec2 along = 1 / distance(wall.a, wall.b) * (wall.b - wall.a);
        doors.push_back({element.id,
                         {wall.a + opening.from * along, wall.a + opening.to * along},
                         plan.walls[opening.line].thickness});
    }
    return doors;
}

std::string doorList(const Environment& environment, std::string_view prefix) {
    std::vector<std::string> doors;
    for (const Doorway& door : doorwaysOf(environment))
        doors.push_back(std::string(prefix) + door.id + " (" +
                        formatFixed(distance(door.line.a, door.line.b), 2) + " m)");
    return listed(doors);
}

std::vector<Doorway> doorsNamed(const std::string& glob, std::string_view text,
                                const Environment& environment) {
    std::vector<Doorway> doors = doorwaysOf(environment);
    std::vector<std::string> known;
    known.reserve(doors.size());
    for (const Doorway& door : doors) known.push_back(door.id);
    const Glob wanted(glob);
    std::erase_if(doors, [&](const Doorway& door) { return !wanted.matches(door.id); });
    if (!doors.empty()) return doors;
    throw UsageError(known.empty()
                         ? "the room has no doors, which " + excerpt(text) + " is about"
                         : "the room has no door " + excerpt(glob) + didYouMean(glob, known) +
                               "; its doors: " + doorList(environment));
}

Polygon floorAround(const Doorway& door, double distance_from_it) {
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

namespace {

/// \throws UsageError
std::pair<std::string, double> parsedDoors(std::string_view text) {
    constexpr double kMaxDistance = 100;
    const KeySpec key{.name = "distance",
                      .type = KeyType::Number,
                      .unit = Unit::Length,
                      .help = "",
                      .lower = 0.001,
                      .upper = kMaxDistance};
    const std::string_view words = text.substr(kDoorPrefix.size());
    const std::size_t comma = words.rfind(',');
    if (words.empty() || comma == 0)
        throw UsageError(excerpt(text) + " is no zone: wanted door:GLOB[,M], such as door:*,0.8");
    if (comma == std::string_view::npos) return {std::string(words), kFromDoor};
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
    std::vector<DoorZone> zones;
    const DoorFloor floor(environment);
    for (const Doorway& door : doorsNamed(glob, text, environment))
        zones.push_back(
            {door.id,
             {std::string(kDoorPrefix) + door.id + ',' + formatDouble(metres),
              floor.around(door, metres), door.line.a + 0.5 * (door.line.b - door.line.a), false}});
    return zones;
}

}  // namespace

std::string_view withoutAllRooms(std::string_view text) {
    constexpr std::string_view kAll = "*/";
    return text.starts_with(kAll) ? text.substr(kAll.size()) : text;
}

std::vector<NamedZone> readZones(std::string_view text, const Environment& environment) {
    text = withoutAllRooms(text);
    std::vector<NamedZone> zones;
    if (!text.starts_with(kDoorPrefix)) {
        const Glob glob(text);
        if (glob.isPattern() && zoneRecord(text, environment) == nullptr)
            for (const Element& element : environment.elements())
                if (element.record.keyword() == "zone" && glob.matches(element.id))
                    zones.push_back(namedZone(element.id, zoneOutline(element.record)));
        if (zones.empty()) zones.push_back(readZone(text, environment));
        return zones;
    }
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
    for (const std::string& whole : texts) {
        const std::string_view text = withoutAllRooms(whole);
        if (!text.starts_with(kDoorPrefix)) {
            for (const NamedZone& zone : readZones(text, environment))
                if (!ids.contains(zone.name)) add(zone.outline, "");
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
