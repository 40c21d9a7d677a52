// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/layout only: keys that several schemas have.
#pragma once

#include <string>

#include "record/schema.h"

namespace ispace {

/// As in the environment: plans lie within this of the origin, in metres.
constexpr double kFarthest = 1e6;

KeySpec idKey();
KeySpec modelKey();
/// An angle, 0 by default.
KeySpec angleKey(std::string name, std::string help, double lower, double upper,
                 Role role = Role::None);
KeySpec headingKey(std::string help);
/// A number above 0 without default.
KeySpec positiveKey(std::string name, Unit unit, std::string help, double upper);

}  // namespace ispace
