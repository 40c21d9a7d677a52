// SPDX-License-Identifier: GPL-3.0-or-later
// Drawings in ASCII DXF: walls, doors and windows by layer, as most plans have them.
#include "extensions/cad/cad.h"
#include "fuzz.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    tryPlan(cad::readDxf, bytes, "plan.dxf", drawingOptions());
}
