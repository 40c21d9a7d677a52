// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "io/dxf_text.h"
#include "io/import_options.h"
#include "record/record.h"

namespace ispace {

/// Reads a plan from ASCII DXF: LINE, LWPOLYLINE and POLYLINE with bulges, ARC, CIRCLE, ELLIPSE
/// and SPLINE in model space, and INSERTs of blocks with them, in the unit of ImportOptions::units,
/// else of
/// `$INSUNITS`.
///
/// - Layers: those that a glob of door_layers or window_layers names hold such symbols, those of
///   wall_layers (by default all others) walls; what is on others, or on layers that are off or
///   frozen, is left out. Names are compared without case.
/// - Points within ImportOptions::snap (default 5 mm) of each other are one, ends that near to
///   another line lie on it; lines drawn twice are one; lines that meet end to end become one
///   fence, of the options' height and thickness. Arcs are cut to pieces 1 mm off at most (radii to
///   10 km). With ImportOptions::simplify lines lose points, see plan_simplify.h.
/// - Doors (open=yes) and windows, see plan_openings.h: across a gap they come with a wall that
///   closes it.
/// - Of all this only the largest region that is enclosed, rooms joined by doors, is kept: lines
///   that bound it or lie in it; with an `inside` point. Where nothing is enclosed all is kept.
///
/// What is left out is counted in Document::notes.
/// \throws FormatError: damaged, no unit, no line on the layers, places beyond 900 km, more than
///         ImportOptions::most_points
Document readDxf(std::string_view bytes, const std::string& name, const ImportOptions& options,
                 const Schemas& schemas);

}  // namespace ispace
