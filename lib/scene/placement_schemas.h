// SPDX-License-Identifier: GPL-3.0-or-later
// lib/scene: placements, device catalogue, Scene = environment + layout. Uses env, record, geom.
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

/// A group of equal sensors without positions.
struct SensorSpec {
    Record record;
    std::optional<int> count;  ///< if given
};

/// Parses `MODEL[,KEY=VALUE…][:COUNT]`: MODEL is a device or a bare kind (`laser`), a piece without
/// `=` continues the value before it (`range=0.1,4`), COUNT follows the last colon (at most 10000).
/// `kinds` lists the permitted keywords.
/// \throws UsageError with the nearest model or key
SensorSpec readSensorSpec(const std::string& text, std::span<const std::string_view> kinds,
                          const Schemas& schemas, const DeviceCatalogue& devices);

}  // namespace ispace
