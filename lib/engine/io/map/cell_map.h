// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/io/map: maps of cells, which robots and pictures hold, become rooms, and rooms maps.
// Results depend on the cells and the options alone. Maps count in cells from their lower left
// corner, records in metres.
//
//     const CellMap map{free, occupied, 0.05, Pose2{{-10, -10}, {}}};
//     writeCellMap(map, {"map.pgm", "no cell is free"}, options, out);
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "io/import_records.h"
#include "io/importers.h"
#include "io/map/map_rooms.h"
#include "raster/cells.h"

namespace ispace {

/// A map of square cells. Free and occupied are sets of the same size; all other cells are unknown.
struct CellMap {
    MapCells free, occupied;
    double resolution = 0;  ///< metres a cell
    Pose2 map_from_grid;    ///< the lower left corner of the cells
    int wall_depth = 0;     ///< cells by which the faces of walls lie within occupied ones

    /// Maps points in cells, cell (x, y) being the square from (x, y) to (x + 1, y + 1), to the
    /// map's metres, and back.
    [[nodiscard]] Point2 inMap(Point2 cells) const;
    [[nodiscard]] Point2 inCells(Point2 point) const;
    /// Returns the cell of a point, which may lie outside the grid.
    [[nodiscard]] CellIndex placeOf(Point2 point) const;
    [[nodiscard]] Point2 middleOf(CellIndex place) const {
        return inMap({place.x + 0.5, place.y + 0.5});
    }
    /// Converts a number of cells to square metres.
    [[nodiscard]] double area(std::size_t cells) const {
        return static_cast<double>(cells) * resolution * resolution;
    }
};

/// Rejects maps of more than 10 km. Few bytes of a picture hold many cells, so the map's building
/// pays for them. \throws FormatError
void checkCellMap(int width, int height, double resolution, const std::string& file,
                  const WorkLimit& limit = {});

/// The source of a map, for messages.
struct CellMapSource {
    std::string file;             ///< named in errors
    std::string hint_if_no_free;  ///< advice if no cell is free
};

/// Writes the rooms of a map: free regions (4-connected; unknown is not free), outlines and holes
/// as closed fences, each with an `inside` point.
///
/// 1. ImportOptions::known_walls split the floor while rooms are chosen; then the floor under them
/// and a cell beyond is restored, so that they are the border. Openings to the picture's border of
/// at most `close_gaps` are closed (gapCells()).
/// 2. The rooms are the regions with the points of `inside` and `known_inside`; without points the
/// likeliest one (likeliestRoom()) or, with RoomChoice::All, all that are closed.
/// 3. Noise smaller than `clean` is removed (cleanRoom()).
/// 4. With `reachable` the floor is the part that a disc of that radius reaches.
/// 5. Outlines follow the cells' edges, simplified by at most `simplify` (default one cell: slanted
///    walls become straight lines through their stairs; two where the map is noisy).
///
/// The `inside` records of a room are the points of `inside` that chose it, else one far from the
/// outline; rooms chosen only by `known_inside` already have a record in another input.
///
/// Warns if less than half of the indoor free cells is kept, if a room leaves the picture, and of
/// unlikely sizes of a building; notes report closed gaps and cleaning.
/// \throws FormatError if no cell is free, for a point that is not on free floor, and for a disc
/// that does not fit
void writeCellMap(const CellMap& map, const CellMapSource& source, const ImportOptions& options,
                  ImportRecords& out);

/// Reports about the rooms that writeCellMap() chose.

/// Reports free cells that are not kept: a warning if they are more than half of the indoor cells
/// and no point chose the rooms, else a note.
void reportDroppedCells(const CellMap& map, const CellPieces& pieces,
                        const std::vector<std::size_t>& rooms, const ImportOptions& options,
                        ImportRecords& out);

/// Warns of a room that leaves the picture through an opening of 0.5 m or more. Along most of the
/// border the picture's edges may be its walls: then the warning comes only if closing doors would
/// separate a room from it.
void warnOfBorder(const CellMap& map, const MapRoom& room, double border_share, ImportRecords& out);

/// Reports the cells that cleaning removed, of `cells` in all rooms; warns if spikes were more than
/// a hundredth of them.
void reportCleaning(const CellMap& map, const Cleaning& cleaning, std::size_t cells,
                    ImportRecords& out);

/// Reports the gaps closed beside the rooms.
void reportClosedGaps(const CellMap& map, const MapCells& cut, const CellPieces& pieces,
                      const std::vector<std::size_t>& rooms, double widest, ImportRecords& out);

}  // namespace ispace
