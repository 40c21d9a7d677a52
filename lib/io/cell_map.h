// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "geom/pose.h"
#include "io/import_options.h"
#include "io/import_records.h"
#include "io/occupancy.h"

namespace ispace {

/// A map of square cells. Free and occupied are sets of the same size; what is in neither is
/// unknown.
struct CellMap {
    MapCells free, occupied;
    double resolution = 0;  ///< metres a cell
    Pose2 map_from_grid;    ///< the lower left corner of the cells
};

/// What messages say about where a map comes from.
struct CellMapSource {
    std::string file;             ///< that errors name
    std::string hint_if_no_free;  ///< what helps where no cell is free
};

/// Writes the room of a map: the largest free region (4-connected; unknown is not free), its
/// outline and its holes closed fences along the cell edges, simplified by at most
/// ImportOptions::simplify (default one cell: slanted walls become straight lines through their
/// stairs), and `inside` a point far from them.
/// \throws FormatError if no cell is free
void writeCellMap(const CellMap& map, const CellMapSource& source, const ImportOptions& options,
                  ImportRecords& out);

}  // namespace ispace
