// SPDX-License-Identifier: GPL-3.0-or-later
// Art galleries: polygons with holes, of fractions.
#include "fuzz.h"
#include "io/importers.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    tryPlan(readGalleryFile, bytes, "gallery.pol");
}
