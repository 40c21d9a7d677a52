// SPDX-License-Identifier: GPL-3.0-or-later
// The one rule for parts of a file that an importer cannot read but that may be walls: those as
// large as walls, in or beside the rooms that are kept, are reported in a warning, so that a check
// fails, whatever else encloses a room.
//
//     std::vector<UnreadThing> unread;
//     unread.push_back({.kind = "3DSOLID", .layer = "A-WALL", .line = 812, .extent = box});
//     warnOfUnread(unread, rooms, "explode them to lines first", out);
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geom/point.h"
#include "geom/spatial_index.h"
#include "io/import_records.h"
#include "io/plan/plan_rooms.h"

namespace ispace {

/// An entity, element or shape that was not read and may be a wall. Importers omit those on layers
/// and in storeys that are not used.
struct UnreadThing {
    std::string kind;               ///< as the file names it: 3DSOLID
    std::string layer = {};         ///< "": none
    std::optional<Point2> at = {};  ///< in the file's coordinates and units
    int line = 0;                   ///< of the file
    std::string owner = {};         ///< around it: "the block desk"; "": the file itself
    Box2 extent = {};               ///< in the frame of the rooms, in metres; empty: unknown
};

/// Tells which things may be walls of the kept rooms. O(n log n) to build, O(log n) a thing apart
/// from edges above and below it.
class RoomVicinity {
  public:
    /// \param rooms none: any place counts
    explicit RoomVicinity(std::span<const PlanRegion> rooms);

    /// Returns true for a thing that may be a wall of these rooms: its size is unknown or at least
    /// half a metre, and its place unknown or at most half a metre off.
    [[nodiscard]] bool mayHaveWall(const UnreadThing& thing) const;

  private:
    /// Returns true for a point strictly within a room, away from edges.
    [[nodiscard]] bool isInside(Point2 p) const;

    std::vector<Segment2> edges_;
    Box2 box_;
    BoxTree tree_;
};

/// Adds one warning for all things that may be walls of the rooms: kinds with their counts, the
/// first place of each kind, and `advice`.
/// \param advice for the user, as "explode them to lines first"
void warnOfUnread(std::span<const UnreadThing> things, std::span<const PlanRegion> rooms,
                  const std::string& advice, ImportRecords& out);

}  // namespace ispace
