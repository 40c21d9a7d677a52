// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "record/record.h"
#include "record/schema.h"

namespace ispace {

/// As in the environment: plans lie within this of the origin, in metres.
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

/// Above what any sensor does, times a second.
constexpr double kMaxRate = 1e5;
/// Where a sensor is and how it looks: a pose in space, or one in the frame of its carrier.
void addSensorPose(std::vector<KeySpec>& keys, std::string heading_help);
KeySpec rangeKey(std::string help);
KeySpec onKey();
KeySpec costKey();
/// Keys of what takes pictures: range, fov up to `widest` degrees, pixels and rate.
void addPictureKeys(std::vector<KeySpec>& keys, double widest);

/// Puts the `range` of a record, if it has one, in the place of two limits: least and greatest, or
/// the greatest alone. Adds what is wrong with it to the findings.
void applyRange(const Record& record, double& min_range, double& max_range, Diagnostics& findings);

/// Numbers of the device table: "0.06..4" and degrees with no more decimals than tell devices
/// apart.
std::string rangeText(double least, double greatest);
std::string degreesText(Angle angle);

/// Figures of a record: its explicit keys, else those of its device if there is one, else of a bare
/// one, put together by withFigures(Figures, const Record&). \throws FormatError as that
template <typename Figures>
Figures figuresOf(const Record& record, const Record* device) {
    Figures base;
    if (device != nullptr) {
        base = withFigures(Figures(), *device);
        base.model = record.text("model");
    }
    return withFigures(std::move(base), record);
}

}  // namespace ispace
