// SPDX-License-Identifier: GPL-3.0-or-later
// Floor plans of HouseExpo: JSON with `verts`, `holes` and `room_category`.
#include "extensions/cad/cad.h"
#include "fuzz.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    tryPlan(cad::readHouseExpo, bytes, "plan.json");
}
