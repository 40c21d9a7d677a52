// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/curtains: cloth on a rail, which stops light over its drawn share and lets people
// pass. Uses record, env, scene.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "env/body.h"
#include "record/schema.h"
#include "scene/thing_kind.h"

namespace ispace::curtains {

/// Returns the schema of `curtain`, an element of the room with the state `drawn`.
std::vector<Schema> curtainSchemas();

/// Builds the cloth: a soft sheet from the beginning of the rail along the drawn share of it; empty
/// for drawn=0, and for a curtain without an extent, which the check of its kind rejects.
/// \pre the record is a `curtain`
Body curtainBody(const Record& record);

/// Returns what comes of `opens` (drawn=0), `closes` (drawn=1) of a person on a curtain.
ActResult actOnCurtain(const Record& record, std::string_view verb, const Record& person,
                       std::string changes);

/// Adds the body and the kind of curtains, for the program.
void addCurtains();

}  // namespace ispace::curtains
