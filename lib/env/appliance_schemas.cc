// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "env/element_keys.h"

namespace ispace::keys {

namespace {

KeySpec levelKey() { return number("level", Unit::Share, "share of its full light", 1, 0, 1); }

KeySpec lightColorKey(Tuple standard) {
    return {.name = "color",
            .type = KeyType::Tuple,
            .help = "red,green,blue of its light, each from 0 to 1",
            .default_value = std::move(standard),
            .min_count = 3,
            .max_count = 3,
            .lower = 0,
            .upper = 1};
}

Schema projectorSchema() {
    constexpr double kMinAngle = 0.1, kMaxAngle = 170;
    KeySpec facing = heading();
    facing.help = "direction that it faces at pan=0, from +x";
    KeySpec fov{.name = "fov",
                .type = KeyType::Tuple,
                .unit = Unit::Angle,
                .help = "full angles of its light across and upright",
                .default_value = Tuple{36, 21},
                .min_count = 2,
                .max_count = 2,
                .lower = kMinAngle,
                .upper = kMaxAngle};
    return schemaOf(
        "projector", RecordType::Infra,
        "a projector that turns, whose picture or plain light pictures show on walls, "
        "floor and people; it has no body",
        {floorAt(), height(2.2, "height of its lens above the floor"), std::move(facing),
         flag("on", "it shines"), levelKey(), lightColorKey({1, 1, 1}),
         number("pan", Unit::Angle, "turn of its axis to the left of its heading", 0, -180, 180),
         number("tilt", Unit::Angle, "turn of its axis upwards", 0, -90, 90), std::move(fov),
         number("lumens", Unit::None, "its full light, lumens", 1000, 0, 1e6),
         texture("that it throws, through which its light passes")});
}

}  // namespace

void addAppliances(std::vector<Schema>& out) {
    KeySpec sides = heading();
    sides.help = "direction of two of its sides, counter-clockwise from +x";
    out.push_back(schemaOf(
        "lamp", RecordType::Infra,
        "a panel of light in the ceiling, 0.7 m square, which pictures show: with lamps the "
        "room has no other light than these",
        {floorAt(), std::move(sides), flag("on", "it shines"), levelKey(),
         lightColorKey({1, 1, 0.97}),
         number("lumens", Unit::None, "its full light for light meters, lumens", 3600, 0, 1e6)}));
    out.push_back(projectorSchema());
    KeySpec power = levelKey();
    power.help = "share of its full power";
    out.push_back(schemaOf("heater", RecordType::Infra,
                           "a heater, which warms the zones of thermometers; it has no body",
                           {floorAt(), flag("on", "it heats"), std::move(power),
                            number("watts", Unit::None, "its full power, W", 1000, 0, 1e6)}));
    out.push_back(schemaOf(
        "speaker", RecordType::Infra, "a speaker, which microphones hear; it has no body",
        {floorAt(), height(1, "height above the floor"), flag("on", "it sounds"),
         number("volume", Unit::None, "sound pressure level at a metre, dB", 70, 0, 200)}));
    out.push_back(schemaOf(
        "panel", RecordType::Infra,
        "a panel at which the cables of sensors end, for the sheets of reports; it has no body",
        {floorAt(), height(1.5, "height above the floor"),
         number("cost", Unit::None, "of a metre of cable, in any currency", 0, 0, 1e6)}));
    out.push_back(
        schemaOf("switch", RecordType::Infra,
                 "a switch on a wall, which clients press and watch; it switches no lamp "
                 "by itself",
                 {floorAt(), heading(), height(1.05, "height of its middle above the floor"),
                  flag("on", "it is on")}));
}

}  // namespace ispace::keys
