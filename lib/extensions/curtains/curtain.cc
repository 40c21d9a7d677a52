// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth is a sheet of the material Cloth without thickness: rays stop at it, robots and people do
// not. A drawn share below 1 leaves the far end of the rail open.
#include "extensions/curtains/curtain.h"

#include <utility>

#include "base/error.h"
#include "env/body_shapes.h"
#include "record/record.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace::curtains {

namespace {

constexpr double kRail = 2.3;

KeySpec endKey(std::string name, std::string help) {
    return {.name = std::move(name),
            .type = KeyType::Tuple,
            .unit = Unit::Length,
            .help = std::move(help),
            .min_count = 2,
            .max_count = 2,
            .lower = -kMaxDistance,
            .upper = kMaxDistance,
            .required = true,
            .role = Role::Place};
}

KeySpec heightKey(std::string name, std::string help, double standard) {
    return {.name = std::move(name),
            .type = KeyType::Number,
            .unit = Unit::Length,
            .help = std::move(help),
            .default_value = standard,
            .lower = 0,
            .upper = kMaxDistance};
}

Point2 endOf(const Record& record, std::string_view key) {
    const Tuple& at = record.tuple(key);
    return {at[0], at[1]};
}

/// Rejects a curtain without an extent.
void checkCurtain(const Record& record) {
    if (endOf(record, "from") == endOf(record, "to"))
        throw FormatError(record.finding("to", "the rail of a curtain has no length"));
    if (record.number("bottom") >= record.number("height"))
        throw FormatError(record.finding(
            "bottom", "the cloth of a curtain begins below its rail: wanted bottom < height"));
}

}  // namespace

std::vector<Schema> curtainSchemas() {
    return {{.keyword = "curtain",
             .type = RecordType::Wall,
             .help =
                 "cloth on a rail across a room or before a window: light stops at it as far as "
                 "it is drawn, and robots and people pass",
             .keys = {idKey(),
                      endKey("from", "end of its rail from which it is drawn"),
                      endKey("to", "the other end"),
                      {.name = "drawn",
                       .type = KeyType::Number,
                       .unit = Unit::Share,
                       .help = "share of its rail that the cloth covers",
                       .default_value = 1.0,
                       .lower = 0,
                       .upper = 1},
                      heightKey("bottom", "of the cloth above the floor", 0),
                      heightKey("height", "of the rail above the floor", kRail)}}};
}

Body curtainBody(const Record& record) {
    Body body;
    const double drawn = record.number("drawn");
    if (!(drawn > 0) || record.number("bottom") >= record.number("height")) return body;
    const Point2 from = endOf(record, "from"), to = endOf(record, "to");
    const Point2 end = drawn < 1 ? from + drawn * (to - from) : to;
    if (end == from) return body;
    body.sheets.push_back({.line = {from, end},
                           .bottom = record.number("bottom"),
                           .top = record.number("height"),
                           .material = Material::Cloth});
    return body;
}

ActResult actOnCurtain(const Record& /*record*/, std::string_view verb, const Record& /*person*/,
                       std::string changes) {
    if (verb == "opens") return {"drawn=0", ""};
    if (verb == "closes") return {"drawn=1", ""};
    return {std::move(changes), ""};
}

void addCurtains() {
    addBodyShape("curtain", curtainBody);
    addThingKind("curtain", {.states = {"drawn"},
                             .check = checkCurtain,
                             .verbs = {"opens", "closes"},
                             .act = actOnCurtain,
                             .entities = {{"drawn", "cover", "curtain"}}});
}

}  // namespace ispace::curtains
