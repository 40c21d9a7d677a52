// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "layout/devices.h"
#include "record/record.h"

namespace ispace {

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
