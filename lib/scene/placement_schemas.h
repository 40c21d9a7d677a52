// SPDX-License-Identifier: GPL-3.0-or-later
// The schemas of placements: sensors, robots, people, furniture that a layout adds.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "record/record.h"
#include "record/schema.h"
#include "scene/devices.h"

namespace ispace {

/// Returns the schemas of placement records, `environment` and `result`.
std::vector<Schema> layoutSchemas();

/// Returns the schemas of device files: the parameters of a laser, ranger, ultrasound, tag or robot
/// record. Model, source and confidence are required; a position is rejected.
std::vector<Schema> deviceSchemas();

/// Returns the schema of every keyword of `.env` and `.3dm`: environmentSchemas() and
/// layoutSchemas(). A constant.
const Schemas& sceneSchemas();

}  // namespace ispace
