// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of elements that extensions bring.
//
// One thread adds them before any scene is read; from then on they are constant, and the functions
// below are thread-safe.
//
//     addBodyShape("curtain", curtainBody);  // Body curtainBody(const Record& record)
#pragma once

#include <string>
#include <string_view>

#include "env/body.h"
#include "record/record.h"

namespace ispace {

/// Adds the body of the records of a keyword that an extension brings, for the program: call it
/// before any scene is read. bodyOf() calls it, also from several threads: it depends on its record
/// alone.
void addBodyShape(std::string_view keyword, Body (*body)(const Record& record));

/// Names the key of the records of things for the id of the person that carries it, and that of
/// people for the id of the thing, which follows from the former, for the program: call it before
/// any scene is read.
void setCarryKeys(std::string of_thing, std::string of_person);
/// Return these keys; "" if no extension has set them.
const std::string& carriedKey();
const std::string& holdsKey();
/// Returns the id of the person that carries a thing, "" for one that stands in the room.
/// Thread-safe.
std::string personWith(const Record& thing);
/// Returns the body of a thing where its record says, also of one that is carried: bodyOf() of that
/// is empty.
Body standingBodyOf(const Record& thing);

/// Returns true for a sheet of Material::Cloth: light stops at it, and it is part of slices; robots
/// and people pass it, and it is not part of bands.
inline bool isSoft(const Sheet& sheet) { return sheet.material == Material::Cloth; }

}  // namespace ispace
