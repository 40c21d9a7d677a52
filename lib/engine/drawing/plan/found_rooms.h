// SPDX-License-Identifier: GPL-3.0-or-later
// The rooms that an import has found, as a table and as marks on its plan: users choose among them
// by --inside with a point of the room.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// A room that an import found, kept or not.
struct FoundRoom {
    double area = 0;              ///< square metres, including rooms joined by doors
    Point2 inside;                ///< `--inside` with this point, and the storey, selects it
    std::string storey = {};      ///< as `--storey` takes it; "": the input has no storeys
    bool touches_border = false;  ///< reaches the edge of the map, or of all walls of the plan
    bool is_kept = false;
    std::vector<Region> floor = {};  ///< its outlines; empty: it is listed, but not drawn
};

/// The rooms of a plan, map or building, and the gaps that were closed around kept rooms.
struct FoundRooms {
    std::vector<FoundRoom> rooms;
    std::vector<Segment2> closed_gaps;
    bool any_plan = false;     ///< an importer of plans ran
    bool all_storeys = false;  ///< requests rooms of other storeys, too, without their floor
    /// Maximum number of rooms that importers return besides kept rooms; the largest ones.
    static constexpr std::size_t kMaxRooms = 200;
};

/// Formats a table for people, sorted by storey and falling area: area, --inside point, storey (if
/// there are storeys), whether the room touches the border, and whether it is kept.
std::string roomsText(const FoundRooms& found);
/// Writes the same as JSON, schema ispace-rooms/1.
std::string roomsJson(const FoundRooms& found);

/// Rounds `p` for an option to as few decimals as keep it clear of the region's edges, two if
/// possible.
/// \pre p lies inside
Point2 shortPointIn(const Region& region, Point2 p);

}  // namespace ispace
