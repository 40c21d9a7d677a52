// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/thing_kind.h"

#include <utility>

namespace ispace {

namespace {

std::map<std::string, ThingKind, std::less<>>& kinds() {
    static std::map<std::string, ThingKind, std::less<>> known;
    return known;
}

}  // namespace

void addThingKind(std::string_view keyword, ThingKind kind) {
    kinds().insert_or_assign(std::string(keyword), std::move(kind));
}

const ThingKind* thingKind(std::string_view keyword) {
    const auto& known = kinds();
    const auto found = known.find(keyword);
    return found == known.end() ? nullptr : &found->second;
}

const std::map<std::string, ThingKind, std::less<>>& thingKinds() { return kinds(); }

std::optional<Emission> emissionOf(const Record& record) {
    const ThingKind* const kind = thingKind(record.keyword());
    if (kind == nullptr || kind->emission == nullptr) return std::nullopt;
    return kind->emission(record);
}

std::shared_ptr<const PersonFigure> figureOf(const Record& person, const Record* load) {
    const ThingKind* const kind = thingKind(person.keyword());
    return kind == nullptr || kind->figure == nullptr ? nullptr : kind->figure(person, load);
}

std::string_view barrierOf(const Record& record) {
    const ThingKind* const kind = thingKind(record.keyword());
    return kind == nullptr || kind->barrier == nullptr ? "" : kind->barrier(record);
}

}  // namespace ispace
