// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "raster/cells.h"

namespace ispace {

/// A room of a map, cut out with at least one row and column of other cells around it.
struct MapRoom {
    MapCells floor, occupied;
    CellPlace offset;  ///< of the cut in the map
};

/// Metres; smaller features of a robot's map are noise of its sensor.
constexpr double kNoiseWidth = 0.5;

/// What cleanRoom() did, in pieces and cells.
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
/// - Specks become floor: islands of one or two occupied cells, or as many as chance joins where
///   single ones are as frequent as on this map; islands that hold no occupied cell, pinholes
///   between rays, of up to eight. None is wider than `width`; legs of tables stay from three cells
///   on.
/// - Spikes go: strips of floor that are one cell wide, or up to `width` where no occupied cell is
///   near, and what is connected only through them, unless that is a room (kMinRoomArea,
///   kMinRoomWidth) or holds one of `keep`. Strips that connect rooms stay.
/// - Slits of unknown between rays, one cell wide and with a dead end, become floor.
/// - Bumps of straight walls, one cell deep and up to three long, become flat; corners keep
///   their places.
/// With cells of 0.3 times the width or more nothing is done. The result is connected by sides.
/// O(cells). \param resolution, width metres: of a cell, and below which features are noise
Cleaning cleanRoom(MapRoom& room, double resolution, double width,
                   const std::vector<CellPlace>& keep);

/// Removes strips of floor that are one cell wide, or at most `width` metres where no occupied cell
/// is near, with what is connected only through them; see cleanRoom(). O(cells)
void removeSpikes(MapRoom& room, double resolution, double width,
                  const std::vector<CellPlace>& keep, Cleaning& done);

}  // namespace ispace
