// SPDX-License-Identifier: GPL-3.0-or-later
// What an importer says of the rooms that it kept: private to plan_rooms.cc.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "io/plan/plan_rooms.h"

namespace ispace {

/// A room below this share of the drawing's extent, or of the largest enclosable area, is
/// uncertain.
constexpr double kSmallShare = 0.5;

/// Metres from the edge of the plan at which a room touches it.
constexpr double kAtBorder = 1e-3;

/// The rooms after closing gaps up to a width.
struct RoomAttempt {
    double width;
    std::size_t closings;  ///< lines that close gaps
    PlanFaces faces;
    std::vector<const PlanFaces::Group*> groups = {};
    double area = 0;
    bool is_whole = false;  ///< every requested point is in a room
};

/// Returns true if a group of faces is floor, and no space between the two lines of a wall.
bool isRoom(const PlanWalls& plan, const PlanFaces& faces, const PlanFaces::Group& group);

/// Warns if a room is a rectangle around the drawing with large parts of it inside, or any single
/// line around a house of thick walls. \return true if so \param lines of the plan and of other
/// inputs \param region the only one kept
bool warnOfFrame(const PlanWalls& plan, std::span<const Segment2> lines, const RoomAttempt& taken,
                 const PlanRegion& region, Budget& work, ImportRecords& out);

/// Warns of many small faces, as of tiles, that take floor from the rooms.
void warnOfTiles(const RoomAttempt& taken, ImportRecords& out);

/// Warns if most of the drawing is left out. \param kept bounds of the rooms kept
void warnOfTheRest(const PlanWalls& plan, const RoomAttempt& taken, const Box2& kept,
                   ImportRecords& out);

/// Lists the widest gaps that were closed. \param width that of the widest allowed
void warnOfGaps(std::span<const Segment2> closing, double width, ImportRecords& out);

}  // namespace ispace
