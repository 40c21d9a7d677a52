// SPDX-License-Identifier: GPL-3.0-or-later
// Maps of cells that come without a map.yaml.
#pragma once

#include <string>
#include <string_view>

#include "io/import_options.h"
#include "record/record.h"

namespace ispace {

/// Reads the plan in a picture that comes alone: pixels of ImportOptions::resolution, the lower
/// left corner at ImportOptions::origin. What is lighter than 80.4 % is free, as map_server has it
/// without thresholds; what is mostly transparent is unknown. See readRosMap for the rest.
/// \throws FormatError: no resolution is given, no free pixel, a bad picture
Document readBarePicture(std::string_view bytes, const std::string& name,
                         const ImportOptions& options, const Schemas& schemas);

/// True for a grid map of MovingAI's benchmarks: the first line is `type` and a word.
bool isGridMap(std::string_view bytes);

/// Reads such a map (`type octile`): cells of `.` and `G` (ground) and `S` (swamp, which can be
/// walked) are free; `@` and `O` (out of bounds), `T` (trees) and `W` (water, which cannot be
/// entered from ground) are not. Cells are ImportOptions::resolution wide, by default 1 m.
/// \throws FormatError with the line
Document readGridMap(std::string_view bytes, const std::string& name, const ImportOptions& options,
                     const Schemas& schemas);

}  // namespace ispace
