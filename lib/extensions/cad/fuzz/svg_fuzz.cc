// SPDX-License-Identifier: GPL-3.0-or-later
// Drawings in SVG: walls, doors and windows by group.
#include "extensions/cad/cad.h"
#include "fuzz.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    tryPlan(cad::readSvg, bytes, "plan.svg", drawingOptions());
}
