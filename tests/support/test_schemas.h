// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of lib/kernel/record: schemas, since the real keywords are defined in libraries above
// it.
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

/// Returns an environment record with keys of all types, one of them required, a placement, and a
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

inline KeySpec testPlace(std::string name, std::size_t most, Role role = Role::Place) {
    KeySpec key = testKey(std::move(name), KeyType::Tuple, Unit::Length);
    key.min_count = 2;
    key.max_count = most;
    key.lower = -1e6;
    key.upper = 1e6;
    key.role = role;
    return key;
}

inline KeySpec testWord(std::string name, Role role) {
    KeySpec key = testKey(std::move(name), KeyType::Word);
    key.role = role;
    return key;
}

/// Returns records with roles, shaped as the real ones: furniture, walls by ends or centre, paths,
/// robots with a goal, sensors that are placed or carried, doors by wall or position, files.
inline const Schemas& placedSchemas() {
    static const Schemas schemas = [] {
        const KeySpec id = testKey("id", KeyType::Word);
        KeySpec thing_at = testPlace("at", 3), floor_at = testPlace("at", 2);
        thing_at.default_value = floor_at.default_value = Tuple{0, 0};
        KeySpec sensor_at = testPlace("at", 3);
        sensor_at.standard_z = 0.15;
        KeySpec bare_heading = testKey("heading", KeyType::Number, Unit::Angle);
        bare_heading.role = Role::Heading;
        KeySpec heading = bare_heading;
        heading.default_value = 0.0;
        KeySpec height = testKey("height", KeyType::Number, Unit::Length);
        height.default_value = 0.7;
        KeySpec size = testKey("size", KeyType::Tuple, Unit::Length);
        size.max_count = 3;
        KeySpec path = testPlace("path", 2), course = testPlace("path", 2, Role::MotionPlan);
        path.type = course.type = KeyType::TupleList;
        KeySpec file = testKey("file", KeyType::Text);
        file.role = Role::File;
        const KeySpec from = testPlace("from", 2), to = testPlace("to", 2);
        const KeySpec name = testKey("name", KeyType::Text);
        const KeySpec offset = testKey("offset", KeyType::Number, Unit::Length);
        return Schemas({
            {"desk", RecordType::Other, "", {id, thing_at, heading, size, height, name}},
            {"wall", RecordType::Wall, "", {id, from, to, floor_at, heading, size}},
            {"fence", RecordType::Wall, "", {id, path, from, to}},
            {"door",
             RecordType::Wall,
             "",
             {id, testWord("wall", Role::Reference), offset, testPlace("at", 2), bare_heading}},
            {"mesh", RecordType::Other, "", {id, thing_at, heading, file}},
            {"robot", RecordType::Placement, "", {id, floor_at, heading, course}},
            {"laser",
             RecordType::Placement,
             "",
             {id, sensor_at, heading, testWord("on", Role::Carrier)}},
        });
    }();
    return schemas;
}

/// Returns the texts of all findings of a FormatError that `action` throws, else an empty list.
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
