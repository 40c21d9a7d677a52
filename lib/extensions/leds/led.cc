// SPDX-License-Identifier: GPL-3.0-or-later
// The glow is emission for pictures alone: an LED casts no light on the room, and lux meters do not
// see it.
#include "extensions/leds/led.h"

#include <utility>

#include "env/body.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace::leds {

namespace {

constexpr double kSize = 0.02, kMostSize = 1, kHeight = 0.3;

}  // namespace

std::vector<Schema> ledSchemas() {
    return {{.keyword = "led",
             .type = RecordType::Placement,
             .help = "a small light that programs switch, and that pictures of cameras show in its "
                     "colour; it lights no room",
             .keys = {
                 idKey(),
                 {.name = "on", .type = KeyType::Flag, .help = "it shines", .default_value = false},
                 {.name = "of",
                  .type = KeyType::Word,
                  .help = "id of the robot or object that carries it: `at` and `heading` are in "
                          "its frame, z counts from the floor or from the object's top",
                  .role = Role::Carrier},
                 {.name = "at",
                  .type = KeyType::Tuple,
                  .unit = Unit::Length,
                  .help = "x,y,z of its middle",
                  .default_value = Tuple{0, 0, kHeight},
                  .min_count = 3,
                  .max_count = 3,
                  .lower = -kMaxDistance,
                  .upper = kMaxDistance,
                  .role = Role::Place},
                 {.name = "heading",
                  .type = KeyType::Number,
                  .unit = Unit::Angle,
                  .help = "direction of its sides",
                  .default_value = 0.0,
                  .lower = -kMaxDistance,
                  .upper = kMaxDistance,
                  .role = Role::Heading},
                 {.name = "color",
                  .type = KeyType::Tuple,
                  .help = "red,green,blue of its light, each from 0 to 1",
                  .default_value = Tuple{0, 1, 0},
                  .min_count = 3,
                  .max_count = 3,
                  .lower = 0,
                  .upper = 1},
                 {.name = "size",
                  .type = KeyType::Number,
                  .unit = Unit::Length,
                  .help = "of its sides",
                  .default_value = kSize,
                  .lower = 0,
                  .upper = kMostSize,
                  .lower_open = true}}}};
}

ThingBody ledBody(const Record& record) {
    const double half = record.number("size") / 2;
    Body cube;
    cube.prisms.push_back({.footprint = rectangle({0, 0}, 2 * half, 2 * half, {}),
                           .bottom = -half,
                           .top = half,
                           .material = Material::Sensor});
    ThingBody body{meshesOf(cube, Surfaces::Drawn)};
    if (!record.flag("on")) return body;
    const Tuple& color = record.tuple("color");
    body.glow = {static_cast<float>(color[0]), static_cast<float>(color[1]),
                 static_cast<float>(color[2])};
    return body;
}

void addLeds() { addThingKind("led", {.states = {"on", "color"}, .body = ledBody}); }

}  // namespace ispace::leds
