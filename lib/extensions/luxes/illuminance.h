// SPDX-License-Identifier: GPL-3.0-or-later
// The light on a spot, in lux, as a light meter reports it. The light of a panel is an integral
// along its contour (J. H. Lambert, Photometria, 1760). Deterministic and thread-safe; O(lamps),
// with rays to 16 points of each panel in front of the meter.
#pragma once

#include "extensions/luxes/lux.h"
#include "sense/added_reading.h"

namespace ispace {

struct ReadingKind;

}  // namespace ispace

namespace ispace::luxes {

/// A reading of a light meter.
struct Illuminance {
    double lux = 0;

    static const ReadingKind kKind;
};

/// Computes the direct light of the lamps, which pictures show too: square panels of 0.7 m with
/// sides along the lamps' headings, under the ceiling, that radiate downwards by Lambert's law. The
/// light of a panel in free sight is exact up to rounding, at any distance. Opaque surfaces and
/// movers cast shadows: the share of the light that they let through is that of 16 points of the
/// panel. Projectors add the light of a white picture. Light that surfaces throw back, and
/// daylight, are not in it.
Illuminance readingOf(const Lux& lux, const Moment& now);

}  // namespace ispace::luxes
