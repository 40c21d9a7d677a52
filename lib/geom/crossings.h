// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/geom: a bound on arrangements, whose time and memory grow with the crossings.
#pragma once

#include <span>
#include <string>

#include "geom/polygon.h"

namespace ispace {

/// Crossings that an arrangement may have, about: some gigabytes.
constexpr double kMostCrossings = 500'000;

/// About how many pairs of the lines have a point in common, by a sample of them where there are
/// many; 0 where too few of the sample do.
double sampledCrossings(std::span<const Segment2> lines);

/// \throws FormatError (without a place) if the lines cross more than kMostCrossings times: "WHAT
/// cross each other about N times, at most … can be; HINT"
void mustCrossRarely(std::span<const Segment2> lines, const std::string& what,
                     const std::string& hint);

}  // namespace ispace
