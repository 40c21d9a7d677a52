// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/maps: maps of robots and games (ARIA, MovingAI) become rooms.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "io/importers.h"

namespace ispace::maps {

/// Returns true if the first line is `2D-Map`.
bool isAriaMap(std::string_view bytes);

/// The option --points; the importer finds it in ImportOptions::own.
struct AriaPoints {
    bool are_obstacles = false;
};

/// Reads a map of ARIA and MobileSim: the LINES, in millimetres, become walls: lines that meet end
/// to end are one fence, points within ImportOptions::snap (default 5 mm) are one. Keeps the lines
/// that bound or lie in the region around Home, else the largest one, with an `inside` point, Home
/// if it lies there. If no region is enclosed, all lines are kept.
///
/// Forbidden areas become zones, `forbidden-NAME` or `forbidden`; forbidden lines and other cairns
/// are counted in Document::notes. With AriaPoints::are_obstacles the points of DATA become cubes
/// on a grid of 0.05 m, as high as the walls, except points within 0.1 m of a line, which are
/// echoes of it. \throws FormatError with the line: truncated, no number where one is due, no lines
Document readAriaMap(std::string_view bytes, const std::string& name, const ImportOptions& options,
                     const Schemas& schemas);

/// Returns true for a grid map of MovingAI's benchmarks: the first line is `type` and a word.
bool isGridMap(std::string_view bytes);

/// Reads a grid map (`type octile`): cells of `.` and `G` (ground) and `S` (swamp, which can be
/// walked) are free; `@` and `O` (out of bounds), `T` (trees) and `W` (water, which cannot be
/// entered from ground) are not. Cells are ImportOptions::resolution wide, by default 1 m, and kept
/// exactly unless ImportOptions::simplify or clean is given.
/// \throws FormatError with the line
Document readGridMap(std::string_view bytes, const std::string& name, const ImportOptions& options,
                     const Schemas& schemas);

/// The rows of these maps, for addImporters().
std::span<const Importer> mapImporters();

}  // namespace ispace::maps
