// SPDX-License-Identifier: GPL-3.0-or-later
// The plan for web pages, which draw it themselves.
#pragma once

#include "base/json_writer.h"
#include "scene/scene.h"

namespace ispace {

/// Writes the fixed part of a plan (floor, zones, things, walls, openings, overhead things) as a
/// JSON object for programs that draw it themselves, at any size:
///
///     {"box":[x0,y0,x1,y1],"layers":[{"name","groups":[{"id","title","shapes":[SHAPE…]}…]}…]}
///
/// Shapes in drawing order have one of `area` (closed curves, even-odd rule), `lines` (open curves)
/// and `arc` ([x, y, radius, from, to], degrees), then `inks`: {"fill"} or {"line","width"} with
/// "dash" if it is not solid. A curve is [x,y,x,y,…] in metres to the millimetre; widths and dashes
/// are in pixels; colours are CSS's. Shapes are not clipped to the page, and hatches are skipped.
/// Equal scenes give equal bytes. O(n log n).
void writePlan(JsonWriter& json, const Scene& scene);

}  // namespace ispace
