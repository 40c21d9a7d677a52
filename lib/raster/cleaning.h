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

/// Metres: on a map made by a robot what is smaller is noise of its sensor.
constexpr double kNoiseWidth = 0.5;

/// What cleanRoom() did, in pieces and cells.
struct Cleaning {
    std::size_t specks = 0, speck_cells = 0;
    std::size_t spikes = 0, spike_cells = 0;
    std::size_t slit_cells = 0;
    std::size_t edges = 0;  ///< sides of cells around the clean floor

    Cleaning& operator+=(const Cleaning& other);
    /// The map is so noisy that its walls are ragged, too: a speck or spike for each hundred edges.
    [[nodiscard]] bool isRagged() const { return 100 * (specks + spikes) > edges; }
};

/// Takes what is below a robot map's own noise out of a room, as far as it is small in metres, too:
///
/// - Specks become floor: islands of one or two occupied cells, or as many as chance joins where
///   single ones are as frequent as on this map; islands that hold no occupied cell, pinholes
///   between rays, of up to eight. None is wider than `width`, and legs of tables stay from three
///   cells on.
/// - Spikes go: strips of floor that are one cell wide, or up to `width` where no occupied cell is
///   near, and what hangs on them, unless that is a room by itself (kMinRoomArea, kMinRoomWidth) or
///   holds one of `keep`. Strips that rooms need to hang together stay.
/// - Slits of unknown between rays, one cell wide and with a dead end, become floor.
/// - Bumps of straight walls, one cell deep and up to three long, become flat; corners keep
///   their places.
///
/// Cells of 0.3 times the width and more mean something, and nothing is done. What is left is
/// connected by sides. O(cells). \param resolution, width metres: of a cell, and below which
/// features are noise
Cleaning cleanRoom(MapRoom& room, double resolution, double width,
                   const std::vector<CellPlace>& keep);

/// Removes strips of floor that are one cell wide, or at most `width` metres where no occupied cell
/// is near, with what is connected only through them; see cleanRoom(). O(cells)
void removeSpikes(MapRoom& room, double resolution, double width,
                  const std::vector<CellPlace>& keep, Cleaning& done);

}  // namespace ispace
