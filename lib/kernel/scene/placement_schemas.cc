// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/placement_schemas.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <string_view>
#include <utility>

#include "env/element_schemas.h"
#include "scene/element_device.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace {

namespace {

/// Limits above any robot: metres, metres a second (a second), degrees a second (a second).
constexpr double kMaxSize = 100, kFastest = 1000, kFastestTurn = 1e5;
/// Kilograms.
constexpr double kMaxMass = 1e5;

/// Adds the keys of motion and odometry errors, for simrun --noise.
void addStrayKeys(std::vector<KeySpec>& keys) {
    constexpr double kMaxError = 100;
    const auto alphas = [&](std::string name, std::string help) {
        keys.push_back({.name = std::move(name),
                        .type = KeyType::Tuple,
                        .help = std::move(help),
                        .min_count = 4,
                        .max_count = 4,
                        .lower = 0,
                        .upper = kMaxError});
    };
    alphas("motion_noise", "alpha 1 to 4 of the robot's motion relative to that of its wheels");
    alphas("odometry_noise",
           "alpha 1 to 4 of the robot's odometry relative to the motion of its wheels");
    keys.push_back({.name = "start_noise",
                    .type = KeyType::Tuple,
                    .help = "standard deviation of x and y in metres, and of the heading in "
                            "degrees, at the start",
                    .min_count = 1,
                    .max_count = 2,
                    .lower = 0,
                    .upper = kMaxError});
}

/// Adds the keys of a robot's contact sensors.
void addContactKeys(std::vector<KeySpec>& keys) {
    constexpr double kMaxLength = 1000;
    constexpr double kTurn = 360, kMaxCone = 90;
    const auto list = [&](std::string name, std::string help, std::size_t count) {
        keys.push_back({.name = std::move(name),
                        .type = KeyType::TupleList,
                        .help = std::move(help),
                        .min_count = count,
                        .max_count = count,
                        .lower = -kTurn,
                        .upper = kTurn});
    };
    list("sonar", "its sonars: x,y in metres from the centre of rotation, bearing in degrees", 3);
    keys.push_back({.name = "sonar_range",
                    .type = KeyType::Tuple,
                    .unit = Unit::Length,
                    .help = "least and greatest distance that they measure, or the greatest alone",
                    .min_count = 1,
                    .max_count = 2,
                    .lower = 0,
                    .upper = kMaxLength});
    keys.push_back(
        positiveKey("sonar_fov", Unit::Angle, "full angle of the cone of a sonar", kMaxCone));
    list("bumpers", "parts of its rim that feel: bearings from,to in degrees, counter-clockwise",
         2);
}

/// Adds the parameters that a model may give; without defaults, as a missing key means "as the
/// model".
/// Speeds are lengths and angles a second, with the suffixes of those.
void addRobotParameters(std::vector<KeySpec>& keys) {
    keys.push_back(positiveKey("radius", Unit::Length,
                               "of the circle about the centre of rotation that collides",
                               kMaxSize));
    keys.push_back({.name = "size",
                    .type = KeyType::Tuple,
                    .unit = Unit::Length,
                    .help = "length,width[,height] of the body; without it a cylinder of radius",
                    .min_count = 2,
                    .max_count = 3,
                    .lower = 0,
                    .upper = kMaxSize,
                    .lower_open = true});
    keys.push_back({.name = "center",
                    .type = KeyType::Number,
                    .unit = Unit::Length,
                    .help = "how far the middle of the body lies ahead of the centre of rotation",
                    .lower = -kMaxSize,
                    .upper = kMaxSize});
    keys.push_back(
        positiveKey("height", Unit::Length, "height of the body, unless size holds it", kMaxSize));
    keys.push_back(
        positiveKey("speed", Unit::Length, "metres a second of FORWARD and BACKWARD", kFastest));
    keys.push_back(
        positiveKey("rotspeed", Unit::Angle, "degrees a second of LEFT and RIGHT", kFastestTurn));
    keys.push_back(
        positiveKey("max_speed", Unit::Length, "greatest speed, metres a second", kFastest));
    keys.push_back(positiveKey("max_rotspeed", Unit::Angle,
                               "greatest speed of turning, degrees a second", kFastestTurn));
    keys.push_back(positiveKey("accel", Unit::Length,
                               "speeding up and braking, metres a second a second", kFastest));
    keys.push_back(positiveKey("rotaccel", Unit::Angle,
                               "the same for turning, degrees a second a second", kFastestTurn));
    keys.push_back({.name = "drive",
                    .type = KeyType::Choice,
                    .help = "two driven wheels, or omnidirectional: sideways, too",
                    .choices = {"differential", "omni"}});
    keys.push_back({.name = "p2os",
                    .type = KeyType::Choice,
                    .help = "type of Pioneer that programs for such robots find (simrun --p2os)",
                    .choices = {"p3dx-sh", "p3dx", "p2dx", "p3at-sh", "p3at"}});
    keys.push_back(positiveKey("max_sidespeed", Unit::Length,
                               "greatest speed to a side with drive=omni, metres a second; "
                               "without it max_speed",
                               kFastest));
    keys.push_back({.name = "wheels",
                    .type = KeyType::Tuple,
                    .unit = Unit::Length,
                    .help = "radius,track of the driven wheels, for their joints in URDF; without "
                            "it by the size of the body",
                    .min_count = 2,
                    .max_count = 2,
                    .lower = 0,
                    .upper = kMaxSize,
                    .lower_open = true});
    addStrayKeys(keys);
    addContactKeys(keys);
}

/// Creates the key of a fixed point on the floor, 0,0 by default.
KeySpec floorAtKey(std::string help) {
    return {.name = "at",
            .type = KeyType::Tuple,
            .unit = Unit::Length,
            .help = std::move(help),
            .default_value = Tuple{0, 0},
            .min_count = 2,
            .max_count = 2,
            .lower = -kMaxDistance,
            .upper = kMaxDistance,
            .role = Role::Place};
}

/// Adds the keys of autonomous motion.
void addCourse(std::vector<KeySpec>& keys) {
    keys.push_back({.name = "path",
                    .type = KeyType::TupleList,
                    .unit = Unit::Length,
                    .help = "points x,y of the way, one after another",
                    .min_count = 2,
                    .max_count = 2,
                    .lower = -kMaxDistance,
                    .upper = kMaxDistance,
                    .role = Role::MotionPlan});
    keys.push_back({.name = "trip",
                    .type = KeyType::Text,
                    .help = "points of a building, such as 3,4;upper/1,2, to which it goes by "
                            "stairs and lifts"});
    keys.push_back({.name = "loop",
                    .type = KeyType::Flag,
                    .help = "from the last point of path or trip to the first, again and again",
                    .default_value = false});
    KeySpec pause{.name = "pause",
                  .type = KeyType::Number,
                  .unit = Unit::Time,
                  .help = "to stay at each point of path or trip",
                  .default_value = 0.0,
                  .lower = 0,
                  .upper = 1e6};
    keys.push_back(std::move(pause));
    keys.push_back({.name = "walk",
                    .type = KeyType::Choice,
                    .help = "stand until a client drives it, or wander about; after path, if both "
                            "are given",
                    .default_value = "stand",
                    .choices = {"stand", "wander"}});
}

Schema robotSchema() {
    Schema schema{.keyword = "robot",
                  .type = RecordType::Placement,
                  .help = "a robot on wheels; bare: a cylinder of radius 0.3",
                  .keys = {}};
    schema.keys.push_back(idKey());
    schema.keys.push_back(modelKey());
    schema.keys.push_back(floorAtKey("centre of rotation x,y at the start"));
    schema.keys.push_back(headingKey("where it faces at the start, from +x"));
    addRobotParameters(schema.keys);
    schema.keys.push_back({.name = "climbs",
                           .type = KeyType::Flag,
                           .help = "it goes on stairs, as people do",
                           .default_value = false});
    KeySpec mass = positiveKey("mass", Unit::None, "kilograms, for lifts", kMaxMass);
    mass.default_value = 20.0;
    schema.keys.push_back(std::move(mass));
    schema.keys.push_back(tagKey());
    addCourse(schema.keys);
    return schema;
}

Schema humanSchema() {
    Schema schema{.keyword = "human",
                  .type = RecordType::Placement,
                  .help = "a person; legs are two circles at scanning height",
                  .keys = {}};
    schema.keys.push_back(idKey());
    schema.keys.push_back(floorAtKey("where the person stands at the start"));
    schema.keys.push_back(headingKey("where the person faces at the start, from +x"));
    KeySpec height = positiveKey("height", Unit::Length, "of the person", 3);
    height.default_value = 1.7;
    schema.keys.push_back(std::move(height));
    KeySpec speed = positiveKey("speed", Unit::Length, "metres a second when walking", 20);
    speed.default_value = 1.2;
    schema.keys.push_back(std::move(speed));
    schema.keys.push_back(tagKey());
    schema.keys.push_back(
        {.name = "prefers",
         .type = KeyType::Text,
         .help =
             "the light (lux) and the temperature (degrees Celsius) that the person likes, as in "
             "light:300;temp:21, for programs that serve it"});
    addCourse(schema.keys);
    return schema;
}

KeySpec areaSizeKey(std::string help, Tuple standard) {
    return {.name = "size",
            .type = KeyType::Tuple,
            .unit = Unit::Length,
            .help = std::move(help),
            .default_value = std::move(standard),
            .min_count = 2,
            .max_count = 2,
            .lower = 0,
            .upper = kMaxDistance,
            .lower_open = true};
}

KeySpec rateKey() {
    KeySpec rate = positiveKey("rate", Unit::Frequency, "readings a second", kMaxRate);
    rate.default_value = 10.0;
    return rate;
}

Schema matSchema() {
    return {.keyword = "mat",
            .type = RecordType::Placement,
            .help = "a pressure mat on the floor: reports the robots and people on it",
            .keys = {idKey(), floorAtKey("centre x,y"), headingKey("direction of the length"),
                     areaSizeKey("length,width", {1, 1}), rateKey()}};
}

Schema gateSchema() {
    KeySpec height =
        positiveKey("height", Unit::Length, "of the beam above the floor", kMaxDistance);
    height.default_value = 0.5;
    KeySpec width = positiveKey("width", Unit::Length, "distance between its posts", kMaxDistance);
    width.default_value = 1.0;
    return {.keyword = "gate",
            .type = RecordType::Placement,
            .help = "a light gate: reports bodies between its posts",
            .keys = {idKey(), floorAtKey("middle between the posts"),
                     headingKey("direction in which one passes"), std::move(width),
                     std::move(height), rateKey()}};
}

Schema environmentSchema() {
    return {.keyword = "environment",
            .type = RecordType::Meta,
            .help = "the environment a layout was made for",
            .keys = {idKey(),
                     {.name = "file",
                      .type = KeyType::Text,
                      .help = "its file, relative to the folder of the layout",
                      .role = Role::File},
                     {.name = "digest",
                      .type = KeyType::Text,
                      .help = "sha256: and 64 hex digits over its records"}}};
}

Schema resultSchema() {
    const auto share = [](std::string name, std::string help) {
        return KeySpec{.name = std::move(name),
                       .type = KeyType::Number,
                       .unit = Unit::Share,
                       .help = std::move(help),
                       .lower = 0,
                       .upper = 1};
    };
    return {
        .keyword = "result",
        .type = RecordType::Meta,
        .help = "how good a layout is, and how it was found",
        .keys = {
            idKey(),
            share("coverage", "covered share of the target"),
            {.name = "area",
             .type = KeyType::Number,
             .unit = Unit::Area,
             .help = "total effective area, eq. (4.6)",
             .lower = 0},
            share("value",
                  "weighted share of the required floor (zones, weights, redundancy), or of the "
                  "objective, if that is not the coverage; with proof=poses the share of exact "
                  "area"),
            {.name = "objective",
             .type = KeyType::Word,
             .help =
                 "subject of `value`: path (seen share of the shortest way), localise (1 "
                 "less the mean error), track (1 less the share of the loss); floor without it"},
            share("bound",
                  "upper bound on the value, or on the coverage without a value: of layouts of the "
                  "candidates or, after refinement, of any poses"),
            share("candidates_bound",
                  "where sensors were refined: the same of the candidates, proven before"),
            {.name = "strategy", .type = KeyType::Word, .help = "strategy that proposed the sites"},
            {.name = "optimize", .type = KeyType::Word, .help = "how they were chosen"},
            {.name = "candidates",
             .type = KeyType::Number,
             .help = "poses to choose from, of all kinds of sensors",
             .lower = 0,
             .whole = true},
            {.name = "least",
             .type = KeyType::Number,
             .help = "no fewer sensors reach the target (no less cost, with a budget or costs)",
             .lower = 0},
            {.name = "proof",
             .type = KeyType::Word,
             .help = "poses: `least` (without a target, `bound`) holds over all poses"},
            {.name = "witnesses",
             .type = KeyType::TupleList,
             .unit = Unit::Length,
             .help = "x,y of points that no fewer than `least` sensors see in any poses",
             .min_count = 2,
             .max_count = 2},
            {.name = "complete",
             .type = KeyType::Flag,
             .help = "no if a time limit or a signal cut the search",
             .default_value = true}}};
}

}  // namespace

