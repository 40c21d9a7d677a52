// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "env/body.h"
#include "geom/planar_map.h"

namespace ispace {

/// One straight wall line with all that its body needs.
struct WallLine {
    Segment2 line;
    double bottom = 0, top = 0;
    double thickness = 0;
    Material material = Material::Wall;
};

/// The lines of a wall, fence or ispace record, in order. What does not make a wall (no extent,
/// extent given twice, zero length or height) is a finding.
std::vector<WallLine> wallLinesOf(const Record& record, Diagnostics& findings);

/// Bodies of welded wall lines: result i belongs to line i. Pieces that meet share the very same
/// corners; where thick pieces meet at a corner, the notch between their ends is filled by a mitre
/// that belongs to the line of the lower index. \pre welded is the weld of the lines
std::vector<Body> wallBodies(std::span<const WallLine> lines, const WeldedLines& welded);

}  // namespace ispace
