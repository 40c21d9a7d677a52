// SPDX-License-Identifier: GPL-3.0-or-later
// Floor plans of HouseExpo: JSON with `verts`, `holes` and `room_category`.
#include "fuzz.h"
#include "io/importers.h"

void ispace::fuzz::tryInput(std::string_view bytes) { tryPlan(readHouseExpo, bytes, "plan.json"); }
