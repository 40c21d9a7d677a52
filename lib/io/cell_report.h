// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "io/cell_map.h"
#include "raster/cleaning.h"

namespace ispace {

/// What the import of a map of cells tells about the rooms that it chose; see writeCellMap().

/// Of the free cells that are not kept: warns where they are more than half of those that are not
/// outside and nobody chose the rooms, else notes.
void tellRest(const CellMap& map, const CellPieces& pieces, const std::vector<std::size_t>& rooms,
              const ImportOptions& options, ImportRecords& out);

/// Warns of a room that leaves the picture by an opening of 0.5 m or more. A room along most of the
/// border, whose walls the picture's edges may well be, is warned of only where closing its doors
/// would part a room from it.
void warnOfBorder(const CellMap& map, const MapRoom& room, double border_share, ImportRecords& out);

/// Notes what was cleaned out of all rooms.
void tellCleaning(const CellMap& map, const Cleaning& cleaning, ImportRecords& out);

/// Notes the gaps beside the rooms that were closed.
void tellGaps(const CellMap& map, const MapCells& cut, const CellPieces& pieces,
              const std::vector<std::size_t>& rooms, double widest, ImportRecords& out);

}  // namespace ispace
