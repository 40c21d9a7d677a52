// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/projector_model.h"

#include <string>
#include <string_view>

#include "base/error.h"
#include "base/number.h"

namespace ispace {

namespace {

double halfTangent(double degrees) { return tan(Angle::degrees(degrees / 2)); }

/// \throws FormatError if it ends before it begins
ProjectorModel::Range rangeOf(const Record& record, std::string_view key,
                              ProjectorModel::Range otherwise) {
    if (!record.has(key)) return otherwise;
    const Tuple& ends = record.tuple(key);
    if (ends[0] > ends[1])
        throw FormatError(record.finding(
            key, "`" + std::string(key) + "`: wanted the least angle before the greatest, found " +
                     formatDouble(ends[0]) + ',' + formatDouble(ends[1])));
    return {ends[0], ends[1]};
}

/// Reads the tangents from the angles, or from the throw.
void readAngles(const Record& record, ProjectorModel& model) {
    const double ratio = static_cast<double>(model.rows) / model.columns;
    if (record.has("fov") && record.has("throw"))
        throw FormatError(record.finding("throw", "`fov` and `throw` are one thing: give one"));
    if (record.has("throw")) {
        model.across = 1 / (2 * record.number("throw"));
        model.upright = ratio * model.across;
    } else if (record.has("fov")) {
        const Tuple& fov = record.tuple("fov");
        model.across = halfTangent(fov[0]);
        model.upright = fov.size() > 1 ? halfTangent(fov[1]) : ratio * model.across;
    } else {
        constexpr double kBareAcross = 36, kBareUpright = 21;
        model.across = halfTangent(kBareAcross);
        model.upright = halfTangent(kBareUpright);
    }
}

}  // namespace

ProjectorModel projectorModel(const Record& record) {
    ProjectorModel model;
    if (record.has("pixels")) {
        const Tuple& pixels = record.tuple("pixels");
        model.columns = static_cast<int>(pixels[0]);
        model.rows = static_cast<int>(pixels[1]);
    }
    readAngles(record, model);
    if (record.has("lumens")) model.lumens = record.number("lumens");
    model.pan = rangeOf(record, "pan_range", model.pan);
    model.tilt = rangeOf(record, "tilt_range", model.tilt);
    return model;
}

void checkProjector(const Record& record, Diagnostics& findings) {
    try {
        const ProjectorModel model = projectorModel(record);
        const auto check = [&](const std::string& key, ProjectorModel::Range range) {
            const double angle = record.number(key);
            if (angle < range.least || angle > range.most)
                findings.add(record.finding(
                    key, "`" + key + "`: " + formatDouble(angle) + " is beyond the " + key +
                             "_range of the projector, " + formatDouble(range.least) + " to " +
                             formatDouble(range.most)));
        };
        check("pan", model.pan);
        check("tilt", model.tilt);
    } catch (const FormatError& error) {
        findings.add(error);
    }
}

Frame3 projectorLens(const Record& record, Angle pan, Angle tilt) {
    const Tuple& at = record.tuple("at");
    return Frame3(
        Pose3{{at[0], at[1], record.number("height")}, record.angle("heading") + pan, tilt, {}});
}

}  // namespace ispace
