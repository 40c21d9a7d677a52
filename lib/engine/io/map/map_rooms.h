// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms of a map of cells: the likeliest one, closed ones, gaps in their walls, floor that a disc
// reaches, and noise of a scanner. Distances are between middles of cells; floor joins by sides,
// obstacles by sides or corners, so that no diagonal step crosses a wall. All results depend on the
// cells alone.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "geom/polygon.h"
#include "raster/cells.h"

namespace ispace {

/// A region that occupies more of the picture's border than this is probably the outside.
constexpr double kOutsideShare = 0.5;

/// Minimum area (square metres) and width (metres) of a room.
constexpr double kMinRoomArea = 1, kMinRoomWidth = 0.5;

/// Finds the piece of the free cells that is most likely the room; std::nullopt without pieces.
///
/// Pieces below 1 m2 that are small against the largest one, below 1/16 of it, are no rooms. A
/// piece at the picture's border, along a share f of it, is probably the outside or open to it: it
/// is taken only if its area times min(1/8, 1 - f) is larger than the largest piece that does not
/// touch the border. So a cave that fills its picture beats hollow rocks, but the yard around a
/// house does not beat the house.
std::optional<std::size_t> likeliestRoom(const CellPieces& pieces, double resolution);

/// Returns the pieces that are closed rooms: away from the picture's border, at least kMinRoomArea
/// large and at some point kMinRoomWidth wide; and the likeliest one. In piece order. O(cells)
std::vector<std::size_t> closedRooms(const MapCells& cells, const CellPieces& pieces,
                                     double resolution);

/// Returns the cells that wall lines cross: no step between side neighbours crosses a line.
/// \param lines in cells, cell (x, y) being the square from (x, y) to (x + 1, y + 1)
MapCells barrierCells(const std::vector<Segment2>& lines, int width, int height);

/// Finds the free cells to remove so that openings to the grid's border of at most `width` cells,
/// give or take one, are closed. Floor that a disc of that diameter cannot enter belongs to the
/// side that reaches it by the widest way, so an opening is cut where it is narrowest; openings
/// between inner rooms stay. O(cells + width squared).
MapCells gapCells(const MapCells& free, double width);

/// Returns the cells that a disc can sweep without leaving the set, moving between side neighbours,
/// from any position where it covers one of `from`; if `from` is empty, from the largest area it
/// fits into. Empty if the disc fits into none of these.
/// \param radius in cells: the disc's centre stays at least this far from the edge of the set
MapCells reachedByDisc(const MapCells& cells, double radius, const std::vector<CellIndex>& from);

/// A room of a map, cut out with at least one row and column of other cells around it.
struct MapRoom {
    MapCells floor, occupied;
    CellIndex offset;  ///< of the cut in the map
};

/// Metres; smaller features of a robot's map are noise of its sensor.
constexpr double kNoiseWidth = 0.5;

/// Counts of removed pieces and of their cells, by kind.
struct Cleaning {
    std::size_t specks = 0, speck_cells = 0;
    std::size_t spikes = 0, spike_cells = 0;
    std::size_t slit_cells = 0;
    std::size_t edges = 0;  ///< sides of cells around the clean floor

    Cleaning& operator+=(const Cleaning& other);
    /// True if the map is so noisy that its walls are ragged: a speck or spike per hundred edges.
    [[nodiscard]] bool isRagged() const { return 100 * (specks + spikes) > edges; }
};

/// Removes a robot map's noise from a room, features that are also small in metres:
///
/// - Specks become floor: islands of one or two occupied cells, or as many as chance joins if
/// single ones are as frequent as on this map; islands without occupied cells, pinholes between
/// rays, of up to eight. All are at most `width` wide; legs of tables stay from three cells on.
/// - Spikes are removed: strips of floor that are one cell wide, or up to `width` if no occupied
/// cell is near, and floor connected only through them, unless that is a room (kMinRoomArea,
/// kMinRoomWidth) or holds one of `keep`. Strips that connect rooms stay.
/// - Slits of unknown between rays, one cell wide and with a dead end, become floor.
/// - Bumps of straight walls, one cell deep and up to three long, become flat; corners do not move.
/// Cells of 0.3 times the width or more are not cleaned. The result is connected by sides.
/// O(cells).
/// \param resolution, width metres: of a cell, and below which features are noise
Cleaning cleanRoom(MapRoom& room, double resolution, double width,
                   const std::vector<CellIndex>& keep);

/// Removes strips of floor that are one cell wide, or at most `width` metres if no occupied cell is
/// near, and floor connected only through them; see cleanRoom(). O(cells)
void removeSpikes(MapRoom& room, double resolution, double width,
                  const std::vector<CellIndex>& keep, Cleaning& done);

}  // namespace ispace
