// SPDX-License-Identifier: GPL-3.0-or-later
// A DXF file as entities, in its own units and without expanding blocks. Source: Autodesk, DXF
// Reference (AutoCAD 2012 and later); entities of blocks keep the coordinates of the block.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "extensions/cad/curves.h"
#include "geom/point.h"
#include "io/plan/line_plan.h"
#include "io/unread.h"

namespace ispace::cad {

/// Straight pieces and arcs; a LINE has two vertices.
struct DxfPolyline {
    struct Vertex {
        Point2 at;
        double bulge = 0;  ///< of the piece that begins here: tan(sweep / 4), left-turning above 0
    };
    std::vector<Vertex> vertices;
    bool closed = false;
    double width = 0;  ///< of the line as drawn
};

/// An arc counter-clockwise from one angle to the other; a whole circle from 0 to 360 degrees.
struct DxfArc {
    Point2 center;
    double radius = 0;
    Angle from, to;
};

/// An ellipse's arc: center + cos(t) major + sin(t) minor, t in radians.
struct DxfEllipse {
    Point2 center;
    Vec2 major, minor;
    double from = 0, to = 0;
};

/// A spline by its control points; its numbers are sound, see splineFault().
using DxfSpline = SplineCurve;

/// An inserted block, perhaps repeated in a grid.
struct DxfInsert {
    std::string block;
    Point2 at;
    double scale_x = 1, scale_y = 1;
    Angle turn;
    int columns = 1, rows = 1;
    double column_step = 0, row_step = 0;
};

/// The boundary of a hatch: rings that its pattern fills by the even-odd rule.
struct DxfHatch {
    std::vector<DxfPolyline> rings;
    bool is_solid = false;  ///< filled with a colour, not with a pattern
};

using DxfShape = std::variant<DxfPolyline, DxfArc, DxfEllipse, DxfSpline, DxfInsert, DxfHatch>;

struct DxfEntity {
    DxfShape shape;
    std::string layer;
    bool mirrored = false;   ///< seen from below: x is mirrored
    int line = 0;            ///< of the file
    bool is_dashed = false;  ///< its type of line has gaps
};

struct DxfBlock {
    Point2 base;
    std::vector<DxfEntity> entities;
    bool is_external = false;              ///< an external reference
    std::vector<UnreadThing> unread = {};  ///< of each insert; extents in the block's coordinates
};

/// A DXF file, in its own units.
struct DxfDrawing {
    int units = 0;                        ///< $INSUNITS; 0: unitless
    std::set<std::string> layers;         ///< in its table
    std::set<std::string> hidden_layers;  ///< off, frozen, or never plotted
    std::map<std::string, DxfBlock> blocks;
    std::vector<DxfEntity> entities;
    std::map<std::string, std::size_t> left_out;  ///< entities, by type or reason
    std::vector<UnreadThing> unread;  ///< of these, those that may be walls; extents in its units
    std::map<int, DrawnSize> sizes;   ///< of polylines and circles that have any, by their lines
};

/// Returns true for a drawing with the layers on which writeDxf() draws a room, see
/// dxfRoomLayers().
bool isDrawnRoom(const DxfDrawing& drawing);

/// Returns the inside points of such a drawing in the plan's frame: centres of circles on `inside`.
/// \param frame from the drawing to the plan, in metres
std::vector<Point2> drawnInside(const DxfDrawing& drawing, const Affine& frame);

/// Adds the shapes on other layers of such a drawing than those of walls and openings: of `objects`
/// that have a height rectangles as cubes, circles and ellipses as cylinders, others as cubes
/// around them, with a note; `zones`, and rectangles of `floors`. \param sizes in metres
/// \param frame as above, without a turn
void addDrawnThings(const DxfDrawing& drawing, const std::map<int, DrawnSize>& sizes,
                    const Affine& frame, ImportRecords& out);

/// Moves straight walls off the floor, which bound no room, from `walls` to records.
void addRaisedWalls(std::vector<PlanPath>& walls, const std::map<int, DrawnSize>& sizes,
                    ImportRecords& out);

/// Reads ASCII DXF. Ignores counts in the file, and parses only the numbers it needs.
/// \throws FormatError with its line: no group code, a malformed number, a missing coordinate, an
/// end before `EOF`
DxfDrawing readDrawing(std::string_view bytes, const std::string& name);

}  // namespace ispace::cad
