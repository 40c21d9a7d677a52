// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/io/plan: plans drawn as lines on layers, from DXF, SVG and cut meshes.
//
// A reader of a format turns its entities into PlanShapes in metres; the rest is common: layers are
// sorted by name, doors and windows found from their symbols, lines joined, rooms chosen, and walls
// of the kept rooms written as fences. Coordinates are whole micrometres, so that records are short
// and equal ends are equal bytes. Work is bounded by a Budget: hatching and terrain read as walls
// are refused by FormatError, with the option that leaves layers out.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/import_records.h"
#include "io/importers.h"
#include "io/plan/drawing_source.h"
#include "io/plan/plan_lines.h"

namespace ispace {

/// The line between the ends of a straight piece or an arc; an arc also has its centre, the hinge
/// of a door.
struct PlanChord {
    Segment2 line;
    std::optional<Point2> center;
};

/// An entity of a drawing in the plan's frame, in metres.
struct PlanShape {
    PlanPath path;  ///< arcs as straight pieces within a millimetre (radii to 10 km)
    std::vector<PlanChord> chords;
    std::string layer;
    bool is_guess = false;  ///< a door found among walls: its chord runs from the closed door to
                            ///< the end of the leaf
    std::string walls_in = {};  ///< the wall name around it, see isWallName(); "": unnamed
    bool is_dashed = false;     ///< a straight line with gaps
};

/// A door or a window of a drawing.
struct PlanOpening {
    Segment2 line;                    ///< ends on walls, or at ends of walls
    std::optional<std::size_t> wall;  ///< the wall piece it lies on; empty: it closes a gap
    bool is_window = false;
    int drawn_on = 0;  ///< line of the file
};

/// A shape on a layer of doors or windows without an opening near it.
struct LostSymbol {
    std::string layer;
    Point2 at;
    int drawn_on = 0;  ///< line of the file
};

/// The openings found.
struct PlanOpenings {
    std::vector<PlanOpening> openings;
    std::size_t unused = 0;         ///< lines without an opening
    std::vector<LostSymbol> lost;   ///< doors first
    std::vector<Segment2> lost_in;  ///< diagonals of the boxes around these
};

/// Measures of a line in a drawing besides its course, in metres, and the pane of a window.
struct DrawnSize {
    double width = 0;                        ///< of the line as drawn
    double bottom = 0, height = 0;           ///< elevation and thickness
    double depth = 0;                        ///< of an opening through its wall; 0: as the wall
    std::string glass = {};                  ///< of a window, as its record has it; "": clear
    bool is_open = false, is_blind = false;  ///< of a window
};

/// Sizes by lines of the file.
using DrawnSizes = std::map<int, DrawnSize>;

/// Finds the openings that symbols of doors and windows represent, doors first.
///
/// A straight piece is an opening if both of its ends are at walls (within 0.1 m): across a gap, or
/// along one wall. Of a symbol without such a piece, two opposite sides at most 0.6 m apart open
/// the walls between them. An arc is the swing of a leaf, hinged at its centre: the opening runs
/// from there to the end of the arc that is at a wall, and lines to the other end are the leaf; two
/// arcs that meet off the walls are a double door, from hinge to hinge. Openings are 0.4 m wide or
/// more; each is found once, and openings on a wall never overlap, unless their `sizes` are above
/// each other. Swings that are a guess open only from the hinge to the closed door; they are
/// skipped if both that and the leaf lie on walls, like the sides of a shower. If a drawing with
/// such swings marks the ends of three doors by short lines across their wall, two more of these,
/// 0.4 m to 1.3 m apart, are a doorway.
///
/// \param thickness of each wall, as drawn around its line: symbols end at its faces; empty: the
/// lines are faces
PlanOpenings findOpenings(std::span<const PlanShape> doors, std::span<const PlanShape> windows,
                          std::span<const Segment2> walls, Budget& work,
                          const DrawnSizes* sizes = nullptr,
                          std::span<const double> thickness = {});

/// Returns lines across walls of two lines at the ends of doors, where the lines run on behind the
/// symbol, and adds the openings of these doors that the other line lacks. So the space between the
/// lines of a wall is no floor but in the doorway.
/// \param thickness as of findOpenings()
std::vector<PlanPath> addJambs(std::vector<PlanOpening>& openings, std::span<const Segment2> walls,
                               std::span<const double> thickness, Budget& work);

/// Doors that a drawing shows among its walls.
struct DrawnDoors {
    std::vector<PlanShape> swings;  ///< one for each leaf
    std::vector<PlanPath> walls;    ///< without leaves and swings
};

/// Finds doors drawn as a leaf and its swing: a curve that bends one way, and a straight line of
/// 0.4 m to 1.5 m from the hinge to that curve. The curve's other end and its middle have the same
/// distance from the hinge (within 12 %), 5 to 110 degrees from the leaf; it need not be a circle
/// about the hinge. A leaf drawn as a closed outline counts as one. If lines lead to both ends of
/// the curve, the leaf is the one with a free end. O(n log n).
DrawnDoors takeDrawnDoors(std::vector<PlanPath> walls, Budget& work);

/// Sorts the shapes of a drawing into walls, doors and windows by their layers.
class LayerSorter {
  public:
    struct Sorted {
        std::vector<PlanPath> walls;
        std::vector<PlanShape> doors, windows;
        /// For a drawing of writeDxf() with correct walls, sizes by lines of the file:
        /// widths are the thickness of walls, and 0 for open doors. Walls are neither joined nor
        /// left out.
        std::optional<std::map<int, DrawnSize>> sizes = {};
    };

