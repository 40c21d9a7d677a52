// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "raster/cell_pieces.h"

namespace ispace {

/// A region that runs along more of the picture's border than this looks like the outside.
constexpr double kOutsideShare = 0.5;

/// The piece of the free cells that most likely is the room.
///
/// Pieces below 1 m2 that are small against the largest one, below 1/16 of it, are no rooms. A
/// piece at the picture's border, along a share f of it, is probably the outside or open to it: it
/// is taken only if its area times min(1/8, 1 - f) is larger than the largest piece that does not
/// touch the border. So a cave that fills its picture beats hollow rocks, and the yard around a
/// house does not beat the house. Nothing if there is no piece.
std::optional<std::size_t> likeliestRoom(const CellPieces& pieces, double resolution);

/// The pieces that are rooms closed in themselves: away from the picture's border, of 1 m2 at
/// least and 0.5 m wide somewhere; and the likeliest one. In their order. O(cells)
std::vector<std::size_t> closedRooms(const MapCells& cells, const CellPieces& pieces,
                                     double resolution);

}  // namespace ispace
