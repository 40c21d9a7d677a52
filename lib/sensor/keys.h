// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "record/record.h"
#include "record/schema.h"

namespace ispace {

/// Plans lie within this distance of the origin, in metres, as in the environment.
constexpr double kFarthest = 1e6;

// Keys that several records have.
KeySpec idKey();
KeySpec modelKey();
/// An angle, 0 by default.
KeySpec angleKey(std::string name, std::string help, double lower, double upper,
                 Role role = Role::None);
KeySpec headingKey(std::string help);
/// A number above 0 without default.
KeySpec positiveKey(std::string name, Unit unit, std::string help, double upper);

/// More readings a second than any sensor takes.
constexpr double kMaxRate = 1e5;
/// The keys of a sensor's pose, in space or in the frame of its carrier.
void addSensorPose(std::vector<KeySpec>& keys, std::string heading_help);
KeySpec rangeKey(std::string help);
KeySpec onKey();
KeySpec costKey();
/// Keys of what takes pictures: range, fov up to `widest` degrees, pixels and rate.
void addPictureKeys(std::vector<KeySpec>& keys, double widest);

/// Replaces both limits, or the greatest alone, by the `range` of a record if it has one. Errors
/// are added to the findings.
void applyRange(const Record& record, double& min_range, double& max_range, Diagnostics& findings);

/// Numbers of the device table: "0.06..4", and degrees with as few decimals as tell devices apart.
std::string rangeText(double least, double greatest);
std::string degreesText(Angle angle);

/// Parameters of a record: its explicit keys, else those of its device if there is one, else of a
/// bare one, put together by withParameters(Parameters, const Record&). \throws FormatError as that
template <typename Parameters>
Parameters parametersOf(const Record& record, const Record* device) {
    Parameters base;
    if (device != nullptr) {
        base = withParameters(Parameters(), *device);
        base.model = record.text("model");
    }
    return withParameters(std::move(base), record);
}

}  // namespace ispace
