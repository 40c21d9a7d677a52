// SPDX-License-Identifier: GPL-3.0-or-later
// Doors and windows: placed in wall lines, then cut out of all walls that they go through.
// Coordinates along lines are metres from their beginning; openings that exceed their wall by
// kFitDistance at most are fitted in, others are findings. Deterministic, single-threaded.
//
//     const std::vector<Opening> openings = placeOpenings(elements, plan, findings);
//     const CutWalls walls = cutOpenings(elements, plan, weld(plan.lines), openings, findings);
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "env/environment.h"
#include "env/walls.h"

namespace ispace {

/// An opening that exceeds its wall by at most this much is fitted in.
constexpr double kFitDistance = 0.001;
/// Openings and thick walls reach at most this far to each side of their lines; an opening given by
/// a position is searched for no farther from a wall's mid-line.
constexpr double kMaxFace = 1;
/// Thickness of a door's leaf, limited by the wall's.
constexpr double kLeafThickness = 0.04;

/// The filling of an opening.
enum class Filling { None, Leaf, ClearPane, OpaquePane };

/// A door or window in its wall line.
struct Opening {
    std::size_t element = 0;     ///< index of its element
    std::size_t line = 0;        ///< index of the wall line
    double from = 0, to = 0;     ///< along the line, from its beginning
    double bottom = 0, top = 0;  ///< heights
    double depth = 0;            ///< total depth through the wall, at least the wall's thickness
    double leaf = 0;             ///< thickness of the filling; 0 for a sheet
    Filling filling = Filling::None;
    bool passage = false;  ///< an open door, which joins the rooms on both sides
};

/// Finds the wall line of each `door` and `window` among the elements.
///
/// The record gives the position by `wall` and `offset` (along all lines of that record, in the
/// order of wallLinesOf), by `at` (on the nearest line, restricted to `wall` and to lines parallel
/// to `heading` if the record has them; among equally near lines the one it fits best, then the
/// first), or by `from` and `to`. A door stands on the bottom of its wall. Reports as findings: no
/// position or two, no wall there (with the nearest), openings that exceed their line or its
/// height. O(m log n) for m openings.
std::vector<Opening> placeOpenings(std::span<const Element> elements, const WallPlan& plan,
                                   Diagnostics& findings);

/// The interval of a wall line that an opening cuts out.
struct OpeningCut {
    std::size_t opening = 0, line = 0;
    Segment2 jambs;  ///< its ends, on the line
};

/// Returns all cuts that cutOpenings() makes: by opening, then by line.
std::vector<OpeningCut> openingCuts(const WallPlan& plan, std::span<const Opening> openings);

/// Wall lines after the openings are cut out.
struct CutWalls {
    std::vector<WallPart> parts;     ///< of walls, then of fillings; source: the line, or number of
                                     ///< lines + opening
    std::vector<Segment2> lines;     ///< all lines except passages
    std::vector<Segment2> passages;  ///< through open doors
};

/// Cuts the openings out of all walls that they go through: walls on the same line, and walls
/// beside it within `depth` or overlapping, up to a metre; between walls that stand apart, sheets
/// line the opening. Reports openings that overlap in one wall, and more coincident walls than it
/// can cut. O((n + m) log n). \pre welded is the weld of the plan's lines
CutWalls cutOpenings(std::span<const Element> elements, const WallPlan& plan,
                     const WeldedLines& welded, std::span<const Opening> openings,
                     Diagnostics& findings);

}  // namespace ispace
