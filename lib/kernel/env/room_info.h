// SPDX-License-Identifier: GPL-3.0-or-later
// The measures of the rooms of a site in the JSON of envc --info, schema ispace-info/1. infoJson()
// of env/environment.h is that of a room alone, which is a site of one.
#pragma once

#include <span>
#include <string>

#include "base/json_writer.h"
#include "env/environment.h"

namespace ispace {

/// A room of a site.
struct RoomInfo {
    std::string id;     ///< "" of a room alone
    double z = 0;       ///< of its floor in the site
    double height = 0;  ///< up to the floor above
    const EnvironmentInfo* info = nullptr;
};

/// Writes the member `rooms`.
void writeRooms(JsonWriter& json, std::span<const RoomInfo> rooms);
/// Writes the members about a room, or about all rooms together, from `limits` to `triangles`.
void writeMeasures(JsonWriter& json, const EnvironmentInfo& info);
/// Returns the object of a room of several, without `rooms`, as an item of `storeys` holds it.
std::string storeyInfoJson(const EnvironmentInfo& info);

}  // namespace ispace
