// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "io/import_options.h"
#include "record/record.h"

namespace ispace {

/// True for XML whose root is `svg`, as far as its beginning tells.
bool isSvg(std::string_view bytes);

/// Reads a plan from SVG: path, line, polyline, polygon, rect, circle and ellipse, in groups and
/// where `use` puts them, with all transforms. The plan's y points up; the lower left corner of
/// the page is the origin.
///
/// - Scale: `width` and `height` against `viewBox`, with pixels of 1/96 inch;
///   ImportOptions::units instead says what one unit of the drawing's own coordinates is.
/// - Layers: the innermost group that a glob names, by label (Inkscape) or id, else the Inkscape
///   layer, else the outermost group that has a name.
/// - What shows nothing is left out: `display: none`, hidden, drawn with neither stroke nor fill
///   (also by rules of `style` elements with one name, class or id);
///   so are definitions, text, pictures, and a rectangle that is the page's background.
/// - Curves are cut to pieces 1 mm off at most.
///
/// See readDxf for what becomes of the lines. Neither documents nor entities are fetched.
/// \throws FormatError with the line: damaged, no size, no line on the layers of walls, places
///         beyond 900 km, elements nested too deep, more points than ImportOptions::most_points
Document readSvg(std::string_view bytes, const std::string& name, const ImportOptions& options,
                 const Schemas& schemas);

}  // namespace ispace
