// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/leds: small lights that programs switch on robots, objects and walls. Uses record,
// scene.
#pragma once

#include <vector>

#include "record/schema.h"
#include "scene/thing_kind.h"

namespace ispace::leds {

/// Returns the schema of `led`, a placement with the states `on` and `color`.
std::vector<Schema> ledSchemas();

/// Returns a cube of the record's size, which glows in its colour while it is on, and is dark else.
/// \pre the record is a `led`
ThingBody ledBody(const Record& record);

/// Adds the kind of LEDs, for the program.
void addLeds();

}  // namespace ispace::leds
