// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "io/import_options.h"
#include "record/record.h"

namespace ispace {

/// True if the bytes are YAML with the top-level keys `image` and `resolution`.
bool isRosMap(std::string_view bytes);

/// Reads a ROS map (map_server's map.yaml and its picture, see parsePicture); writeCellMap() tells
/// what becomes of it. Warns if shades of unknown count as free. \param name the map.yaml; `image`
/// is relative to its folder (for "-" to the current one) \throws FormatError with place in YAML or
/// image, std::system_error for a missing image
Document readRosMap(std::string_view yaml, const std::string& name, const ImportOptions& options,
                    const Schemas& schemas);

}  // namespace ispace
