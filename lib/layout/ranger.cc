// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/ranger.h"

#include <cmath>

#include "base/number.h"
#include "layout/limits.h"

namespace ispace {

namespace {

/// Field of view of the other side with square pixels.
Angle squareFov(const Ranger& ranger) {
    const double share = static_cast<double>(ranger.rows) / ranger.columns;
    if (ranger.projection == Projection::Spherical) return share * ranger.fov_x;
    return Angle::radians(2 * std::atan(share * tan(0.5 * ranger.fov_x)));
}

void applyPicture(Ranger& ranger, const Record& record, Diagnostics& findings) {
    if (record.has("projection"))
        ranger.projection =
            record.text("projection") == "spherical" ? Projection::Spherical : Projection::Pinhole;
    if (record.has("pixels")) {
        ranger.columns = static_cast<int>(record.tuple("pixels")[0]);
        ranger.rows = static_cast<int>(record.tuple("pixels")[1]);
        if (ranger.pixels() > kMostPixels)
            findings.add(
                record.finding("pixels", std::to_string(ranger.pixels()) + " pixels, at most " +
                                             std::to_string(kMostPixels) + " are possible"));
    }
    if (record.has("fov")) {
        const Tuple& fov = record.tuple("fov");
        ranger.fov_x = Angle::degrees(fov[0]);
        ranger.fov_y = fov.size() > 1 ? Angle::degrees(fov[1]) : squareFov(ranger);
    }
    const bool pinhole = ranger.projection == Projection::Pinhole;
    const double widest = std::max(ranger.fov_x.degrees(), ranger.fov_y.degrees());
    if (pinhole && widest >= 180)
        findings.add(record.finding("fov", "a pinhole sees less than 180 degrees, not " +
                                               formatDouble(widest) +
                                               " (projection=spherical sees all around)"));
    if (!pinhole && ranger.fov_y > Angle::degrees(180))
        findings.add(record.finding(
            "fov", "more than 180 degrees upright: " + formatDouble(ranger.fov_y.degrees())));
}

}  // namespace

double Ranger::fx() const { return columns / (2 * tan(0.5 * fov_x)); }
double Ranger::fy() const { return rows / (2 * tan(0.5 * fov_y)); }

Vec3 Ranger::ray(double column, double row) const {
    if (projection == Projection::Pinhole) return {1, (cx() - column) / fx(), (cy() - row) / fy()};
    const auto [cb, sb] = cosSin(bearing(column));
    const auto [ce, se] = cosSin(elevation(row));
    return {cb * ce, sb * ce, se};
}

Ranger withFigures(Ranger base, const Record& record) {
    Diagnostics findings;
    applyRange(record, base.min_range, base.max_range, findings);
    applyPicture(base, record, findings);
    if (record.has("rate")) base.rate = record.number("rate");
    if (record.has("measures")) base.measures_depth = record.text("measures") == "depth";
    if (record.has("ambiguity")) base.ambiguity = record.number("ambiguity");
    if (base.ambiguity > 0 && base.min_range >= base.ambiguity)
        findings.add(record.finding(record.has("range") ? "range" : "ambiguity",
                                    "the least range " + formatDouble(base.min_range) +
                                        " m is not below the ambiguity, " +
                                        formatDouble(base.ambiguity) + " m: nothing is measured"));
    if (base.measures_depth && base.projection == Projection::Spherical)
        findings.add(record.finding("measures", "a spherical ranger measures distances"));
    applyNoise(record, base.noise, findings);
    findings.throwIfAny();
    return base;
}

Ranger rangerOf(const Record& record, const DeviceCatalogue& devices) {
    return modelled<Ranger>(record, devices);
}

}  // namespace ispace
