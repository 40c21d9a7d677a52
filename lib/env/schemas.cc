// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/schemas.h"

#include <utility>

namespace ispace {

namespace {

/// Plans lie within this of the origin, in metres: doubles still tell micrometres apart there.
constexpr double kFarthest = 1e6;

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
            .lower = -kFarthest,
            .upper = kFarthest};
}

KeySpec atKey() {
    KeySpec key = lengths("at", "centre of the footprint x,y and height of the underside z", 2, 3);
    key.default_value = Tuple{0, 0};
    return key;
}

KeySpec floorAtKey() {
    KeySpec key = lengths("at", "centre x,y", 2, 2);
    key.default_value = Tuple{0, 0};
    return key;
}

KeySpec headingKey() {
    return {.name = "heading",
            .type = KeyType::Number,
            .unit = Unit::Angle,
            .help = "direction of the length, counter-clockwise from +x",
            .default_value = 0.0,
            .lower = -kFarthest,
            .upper = kFarthest};
}

/// Extents, each above 0.
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

KeySpec heightKey(std::string help = "height where size gives none") {
    return {.name = "height",
            .type = KeyType::Number,
            .unit = Unit::Length,
            .help = std::move(help),
            .lower = 0,
            .upper = kFarthest,
            .lower_open = true};
}

KeySpec heightKey(double standard, std::string help = "height where size gives none") {
    KeySpec key = heightKey(std::move(help));
    key.default_value = standard;
    return key;
}

KeySpec thicknessKey(std::string help) {
    return {.name = "thickness",
            .type = KeyType::Number,
            .unit = Unit::Length,
            .help = std::move(help),
            .default_value = 0.0,
            .lower = 0,
            .upper = kFarthest};
}

KeySpec kindKey(std::string help, std::vector<std::string> choices) {
    KeySpec key{.name = "kind", .type = KeyType::Choice, .help = std::move(help)};
    key.default_value = choices.front();
    key.choices = std::move(choices);
    return key;
}

KeySpec flagKey(std::string name, std::string help) {
    return {.name = std::move(name),
            .type = KeyType::Flag,
            .help = std::move(help),
            .default_value = false};
}

KeySpec pathKey(std::string help) {
    KeySpec key = lengths("path", std::move(help), 2, 2);
    key.type = KeyType::TupleList;
    return key;
}

Schema schema(std::string keyword, RecordType type, std::string help, std::vector<KeySpec> keys) {
    keys.insert(keys.begin(), idKey());
    return {std::move(keyword), type, std::move(help), std::move(keys)};
}

void addSpaces(std::vector<Schema>& out) {
    out.push_back(schema(
        "ispace", RecordType::Space, "a room: floor and four walls",
        {floorAtKey(), headingKey(), sizeKey("length,width[,height] of the room", 2, 3, {8, 8}),
         heightKey(kWallHeight), flagKey("ceiling", "close it with a ceiling")}));
    KeySpec inside_at = lengths("at", "the point x,y", 2, 2);
    inside_at.required = true;
    out.push_back(schema("inside", RecordType::Space, "a point known to be inside the room",
                         {std::move(inside_at)}));
    out.push_back(schema("zone", RecordType::Space,
                         "a part of the floor, called by its id: a polygon or a rectangle",
                         {pathKey("corners of the polygon, three or more"), floorAtKey(),
                          headingKey(), sizeKey("length,width of the rectangle", 2, 2)}));
}

void addFloors(std::vector<Schema>& out) {
    KeySpec friction{.name = "friction",
                     .type = KeyType::Number,
                     .help = "share by which robots are slowed down on it",
                     .default_value = 0.0,
                     .lower = 0,
                     .upper = 1};
    out.push_back(schema(
        "floor", RecordType::Floor, "a covering of a part of the floor",
        {floorAtKey(), headingKey(), sizeKey("length,width of the covering", 2, 2, {8, 8}),
         kindKey("one colour, or squares in two", {"plain", "checker"}), std::move(friction)}));
}

void addWalls(std::vector<Schema>& out) {
    // Bounded below by 0 as a whole since a thickness of 0 is usual; the body refuses the others.
    KeySpec wall_size = lengths("size", "length[,thickness[,height]]", 1, 3);
    wall_size.lower = 0;
    out.push_back(
        schema("wall", RecordType::Wall, "a straight wall, by its ends or by centre and length",
               {lengths("from", "one end of the mid-line", 2, 2),
                lengths("to", "the other end", 2, 2), atKey(), headingKey(), std::move(wall_size),
                heightKey(kWallHeight), thicknessKey("thickness where size gives none"),
                kindKey("what it is made of", {"plain", "brick", "wood", "concrete"})}));
    out.push_back(schema("fence", RecordType::Wall,
                         "walls along a path, as drawn in the fast construct mode",
                         {pathKey("corners of the mid-line, two or more"),
                          lengths("from", "one end", 2, 2), lengths("to", "the other end", 2, 2),
                          flagKey("closed", "join the last point to the first"),
                          heightKey(kWallHeight, "height"), thicknessKey("thickness")}));
}

void addThings(std::vector<Schema>& out) {
    const std::string box = "length,width[,height]";
    const std::string round = "length,width[,height], or the diameter";
    const auto other = [&out](std::string keyword, std::string help, std::vector<KeySpec> keys) {
        keys.insert(keys.begin(), {atKey(), headingKey()});
        out.push_back(
            schema(std::move(keyword), RecordType::Other, std::move(help), std::move(keys)));
    };
    out.push_back(
        schema("pillar", RecordType::Infra, "a pillar of the building",
               {atKey(), headingKey(),
                sizeKey("length,width[,height], or the width of all sides", 1, 3, {0.4, 0.4}),
                heightKey(kWallHeight), kindKey("its section", {"square", "round"})}));
    other("table", "a round table on one foot", {sizeKey(round, 1, 3, {0.9, 0.9}), heightKey(0.7)});
    other("desk", "a desk; its length lies along the heading, its open side to the right",
          {sizeKey(box, 2, 3, {1.2, 0.8}), heightKey(0.7),
           kindKey("on four legs, or on panels down to the floor", {"legs", "closed"})});
    other("chair", "a chair; its back is behind, against the heading",
          {sizeKey(box, 2, 3, {0.45, 0.45}), heightKey(0.85)});
    other("barrier", "a thin upright board", {sizeKey(box, 2, 3, {1.2, 0.05}), heightKey(1)});
    other("cube", "a box",
          {sizeKey("the edge, or length,width[,height]", 1, 3, {0.5}),
           heightKey("height where size gives none; without it the length")});
    other("cylinder", "an upright cylinder, elliptic where length and width differ",
          {sizeKey(round, 1, 3, {0.3, 0.3}), heightKey(0.5)});
}

}  // namespace

std::vector<Schema> environmentSchemas() {
    std::vector<Schema> out;
    addSpaces(out);
    addFloors(out);
    addWalls(out);
    addThings(out);
    return out;
}

}  // namespace ispace
