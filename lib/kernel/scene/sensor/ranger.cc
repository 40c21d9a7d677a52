// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/ranger.h"

#include <cmath>

#include "base/number.h"
#include "scene/sensor/field_of_view.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace {

namespace {

/// Computes the field of view of the other side with square pixels.
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
        if (ranger.pixels() > kMaxPixels)
            findings.add(
                record.finding("pixels", std::to_string(ranger.pixels()) + " pixels, at most " +
                                             std::to_string(kMaxPixels) + " are possible"));
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

Ranger withParameters(Ranger base, const Record& record) {
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

FieldOfView fieldOfView(const Ranger& ranger, const Pose3& pose) {
    const Angle half_x = 0.5 * ranger.fov_x, half_y = 0.5 * ranger.fov_y;
    if (ranger.projection == Projection::Spherical)
        return FieldOfView::window(pose, half_x, half_y, ranger.max_range);
    return FieldOfView::pyramid(pose, half_x, half_y, ranger.max_range, ranger.measures_depth);
}

namespace {

void addRangerKeys(std::vector<KeySpec>& keys) {
    addPictureKeys(keys, 360);
    keys.push_back({.name = "projection",
                    .type = KeyType::Choice,
                    .help = "equal steps across a plane picture, or equal angles about the sensor",
                    .choices = {"pinhole", "spherical"}});
    keys.push_back(
        {.name = "measures",
         .type = KeyType::Choice,
         .help = "subject of its limits and noise: distance along the ray, or depth along the axis",
         .choices = {"distance", "depth"}});
    keys.push_back({.name = "ambiguity",
                    .type = KeyType::Number,
                    .unit = Unit::Length,
                    .help = "distances are measured modulo this, at any range; 0: in full",
                    .lower = 0,
                    .upper = kMaxDistance});
    addNoiseKeys(keys);
}

/// Returns a ray of a ranger through the edge of its picture: -1..1 across and upright.
Vec3 edgeRay(const Ranger& ranger, double across, double upright) {
    if (ranger.projection == Projection::Spherical)
        return directionOf(-0.5 * across * ranger.fov_x, 0.5 * upright * ranger.fov_y);
    return {1, -across * tan(0.5 * ranger.fov_x), upright * tan(0.5 * ranger.fov_y)};
}

Mesh rangerView(const Sensor& sensor, double reach) {
    const Ranger& ranger = sensor.as<Ranger>();
    const bool is_bent = ranger.projection == Projection::Spherical || !ranger.measures_depth;
    const auto at = [&](double across, double upright, double range) {
        const Vec3 ray = edgeRay(ranger, across, upright);
        return (is_bent ? range / length(ray) : range) * ray;
    };
    const bool is_all_around =
        ranger.projection == Projection::Spherical && ranger.fov_x >= Angle::degrees(360);
    return pictureView(ranger.fov_x, ranger.fov_y,
                       viewLimits(ranger.min_range, ranger.max_range, reach), is_all_around, at);
}

std::vector<Mesh> rangerBody() { return lensBox({0.05, 0.18, 0.05}, {-0.05, 0.05}, 0.015); }

DeviceSummary rangerSummary(const SensorModel& model) {
    const Ranger& ranger = std::get<Ranger>(model);
    return {rangeText(ranger.min_range, ranger.max_range),
            degreesText(ranger.fov_x) + "x" + degreesText(ranger.fov_y),
            std::to_string(ranger.columns) + "x" + std::to_string(ranger.rows),
            formatDouble(ranger.rate)};
}

}  // namespace

const SensorKind Ranger::kKind = {
    .keyword = "ranger",
    .noun = "ranger",
    .help = "3-D range camera; bare: range=0,5 fov=47.5,39.6 pixels=176,144",
    .heading_help = "direction of its axis, from +x",
    .device_help = "a 3-D range camera one can buy",
    .sign = SensorSign::Square,
    .add_keys = addRangerKeys,
    .body = rangerBody,
    .read = readModel<Ranger>,
    .summary = rangerSummary,
    .view = rangerView,
    .bearings = windowBearings<Ranger>,
    .field_of_view = fieldOfViewOf<Ranger>,
    .is_read = true,
    .is_arranged = true,
    .follows_poses = true,
    .sight_errors = [](const SensorModel& model, double range) -> SightErrors {
        const Ranger& ranger = std::get<Ranger>(model);
        const bool is_pinhole = ranger.projection == Projection::Pinhole;
        const double pixel = is_pinhole ? 1 / ranger.fx() : ranger.fov_x.radians() / ranger.columns;
        return {distanceSigma(ranger.noise, range), directionSigma(ranger.noise, pixel)};
    }};

}  // namespace ispace
