// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/scene_edit.h"

#include <algorithm>

#include "base/error.h"
#include "base/message.h"
#include "layout/schemas.h"

namespace ispace {

namespace {

constexpr std::string_view kBlanks = " \t";

/// Takes the first word of a text.
std::string_view takeWord(std::string_view& rest) {
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
    const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
    rest.remove_prefix(word.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
    return word;
}

/// True if the edit says anew where what it names is.
bool places(const Edit& edit, const Record& record) {
    if (edit.kind != Edit::Kind::Set) return false;
    const KeySpec* const key = record.schema().find(edit.key);
    return key != nullptr && (key->role == Role::Place || key->role == Role::Heading);
}

bool isMover(const Record& record) {
    return record.keyword() == "robot" || record.keyword() == "human";
}

}  // namespace

std::vector<Edit> parseEdits(std::string_view request) {
    std::string_view rest = request;
    const std::string_view verb = takeWord(rest);
    if (verb == "ADD") return {parseEdit(Edit::Kind::Add, rest)};
    if (verb == "SET") return {parseEdit(Edit::Kind::Set, rest)};
    if (verb != "DELETE") throw UsageError(excerpt(verb) + " is no change of a world");
    std::vector<Edit> edits;
    while (!rest.empty()) edits.push_back(parseEdit(Edit::Kind::Delete, takeWord(rest)));
    return edits;
}

bool isAbout(const Edit& edit, const std::string& id) { return edit.ids.matches(id); }

const char* fileKeyOf(const Record& record) {
    for (const KeySpec& key : record.schema().keys)
        if (key.role == Role::File && record.has(key.name)) return key.name.c_str();
    return nullptr;
}

bool touchFiles(const std::vector<Edit>& edits, const Scene& scene) {
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        if (fileKeyOf(scene.records[i]) == nullptr) continue;
        const bool is_last = i + 1 == scene.records.size();
        const auto touches = [&](const Edit& edit) {
            return edit.kind == Edit::Kind::Add ? is_last : isAbout(edit, scene.ids[i]);
        };
        if (std::any_of(edits.begin(), edits.end(), touches)) return true;
    }
    return false;
}

std::vector<Record> editedRecords(const Scene& scene, const std::vector<Edit>& edits,
                                  const MoverPlaces& where) {
    std::vector<Record> records = scene.records;
    for (std::size_t i = 0; i < records.size(); ++i) {
        if (!isMover(records[i])) continue;
        const auto moves = [&](const Edit& edit) {
            return places(edit, records[i]) && isAbout(edit, scene.ids[i]);
        };
        if (std::none_of(edits.begin(), edits.end(), moves)) continue;
        const auto pose = where(scene.ids[i]);
        if (!pose) continue;
        records[i].set("at", Tuple{pose->position.x, pose->position.y});
        records[i].set("heading", pose->heading.degrees());
    }
    return edited(std::move(records), edits, sceneSchemas());
}

void placeAgain(std::vector<Record>& records, std::span<const std::string> ids,
                const std::vector<Edit>& edits, const MoverPlaces& where) {
    for (std::size_t i = 0; i < records.size(); ++i) {
        if (!isMover(records[i])) continue;
        const auto sets = [&](std::string_view key) {
            return std::any_of(edits.begin(), edits.end(), [&](const Edit& edit) {
                return places(edit, records[i]) && (key.empty() || edit.key == key) &&
                       isAbout(edit, ids[i]);
            });
        };
        if (!sets("")) continue;
        const auto pose = where(ids[i]);
        if (!pose) continue;
        if (!sets("at")) records[i].set("at", Tuple{pose->position.x, pose->position.y});
        if (!sets("heading")) records[i].set("heading", pose->heading.degrees());
    }
}

std::vector<std::string> placedBy(const std::vector<Edit>& edits, const Scene& scene) {
    std::vector<std::string> placed;
    for (const Edit& edit : edits) {
        if (edit.kind != Edit::Kind::Set) continue;
        for (std::size_t i = 0; i < scene.ids.size(); ++i)
            if (isAbout(edit, scene.ids[i]) && places(edit, scene.records[i]))
                placed.push_back(scene.ids[i]);
    }
    return placed;
}

}  // namespace ispace
