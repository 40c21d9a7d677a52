// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "io/import_records.h"
#include "io/plan_region.h"

namespace ispace {

/// A plan of lines before its rooms are chosen.
struct PlanWalls {
    std::vector<Segment2> lines;  ///< of walls, with what closes the gaps of doors and windows
    std::vector<Segment2> doors;  ///< across which rooms hang together: among the lines, or on them
    std::optional<Point2> home;   ///< a place that the plan itself has in the room
    /// False for a point of what is no floor though it is enclosed, as a hole; may be empty.
    std::function<bool(Point2)> is_floor = {};
    /// What helps where a plan of this extent (metres) cannot be one; may be empty.
    std::function<std::string(double)> unit_hint = {};
};

/// What is imported of a plan.
struct PlanRooms {
    std::vector<PlanRegion> regions;  ///< empty: nothing is enclosed
    std::vector<Segment2> closing;    ///< lines that close gaps in their walls
    std::vector<Region> reached;      ///< floor that a disc reaches, if that was asked for
    bool writes_inside = true;        ///< false: inside points come from elsewhere

    [[nodiscard]] double area() const;
};

/// Chooses the rooms that are meant (ImportOptions::inside, rooms) and closes gaps for that.
///
/// A room is a face of the lines, or several that doors join, into which a disc of 0.5 m fits:
/// what is thinner is the hollow of a wall drawn as two lines. With points (ImportOptions::inside,
/// known_inside) the rooms that hold them are meant; without, the one with PlanWalls::home, else
/// the largest, or all.
///
/// With ImportOptions::close_gaps, gaps up to that width between loose ends of walls, and between
/// corners of walls drawn as two lines, are closed where they part a room from the outside of all.
/// Without it they are closed where the plan needs it: up to 0.2 m if that encloses twice as much
/// or the home, up to 2.5 m if nothing is enclosed else; of the widths tried the smallest is taken
/// that comes to half of the best. What is closed is told as a warning, and so is a room that is
/// small against the drawing, and a drawing of less than 2 m or more than 2 km.
PlanRooms chooseRooms(const PlanWalls& plan, const ImportOptions& options, ImportRecords& out);

/// Adds the lines that close gaps as fences, and the inside points. Where only what a disc reaches
/// is kept, its outlines: then the importer writes no walls of its own.
void writeRooms(const PlanRooms& rooms, const ImportOptions& options, ImportRecords& out);

}  // namespace ispace
