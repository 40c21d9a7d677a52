// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/json_writer.h"
#include "layout/scene.h"

namespace ispace {

/// The fixed part of a plan (floor, zones, things, walls, openings, what hangs from the ceiling) as
/// a JSON object for programs that draw it themselves, at any size:
///
///     {"box":[x0,y0,x1,y1],"layers":[{"name","groups":[{"id","title","shapes":[SHAPE…]}…]}…]}
///
/// Shapes in the order of drawing have one of `area` (closed curves, even-odd rule), `lines` (open
/// curves) and `arc` ([x, y, radius, from, to], degrees), then `inks`: {"fill"} or {"line","width"}
/// with "dash" if it is not solid. A curve is [x,y,x,y,…] in metres to the millimetre; widths and
/// dashes are pixels; colours are CSS's. The page's edge cuts nothing, and hatches are left out.
/// Equal scenes give equal bytes. O(n log n).
void writePlan(JsonWriter& json, const Scene& scene);

}  // namespace ispace
