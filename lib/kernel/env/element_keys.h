// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/kernel/env: keys that several elements have.
#pragma once

#include <string>
#include <vector>

#include "record/schema.h"

namespace ispace::keys {

KeySpec floorAt();
KeySpec heading();
KeySpec height(double standard, std::string help = "height, unless size holds it");
/// Creates the key of a flag that is off by default.
KeySpec flag(std::string name, std::string help);
KeySpec number(std::string name, Unit unit, std::string help, double standard, double lower,
               double upper);
/// \param where how the picture lies on the body
KeySpec texture(const std::string& where);

/// Creates a schema with an id before its keys.
Schema schemaOf(std::string keyword, RecordType type, std::string help, std::vector<KeySpec> keys);
/// Appends the schemas of lamps and other appliances, whose states are keys, see stateKeys().
void addAppliances(std::vector<Schema>& out);

}  // namespace ispace::keys
