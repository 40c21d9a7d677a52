// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geom/overlay.h"

namespace ispace {

/// The regions with a vertex over the middle of each chord, so that their areas are those of
/// Overlay::areasOf(): for formats without arcs. The vertices lie within a third of kChordError of
/// the arcs and are the same in regions on either side. An arc that another boundary has cut to
/// less than a millimetre or so keeps its chord.
/// \param regions from overlay.regions()
std::vector<Region> withArcAreas(const Overlay& overlay, std::vector<Region> regions);

}  // namespace ispace
