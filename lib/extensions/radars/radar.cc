// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/radars/radar.h"

#include <algorithm>
#include <cmath>

#include "base/number.h"
#include "extensions/radars/radar_frame.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace::radars {

Radar withParameters(Radar base, const Record& record) {
    Diagnostics findings;
    applyRange(record, base.min_range, base.max_range, findings);
    if (record.has("fov")) applyWindow(record, base.fov_x, base.fov_y, findings);
    if (record.has("rate")) base.rate = record.number("rate");
    if (record.has("detections")) base.detections = static_cast<int>(record.number("detections"));
    if (record.has("min_speed")) base.min_speed = record.number("min_speed");
    if (record.has("max_speed")) base.max_speed = record.number("max_speed");
    if (base.max_speed > 0 && base.min_speed >= base.max_speed)
        findings.add(record.finding(record.has("min_speed") ? "min_speed" : "max_speed",
                                    "the least speed " + formatDouble(base.min_speed) +
                                        " m/s is not below the greatest, " +
                                        formatDouble(base.max_speed) + " m/s"));
    if (record.has("angle_resolution")) base.angle_resolution = record.angle("angle_resolution");
    if (record.has("speed_resolution")) base.speed_resolution = record.number("speed_resolution");
    if (record.has("speed_sigma")) base.speed_sigma = record.number("speed_sigma");
    applyNoise(record, base.noise, findings);
    findings.throwIfAny();
    return base;
}

FieldOfView fieldOfView(const Radar& radar, const Pose3& pose) {
    return FieldOfView::window(pose, 0.5 * radar.fov_x, 0.5 * radar.fov_y, radar.max_range);
}

bool senses(const Radar& radar, Vec2 velocity, Vec3 direction) {
    const double speed = velocity.x * direction.x + velocity.y * direction.y;
    return std::fabs(speed) >= radar.min_speed && speed != 0;
}

namespace {

/// Creates the key of a speed, 0 or more.
KeySpec speedKey(std::string name, std::string help) {
    constexpr double kMaxSpeed = 1e3;
    return {.name = std::move(name),
            .type = KeyType::Number,
            .unit = Unit::Length,
            .help = std::move(help),
            .lower = 0,
            .upper = kMaxSpeed};
}

void addRadarKeys(std::vector<KeySpec>& keys) {
    constexpr double kMaxDetections = 10'000;
    keys.push_back(rangeKey("least and greatest distance detected, or the greatest alone"));
    keys.push_back(windowKey());
    keys.push_back(positiveKey("rate", Unit::Frequency, "readings a second", kMaxRate));
    keys.push_back({.name = "detections",
                    .type = KeyType::Number,
                    .help = "greatest number in a reading; the nearest are kept",
                    .lower = 1,
                    .upper = kMaxDetections,
                    .whole = true});
    keys.push_back(speedKey("min_speed",
                            "least radial speed detected, metres a second; slower movers count as "
                            "the room"));
    keys.push_back(speedKey("max_speed",
                            "greatest radial speed, metres a second: speeds are known modulo twice "
                            "this; 0: in full"));
    keys.push_back({.name = "angle_resolution",
                    .type = KeyType::Number,
                    .unit = Unit::Angle,
                    .help = "movers nearer to each other in bearing, and than `resolution` in "
                            "range and `speed_resolution` in speed, are one detection",
                    .lower = 0,
                    .upper = 360});
    keys.push_back(speedKey("speed_resolution",
                            "speeds are whole multiples of this, metres a second; 0: any"));
    keys.push_back(
        speedKey("speed_sigma", "standard deviation of a radial speed, metres a second"));
    addNoiseKeys(keys);
}

/// Builds a board with the antennas' cover in front.
std::vector<Mesh> radarBody() {
    Mesh board{Material::Sensor, {}, {}}, cover{Material::Metal, {}, {}};
    addBox(board, {-0.02, -0.03, -0.035}, {-0.005, 0.03, 0.035});
    addBox(cover, {-0.005, -0.012, -0.012}, {0, 0.012, 0.012});
    return {std::move(board), std::move(cover)};
}

}  // namespace

const SensorKind Radar::kKind = {
    .keyword = "radar",
    .noun = "radar",
    .help =
        "millimetre-wave radar, which detects movers; bare: range=0,9 fov=120,60 rate=10 "
        "min_speed=0.1",
    .heading_help = "direction of its axis, from +x",
    .device_help = "a millimetre-wave radar one can buy",
    .sign = SensorSign::Square,
    .add_keys = addRadarKeys,
    .body = radarBody,
    .read = readModel<Radar>,
    .summary = [](const SensorModel& model) -> DeviceSummary {
        const Radar& radar = *tryModel<Radar>(model);
        return {rangeText(radar.min_range, radar.max_range),
                degreesText(radar.fov_x) + "x" + degreesText(radar.fov_y),
                std::to_string(radar.detections), formatDouble(radar.rate)};
    },
    .view = windowViewOf<Radar>,
    .bearings = windowBearings<Radar>,
    .field_of_view = fieldOfViewOf<Radar>,
    .stopped_by = Surfaces::Solid,
    .is_read = true,
    .is_arranged = true,
    .follows_poses = true,
    .sight_errors = [](const SensorModel& model, double range) -> SightErrors {
        const RangeNoise& noise = tryModel<Radar>(model)->noise;
        return {distanceSigma(noise, range), std::max(directionSigma(noise, 0), kMinSigma)};
    },
    .senses = [](const SensorModel& model, Vec2 velocity,
                 Vec3 direction) { return senses(*tryModel<Radar>(model), velocity, direction); },
    .measure = measureBy<Radar>,
    .reading = &RadarFrame::kKind};

void addRadars() { addSensorKind(Radar::kKind); }

}  // namespace ispace::radars