std::vector<Schema> layoutSchemas() {
    std::vector<Schema> schemas = sensorSchemas();
    std::vector<Schema> others = {matSchema(),   gateSchema(),        robotSchema(),
                                  humanSchema(), environmentSchema(), resultSchema()};
    std::move(others.begin(), others.end(), std::back_inserter(schemas));
    return schemas;
}

std::vector<Schema> deviceSchemas() {
    std::vector<Schema> schemas = sensorDeviceSchemas();
    schemas.push_back(deviceSchema("robot", "a robot one can buy", addRobotParameters));
    for (const ElementDevice* element : elementDevices())
        schemas.push_back(deviceSchema(std::string(element->keyword),
                                       std::string(element->device_help), element->add_keys));
    return schemas;
}

namespace {

const KeySpec* carrierKey(const Schema& schema) {
    const auto found = std::find_if(schema.keys.begin(), schema.keys.end(),
                                    [](const KeySpec& key) { return key.role == Role::Carrier; });
    return found == schema.keys.end() ? nullptr : &*found;
}

}  // namespace

bool mayBeCarried(const Schema& schema) { return carrierKey(schema) != nullptr; }

std::string carrierOf(const Record& record) {
    const KeySpec* const key = carrierKey(record.schema());
    return key == nullptr || !record.has(key->name) ? "" : record.text(key->name);
}

