// SPDX-License-Identifier: GPL-3.0-or-later
// What an SVG of Cairo needs to be searched and to be the same every time; for canvas.cc only.
#pragma once

#include <string>

#include "draw/text.h"
#include "geom/point.h"

namespace ispace {

/// Appends the element of one line of printable text that begins at `begin` (page units) and is
/// `length` long; viewers that lack the font stretch theirs to it. `halo`: its rim alone.
void appendSvgText(std::string& out, Point2 begin, double length, const std::string& text,
                   const TextStyle& style, bool halo);

/// The picture with these elements behind its last.
std::string withTexts(std::string svg, const std::string& texts);

/// Cairo names SVG surfaces by a counter of the process; numbered anew, equal pictures are equal.
std::string renumberSurfaces(const std::string& svg);

}  // namespace ispace
