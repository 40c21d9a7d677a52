// SPDX-License-Identifier: GPL-3.0-or-later
// The rooms that the lines of a plan enclose: faces of their arrangement, joined where doors are.
//
//     const PlanRooms rooms = chooseRooms({.lines = walls, .doors = doors}, options, work, out);
//     writeRooms(rooms, options, out);
//
// Areas and faces are those of geom/arrangement.h: exact up to rounding to doubles, after welding
// within kWeldDistance.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/budget.h"
#include "geom/arrangement.h"
#include "geom/planar_map.h"
#include "geom/polygon.h"
#include "io/import_records.h"
#include "io/plan/plan_lines.h"

namespace ispace {

/// A point of a region is on a line at this distance: both were welded, which moves each.
constexpr double kOnLine = 3 * kWeldDistance;

/// The imported part of a plan: one face of its lines, or several that doors join.
struct PlanRegion {
    std::vector<Region> rooms;  ///< the largest first
    Point2 inside;              ///< a point of the first, clear of its walls

    [[nodiscard]] double area() const;
};

/// The faces of a plan's lines, grouped where doors join them.
class PlanFaces {
  public:
    /// Welded pieces of walls, and of closings where no wall lies on them, in the order of the
    /// closings.
    struct Pieces {
        std::vector<Segment2> walls, closings;
        std::vector<std::size_t> closing_of;  ///< index of the closing that a piece comes from
    };
    static Pieces weldedPieces(std::span<const Segment2> walls, std::span<const Segment2> closings,
                               Budget& work);

    /// Faces joined by doors: indices of faces(), the largest first.
    struct Group {
        std::vector<std::size_t> faces;
        double area = 0;
    };

    /// \param doors lines that can be crossed: among the walls, or on them
    /// \param closings lines across gaps between walls; they bound only faces that they separate
    /// from the outside
    /// \param work pays for closings; outlives this object
    PlanFaces(std::span<const Segment2> walls, Budget& work, std::span<const Segment2> doors = {},
              std::span<const Segment2> closings = {});
    /// Builds the faces from welded pieces, with the first `closing_pieces` of the closings.
    PlanFaces(const Pieces& pieces, Budget& work, std::span<const Segment2> doors,
              std::size_t closing_pieces);

    [[nodiscard]] const std::vector<Region>& faces() const { return faces_; }
    /// Returns the groups by falling area.
    [[nodiscard]] const std::vector<Group>& groups() const { return groups_; }
    /// Finds the group that holds the point strictly inside one of its faces.
    [[nodiscard]] const Group* groupAt(Point2 p) const;
    /// Returns true if all its faces are at most as wide as a wall: the space between the two lines
    /// of a wall.
    [[nodiscard]] bool isHollow(const Group& group) const;
    /// Returns corners of the solid between the two lines of a wall, as seen from the floor.
    [[nodiscard]] std::vector<Point2> wallCorners() const;
    [[nodiscard]] PlanRegion region(const Group& group) const;
    /// Returns the part of the region's boundary that lies on closings alone.
    [[nodiscard]] std::vector<Segment2> closedBy(const PlanRegion& region) const;

  private:
    void takeFaces(std::span<const Segment2> doors);
    void makeGroups(std::span<const Segment2> doors);
    [[nodiscard]] std::optional<std::size_t> faceAt(Point2 p) const;

