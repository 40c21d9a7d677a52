// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/sensor_schemas.h"

#include <string>
#include <utility>

#include "env/environment.h"
#include "layout/laser.h"
#include "layout/noise.h"
#include "layout/schema_keys.h"

namespace ispace {

namespace {

/// Above what any sensor does, times a second.
constexpr double kMostOften = 1e5;

KeySpec rangeKey(std::string help) {
    return {.name = "range",
            .type = KeyType::Tuple,
            .unit = Unit::Length,
            .help = std::move(help),
            .min_count = 1,
            .max_count = 2,
            .lower = 0,
            .upper = kFarthest};
}

/// Where a sensor is and how it looks: a pose in space, or one in the frame of its carrier.
void addSensorPose(std::vector<KeySpec>& keys, std::string heading_help) {
    keys.push_back({.name = "at",
                    .type = KeyType::Tuple,
                    .unit = Unit::Length,
                    .help = "optical centre; height 0.15 without z; left out: to be placed, or "
                            "with `on` 0,0",
                    .min_count = 2,
                    .max_count = 3,
                    .lower = -kFarthest,
                    .upper = kFarthest,
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
                "id of the robot or object that carries it: `at` and `heading` are in its "
                "frame, z counts from the floor or from the object's top",
            .role = Role::Carrier};
}

KeySpec costKey() {
    KeySpec key =
        positiveKey("cost", Unit::None, "of one, in any currency; for arrange --budget", kFarthest);
    key.default_value = 1.0;
    return key;
}

Schema sensorSchema(std::string keyword, std::string help, std::string heading_help,
                    void (*add_figures)(std::vector<KeySpec>&)) {
    Schema schema{.keyword = std::move(keyword),
                  .type = RecordType::Placement,
                  .help = std::move(help),
                  .keys = {}};
    schema.keys.push_back(idKey());
    schema.keys.push_back(modelKey());
    addSensorPose(schema.keys, std::move(heading_help));
    add_figures(schema.keys);
    schema.keys.push_back(onKey());
    schema.keys.push_back(costKey());
    return schema;
}

/// Figures of what sees a picture: rangers and cameras.
void addPictureFigures(std::vector<KeySpec>& keys, double widest) {
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
    keys.push_back(positiveKey("rate", Unit::Frequency, "pictures a second", kMostOften));
}

void addSweepFigures(std::vector<KeySpec>& keys) {
    keys.push_back({.name = "sweep",
                    .type = KeyType::Choice,
                    .help = "which of its angles changes from scan to scan, for a picture of the "
                            "whole space",
                    .choices = {"none", "heading", "tilt", "roll"}});
    keys.push_back({.name = "sweep_span",
                    .type = KeyType::Number,
                    .unit = Unit::Angle,
                    .help = "by how much it changes in a sweep, from the angle written on; 360 "
                            "without it",
                    .lower = 0,
                    .upper = 360,
                    .lower_open = true});
    keys.push_back({.name = "sweep_step",
                    .type = KeyType::Number,
                    .unit = Unit::Angle,
                    .help = "by how much from scan to scan; 1 without it",
                    .lower = 0,
                    .upper = 360,
                    .lower_open = true});
}

void addCameraFigures(std::vector<KeySpec>& keys) { addPictureFigures(keys, 179); }

}  // namespace

void addLaserFigures(std::vector<KeySpec>& keys) {
    keys.push_back(rangeKey("least and greatest distance measured, or the greatest alone"));
    keys.push_back({.name = "fov",
                    .type = KeyType::Number,
                    .unit = Unit::Angle,
                    .help = "field of view, half of it to each side",
                    .lower = 0,
                    .upper = 360});
    keys.push_back({.name = "step",
                    .type = KeyType::Number,
                    .unit = Unit::Angle,
                    .help = "angle between neighbouring beams",
                    .lower = 0,
                    .upper = 360,
                    .lower_open = true});
    keys.push_back({.name = "first",
                    .type = KeyType::Number,
                    .unit = Unit::Angle,
                    .help = "bearing of the first beam",
                    .lower = -360,
                    .upper = 360});
    keys.push_back({.name = "beams",
                    .type = KeyType::Number,
                    .help = "number of beams",
                    .lower = 1,
                    .upper = kMostBeams});
    keys.push_back(positiveKey("rate", Unit::Frequency, "scans a second", kMostOften));
    keys.push_back({.name = "spin",
                    .type = KeyType::Number,
                    .unit = Unit::Frequency,
                    .help = "turns a second of its beam, which give each beam its own time; below "
                            "0 clockwise, 0: all beams at once",
                    .lower = -kMostOften,
                    .upper = kMostOften});
    addSweepFigures(keys);
    addNoiseKeys(keys);
}

void addRangerFigures(std::vector<KeySpec>& keys) {
    addPictureFigures(keys, 360);
    keys.push_back({.name = "projection",
                    .type = KeyType::Choice,
                    .help = "equal steps across a plane picture, or equal angles about the sensor",
                    .choices = {"pinhole", "spherical"}});
    keys.push_back({.name = "measures",
                    .type = KeyType::Choice,
                    .help = "what its limits and noise are about: distance along the ray, or depth "
                            "along the axis",
                    .choices = {"distance", "depth"}});
    keys.push_back(
        {.name = "ambiguity",
         .type = KeyType::Number,
         .unit = Unit::Length,
         .help = "distances are measured modulo this, however far things are; 0: in full",
         .lower = 0,
         .upper = kFarthest});
    addNoiseKeys(keys);
}

void addUltrasoundFigures(std::vector<KeySpec>& keys) {
    keys.push_back(rangeKey("least and greatest distance heard, or the greatest alone"));
    keys.push_back(
        positiveKey("fov", Unit::Angle, "full angle of the cone in which it hears", 360));
    keys.push_back(positiveKey("rate", Unit::Frequency, "measurements a second", kMostOften));
    addNoiseKeys(keys);
}

void addTagFigures(std::vector<KeySpec>& keys) {
    keys.push_back(positiveKey("rate", Unit::Frequency, "bursts a second", kMostOften));
    keys.push_back(
        positiveKey("fov", Unit::Angle, "full angle of the cone into which it emits", 360));
    keys.push_back({.name = "locate",
                    .type = KeyType::Choice,
                    .help = "by times of flight to receivers, or simply where it is, give or take",
                    .choices = {"flight", "simple"}});
    keys.push_back({.name = "sigma",
                    .type = KeyType::Number,
                    .unit = Unit::Length,
                    .help = "of locate=simple: standard deviation of x and of y, with scan --noise",
                    .lower = 0,
                    .upper = 1e3});
}

std::vector<Schema> sensorSchemas() {
    return {sensorSchema("laser", "planar laser range finder; bare: range=0,5 fov=180 step=1",
                         "direction of bearing 0, from +x", addLaserFigures),
            sensorSchema("ranger", "3-D range camera; bare: range=0,5 fov=47.5,39.6 pixels=176,144",
                         "direction of its axis, from +x", addRangerFigures),
            sensorSchema("camera", "camera; bare: fov=45 pixels=640,480",
                         "direction of its axis, from +x", addCameraFigures),
            sensorSchema("ultrasound", "ultrasonic receiver; bare: range=8 fov=120",
                         "direction of its axis, from +x", addUltrasoundFigures),
            sensorSchema("tag", "ultrasonic emitter, to be located", "where it faces, from +x",
                         addTagFigures)};
}

}  // namespace ispace
