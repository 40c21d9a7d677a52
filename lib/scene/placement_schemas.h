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

/// The keywords of what is placed, and environment and result.
std::vector<Schema> layoutSchemas();

/// The keywords of device files: the parameters of a laser, ranger, ultrasound, tag or robot
/// record,
/// with model, source and confidence required, and without a place.
std::vector<Schema> deviceSchemas();

/// Every keyword of `.env` and `.3dm`: environmentSchemas() and layoutSchemas(). A constant.
const Schemas& sceneSchemas();

/// Sensors that are alike, without place.
struct SensorSpec {
    Record record;
    std::optional<int> count;  ///< if it is given
};

/// Reads `MODEL[,KEY=VALUE…][:COUNT]`: MODEL is a device or a bare kind (`laser`), a piece without
/// `=` continues the value before it (`range=0.1,4`), COUNT follows the last colon (at most
/// 10000). `kinds` are the keywords that may be named.
/// \throws UsageError with the nearest model or key
SensorSpec readSensorSpec(const std::string& text, std::span<const std::string_view> kinds,
                          const Schemas& schemas, const DeviceCatalogue& devices);

}  // namespace ispace
