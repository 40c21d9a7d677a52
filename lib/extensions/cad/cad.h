// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/cad: drawings (DXF, SVG) and plans that other programs wrote as polygons
// (HouseExpo, art galleries) become rooms.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "io/importers.h"

namespace ispace::cad {

/// Returns true if the bytes begin like ASCII DXF: a section, perhaps behind comments.
bool isDxf(std::string_view bytes);

/// Reads a plan from ASCII DXF: LINE, LWPOLYLINE and POLYLINE with bulges, ARC, CIRCLE, ELLIPSE
/// and SPLINE in model space, and INSERTs of blocks with them, in the unit of ImportOptions::units,
/// else of `$INSUNITS`.
///
/// - Layers: globs of door_layers and window_layers name those with symbols, wall_layers those with
/// walls (default: all others). Skips other layers and layers that are off or frozen. Case does not
/// matter.
/// - Points within ImportOptions::snap (default 5 mm) of each other become one, and ends that close
/// to another line end on it; lines drawn twice count once; lines that meet end to end become one
/// fence of the options' height and thickness. Arcs become straight pieces within 1 mm (radii to 10
/// km). With ImportOptions::simplify lines lose points, see simplifiedPaths().
/// - Doors (open=yes) and windows, see findOpenings(): in a gap they come with a wall that closes
/// it.
/// - Only the largest enclosed region is kept, with rooms joined by doors: the lines that bound it
/// or lie in it, and an `inside` point. If no region is enclosed, all lines are kept.
/// - A drawing with the layers of dxfRoomLayers(), if no option names layers, is read back as the
/// room that writeDxf() drew: all walls with their thickness and height, openings with height and
/// depth, doors with a width shut, solids by addDrawnThings().
///
/// Document::notes counts the skipped elements.
/// \throws FormatError: damaged, no unit, no line on the layers, coordinates beyond 900 km of the
/// drawing's own origin (surveyors' coordinates move there), more
/// than ImportOptions::max_work
Document readDxf(std::string_view bytes, const std::string& name, const ImportOptions& options,
                 const Schemas& schemas);

/// Returns true for XML with the root `svg`, see xmlRootName().
bool isSvg(std::string_view bytes);

/// Reads a plan from SVG: path, line, polyline, polygon, rect, circle and ellipse, in groups and
/// through `use`, with all transforms. The plan's y points up; the lower left corner of the page is
/// the origin.
///
/// - Scale: `width` and `height` against `viewBox`, with pixels of 1/96 inch;
///   ImportOptions::units overrides the unit of the drawing's coordinates.
/// - Layers: the innermost group with a label (Inkscape) or id that matches a glob, else the
/// Inkscape layer, else the outermost named group.
/// - Invisible elements are left out: `display: none`, hidden, without stroke and fill
///   (also by rules of `style` elements with one name, class or id);
///   so are definitions, text, pictures, and a rectangle as the page's background.
/// - Curves become straight pieces within 1 mm.
///
/// readDxf() documents the further processing of lines. Neither documents nor entities are fetched.
/// \throws FormatError with the line: damaged, no size, no line on the layers of walls, coordinates
/// beyond 900 km, elements nested too deep, more than ImportOptions::max_work
Document readSvg(std::string_view bytes, const std::string& name, const ImportOptions& options,
                 const Schemas& schemas);

/// Reads a floor plan of the HouseExpo data set: JSON with `verts`, the outline in metres, which
/// also runs around inner walls; and as our extension `holes`, a list of such rings: pillars and
/// free-standing walls.
///
/// The largest region within the outline and outside of the holes becomes the room: its outline
/// and its holes are closed fences, with an `inside` point clear of walls. Repeated vertices,
/// either orientation, and rings that touch or cross are fine. Vertices move by at most
/// ImportOptions::simplify (default not at all); those within ImportOptions::snap (default 0) of
/// each other become one. The boxes of `room_category` become zones: `kitchen`, `kitchen-2`.
/// \throws FormatError with the position in the JSON
Document readHouseExpo(std::string_view json, const std::string& name, const ImportOptions& options,
                       const Schemas& schemas);

/// Returns true for an instance of the art gallery problem: a number of corners and a fraction p/q.
/// \param is_named its file has the suffix .pol, so that a number may replace the fraction
bool isGalleryFile(std::string_view bytes, bool is_named = false);

/// Reads an instance of the art gallery problem (`.pol` of AGPLIB): the number of corners of a
/// simple polygon and their x and y, each a number or a fraction p/q, in metres; then, if it has
/// holes, their number and each in the same way. They become closed fences, with coordinates
/// rounded to doubles alone, and an `inside` point. Linear time. \throws FormatError: no number
/// where one is due, a polygon that crosses itself or has no area
Document readGalleryFile(std::string_view bytes, const std::string& name,
                         const ImportOptions& options, const Schemas& schemas);

/// The rows of these formats, for addImporters().
std::span<const Importer> cadImporters();

}  // namespace ispace::cad
