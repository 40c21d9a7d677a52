// SPDX-License-Identifier: GPL-3.0-or-later
// The device catalogue: sensors, robots and projectors one can buy, with parameters from data
// sheets.
//
// Each record names its public sources and how far they are trusted: `confidence` is A for a
// maker's document, B for a second source, U if unsure. A catalogue is immutable, and thread-safe
// as const objects are. Look-ups are O(devices); pointers to records hold as long as the catalogue.
//
//     const DeviceCatalogue devices = loadDevices("share/devices");
//     const Record* const scanner = devices.find("urg-04lx");  // null if unknown
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "record/record.h"
#include "scene/sensor/sensor.h"

namespace ispace {

/// The models of share/devices: text files in the language of `.3dm`, one record a device, with
/// its parameters, their `source` and `confidence`.
class DeviceCatalogue {
  public:
    DeviceCatalogue() = default;
    explicit DeviceCatalogue(std::vector<Record> records) : records_(std::move(records)) {}

    /// Finds the record of a model; null if unknown. Models are unique over all keywords.
    [[nodiscard]] const Record* find(std::string_view model) const;
    /// Returns all devices in catalogue order: by file, then as written.
    [[nodiscard]] const std::vector<Record>& devices() const { return records_; }
    /// Returns all model names in catalogue order.
    [[nodiscard]] std::vector<std::string> models() const;
    /// Returns the model names of one keyword.
    [[nodiscard]] std::vector<std::string> models(std::string_view keyword) const;

  private:
    std::vector<Record> records_;
};

/// Reads all `*.3dm` files of a folder, and `kinds/KEYWORD.3dm` in it for each kind of sensor that
/// the program has, in the order of their names. Devices of kinds that extensions add lie there.
/// \throws FormatError with the findings of all files: bad records, doubled models, parameters that
/// contradict each other; std::system_error if the folder or a file cannot be read
DeviceCatalogue loadDevices(const std::string& folder);

/// Finds the device that `model` of a record names; null if the record has no model.
/// \throws FormatError for an unknown model (with the nearest name of the record's kind) and for
/// one of another kind
const Record* deviceOf(const Record& record, const DeviceCatalogue& devices);

/// Reads the model of a sensor's record. \pre its kind is simulated (SensorKind::read)
/// \throws FormatError as the kind's and deviceOf
SensorModel sensorModelOf(const Record& record, const DeviceCatalogue& devices);

/// Writes a table of all sensor devices with a header line: model, kind, name, range, field of
/// view, beams or pixels, rate and confidence in aligned columns; by kind, then in catalogue order.
std::string deviceTable(const DeviceCatalogue& devices);

}  // namespace ispace
