// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of the floor that options name: zones of records, rectangles, polygons, floor at doors.
// Errors name the nearest known zone.
//
//     const NamedZone zone = readZone("rect:0,0,2,150cm", environment);
//     const std::vector<NamedZone> at_doors = readZones("door:front*,1m", environment);
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "env/environment.h"
#include "record/record.h"

namespace ispace {

/// Part of the floor, named by the id of a `zone` record, `rect:X,Y,X,Y` (two opposite corners), or
/// `poly:X,Y;X,Y;...` (thesis section 4.4.6); lengths with units as in records.
struct NamedZone {
    std::string name;  ///< as written
    Polygon outline;   ///< counter-clockwise
    /// The Insider Judge's known inside point: the centre of gravity, or another point if that is
    /// not strictly inside.
    Point2 inside;
    bool is_center_outside = false;  ///< the thesis' warning
};

/// Reads one zone; the id of a record takes precedence over the other forms.
/// \throws UsageError for an unknown zone (with the nearest name), a polygon of fewer than three
///         corners, without area, or that crosses itself
NamedZone readZone(std::string_view text, const Environment& environment);
/// Returns the zone of an outline. \throws UsageError as readZone()
NamedZone namedZone(std::string_view text, Polygon outline);
/// Returns ", did you mean `*bath*`?" for a pattern with capitals that matches one of these names
/// in lower case; else "".
std::string inLowerCase(std::string_view pattern, std::span<const std::string> names);
/// Returns "the room has no zone `x`, did you mean …; its zones: a, b".
std::string unknownZoneText(std::string_view text, const Environment& environment);

/// Returns a text about zones without the `*/` that begins it for all rooms of a site, of which a
/// room alone is the only one.
std::string_view withoutAllRooms(std::string_view text);

/// Reads all zones of a text: `door:GLOB[,M]` means one zone for each door with a matching id: the
/// floor within M of its opening, up to walls, see DoorFloor. A glob means the records `zone` that
/// it matches. Any other text is one zone, as of readZone(). Rounded ends have 16 chords per
/// quarter circle. \throws UsageError as readZone(), for a bad distance, and if no door or zone
/// matches
std::vector<NamedZone> readZones(std::string_view text, const Environment& environment);

/// The id of a door or window, and the rectangle of its opening in the floor.
struct Doorway {
    std::string id;
    Segment2 line;
    double thickness = 0;
};
/// Returns the doors, or the openings of another keyword (`window`), in the order of their records.
std::vector<Doorway> doorwaysOf(const Environment& environment, std::string_view keyword = "door");
/// Begins a zone of doors.
constexpr std::string_view kDoorPrefix = "door:";
/// Metres of floor at doors, unless given.
constexpr double kFromDoor = 1.5;
/// Returns the doors whose ids match. \param text that is about them, for messages
/// \throws UsageError with doorList() if there are none
std::vector<Doorway> doorsNamed(const std::string& glob, std::string_view text,
                                const Environment& environment);
/// Returns the doors with their widths, up to twenty: "ground/front (0.90 m), ground/back (1.00
/// m)". \param prefix before each id
std::string doorList(const Environment& environment, std::string_view prefix = "");
/// Returns all points within the distance of the doorway, walls ignored, counter-clockwise and
/// convex.
Polygon floorAround(const Doorway& door, double distance);

/// Returns records for these zones, skipping zones that are records already; those at doors have
/// the id DOOR-zone, or DOOR-zone-2 and so on. \throws UsageError as readZones()
std::vector<Record> zoneRecords(std::span<const std::string> texts, const Environment& environment,
                                const Schemas& schemas);

}  // namespace ispace
