// SPDX-License-Identifier: GPL-3.0-or-later
// Art galleries: polygons with holes, of fractions.
#include "extensions/cad/cad.h"
#include "fuzz.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    tryPlan(cad::readGalleryFile, bytes, "gallery.pol");
}
