// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/json_writer.h"
#include "coverage/presence.h"

namespace ispace {

/// Writes the member `presence` of coverageJson().
void writePresence(JsonWriter& json, const Presence& presence);

/// Writes the share of all ways, and a table each of people and sensors.
std::string presenceText(const Presence& presence);

}  // namespace ispace
