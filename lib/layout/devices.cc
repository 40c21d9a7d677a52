// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/devices.h"

#include <algorithm>
#include <filesystem>

#include "base/file.h"
#include "layout/laser.h"
#include "layout/schemas.h"
#include "record/text.h"

namespace ispace {

namespace {

/// What a device file may hold. A constant, as records point into it.
const Schemas& deviceSchemas() {
    static const Schemas schemas({laserDeviceSchema()});
    return schemas;
}

std::vector<std::string> deviceFiles(const std::string& folder) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".3dm") files.push_back(entry.path().string());
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

DeviceCatalogue DeviceCatalogue::load(const std::string& folder) {
    DeviceCatalogue catalogue;
    Diagnostics findings;
    for (const std::string& file : deviceFiles(folder)) {
        try {
            Document document = readRecordText(readAll(file), file, deviceSchemas());
            for (Record& record : document.records) {
                const std::string model = record.text("model");
                if (catalogue.find(model) != nullptr) {
                    findings.add(record.finding("model", "model `" + model + "` stands twice"));
                    continue;
                }
                withFigures({}, record);
                catalogue.records_.push_back(std::move(record));
            }
        } catch (const FormatError& error) {
            findings.add(error);
        }
    }
    findings.throwIfAny();
    return catalogue;
}

const Record* DeviceCatalogue::find(std::string_view model) const {
    const auto found = std::find_if(records_.begin(), records_.end(), [&](const Record& record) {
        return record.text("model") == model;
    });
    return found == records_.end() ? nullptr : &*found;
}

std::vector<std::string> DeviceCatalogue::models() const {
    std::vector<std::string> names;
    names.reserve(records_.size());
    for (const Record& record : records_) names.push_back(record.text("model"));
    return names;
}

}  // namespace ispace
