// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// A room that an import found, whether it is kept or not.
struct FoundRoom {
    double area = 0;              ///< square metres, with the rooms that doors join to it
    Point2 inside;                ///< `--inside` with this point, and the storey, chooses it
    std::string storey = {};      ///< as `--storey` takes it; "": the input has none
    bool touches_border = false;  ///< reaches the edge of the map, or of all walls of the plan
    bool is_kept = false;
    std::vector<Region> floor = {};  ///< its outlines; empty: it is listed, but not drawn
};

/// The rooms of a plan, map or building, and the gaps that were closed around those kept.
struct FoundRooms {
    std::vector<FoundRoom> rooms;
    std::vector<Segment2> closed_gaps;
    bool any_plan = false;     ///< an importer of plans ran
    bool all_storeys = false;  ///< wanted are those of other storeys, too, without their floor
    /// Importers hand over no more rooms than this, the largest ones, besides those kept.
    static constexpr std::size_t kMost = 200;
};

/// A table for people, by storeys in their order and falling area: area, --inside point, storey
/// (where there are any), whether the room touches the border, and whether it is kept.
std::string roomsText(const FoundRooms& found);
/// The same as JSON, schema ispace-rooms/1.
std::string roomsJson(const FoundRooms& found);

/// `p` with as few decimals as keep it clear of the region's edges, two if possible, for an option.
/// \pre p lies inside
Point2 shortPointIn(const Region& region, Point2 p);

}  // namespace ispace
