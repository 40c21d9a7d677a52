// SPDX-License-Identifier: GPL-3.0-or-later
// Sensors as options name them, such as `--sensor urg-04lx,rate=5:3`: a record without a position,
// and a number. Values are checked by the key's schema; contradictions between them are found when
// the model is read.
//
//     const auto [record, count] = readSensorSpec("laser,range=0.1,4:2", kinds, schemas, devices);
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "record/record.h"
#include "record/schema.h"
#include "scene/devices.h"

namespace ispace {

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