    /// \param hidden layers that are off or frozen
    LayerSorter(std::set<std::string> hidden, const ImportOptions& options)
        : hidden_(std::move(hidden)), options_(options) {}

    /// Returns true for layers of walls, doors and windows.
    [[nodiscard]] bool isUsed(const std::string& layer);
    /// Returns true if an option names such layers; blocks and groups so named count as layers.
    [[nodiscard]] bool isNamed(const std::string& name) const;
    [[nodiscard]] bool isHidden(const std::string& layer) const {
        return hidden_.count(layer) != 0;
    }
    /// Returns true for layers of walls.
    [[nodiscard]] bool mayBeWall(const std::string& layer);
    /// Layers that isThingName() close no room, and those that isDoorName() are doors, unless no
    /// other has a line. Dashed lines without a name of walls are axes, or edges above: they close
    /// no room either.
    Sorted sort(std::vector<PlanShape> shapes);
    /// Notes the use of each layer.
    void note(ImportRecords& out) const;
    /// Warns of globs of doors and windows without a line.
    void warnOfGlobs(ImportRecords& out) const;
    /// \param left_out entities, for the message
    /// \throws FormatError: no line on the layers of walls
    void mustHaveWalls(const Sorted& sorted, const std::string& name,
                       const std::map<std::string, std::size_t>& left_out) const;
    /// Returns names of walls, and of windows beside them, with their numbers of lines, if lines
    /// without a name became walls, too, because no option says otherwise.
    [[nodiscard]] std::map<std::string, std::size_t> unusedWallNames() const;

  private:
    enum Use : std::size_t { Walls, Doors, Windows, Others, Hidden, Things, kUses };
    Use useOf(const std::string& layer);
    [[nodiscard]] bool hasLines(const std::string& glob) const;
    /// Returns all layers with lines, for a message, those that are hidden behind the others.
    [[nodiscard]] std::string all() const;

    std::set<std::string> hidden_;
    const ImportOptions& options_;
    std::map<std::string, Use> uses_;
    std::array<std::map<std::string, std::size_t>, kUses> counts_;
    std::map<std::string, std::size_t> wall_names_;    // with their lines; "": lines without one
    std::map<std::string, std::size_t> window_names_;  // of these that became walls
    std::map<std::string, std::size_t> dashed_;        // lines that close no room, by layer
};

/// Writes the plan of sorted shapes, see readDxf: walls, doors and windows of the largest region.
/// For drawings, doors among the walls close no room, see takeDrawnDoors(); impossible scales of a
/// building are rejected, see checkScale(); and unused names of walls are reported.
/// \param drawing null for cuts through meshes
/// \return the room kept
/// \throws FormatError: no line on the layers of walls
PlanOutcome writeLinePlan(LayerSorter::Sorted shapes, const LayerSorter& sorter,
                          const std::string& name, const ImportOptions& options,
                          const DrawingSource* drawing, ImportRecords& out);

/// Leaves out shapes that lie far from the bulk of the lines, by five times its extent: what a slip
/// of the mouse leaves behind, or an origin in a plan of surveyors' coordinates. Warns of them,
/// unless `out` is null.
/// \param shapes in metres. O(n log n)
void leaveOutStrays(std::vector<PlanShape>& shapes, ImportRecords* out = nullptr);

/// Moves a drawing of which most stands in surveyors' coordinates to the origin, by whole metres.
/// \param name of the file \return by what \throws FormatError: shapes beyond kMaxPlanCoordinate.
/// O(n)
std::optional<Vec2> movedHome(std::vector<PlanShape>& shapes, const std::string& name);

/// \throws FormatError: a shape beyond all surveyors' coordinates
void requireOnEarth(const PlanShape& shape, const std::string& name);

/// Sorts the shapes of a drawing without hidden layers, and writes them. \return the floor area
/// kept, in square metres
double writeLinePlan(std::vector<PlanShape> shapes, const std::string& name,
                     const ImportOptions& options, ImportRecords& out);

/// Returns "WALLS (24), 0 (3) and 2 more".
std::string listText(const std::map<std::string, std::size_t>& counts);

}  // namespace ispace
