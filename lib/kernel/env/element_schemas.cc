// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/element_schemas.h"

#include <utility>

#include "env/element_keys.h"

namespace ispace {

namespace {

/// Limit of coordinates, in metres; doubles still resolve micrometres there.
constexpr double kMaxDistance = 1e6;

KeySpec idKey() {
    return {.name = "id",
            .type = KeyType::Word,
            .help = "name of the element; the keyword and a number where left out"};
}

KeySpec lengths(std::string name, std::string help, std::size_t min_count, std::size_t max_count) {
    return {.name = std::move(name),
            .type = KeyType::Tuple,
            .unit = Unit::Length,
            .help = std::move(help),
            .min_count = min_count,
            .max_count = max_count,
            .lower = -kMaxDistance,
            .upper = kMaxDistance};
}

KeySpec pointKey(std::string name, std::string help) {
    KeySpec key = lengths(std::move(name), std::move(help), 2, 2);
    key.role = Role::Place;
    return key;
}

KeySpec atKey() {
    KeySpec key = lengths("at", "centre of the footprint x,y and height of the underside z", 2, 3);
    key.role = Role::Place;
    key.default_value = Tuple{0, 0};
    return key;
}

/// Returns the key of extents, each above 0.
KeySpec sizeKey(std::string help, std::size_t min_count, std::size_t max_count) {
    KeySpec key = lengths("size", std::move(help), min_count, max_count);
    key.lower = 0;
    key.lower_open = true;
    return key;
}

KeySpec sizeKey(std::string help, std::size_t min_count, std::size_t max_count, Tuple standard) {
    KeySpec key = sizeKey(std::move(help), min_count, max_count);
    key.default_value = std::move(standard);
    return key;
}

KeySpec heightKey(std::string help = "height, unless size holds it") {
    return {.name = "height",
            .type = KeyType::Number,
            .unit = Unit::Length,
            .help = std::move(help),
            .lower = 0,
            .upper = kMaxDistance,
            .lower_open = true};
}

}  // namespace

namespace keys {

KeySpec floorAt() {
    KeySpec key = pointKey("at", "centre x,y");
    key.default_value = Tuple{0, 0};
    return key;
}

KeySpec heading() {
    return {.name = "heading",
            .type = KeyType::Number,
            .unit = Unit::Angle,
            .help = "direction of the length, counter-clockwise from +x",
            .default_value = 0.0,
            .lower = -kMaxDistance,
            .upper = kMaxDistance,
            .role = Role::Heading};
}

KeySpec height(double standard, std::string help) {
    KeySpec key = heightKey(std::move(help));
    key.default_value = standard;
    return key;
}

KeySpec flag(std::string name, std::string help) {
    return {.name = std::move(name),
            .type = KeyType::Flag,
            .help = std::move(help),
            .default_value = false};
}

KeySpec texture(const std::string& where) {
    return {.name = "texture",
            .type = KeyType::Text,
            .help = "picture " + where +
                    ", edge to edge: PNG, JPEG and others, relative to the folder of this file",
            .role = Role::File};
}

Schema schemaOf(std::string keyword, RecordType type, std::string help, std::vector<KeySpec> keys) {
    keys.insert(keys.begin(), idKey());
    return {std::move(keyword), type, std::move(help), std::move(keys)};
}

KeySpec number(std::string name, Unit unit, std::string help, double standard, double lower,
               double upper) {
    return {.name = std::move(name),
            .type = KeyType::Number,
            .unit = unit,
            .help = std::move(help),
            .default_value = standard,
            .lower = lower,
            .upper = upper};
}

}  // namespace keys

namespace {

KeySpec thicknessKey(std::string help) {
    return {.name = "thickness",
            .type = KeyType::Number,
            .unit = Unit::Length,
            .help = std::move(help),
            .default_value = 0.0,
            .lower = 0,
            .upper = kMaxDistance};
}

KeySpec kindKey(std::string help, std::vector<std::string> choices) {
    KeySpec key{.name = "kind", .type = KeyType::Choice, .help = std::move(help)};
    key.default_value = choices.front();
    key.choices = std::move(choices);
    return key;
}

KeySpec textKey(std::string name, std::string help) {
    return {.name = std::move(name), .type = KeyType::Text, .help = std::move(help)};
}

KeySpec pathKey(std::string help) {
    KeySpec key = lengths("path", std::move(help), 2, 2);
    key.type = KeyType::TupleList;
    key.role = Role::Place;
    return key;
}

}  // namespace

KeySpec tagKey() {
    return {.name = "tag",
            .type = KeyType::Word,
            .help = "its tag, which sensors such as `rfid` readers list"};
}

namespace {

/// Returns the keys of a zone's heat, for thermometers.
std::vector<KeySpec> heatKeys() {
    constexpr double kMinValue = 1e-3;  // keeps the temperature finite
    return {
        keys::number("celsius", Unit::None, "its temperature at the start, degrees Celsius", 20,
                     -100, 100),
        keys::number("storage", Unit::None,
                     "heat that its air and walls store, kJ/K for a square metre", 165, kMinValue,
                     1e4),
        keys::number("loss", Unit::None,
                     "heat that it loses to the outside, W/K for a square metre, all windows shut",
                     1.5, kMinValue, 1e4)};
}

void addSpaces(std::vector<Schema>& out) {
    out.push_back(keys::schemaOf(
        "ispace", RecordType::Space, "a room: floor and four walls",
        {keys::floorAt(), keys::heading(),
         sizeKey("length,width[,height] of the room", 2, 3, {8, 8}), keys::height(kWallHeight),
         keys::flag("ceiling", "close it with a ceiling")}));
    KeySpec inside_at = pointKey("at", "the point x,y");
    inside_at.required = true;
    out.push_back(keys::schemaOf("inside", RecordType::Space,
                                 "a point known to be inside the room; several make several rooms",
                                 {std::move(inside_at)}));
    Schema zone = keys::schemaOf("zone", RecordType::Space,
                                 "a part of the floor, called by its id: a polygon or a rectangle",
                                 {pathKey("corners of the polygon, three or more"), keys::floorAt(),
                                  keys::heading(), sizeKey("length,width of the rectangle", 2, 2),
                                  textKey("number", "number of the room, as on its door"),
                                  textKey("name", "name of the room")});
    for (KeySpec& key : heatKeys()) zone.keys.push_back(std::move(key));
    out.push_back(std::move(zone));
    out.push_back(keys::schemaOf(
        "weather", RecordType::Space,
        "the weather outside, for thermometers: scripts and clients may change it",
        {keys::number("celsius", Unit::None, "of the air, degrees Celsius", 10, -100, 100),
         keys::number("sun", Unit::None, "that falls on each window, W for a square metre", 0, 0,
                      1500)}));
}

void addFloors(std::vector<Schema>& out) {
    KeySpec friction{.name = "friction",
                     .type = KeyType::Number,
                     .help = "share by which robots are slowed down on it",
                     .default_value = 0.0,
                     .lower = 0,
                     .upper = 1};
    out.push_back(keys::schemaOf(
        "floor", RecordType::Floor, "a covering of a part of the floor",
        {keys::floorAt(), keys::heading(), sizeKey("length,width of the covering", 2, 2, {8, 8}),
         kindKey("one colour, or squares in two", {"plain", "checker"}), std::move(friction),
         keys::texture(
             "that covers it once, its lower edge along the length, its top to the left of "
             "the heading")}));
}

void addWalls(std::vector<Schema>& out) {
    // The bound of 0 holds for all numbers, since a thickness of 0 is usual; the body rejects zeros
    // in the others.
    KeySpec wall_size = lengths("size", "length[,thickness[,height]]", 1, 3);
    wall_size.lower = 0;
    out.push_back(keys::schemaOf(
        "wall", RecordType::Wall, "a straight wall, by its ends or by centre and length",
        {pointKey("from", "one end of the mid-line"), pointKey("to", "the other end"), atKey(),
         keys::heading(), std::move(wall_size), keys::height(kWallHeight),
         thicknessKey("thickness, unless size holds it"),
         kindKey("material", {"plain", "brick", "wood", "concrete"}),
         keys::texture("that covers each of its two faces once, upright, from neither side "
                       "mirrored")}));
    out.push_back(keys::schemaOf(
        "fence", RecordType::Wall, "walls along a path, as drawn in the fast construct mode",
        {pathKey("corners of the mid-line, two or more"), pointKey("from", "one end"),
         pointKey("to", "the other end"), keys::flag("closed", "join the last point to the first"),
         keys::height(kWallHeight, "height"), thicknessKey("thickness"),
         keys::texture("that covers both faces of each of its walls once, upright")}));
}

KeySpec countKey(std::string name, std::string help, double standard, double most) {
    return {.name = std::move(name),
            .type = KeyType::Number,
            .help = std::move(help),
            .default_value = standard,
            .lower = 1,
            .upper = most,
            .whole = true};
}

/// Returns the keys that give the position of a door or a window.
std::vector<KeySpec> openingKeys(double standard_width) {
    KeySpec heading = keys::heading();
    heading.help = "direction of the wall, where several are near";
    heading.default_value.reset();
    return {{.name = "wall",
             .type = KeyType::Word,
             .help = "id of the wall, fence or room it is in; left out: the nearest wall",
             .role = Role::Reference},
            {.name = "offset",
             .type = KeyType::Number,
             .unit = Unit::Length,
             .help = "from the beginning of the wall, along it, to the middle of the opening",
             .lower = 0,
             .upper = kMaxDistance},
            pointKey("at", "middle of the opening, on its wall or near it"),
            std::move(heading),
            pointKey("from", "one end of the opening"),
            pointKey("to", "the other end"),
            sizeKey("length[,width[,height]]: along the wall, through it, upwards", 1, 3,
                    {standard_width})};
}

void addOpenings(std::vector<Schema>& out) {
    std::vector<KeySpec> door = openingKeys(0.9);
    door.push_back(keys::height(2, "height, unless size holds it"));
    door.push_back(keys::flag("open", "yes: one can pass, and the rooms on both sides are one"));
    out.push_back(keys::schemaOf("door", RecordType::Wall,
                                 "an opening down to the floor, with a leaf", std::move(door)));
    std::vector<KeySpec> window = openingKeys(1.2);
    window.push_back(keys::height(1.2, "height, unless size holds it"));
    window.push_back({.name = "sill",
                      .type = KeyType::Number,
                      .unit = Unit::Length,
                      .help = "height of its lower edge above the floor",
                      .default_value = 0.9,
                      .lower = 0,
                      .upper = kMaxDistance});
    KeySpec glass{.name = "glass",
                  .type = KeyType::Choice,
                  .help = "clear: light passes; opaque: light stops; none: an open hole",
                  .default_value = "clear",
                  .choices = {"clear", "opaque", "none"}};
    window.push_back(std::move(glass));
    window.push_back(keys::flag("open", "yes: its pane is away"));
    window.push_back(keys::flag("blind", "yes: its blind is shut, and light stops"));
    out.push_back(keys::schemaOf("window", RecordType::Wall, "an opening above a sill, with a pane",
                                 std::move(window)));
}

void addInfra(std::vector<Schema>& out) {
    out.push_back(keys::schemaOf(
        "infra", RecordType::Infra, "a frame of bars under the ceiling, to hang sensors from",
        {keys::floorAt(), keys::heading(), sizeKey("length,width", 2, 2, {4, 4}),
         keys::height(2.4, "height of the bars' underside"),
         countKey("rows", "bars along the length", 3, 1000),
         countKey("cols", "bars across", 3, 1000)}));
}

Schema meshSchema() {
    KeySpec at = atKey();
    at.help = "origin of the file x,y and height z of the file's height 0";
    return keys::schemaOf(
        "mesh", RecordType::Other, "a body from a file: OBJ, STL, PLY, COLLADA, glTF, GLB or IFC",
        {std::move(at),
         keys::heading(),
         {.name = "file",
          .type = KeyType::Text,
          .help = "the file, relative to the folder of this one",
          .required = true,
          .role = Role::File},
         {.name = "unit",
          .type = KeyType::Choice,
          .help = "unit of the file's numbers",
          .default_value = "m",
          .choices = {"m", "cm", "mm", "inch", "foot"}},
         {.name = "up",
          .type = KeyType::Choice,
          .help = "the file's axis that points up; auto: y in glTF, the axis that COLLADA or a "
                  "comment of OBJ (`y up`) names, else z",
          .default_value = "auto",
          .choices = {"auto", "x", "y", "z"}},
         {.name = "scale",
          .type = KeyType::Number,
          .help = "makes it larger by this factor",
          .default_value = 1.0,
          .lower = 0,
          .upper = 1e6,
          .lower_open = true},
         {.name = "side_files",
          .type = KeyType::Choice,
          .help = "where files that the file names may lie (buffers of glTF, materials of OBJ): in "
                  "its folder and below, or anywhere",
          .default_value = "folder",
          .choices = {"folder", "anywhere"}},
         {.name = "digest",
          .type = KeyType::Word,
          .help = "sha256: of the content when it was compiled; readers reject other content"}});
}

void addThings(std::vector<Schema>& out) {
    const std::string box = "length,width[,height]";
    const std::string round = "length,width[,height], or the diameter";
    const auto other = [&out](std::string keyword, std::string help, std::vector<KeySpec> keys) {
        keys.insert(keys.begin(), {atKey(), keys::heading()});
        keys.push_back(tagKey());
        out.push_back(keys::schemaOf(std::move(keyword), RecordType::Other, std::move(help),
                                     std::move(keys)));
    };
    out.push_back(keys::schemaOf(
        "pillar", RecordType::Infra, "a pillar of the building",
        {atKey(), keys::heading(),
         sizeKey("length,width[,height], or the width of all sides", 1, 3, {0.4, 0.4}),
         keys::height(kWallHeight), kindKey("its section", {"square", "round"})}));
    other("table", "a round table on one foot",
          {sizeKey(round, 1, 3, {0.9, 0.9}), keys::height(0.7)});
    other("desk", "a desk; its length lies along the heading, its open side to the right",
          {sizeKey(box, 2, 3, {1.2, 0.8}), keys::height(0.7),
           kindKey("on four legs, or on panels down to the floor", {"legs", "closed"})});
    other("chair", "a chair; its back is behind, against the heading",
          {sizeKey(box, 2, 3, {0.45, 0.45}), keys::height(0.85)});
    other("barrier", "a thin upright board",
          {sizeKey(box, 2, 3, {1.2, 0.05}), keys::height(1),
           keys::texture("that covers each of its two long sides once, upright")});
    other("boxes", "boxes upon each other",
          {sizeKey("length,width[,height] of the stack", 2, 3, {0.6, 0.4}), keys::height(0.9),
           countKey("count", "how many", 3, 100)});
    other("screen", "a projection screen on two feet; its length lies along the heading",
          {sizeKey(box, 2, 3, {1.8, 0.5}), keys::height(2),
           keys::texture("that covers each side of its board once, upright")});
    other("cube", "a box",
          {sizeKey("the edge, or length,width[,height]", 1, 3, {0.5}),
           heightKey("height, unless size holds it; without both the length"),
           keys::texture("that covers each of its four sides once, upright, and its top, with the "
                         "picture's right towards the heading")});
    other("cylinder", "an upright cylinder, elliptic where length and width differ",
          {sizeKey(round, 1, 3, {0.3, 0.3}), keys::height(0.5)});
}

}  // namespace

std::vector<Schema> environmentSchemas() {
    std::vector<Schema> out;
    addSpaces(out);
    addFloors(out);
    addWalls(out);
    addOpenings(out);
    addInfra(out);
    keys::addAppliances(out);
    addThings(out);
    out.push_back(meshSchema());
    return out;
}

}  // namespace ispace
