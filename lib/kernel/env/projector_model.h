// SPDX-License-Identifier: GPL-3.0-or-later
// The figures of projectors: those of their records, their models, or bare ones. Apart from
// projector_beam.h, which all that know sensors include.
#pragma once

#include <vector>

#include "base/error.h"
#include "geom/pose.h"
#include "record/record.h"
#include "record/schema.h"

namespace ispace {

/// Figures of a projector: those of its record, which has the values of its model, else bare ones.
struct ProjectorModel {
    /// The least and the greatest of an angle, in degrees.
    struct Range {
        double least = 0, most = 0;
    };
    int columns = 1280, rows = 720;  ///< of its picture
    double across = 0, upright = 0;  ///< tangents of half the fields of view
    double lumens = 1000;            ///< of its full light
    Range pan{-180, 180}, tilt{-90, 90};

    /// Returns true if programs may turn it.
    [[nodiscard]] bool turns() const { return pan.least < pan.most || tilt.least < tilt.most; }
};

/// Reads the figures of a record or a device. \pre it has the keys of addProjectorParameters()
/// \throws FormatError if both fov and throw are written, or a range ends before it begins
ProjectorModel projectorModel(const Record& record);

/// Reports figures that contradict each other, and a pan or tilt beyond its range.
/// \pre the record is a `projector`
void checkProjector(const Record& record, Diagnostics& findings);

/// Appends the keys that a model of a projector may give; without defaults, as a missing key means
/// "as the model".
void addProjectorParameters(std::vector<KeySpec>& keys);

/// Returns the frame of a projector's lens turned by these angles: facing along its axis, the
/// picture upright along `up`.
Frame3 projectorLens(const Record& record, Angle pan, Angle tilt);

}  // namespace ispace
