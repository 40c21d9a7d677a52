// SPDX-License-Identifier: GPL-3.0-or-later
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

/// The piece of the free cells that is most likely the room; none if there is no piece.
///
/// Pieces below 1 m2 that are small against the largest one, below 1/16 of it, are no rooms. A
/// piece at the picture's border, along a share f of it, is probably the outside or open to it: it
/// is taken only if its area times min(1/8, 1 - f) is larger than the largest piece that does not
/// touch the border. So a cave that fills its picture beats hollow rocks, but the yard around a
/// house does not beat the house.
std::optional<std::size_t> likeliestRoom(const CellPieces& pieces, double resolution);

/// The pieces that are closed rooms: away from the picture's border, at least kMinRoomArea large
/// and kMinRoomWidth wide somewhere; and the likeliest one. In piece order. O(cells)
std::vector<std::size_t> closedRooms(const MapCells& cells, const CellPieces& pieces,
                                     double resolution);

/// The cells that wall lines pass through: no step between side neighbours crosses a line.
/// \param lines in cells, cell (x, y) being the square from (x, y) to (x + 1, y + 1)
MapCells barrierCells(const std::vector<Segment2>& lines, int width, int height);

/// Free cells to remove so that openings to the grid's border of at most `width` cells, give or
/// take one, are closed. Floor that a disc of that diameter cannot enter belongs to the side that
/// reaches it by the widest way, so an opening is cut where it is narrowest; openings between
/// inner rooms stay.
/// O(cells + width squared).
MapCells gapCells(const MapCells& free, double width);

/// The cells that a disc can sweep without leaving the set, moving between side neighbours, from
/// where it covers one of `from`; without any, from the largest area it fits into.
/// Empty if the disc fits nowhere (there).
/// \param radius in cells: the disc's centre stays at least this far from the
/// edge of the set
MapCells reachedByDisc(const MapCells& cells, double radius, const std::vector<CellPlace>& from);

}  // namespace ispace
