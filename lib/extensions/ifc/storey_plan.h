// SPDX-License-Identifier: GPL-3.0-or-later
// The plan of one storey: walls as areas, and the openings in them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "base/budget.h"
#include "extensions/ifc/reader/building.h"
#include "geom/polygon.h"
#include "io/plan/plan_lines.h"

namespace ispace::ifc {

/// Computes the area of a section.
std::vector<Region> areaOf(const BuildingSection& section);

/// Walls of a storey, in the building's coordinates, on whole micrometres.
struct StoreyWalls {
    std::vector<Region> solids;      ///< walls that meet and are equally high are merged
    std::vector<double> solid_tops;  ///< of each; those behind the last are as high as most
    std::vector<Segment2> sheets;
    std::vector<double> sheet_tops;    ///< as solid_tops
    std::vector<BuildingBox> columns;  ///< that touch no wall
    std::vector<BuildingBox> raised;   ///< straight walls off the floor that touch no other wall
    double top = 0;                    ///< of most of them, by length

    [[nodiscard]] double topOf(std::size_t solid) const {
        return solid < solid_tops.size() ? solid_tops[solid] : top;
    }
    [[nodiscard]] double topOfSheet(std::size_t sheet) const {
        return sheet < sheet_tops.size() ? sheet_tops[sheet] : top;
    }
};

/// Returns the height of the next floor above a storey, at least 1.8 m higher; infinity if it is
/// the highest one.
double ceilingOf(const Building& building, std::size_t storey);

/// Joins the walls of a storey: corners within 2 mm of another wall move onto it. Lower walls than
/// most keep their height, but those of at least 2.2 m that are at most 0.6 m lower are as high as
/// most, since slabs and ceilings make these differences, and so are parts of walls. Higher walls,
/// such as gables, end with most: the room is not higher because of them.
/// \throws FormatError (without a file) as NearSegments
StoreyWalls wallsOf(const Building& building, std::size_t storey, Budget& work);

/// An opening in the walls.
struct StoreyOpening {
    std::size_t opening = 0;           ///< index in Building::openings
    Segment2 line;                     ///< in a face of the wall, or across a gap in the walls
    std::optional<std::size_t> curve;  ///< index of the face's curve, see WallFaces; empty: a gap
    double depth = 0;                  ///< from this face to the farthest it goes through, metres
    std::vector<Segment2> others;      ///< the parts of the other faces that it removes
    [[nodiscard]] std::vector<Segment2> reveals() const;
};

/// Subtracts holes from the walls where their faces are not straight.
void carve(StoreyWalls& walls, std::span<const BuildingBox> holes);

/// Merges further pieces into the walls.
void addPieces(StoreyWalls& walls, std::span<const Polygon> pieces);

/// Returns the parts of an area that no wall covers, the largest first.
/// \throws FormatError (without a file) if the corners of all exceed the work that is left
std::vector<Region> floorOf(std::span<const Region> area, const StoreyWalls& walls, Budget& work);

/// Finds the faces of walls that openings go through.
class WallFaces {
  public:
    /// Numbers outlines and holes of the solids, in order, as curves 0, 1, 2 ...
    WallFaces(const StoreyWalls& walls, Budget& work);

    /// Finds the position of a box in the walls: through their faces along one of its sides, else
    /// across a gap between ends of walls; a free-standing door or window is a wall itself. Returns
    /// std::nullopt otherwise, or for an opening below 0.3 m.
    /// \param is_hole the box is that of a hole, which goes through all faces in it; else that of a
    /// door or window itself, which takes the nearest faces within 0.5 m
    [[nodiscard]] std::optional<StoreyOpening> find(const BuildingBox& box, bool is_hole) const;

    /// Returns the part of a wall that is missing at a box: from the end of the wall on one side of
    /// the box to that on the other, as thick as both, and a little into them. std::nullopt if
    /// there is a wall, or no end of one within 0.4 m of a side.
    /// \param from_one_end without an end on the other side the box itself ends the part, as of
    /// one window in a row of them
    [[nodiscard]] std::optional<Polygon> missingWall(const BuildingBox& box,
                                                     bool from_one_end) const;

  private:
    struct Face {
        Segment2 line;  ///< with the wall on its left
        std::size_t curve;
    };
    /// A face beside a box, in the frame of the box.
    struct Beside {
        const Face* face;
        double from, to, aside;
        bool is_lower;  ///< the wall lies to the left of the box's length
    };
    [[nodiscard]] std::vector<Beside> facesBeside(const BuildingBox& box, double reach) const;
    [[nodiscard]] std::optional<StoreyOpening> through(const BuildingBox& box, bool is_hole) const;
    [[nodiscard]] std::optional<StoreyOpening> across(const BuildingBox& box) const;
    /// The end of a wall beside a box, in the frame of the box.
    struct Jamb {
        double at = 0, slope = 0;  ///< x = at + slope * y
        double low = 0, high = 0;  ///< of y
    };
    [[nodiscard]] std::optional<Jamb> jambBeside(const BuildingBox& box, double side) const;
    [[nodiscard]] bool isInWall(Point2 p) const;

    const StoreyWalls& walls_;
    std::vector<Face> faces_;
    NearSegments search_;
};

}  // namespace ispace::ifc
