// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/schema_keys.h"

#include <utility>

namespace ispace {

KeySpec idKey() { return {.name = "id", .type = KeyType::Word, .help = "name of the record"}; }

KeySpec angleKey(std::string name, std::string help, double lower, double upper, Role role) {
    return {.name = std::move(name),
            .type = KeyType::Number,
            .unit = Unit::Angle,
            .help = std::move(help),
            .default_value = 0.0,
            .lower = lower,
            .upper = upper,
            .role = role};
}

KeySpec headingKey(std::string help) {
    return angleKey("heading", std::move(help), -kFarthest, kFarthest, Role::Heading);
}

KeySpec positiveKey(std::string name, Unit unit, std::string help, double upper) {
    return {.name = std::move(name),
            .type = KeyType::Number,
            .unit = unit,
            .help = std::move(help),
            .lower = 0,
            .upper = upper,
            .lower_open = true};
}

KeySpec modelKey() {
    return {.name = "model",
            .type = KeyType::Word,
            .help = "device of the catalogue that gives the figures not written"};
}

}  // namespace ispace
