// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "io/import_options.h"
#include "record/record.h"

namespace ispace {

/// True if the first line is `2D-Map`.
bool isAriaMap(std::string_view bytes);

/// Reads a map of ARIA and MobileSim: the LINES, in millimetres, become walls (lines that meet end
/// to end one fence; points within ImportOptions::snap, default 5 mm, are one). Of the region that
/// encloses Home, else the largest, are kept the lines that bound it or lie in it, and an `inside`
/// point, Home where it is in the region; where nothing is enclosed all lines are kept.
///
/// Forbidden areas become zones, `forbidden-NAME` or `forbidden`; forbidden lines and other
/// cairns are counted in Document::notes. With ImportOptions::points the points of DATA become
/// cubes on a grid of 0.05 m, as high as the walls, but for those within 0.1 m of a line, which is
/// what they are echoes of.
/// \throws FormatError with the line: truncated, no number where one is due, no lines
Document readAriaMap(std::string_view bytes, const std::string& name, const ImportOptions& options,
                     const Schemas& schemas);

}  // namespace ispace
