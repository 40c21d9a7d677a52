// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "env/environment.h"
#include "env/zone.h"
#include "record/record.h"

namespace ispace {

/// All zones that a text means: `door:GLOB,M` is one for each door whose id matches the glob, the
/// floor within M of its opening, straight through walls; every other text is one, as readZone()
/// reads it. Rounded ends are 16 chords to a quarter. \throws UsageError as readZone(), for a
/// bad distance, and if no door matches
std::vector<NamedZone> readZones(std::string_view text, const Environment& environment);

/// Records of these zones, but for zones that are records already: those at doors have the id
/// DOOR-zone, or DOOR-zone-2 and so on. \throws UsageError as readZones()
std::vector<Record> zoneRecords(std::span<const std::string> texts, const Environment& environment,
                                const Schemas& schemas);

}  // namespace ispace
