// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "env/environment.h"
#include "record/record.h"

namespace ispace {

/// Part of the floor that somebody names: the id of a `zone` record, `rect:X,Y,X,Y` (two opposite
/// corners), or `poly:X,Y;X,Y;...` (thesis section 4.4.6); lengths with units as in records.
struct NamedZone {
    std::string name;  ///< as written
    Polygon outline;   ///< counter-clockwise
    /// A point inside by which the Insider Judge knows the inside from the outside: the centre of
    /// gravity, or, where that does not lie strictly inside, another one.
    Point2 inside;
    bool is_center_outside = false;  ///< the thesis' warning
};

/// A record's id goes before what it may read like else.
/// \throws UsageError for an unknown zone (with the nearest name), a polygon of fewer than three
///         corners, without area, or that crosses itself
NamedZone readZone(std::string_view text, const Environment& environment);

/// All zones that a text means: `door:GLOB,M` is one for each door whose id matches the glob, the
/// floor within M of its opening, straight through walls; every other text is one, as readZone()
/// reads it. Rounded ends are 16 chords to a quarter. \throws UsageError as readZone(), for a
/// bad distance, and if no door matches
std::vector<NamedZone> readZones(std::string_view text, const Environment& environment);

/// Records of these zones, but for zones that are records already: those at doors have the id
/// DOOR-zone, or DOOR-zone-2 and so on. \throws UsageError as readZones()
std::vector<Record> zoneRecords(std::span<const std::string> texts, const Environment& environment,
                                const Schemas& schemas);

}  // namespace ispace
