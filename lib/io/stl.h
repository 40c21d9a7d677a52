// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "layout/scene.h"

namespace ispace {

/// The scene as binary STL: metres, z up, all elements, placed sensors, robots, people and the
/// floor in one surface; 80 bytes of header, a count, then per triangle its unit normal, three
/// corners (counter-clockwise seen from outside; 32-bit floats, little-endian) and two bytes 0.
///
/// Sheets (walls without thickness, panes, floors) are there once, as surfaces to be seen from both
/// sides. Triangles that have no area, or none left in floats, are left out. Equal scenes give
/// equal bytes. O(triangles).
std::string writeStl(const Scene& scene);

}  // namespace ispace
