// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/schemas.h"

#include <iterator>
#include <utility>

#include "env/schemas.h"
#include "layout/laser.h"

namespace ispace {

namespace {

/// As in the environment: plans lie within this of the origin, in metres.
constexpr double kFarthest = 1e6;

KeySpec idKey() { return {.name = "id", .type = KeyType::Word, .help = "name of the record"}; }

KeySpec angleKey(std::string name, std::string help, double lower, double upper) {
    return {.name = std::move(name),
            .type = KeyType::Number,
            .unit = Unit::Angle,
            .help = std::move(help),
            .default_value = 0.0,
            .lower = lower,
            .upper = upper};
}

/// Figures that a model gives too; none has a default, as its absence means "as the model".
void addLaserFigures(std::vector<KeySpec>& keys) {
    keys.push_back({.name = "range",
                    .type = KeyType::Tuple,
                    .unit = Unit::Length,
                    .help = "least and greatest distance measured, or the greatest alone",
                    .min_count = 1,
                    .max_count = 2,
                    .lower = 0,
                    .upper = kFarthest});
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
}

Schema laserSchema() {
    Schema schema{.keyword = "laser",
                  .type = RecordType::Placement,
                  .help = "planar laser range finder; bare: range=0,5 fov=180 step=1",
                  .keys = {}};
    schema.keys.push_back(idKey());
    schema.keys.push_back({.name = "model",
                           .type = KeyType::Word,
                           .help = "device of the catalogue that gives the figures not written"});
    schema.keys.push_back({.name = "at",
                           .type = KeyType::Tuple,
                           .unit = Unit::Length,
                           .help = "optical centre; height 0.15 without z; left out: to be placed",
                           .min_count = 2,
                           .max_count = 3,
                           .lower = -kFarthest,
                           .upper = kFarthest});
    schema.keys.push_back(
        angleKey("heading", "direction of bearing 0, from +x", -kFarthest, kFarthest));
    schema.keys.push_back(angleKey("tilt", "above level, negative looks down", -90, 90));
    schema.keys.push_back(angleKey("roll", "left side up", -180, 180));
    addLaserFigures(schema.keys);
    schema.keys.push_back(
        {.name = "on", .type = KeyType::Word, .help = "id of what the sensor is mounted on"});
    return schema;
}

Schema environmentSchema() {
    return {.keyword = "environment",
            .type = RecordType::Meta,
            .help = "the environment a layout was made for",
            .keys = {idKey(),
                     {.name = "file",
                      .type = KeyType::Text,
                      .help = "its file, relative to the folder of the layout"},
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
        .keys = {idKey(),
                 share("coverage", "covered share of the target"),
                 {.name = "area",
                  .type = KeyType::Number,
                  .unit = Unit::Area,
                  .help = "total effective area, eq. (4.6)",
                  .lower = 0},
                 share("bound", "no layout covers more than this share"),
                 {.name = "strategy", .type = KeyType::Word, .help = "how places were proposed"},
                 {.name = "complete",
                  .type = KeyType::Flag,
                  .help = "no if a time limit or a signal cut the search",
                  .default_value = true}}};
}

}  // namespace

std::vector<Schema> layoutSchemas() { return {laserSchema(), environmentSchema(), resultSchema()}; }

Schema laserDeviceSchema() {
    Schema schema{.keyword = "laser",
                  .type = RecordType::Placement,
                  .help = "a planar laser range finder one can buy",
                  .keys = {}};
    schema.keys.push_back(idKey());
    schema.keys.push_back({.name = "model",
                           .type = KeyType::Word,
                           .help = "what laser records call it",
                           .required = true});
    schema.keys.push_back({.name = "name", .type = KeyType::Text, .help = "maker and type"});
    addLaserFigures(schema.keys);
    schema.keys.push_back({.name = "source",
                           .type = KeyType::Text,
                           .help = "public documents the figures come from",
                           .required = true});
    schema.keys.push_back({.name = "confidence",
                           .type = KeyType::Choice,
                           .help = "A maker's document, B second source, U unsure",
                           .choices = {"A", "B", "U"},
                           .required = true});
    return schema;
}

const Schemas& sceneSchemas() {
    static const Schemas schemas = [] {
        std::vector<Schema> all = environmentSchemas();
        std::vector<Schema> placements = layoutSchemas();
        std::move(placements.begin(), placements.end(), std::back_inserter(all));
        return Schemas(std::move(all));
    }();
    return schemas;
}

}  // namespace ispace
