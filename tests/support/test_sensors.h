// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of lib/kernel/scene and the libraries above it: records and devices of sensors from
// text.
#pragma once

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "record/text.h"
#include "scene/sensor/sensor.h"
#include "support/test_paths.h"

namespace ispace::testing {

inline Record sensorRecord(const std::string& line) {
    static const Schemas schemas(sensorSchemas());
    return readRecord(line, "line", schemas);
}

/// Removes the lines of robots, projectors and kinds that are not added; they stay as empty ones.
inline std::string sensorsOf(const std::string& text) {
    std::istringstream lines(text);
    std::string kept;
    for (std::string line; std::getline(lines, line);)
        kept += line.starts_with("#") || sensorKind(line.substr(0, line.find(' '))) != nullptr
                    ? line + '\n'
                    : "\n";
    return kept;
}

/// Finds the sensor, among the devices that come with the project, that `model` of the record
/// names; null without `model`.
/// \pre the device is a sensor
inline const Record* deviceFor(const Record& record) {
    static const Schemas schemas(sensorDeviceSchemas());
    static const std::vector<Record> devices = [] {
        std::vector<Record> all;
        const std::filesystem::recursive_directory_iterator files(sourcePath("share/devices"));
        for (const auto& file : files) {
            if (!file.is_regular_file()) continue;
            const std::string text = sensorsOf(readAll(file.path().string()));
            Document document = readRecordText(text, file.path().string(), schemas);
            for (Record& device : document.records) all.push_back(std::move(device));
        }
        return all;
    }();
    if (!record.has("model")) return nullptr;
    for (const Record& device : devices)
        if (device.text("model") == record.text("model")) return &device;
    throw UsageError("no device " + record.text("model"));
}

/// Returns the findings that `work` throws as FormatError, one per line; "" if it does not throw.
template <typename Work>
std::string findings(Work work) {
    try {
        static_cast<void>(work());
    } catch (const FormatError& error) {
        std::string out;
        for (const Diagnostic& diagnostic : error.diagnostics()) out += diagnostic.text() + '\n';
        return out;
    }
    return "";
}

}  // namespace ispace::testing
