// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "env/body.h"

namespace ispace {

/// Findings about the shape of a record beyond its schema and its wall lines: zones and closed
/// fences that cross themselves, zones without extent, bodies too small for their place, files of
/// meshes that are not loaded or hold no body.
void checkShape(const Record& record, const Body& body, Diagnostics& findings);

/// "(4.1, 2.0)": a place as people find it on a plan, to the centimetre.
std::string placeText(Point2 p);

}  // namespace ispace
