// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of elements that extensions bring.
#pragma once

#include <string_view>

#include "env/body.h"
#include "record/record.h"

namespace ispace {

/// Adds the body of the records of a keyword that an extension brings, for the program: call it
/// before any scene is read.
void addBodyShape(std::string_view keyword, Body (*body)(const Record& record));

/// Returns true for a sheet of Material::Cloth: light stops at it, and it is part of slices; robots
/// and people pass it, and it is not part of bands.
inline bool isSoft(const Sheet& sheet) { return sheet.material == Material::Cloth; }

}  // namespace ispace
