// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "geom/planar_map.h"

namespace ispace {

/// The lines cut where they cross each other, crossings rounded to doubles: the pieces of a line in
/// its order, with its index. Where lines cross more than some twenty times each on average they
/// stay whole. Pieces meet at common ends but for rounding, which weld() takes care of.
WeldedLines cutAtCrossings(std::span<const Segment2> lines);

}  // namespace ispace
