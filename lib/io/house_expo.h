// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "io/import_options.h"
#include "record/record.h"

namespace ispace {

/// True if the bytes begin like a JSON object or list.
bool isJson(std::string_view bytes);

/// Reads a floor plan of the HouseExpo data set: JSON with `verts`, the outline in metres, inner
/// walls walked around; and as our extension `holes`, a list of such rings: pillars, and walls
/// that stand free.
///
/// The largest region within the outline and outside of the holes becomes the room: its outline
/// and its holes are closed fences, with an `inside` point clear of walls. Repeated vertices,
/// either orientation, and rings that touch or cross are fine. Vertices move by at most
/// ImportOptions::simplify (default not at all); those within ImportOptions::snap (default 0) of
/// each other become one. The boxes of `room_category` become zones: `kitchen`, `kitchen-2`.
/// \throws FormatError with the place in the JSON
Document readHouseExpo(std::string_view json, const std::string& name, const ImportOptions& options,
                       const Schemas& schemas);

}  // namespace ispace
