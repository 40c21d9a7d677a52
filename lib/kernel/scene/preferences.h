// SPDX-License-Identifier: GPL-3.0-or-later
// Preferences of people, checked when a scene is made: 0 to a million lux, -100 to 100 degrees
// Celsius.
#pragma once

#include <optional>

#include "record/record.h"

namespace ispace {

/// The light and the temperature that a person likes, by `prefers=light:300;temp:21` of its record.
struct Preferences {
    std::optional<double> lux = {};
    std::optional<double> celsius = {};
};

/// \pre the record is a `human` \throws FormatError for an unknown name, a number out of bounds and
/// one that is given twice
Preferences preferencesOf(const Record& record);

}  // namespace ispace
