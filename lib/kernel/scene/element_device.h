// SPDX-License-Identifier: GPL-3.0-or-later
// Elements of the room that the device catalogue has models of, as it has of sensors and robots.
//
// A device fills only those keys that a record does not write. The scene keeps records and digest
// as written; the environment is built of the filled records.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "record/record.h"
#include "record/schema.h"
#include "scene/devices.h"
#include "scene/sensor/sensor.h"

namespace ispace {

/// A keyword of `.env` whose records may name a `model`: the values of that device stand in for
/// those that they lack.
struct ElementDevice {
    std::string_view keyword;
    std::string_view device_help;                       ///< "a projector one can buy"
    void (*add_keys)(std::vector<KeySpec>&) = nullptr;  ///< of its models, in its records, too
    /// Writes the values of a device into a record that lacks them.
    void (*fill)(Record& record, const Record& device) = nullptr;
    /// Reports figures of a device that contradict each other.
    void (*check_device)(const Record& device, Diagnostics& findings) = nullptr;
    /// The same of a record of a scene, once it is filled.
    void (*check)(const Record& record, Diagnostics& findings) = nullptr;
    DeviceSummary (*summary)(const Record& device) = nullptr;
};

/// Returns all, in the order of tables.
std::span<const ElementDevice* const> elementDevices();
/// Returns that of a keyword; null without one.
const ElementDevice* elementDevice(std::string_view keyword);

/// Returns the records with the values of their devices, for the environment and all that read it;
/// empty if no element names a model. Checks the figures of all elements with devices.
/// \throws FormatError with the findings about models and figures
std::optional<std::vector<Record>> withDevices(const std::vector<Record>& records,
                                               const DeviceCatalogue& devices);

}  // namespace ispace
