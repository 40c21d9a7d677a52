// SPDX-License-Identifier: GPL-3.0-or-later
#include "site/building_schemas.h"

#include <string>
#include <utility>

#include "scene/sensor/sensor_keys.h"

namespace ispace {

namespace {

/// Metres; metres a second.
constexpr double kMaxSize = 1000, kFastest = 100;

KeySpec pointKey(std::string help, bool required) {
    KeySpec key{.name = "at",
                .type = KeyType::Tuple,
                .unit = Unit::Length,
                .help = std::move(help),
                .min_count = 2,
                .max_count = 2,
                .lower = -kMaxDistance,
                .upper = kMaxDistance,
                .required = required,
                .role = Role::Place};
    if (!required) key.default_value = Tuple{0, 0};
    return key;
}

KeySpec sizeKey(std::string help) {
    return {.name = "size",
            .type = KeyType::Tuple,
            .unit = Unit::Length,
            .help = std::move(help),
            .min_count = 2,
            .max_count = 2,
            .lower = 0,
            .upper = kMaxSize,
            .lower_open = true,
            .required = true};
}

KeySpec storeysKey() {
    return {.name = "storeys",
            .type = KeyType::Text,
            .help = "ids of the storeys that it joins, such as ground,upper",
            .required = true};
}

Schema storeySchema() {
    KeySpec z{.name = "z",
              .type = KeyType::Number,
              .unit = Unit::Length,
              .help = "height of its floor in the building",
              .default_value = 0.0,
              .lower = -kMaxDistance,
              .upper = kMaxDistance};
    return {.keyword = "storey",
            .type = RecordType::Space,
            .help = "a storey: a room of its own, in a file or below it",
            .keys = {idKey(),
                     {.name = "name", .type = KeyType::Text, .help = "as people call it"},
                     {.name = "file",
                      .type = KeyType::Text,
                      .help = "its room, in any format that envc reads; relative to the folder of "
                              "the building",
                      .role = Role::File},
                     std::move(z),
                     positiveKey("height", Unit::Length,
                                 "from its floor to that above; its highest wall where left out",
                                 kMaxSize),
                     pointKey("origin of its room in the building, x,y", false),
                     headingKey("direction of the room's x axis in the building")}};
}

Schema stairsSchema() {
    KeySpec top = pointKey("point x,y at which it ends above; straight ahead where left out", true);
    top.name = "top";
    top.required = false;
    return {.keyword = "stairs",
            .type = RecordType::Infra,
            .help = "a flight of stairs from each of its storeys to the next one above",
            .keys = {idKey(), storeysKey(),
                     pointKey("middle of the edge of the lowest step, x,y in the building", true),
                     headingKey("direction in which it rises"),
                     sizeKey("width,length: across and along the heading"), std::move(top)}};
}

Schema liftSchema() {
    KeySpec speed = positiveKey("speed", Unit::Length, "metres a second", kFastest);
    speed.default_value = 1.0;
    constexpr double kSlowest = 0.01;
    speed.lower = kSlowest;
    speed.lower_open = false;
    return {.keyword = "lift",
            .type = RecordType::Infra,
            .help = "a lift that stops at its storeys",
            .keys = {idKey(),
                     storeysKey(),
                     pointKey("centre of the cabin, x,y in the building", true),
                     headingKey("direction in which one leaves through its door"),
                     sizeKey("width,length of the cabin: across and along the heading"),
                     positiveKey("door", Unit::Length, "width of its door", kMaxSize),
                     std::move(speed),
                     {.name = "capacity",
                      .type = KeyType::Word,
                      .help = "greatest load in kilograms, such as 630kg"}}};
}

Schema shaftSchema() {
    return {.keyword = "shaft",
            .type = RecordType::Infra,
            .help = "an opening through the floors of its storeys but the lowest",
            .keys = {idKey(),
                     storeysKey(),
                     {.name = "path",
                      .type = KeyType::TupleList,
                      .unit = Unit::Length,
                      .help = "corners of its outline, x,y in the building",
                      .min_count = 2,
                      .max_count = 2,
                      .lower = -kMaxDistance,
                      .upper = kMaxDistance,
                      .required = true,
                      .role = Role::Place}}};
}

}  // namespace

const Schemas& buildingSchemas() {
    static const Schemas schemas({storeySchema(), stairsSchema(), liftSchema(), shaftSchema()});
    return schemas;
}

}  // namespace ispace
