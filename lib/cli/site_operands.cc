// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/site_operands.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/glob.h"
#include "base/message.h"
#include "building/coupling.h"
#include "cli/common_options.h"

namespace ispace {

std::string SiteInput::digest() const {
    return building ? building->document.digest() : only().digest();
}

std::vector<Record> SiteInput::environmentRecords() const {
    if (environment) return environment->records;
    std::vector<Record> records;
    for (const Storey& storey : building->document.storeys) {
        records.push_back(storey.record);
        records.insert(records.end(), storey.room->records.begin(), storey.room->records.end());
    }
    for (const StoreyPassage& passage : building->document.passages)
        records.push_back(passage.record);
    return records;
}

std::string SiteInput::prefix(std::size_t room) const {
    return ids[room].empty() ? "" : ids[room] + ": ";
}

void SiteInput::setLayout(Document changed) {
    layout = std::move(changed);
    if (!building) {
        rooms = {std::make_shared<const Scene>(makeScene(
            *environment, &*layout, devicesFor({&*environment, &*layout}), rooms.front().get()))};
        return;
    }
    std::vector<const Document*> all;
    for (const Storey& storey : building->document.storeys) all.push_back(storey.room.get());
    const std::vector<Document> layouts = layoutsOf(*layout, building->document);
    for (const Document& one : layouts) all.push_back(&one);
    building = makeBuildingScene(building->document, layouts,
                                 devicesFor(std::span<const Document* const>(all)));
    rooms = building->scenes;
}

SiteInput readSite(const SceneRequest& request) {
    SiteInput site;
    if (auto found = readBuildingInput(request)) {
        site.environment_operand = std::move(found->environment_operand);
        site.layout_operand = std::move(found->layout_operand);
        site.named = std::move(found->named);
        site.files = std::move(found->files);
        site.layout = std::move(found->layout);
        site.warnings = std::move(found->warnings);
        site.rooms = found->building.scenes;
        for (const Storey& storey : found->building.document.storeys) site.ids.push_back(storey.id);
        site.building = std::move(found->building);
        return site;
    }
    SceneInput room = readScene(request);
    site.files = filesOf(room);
    site.environment_operand = std::move(room.environment_operand);
    site.layout_operand = std::move(room.layout_operand);
    site.named = std::move(room.named);
    site.layout = std::move(room.layout);
    site.warnings = room.environment.warnings;
    site.choices = std::move(room.choices);
    site.environment = std::move(room.environment);
    site.rooms = {std::make_shared<const Scene>(std::move(room.scene))};
    site.ids = {""};
    return site;
}

void warnOfImport(const CommonOptions& options, const std::string& tool, const SiteInput& input) {
    warn(options, tool, input.choices);
    warn(options, tool, input.warnings);
}

std::vector<Diagnostic> siteWarnings(const SiteInput& input, const FindingFilter& filter) {
    return input.building ? storeyWarnings(Coupling(*input.building), filter)
                          : sceneWarnings(input.only(), filter);
}

void mustBeOneRoom(const SiteInput& input, const std::string& option) {
    if (input.building && !option.empty())
        throw UsageError(option + " needs one room: choose one with --storey (" +
                         input.building->document.storeyList() + ')');
}

namespace {

/// The rooms that a text is about.
struct RoomsNamed {
    std::vector<std::size_t> rooms;
    std::string text;
};

RoomsNamed roomsNamed(const SiteInput& input, std::string_view option, const std::string& text) {
    RoomsNamed named{{}, text};
    const std::size_t slash = text.find('/');
    if (slash == std::string::npos) {
        if (text.starts_with("rect:") || text.starts_with("poly:"))
            throw UsageError(std::string(option) + ": " + excerpt(text) +
                             " names no storey, as in " + input.ids.front() + '/' + text);
        for (std::size_t i = 0; i < input.rooms.size(); ++i) named.rooms.push_back(i);
        return named;
    }
    const std::string storey = text.substr(0, slash);
    named.text = text.substr(slash + 1);
    const Glob glob(storey);
    for (std::size_t i = 0; i < input.ids.size(); ++i)
        if (glob.matches(input.ids[i])) named.rooms.push_back(i);
    if (named.rooms.empty()) {
        const StoreyedDocument& document = input.building->document;
        const Storey* const one =
            ofOption(std::string(option), [&] { return &document.storey(storey); });
        named.rooms = {static_cast<std::size_t>(one - document.storeys.data())};
    }
    return named;
}

}  // namespace

void forEachRoomOf(const SiteInput& input, std::string_view option, const std::string& text,
                   const std::function<void(std::size_t room, const std::string& text)>& read) {
    if (input.isOneRoom()) return read(0, text);
    const RoomsNamed named = roomsNamed(input, option, text);
    std::string first;
    bool is_read = false;
    for (const std::size_t room : named.rooms) {
        try {
            read(room, named.text);
            is_read = true;
        } catch (const UsageError& error) {
            if (!first.empty()) continue;
            first = input.ids[room] + ": " + error.what();
        }
    }
    if (!is_read)
        throw UsageError(std::string(option) + ": " + first +
                         (named.rooms.size() > 1 ? "; neither does it fit another storey" : ""));
}

}  // namespace ispace