    Budget* work_;
    std::vector<Segment2> walls_;
    std::vector<Segment2> closings_;  // pieces of them that lie on no wall
    std::vector<Region> faces_;
    std::vector<Box2> boxes_;
    std::vector<Group> groups_;
    double widest_wall_ = 0;
};

/// Returns the diameter of the largest disc between the two lines of a wall in a plan of this
/// extent: 0.5 m, or a twelfth of the extent, whatever its scale.
double widestWall(double extent);

/// Returns true for a face between the two lines of a wall: no disc wider than `widest` fits.
bool isNarrow(const Region& face, double widest);

/// Finds a point of the face away from its edges and from lines within it.
Point2 clearPoint(const Region& face, std::span<const Segment2> lines);

/// Computes whether each line bounds a room of the regions, or lies in one with its middle or an
/// end.
std::vector<bool> belongsTo(std::span<const PlanRegion> regions, std::span<const Segment2> lines);

/// Returns true if the lines cross so often that finding their faces would take hours, which no
/// real plan reaches.
/// \param crossings of the lines, as sampledCrossings() estimates them
bool crossTooOften(std::span<const Segment2> lines, double crossings);
inline bool crossTooOften(std::span<const Segment2> lines) {
    return crossTooOften(lines, sampledCrossings(lines));
}

/// Takes units of work for crossings beyond two a line, as walls meet others at both ends.
/// \param rooms All: a room that each of them makes costs, too
/// \return false if fewer are left
bool payForCrossings(double crossings, std::size_t lines, RoomChoice rooms, Budget& budget);

/// Computes the floor that a disc sweeps when it moves from `start` without crossing a wall, as
/// pieces of `rooms` with rounded corners; the radius is met within 1 %. Empty if the disc does not
/// fit at `start`. \param walls lines that the disc must not cross, among them the rooms'
/// boundaries, without doors
std::vector<Region> reachedFloor(std::span<const Region> rooms, std::span<const Segment2> walls,
                                 Point2 start, double radius);

/// Returns the outlines of pieces of reachedFloor(), open where doors join two of them. A wall
/// without thickness between two pieces is on both outlines.
std::vector<PlanPath> reachedOutlines(std::span<const Region> pieces,
                                      std::span<const Segment2> doors, Budget& work);

/// Returns the lines without the parts that passages cover, as doors cover walls.
/// \param reach distance of a passage from the lines that it covers
std::vector<Segment2> withoutPassages(std::span<const Segment2> lines,
                                      std::span<const Segment2> passages, Budget& work,
                                      double reach = kOnLine);

/// A plan of lines before its rooms are chosen.
struct PlanWalls {
    std::vector<Segment2> lines;  ///< of walls, with those that close the gaps of doors and windows
    std::vector<Segment2> doors;  ///< between rooms: among the lines, or on them
    std::optional<Point2> home;   ///< a point in the room that the plan names
    /// Returns false for an enclosed point that is not floor, as in a hole; may be empty.
    std::function<bool(Point2)> is_floor = {};
    /// Returns advice for a plan of an unlikely extent; may be empty.
    std::function<std::string()> unit_hint = {};
    bool is_drawing = false;  ///< the frame of a sheet may surround it
};

/// The imported rooms of a plan.
struct PlanRooms {
    std::vector<PlanRegion> regions;  ///< empty: no room is enclosed
    std::vector<Segment2> closing;    ///< lines that close gaps in their walls
    std::vector<PlanPath> reached;    ///< reachedOutlines() of a disc, if requested
    bool writes_inside = true;        ///< false: another input has the inside points
    bool is_frame = false;            ///< the room is a rectangle around the whole drawing

    [[nodiscard]] double area() const;
};

/// Chooses the rooms to keep (ImportOptions::inside, rooms), closing gaps where needed.
///
/// A room is a face of the lines, or several that doors join, into which a disc of 0.5 m fits:
/// thinner ones lie between the two lines of a wall. With points (ImportOptions::inside,
/// known_inside) the rooms that hold them are kept; without, the one with PlanWalls::home, else the
/// largest, or all.
///
/// With ImportOptions::close_gaps, gaps up to that width between loose ends of walls, and between
/// corners of walls drawn as two lines, are closed if they separate a room from the outside.
/// Without it they are closed as needed: up to 0.2 m if that encloses twice as much, or the home,
/// and up to 2.5 m if narrower gaps enclose no room; the smallest width tried wins that encloses
/// half of the best. Points choose among the rooms that are enclosed without them; only if one lies
/// outside all of these, gaps are closed for its sake. Warnings report closed gaps, rooms that are
/// small in their drawing, and drawings of less than 2 m or more than 2 km.
PlanRooms chooseRooms(const PlanWalls& plan, const ImportOptions& options, Budget& work,
                      ImportRecords& out);

/// Writes lines that close gaps as fences, and the inside points; with PlanRooms::reached only its
/// outlines, and the importer writes no walls.
void writeRooms(const PlanRooms& rooms, const ImportOptions& options, ImportRecords& out);

}  // namespace ispace