namespace {

std::vector<Schema>& addedSchemas() {
    static std::vector<Schema> added;
    return added;
}

struct AddedKeys {
    std::string keyword;
    std::vector<KeySpec> keys;
};

std::vector<AddedKeys>& addedKeys() {
    static std::vector<AddedKeys> added;
    return added;
}

}  // namespace

void addSceneSchemas(std::vector<Schema> schemas) {
    std::move(schemas.begin(), schemas.end(), std::back_inserter(addedSchemas()));
}

void addSceneKeys(std::string_view keyword, std::vector<KeySpec> keys) {
    addedKeys().push_back({std::string(keyword), std::move(keys)});
}

const Schemas& sceneSchemas() {
    static const Schemas schemas = [] {
        std::vector<Schema> all = environmentSchemas();
        std::vector<Schema> placements = layoutSchemas();
        std::move(placements.begin(), placements.end(), std::back_inserter(all));
        std::copy(addedSchemas().begin(), addedSchemas().end(), std::back_inserter(all));
        for (const AddedKeys& added : addedKeys()) {
            const auto of = std::find_if(all.begin(), all.end(), [&added](const Schema& schema) {
                return schema.keyword == added.keyword;
            });
            assert(of != all.end());
            of->keys.insert(of->keys.end(), added.keys.begin(), added.keys.end());
        }
        return Schemas(std::move(all));
    }();
    return schemas;
}

}  // namespace ispace
