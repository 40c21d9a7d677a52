// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "env/environment.h"
#include "env/walls.h"

namespace ispace {

/// An opening whose ends miss the wall's by at most this much is fitted in.
constexpr double kFitDistance = 0.001;
/// Openings and thick walls reach at most this far to each side of their lines; openings given by a
/// place are looked for no farther from a wall's mid-line.
constexpr double kMaxFace = 1;
/// Thickness of a door's leaf; at most the wall's.
constexpr double kLeafThickness = 0.04;

/// The filling of an opening.
enum class Filling { None, Leaf, ClearPane, OpaquePane };

/// A door or window as it lies in one wall line.
struct Opening {
    std::size_t element = 0;     ///< index of its element
    std::size_t line = 0;        ///< the wall line
    double from = 0, to = 0;     ///< along the line, from its beginning
    double bottom = 0, top = 0;  ///< heights
    double depth = 0;            ///< how far through it reaches, at least the wall's thickness
    double leaf = 0;             ///< thickness of its filling, 0 for a sheet
    Filling filling = Filling::None;
    bool passage = false;  ///< an open door: the rooms on both sides are one
};

/// Finds the wall line of each `door` and `window` among the elements.
///
/// Its place is given by `wall` and `offset` (along all lines of that record, in the order of
/// wallLinesOf), by `at` (on the nearest line, of `wall` and parallel to `heading` if they are
/// written; where several are equally near, the one it fits best, then the first), or by `from`
/// and `to`. A door stands on the bottom of its wall. Findings: no place or two, no wall there
/// (with the nearest), what sticks out of its line or above it. O(m log n) for m openings.
std::vector<Opening> placeOpenings(std::span<const Element> elements, const WallPlan& plan,
                                   Diagnostics& findings);

/// Where an opening goes through a wall line.
struct OpeningCut {
    std::size_t opening = 0, line = 0;
    Segment2 jambs;  ///< on the line
};

/// All lines that openings go through, as cutOpenings() finds them: by opening, then by line.
std::vector<OpeningCut> openingCuts(const WallPlan& plan, std::span<const Opening> openings);

/// Wall lines with the openings cut out.
struct CutWalls {
    std::vector<WallPart> parts;     ///< of the walls, then of what fills the openings; sources:
                                     ///< the line, or the number of lines + the opening
    std::vector<Segment2> lines;     ///< all lines but the passages
    std::vector<Segment2> passages;  ///< through open doors
};

/// Cuts the openings into all walls that they go through: those on the same line, and those beside
/// it as far as `depth` reaches or as walls overlap, a metre at most; between walls that stand
/// apart sheets line the opening. Findings: openings that overlap in one wall, and too many
/// walls upon each other. O((n + m) log n). \pre welded is the weld of the plan's lines
CutWalls cutOpenings(std::span<const Element> elements, const WallPlan& plan,
                     const WeldedLines& welded, std::span<const Opening> openings,
                     Diagnostics& findings);

}  // namespace ispace
