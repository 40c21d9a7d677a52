// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/sensor_keys.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number.h"
#include "env/environment.h"

namespace ispace {

KeySpec idKey() { return {.name = "id", .type = KeyType::Word, .help = "name of the record"}; }

KeySpec angleKey(std::string name, std::string help, double lower, double upper, Role role) {
    return {.name = std::move(name),
            .type = KeyType::Number,
            .unit = Unit::Angle,
            .help = std::move(help),
            .default_value = 0.0,
            .lower = lower,
            .upper = upper,
            .role = role};
}

KeySpec headingKey(std::string help) {
    return angleKey("heading", std::move(help), -kMaxDistance, kMaxDistance, Role::Heading);
}

KeySpec positiveKey(std::string name, Unit unit, std::string help, double upper) {
    return {.name = std::move(name),
            .type = KeyType::Number,
            .unit = unit,
            .help = std::move(help),
            .lower = 0,
            .upper = upper,
            .lower_open = true};
}

KeySpec modelKey() {
    return {.name = "model",
            .type = KeyType::Word,
            .help = "device of the catalogue that gives the parameters not written"};
}

KeySpec rangeKey(std::string help) {
    return {.name = "range",
            .type = KeyType::Tuple,
            .unit = Unit::Length,
            .help = std::move(help),
            .min_count = 1,
            .max_count = 2,
            .lower = 0,
            .upper = kMaxDistance};
}

void addSensorPose(std::vector<KeySpec>& keys, std::string heading_help) {
    keys.push_back({.name = "at",
                    .type = KeyType::Tuple,
                    .unit = Unit::Length,
                    .help = "optical centre; height 0.15 without z; without it a sensor has no "
                            "pose, or with `on` 0,0",
                    .min_count = 2,
                    .max_count = 3,
                    .lower = -kMaxDistance,
                    .upper = kMaxDistance,
                    .role = Role::Place,
                    .standard_z = kScanHeight});
    keys.push_back(headingKey(std::move(heading_help)));
    keys.push_back(angleKey("tilt", "above level, negative looks down", -90, 90, Role::Tilt));
    keys.push_back(angleKey("roll", "left side up", -180, 180));
}

KeySpec onKey() {
    return {.name = "on",
            .type = KeyType::Word,
            .help =
                "id of the robot, person or object that carries it: `at` and `heading` are in its "
                "frame, z counts from the floor or from the object's top; without z a person "
                "carries it at the eyes, 0.94 of the height",
            .role = Role::Carrier};
}

KeySpec costKey() {
    KeySpec key = positiveKey("cost", Unit::None, "of one, in any currency; for arrange --budget",
                              kMaxDistance);
    key.default_value = 1.0;
    return key;
}

void addPictureKeys(std::vector<KeySpec>& keys, double widest) {
    keys.push_back(rangeKey("least and greatest distance seen, or the greatest alone"));
    keys.push_back({.name = "fov",
                    .type = KeyType::Tuple,
                    .unit = Unit::Angle,
                    .help = "field of view across and upright; square pixels without the second",
                    .min_count = 1,
                    .max_count = 2,
                    .lower = 0,
                    .upper = widest,
                    .lower_open = true});
    keys.push_back({.name = "pixels",
                    .type = KeyType::Tuple,
                    .help = "columns,rows of its picture",
                    .min_count = 2,
                    .max_count = 2,
                    .lower = 1,
                    .upper = 16384,
                    .whole = true});
    keys.push_back(positiveKey("rate", Unit::Frequency, "pictures a second", kMaxRate));
}

void applyRange(const Record& record, double& min_range, double& max_range, Diagnostics& findings) {
    if (!record.has("range")) return;
    const Tuple& range = record.tuple("range");
    if (range.size() == 2) min_range = range.front();
    max_range = range.back();
    if (max_range <= 0)
        findings.add(record.finding("range", "the greatest range is 0, it must be above 0"));
    else if (min_range > max_range)
        findings.add(record.finding("range", "the least range " + formatDouble(min_range) +
                                                 " m is above the greatest, " +
                                                 formatDouble(max_range) + " m"));
}

KeySpec windowKey() {
    return {.name = "fov",
            .type = KeyType::Tuple,
            .unit = Unit::Angle,
            .help = "field of view across and upright, or across alone",
            .min_count = 1,
            .max_count = 2,
            .lower = 0,
            .upper = 360,
            .lower_open = true};
}

void applyWindow(const Record& record, Angle& across, Angle& upright, Diagnostics& findings) {
    const Tuple& fov = record.tuple("fov");
    across = Angle::degrees(fov.front());
    if (fov.size() > 1) upright = Angle::degrees(fov.back());
    if (upright > Angle::degrees(180))
        findings.add(record.finding(
            "fov", "more than 180 degrees upright: " + formatDouble(upright.degrees())));
}

std::string rangeText(double least, double greatest) {
    return formatDouble(least) + ".." + formatDouble(greatest);
}

std::string degreesText(Angle angle) {
    return formatDouble(std::round(angle.degrees() * 100) / 100);
}

void addNoiseKeys(std::vector<KeySpec>& keys) {
    constexpr double kMax = 1e3;
    keys.push_back({.name = "bias",
                    .type = KeyType::Number,
                    .unit = Unit::Length,
                    .help = "added to each distance measured, with scan --noise (as all of these)",
                    .lower = -kMax,
                    .upper = kMax});
    keys.push_back({.name = "sigma",
                    .type = KeyType::Tuple,
                    .help = "s0,s1,s2: at distance r its standard deviation is s0 + s1 r + s2 r^2",
                    .min_count = 1,
                    .max_count = 3,
                    .lower = -kMax,
                    .upper = kMax});
    keys.push_back({.name = "angle_sigma",
                    .type = KeyType::Number,
                    .unit = Unit::Angle,
                    .help = "standard deviation of each beam's bearing",
                    .lower = 0,
                    .upper = 90});
    keys.push_back({.name = "dropout",
                    .type = KeyType::Number,
                    .unit = Unit::Share,
                    .help = "share of the returns that is lost",
                    .lower = 0,
                    .upper = 1});
    keys.push_back({.name = "incidence",
                    .type = KeyType::Tuple,
                    .unit = Unit::Angle,
                    .help = "angles to the normal of the surface: between them a growing share of "
                            "returns is lost, beyond the second all",
                    .min_count = 2,
                    .max_count = 2,
                    .lower = 0,
                    .upper = 90});
    keys.push_back({.name = "resolution",
                    .type = KeyType::Number,
                    .unit = Unit::Length,
                    .help = "distances are whole multiples of this; 0: any",
                    .lower = 0,
                    .upper = kMax});
}

double uniformSigma(double width) { return width / std::sqrt(12.0); }

double distanceSigma(const RangeNoise& noise, double range) {
    const auto [s0, s1, s2] = noise.sigma;
    const double sigma = std::max(0.0, s0 + range * (s1 + range * s2));
    return std::max(kMinSigma, std::hypot(sigma, uniformSigma(noise.resolution)));
}

double directionSigma(const RangeNoise& noise, double step) {
    return std::hypot(noise.angle_sigma.radians(), uniformSigma(step));
}

void applyNoise(const Record& record, RangeNoise& noise, Diagnostics& findings) {
    if (record.has("bias")) noise.bias = record.number("bias");
    if (record.has("sigma")) {
        const Tuple& sigma = record.tuple("sigma");
        if (sigma.front() < 0)
            findings.add(record.finding("sigma",
                                        "`sigma`: its first number, the standard deviation "
                                        "close by, is below 0"));
        noise.sigma = {};
        std::copy(sigma.begin(), sigma.end(), noise.sigma.begin());
    }
    if (record.has("angle_sigma")) noise.angle_sigma = record.angle("angle_sigma");
    if (record.has("dropout")) noise.dropout = record.number("dropout");
    if (record.has("resolution")) noise.resolution = record.number("resolution");
    if (record.has("incidence")) {
        const Tuple& incidence = record.tuple("incidence");
        if (incidence[0] > incidence[1])
            findings.add(record.finding(
                "incidence", "`incidence`: " + formatDouble(incidence[0]) +
                                 " degrees, from which on returns get lost, is above " +
                                 formatDouble(incidence[1]) + ", from which on all are"));
        noise.graze_from = Angle::degrees(incidence[0]);
        noise.graze_to = Angle::degrees(incidence[1]);
    }
}

}  // namespace ispace
