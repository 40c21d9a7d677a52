// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/projector_device.h"

#include <cmath>
#include <numbers>
#include <string>

#include "base/number.h"
#include "env/projector_model.h"

namespace ispace {

namespace {

/// A fov of the record leaves out the throw of the model, and the other way round.
void fill(Record& record, const Record& device) {
    const bool has_angles = record.has("fov") || record.has("throw");
    device.forEachWritten([&](const KeySpec& key, const Value& value) {
        const bool is_angle = key.name == "fov" || key.name == "throw";
        if (key.name == "model" || key.name == "id" || record.schema().find(key.name) == nullptr ||
            record.has(key.name) || (is_angle && has_angles))
            return;
        record.set(key.name, value);
    });
}

void checkModel(const Record& device, Diagnostics& findings) {
    try {
        projectorModel(device);
    } catch (const FormatError& error) {
        findings.add(error);
    }
}

std::string degreesOf(double half_tangent) {
    return formatDouble(std::round(2 * std::atan(half_tangent) * 180 / std::numbers::pi));
}

DeviceSummary summaryOf(const Record& device) {
    const ProjectorModel model = projectorModel(device);
    return {"-", degreesOf(model.across) + 'x' + degreesOf(model.upright),
            std::to_string(model.columns) + 'x' + std::to_string(model.rows), "-"};
}

}  // namespace

const ElementDevice kProjectorDevice = {.keyword = "projector",
                                        .device_help = "a projector one can buy",
                                        .add_keys = addProjectorParameters,
                                        .fill = fill,
                                        .check_device = checkModel,
                                        .check = checkProjector,
                                        .summary = summaryOf};

}  // namespace ispace
