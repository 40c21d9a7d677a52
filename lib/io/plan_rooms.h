// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "geom/polygon.h"
#include "io/import_records.h"

namespace ispace {

/// The part of a plan that is imported: one face of its lines, or several that doors join.
struct PlanRegion {
    std::vector<Region> rooms;  ///< the largest first
    Point2 inside;              ///< a point of the first, clear of its walls

    [[nodiscard]] double area() const;
};

/// The faces of a plan's lines, those that doors join taken together.
class PlanFaces {
  public:
    /// Welded pieces: of walls, and of closings where no wall lies on them, in the order of these.
    struct Pieces {
        std::vector<Segment2> walls, closings;
        std::vector<std::size_t> closing_of;  ///< index of the closing that a piece comes from
    };
    static Pieces weldedPieces(std::span<const Segment2> walls, std::span<const Segment2> closings);

    /// Faces that hang together: indices of faces(), the largest first.
    struct Group {
        std::vector<std::size_t> faces;
        double area = 0;
    };

    /// \param doors lines across which one can pass: among the walls, or on them
    /// \param closings lines across gaps between walls: they bound what they separate from the
    ///        outside of everything, and nothing else
    explicit PlanFaces(std::span<const Segment2> walls, std::span<const Segment2> doors = {},
                       std::span<const Segment2> closings = {});
    /// The same of pieces, with the first so many pieces of closings.
    PlanFaces(const Pieces& pieces, std::span<const Segment2> doors, std::size_t closing_pieces);

    [[nodiscard]] const std::vector<Region>& faces() const { return faces_; }
    /// By falling area.
    [[nodiscard]] const std::vector<Group>& groups() const { return groups_; }
    /// The group that holds the point strictly inside one of its faces.
    [[nodiscard]] const Group* groupAt(Point2 p) const;
    /// True if nothing wider than a wall fits into any of its faces: what lies between the two
    /// lines of a wall, and never a room.
    [[nodiscard]] bool isHollow(const Group& group) const;
    /// Corners of the solid between the two lines of a wall, as seen from the floor.
    [[nodiscard]] std::vector<Point2> wallCorners() const;
    [[nodiscard]] PlanRegion region(const Group& group) const;
    /// The part of the region's boundary that lies on closings alone.
    [[nodiscard]] std::vector<Segment2> closedBy(const PlanRegion& region) const;

  private:
    void takeFaces(std::span<const Segment2> doors);
    void makeGroups(std::span<const Segment2> doors);
    [[nodiscard]] std::optional<std::size_t> faceAt(Point2 p) const;

    std::vector<Segment2> walls_;
    std::vector<Segment2> closings_;  // pieces of them that lie on no wall
    std::vector<Region> faces_;
    std::vector<Box2> boxes_;
    std::vector<Group> groups_;
    double thinnest_ = 0;  // radius of the disc that fits into a room
};

/// For each line, whether it bounds one of the regions' rooms or lies in it, with its middle or an
/// end.
std::vector<bool> belongsTo(std::span<const PlanRegion> regions, std::span<const Segment2> lines);

/// True if the lines cross each other so often that their faces would take hours: no plan does.
/// An estimate from a sample, the same one at every call.
bool crossTooOften(std::span<const Segment2> lines);

/// The floor that a disc covers which moves from `start` without crossing a wall: the pieces of
/// `rooms` that it sweeps. Corners of rooms are rounded accordingly; the radius is met
/// up to 1 %. Empty where the disc does not fit at `start`.
/// \param walls what the disc must not cross, among them the rooms' boundaries; doors left out
std::vector<Region> reachedFloor(std::span<const Region> rooms, std::span<const Segment2> walls,
                                 Point2 start, double radius);

/// The lines without the parts on which a passage lies, as doors lie on walls.
std::vector<Segment2> withoutPassages(std::span<const Segment2> lines,
                                      std::span<const Segment2> passages);

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
