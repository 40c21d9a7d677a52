// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of this folder share: the real keywords live above it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "record/schema.h"

namespace ispace {

inline KeySpec testKey(std::string name, KeyType type, Unit unit = Unit::None) {
    KeySpec key;
    key.name = std::move(name);
    key.type = type;
    key.unit = unit;
    key.help = "help on " + key.name;
    return key;
}

/// An environment record with keys of all types, one with a key it must have, a placement, and a
/// meta record with shares.
inline const Schemas& testSchemas() {
    static const Schemas schemas = [] {
        const KeySpec id = testKey("id", KeyType::Word);
        KeySpec at = testKey("at", KeyType::Tuple, Unit::Length);
        at.min_count = 2;
        at.max_count = 3;
        KeySpec heading = testKey("heading", KeyType::Number, Unit::Angle);
        heading.default_value = 0.0;
        KeySpec height = testKey("height", KeyType::Number, Unit::Length);
        height.default_value = 0.7;
        height.lower = 0;
        height.lower_open = true;
        height.upper = 100;
        KeySpec closed = testKey("closed", KeyType::Flag);
        closed.default_value = false;
        KeySpec kind = testKey("kind", KeyType::Choice);
        kind.choices = {"open", "closed", "two words"};
        kind.default_value = std::string("open");
        KeySpec path = testKey("path", KeyType::TupleList, Unit::Length);
        path.min_count = path.max_count = 2;
        path.required = true;
        KeySpec fov = testKey("fov", KeyType::Number, Unit::Angle);
        fov.lower = 0;
        fov.upper = 360;
        KeySpec range = testKey("range", KeyType::Tuple, Unit::Length);
        range.max_count = 2;
        range.lower = 0;
        KeySpec coverage = testKey("coverage", KeyType::Number, Unit::Share);
        coverage.lower = 0;
        coverage.upper = 1;
        return Schemas({
            {"desk",
             RecordType::Other,
             "a desk",
             {id, at, heading, height, closed, kind, testKey("name", KeyType::Text)}},
            {"fence", RecordType::Wall, "a fence", {id, path, closed}},
            {"laser",
             RecordType::Placement,
             "a laser",
             {id, testKey("model", KeyType::Word), at, heading, fov, range,
              testKey("period", KeyType::Number, Unit::Time)}},
            {"result",
             RecordType::Meta,
             "what came out",
             {id, coverage, testKey("area", KeyType::Number, Unit::Area),
              testKey("factor", KeyType::Number),
              testKey("rate", KeyType::Number, Unit::Frequency)}},
        });
    }();
    return schemas;
}

/// The texts of all findings of a FormatError that `action` throws, else nothing.
template <typename Action>
std::vector<std::string> findingsOf(Action action) {
    std::vector<std::string> texts;
    try {
        action();
    } catch (const FormatError& error) {
        for (const Diagnostic& finding : error.diagnostics()) texts.push_back(finding.text());
    }
    return texts;
}

}  // namespace ispace
