// SPDX-License-Identifier: GPL-3.0-or-later
#include <cassert>
#include <utility>

#include "base/error.h"
#include "record/edit.h"
#include "record/schema.h"

namespace ispace {

namespace {

/// What an edit's numbers are checked as.
KeySpec numberKey(std::string name, Unit unit) {
    KeySpec key;
    key.name = std::move(name);
    key.unit = unit;
    return key;
}

/// "ID:NUMBERS" at its last colon: ids may hold colons, numbers do not.
std::string_view splitNumbers(std::string_view text, const char* wanted, Edit& edit) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string_view::npos || colon == 0 || colon + 1 == text.size())
        throw UsageError('`' + std::string(text) + "` is not " + wanted);
    edit.ids = Glob(text.substr(0, colon));
    return text.substr(colon + 1);
}

void parseSet(std::string_view text, Edit& edit) {
    const std::size_t equals = text.find('=');
    const std::size_t dot = equals == std::string_view::npos ? equals : text.rfind('.', equals);
    if (dot == std::string_view::npos || dot == 0 || dot + 1 == equals)
        throw UsageError('`' + std::string(text) + "` is not ID.KEY=VALUE");
    edit.ids = Glob(text.substr(0, dot));
    edit.key = text.substr(dot + 1, equals - dot - 1);
    edit.value = text.substr(equals + 1);
}

void parseMove(std::string_view text, Edit& edit) {
    const std::string_view numbers = splitNumbers(text, "ID:DX,DY[,DZ]", edit);
    KeySpec key = numberKey("move", Unit::Length);
    key.type = KeyType::Tuple;
    key.min_count = 2;
    key.max_count = 3;
    const Tuple by = std::get<Tuple>(parseValue(key, numbers));
    edit.by = {by[0], by[1], by.size() > 2 ? by[2] : 0};
}

}  // namespace

std::string optionOf(Edit::Kind kind) {
    switch (kind) {
        case Edit::Kind::Add:
            return "--add";
        case Edit::Kind::Fence:
            return "--fence";
        case Edit::Kind::Set:
            return "--set";
        case Edit::Kind::Move:
            return "--move";
        case Edit::Kind::Forward:
            return "--forward";
        case Edit::Kind::Rotate:
            return "--rotate";
        case Edit::Kind::Tilt:
            return "--tilt";
        case Edit::Kind::Delete:
            break;
    }
    return "--delete";
}

Edit parseEdit(Edit::Kind kind, std::string_view text) {
    if (text.empty()) throw UsageError("an empty text is given");
    Edit edit;
    edit.kind = kind;
    edit.text = text;
    switch (kind) {
        case Edit::Kind::Add:
        case Edit::Kind::Fence:
            break;
        case Edit::Kind::Delete:
            edit.ids = Glob(text);
            break;
        case Edit::Kind::Set:
            parseSet(text, edit);
            break;
        case Edit::Kind::Move:
            parseMove(text, edit);
            break;
        case Edit::Kind::Forward: {
            const std::string_view number = splitNumbers(text, "ID:M", edit);
            edit.by.x = std::get<double>(parseValue(numberKey("forward", Unit::Length), number));
            break;
        }
        case Edit::Kind::Rotate:
        case Edit::Kind::Tilt: {
            const std::string_view number = splitNumbers(text, "ID:DEG", edit);
            edit.angle = Angle::degrees(
                std::get<double>(parseValue(numberKey("angle", Unit::Angle), number)));
            break;
        }
    }
    return edit;
}

}  // namespace ispace
