// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "env/element_keys.h"
#include "env/projector_model.h"

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

constexpr double kTurn = 180, kUpright = 90;

Schema projectorSchema() {
    KeySpec facing = heading();
    facing.help = "direction that it faces at pan=0, from +x";
    std::vector<KeySpec> keys = {
        {.name = "model",
         .type = KeyType::Word,
         .help = "device of the catalogue that gives the parameters not written"},
        floorAt(),
        height(2.2, "height of its lens above the floor"),
        std::move(facing),
        flag("on", "it shines"),
        levelKey(),
        lightColorKey({1, 1, 1}),
        number("pan", Unit::Angle, "turn of its axis to the left of its heading, within pan_range",
               0, -kTurn, kTurn),
        number("tilt", Unit::Angle, "turn of its axis upwards, within tilt_range", 0, -kUpright,
               kUpright)};
    addProjectorParameters(keys);
    keys.push_back(texture("that it throws, through which its light passes"));
    return schemaOf("projector", RecordType::Infra,
                    "a projector that turns, whose picture or plain light pictures show on walls, "
                    "floor and people; it has no body; bare: pixels=1280,720 fov=36,21 lumens=1000",
                    std::move(keys));
}

}  // namespace

}  // namespace ispace::keys

namespace ispace {

void addProjectorParameters(std::vector<KeySpec>& keys) {
    constexpr double kMinAngle = 0.1, kMaxAngle = 170, kMaxPixels = 16384;
    constexpr double kMinThrow = 0.05, kMaxThrow = 500, kMaxLumens = 1e6;
    keys.push_back({.name = "pixels",
                    .type = KeyType::Tuple,
                    .help = "columns,rows of its picture",
                    .min_count = 2,
                    .max_count = 2,
                    .lower = 1,
                    .upper = kMaxPixels,
                    .whole = true});
    keys.push_back({.name = "fov",
                    .type = KeyType::Tuple,
                    .unit = Unit::Angle,
                    .help = "full angles of its light across and upright; one number is across, "
                            "with square pixels",
                    .min_count = 1,
                    .max_count = 2,
                    .lower = kMinAngle,
                    .upper = kMaxAngle});
    keys.push_back({.name = "throw",
                    .type = KeyType::Number,
                    .help = "instead of fov: distance of a wall over the width of the picture on "
                            "it, with square pixels",
                    .lower = kMinThrow,
                    .upper = kMaxThrow});
    keys.push_back({.name = "lumens",
                    .type = KeyType::Number,
                    .help = "its full light, lumens",
                    .lower = 0,
                    .upper = kMaxLumens});
    const auto range = [&keys](std::string name, std::string help, double most) {
        keys.push_back({.name = std::move(name),
                        .type = KeyType::Tuple,
                        .unit = Unit::Angle,
                        .help = std::move(help),
                        .min_count = 2,
                        .max_count = 2,
                        .lower = -most,
                        .upper = most});
    };
    range("pan_range", "least,greatest pan; -180,180 without it, 0,0 for one that stays", 180);
    range("tilt_range", "least,greatest tilt; -90,90 without it", 90);
}

}  // namespace ispace

namespace ispace::keys {

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
