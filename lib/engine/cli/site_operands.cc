// SPDX-License-Identifier: GPL-3.0-or-later
// A room is a site of one storey: tools read sites, and ask isOneRoom() only where names or reports
// differ. Scenes of a site are shared and constant; a change makes new ones.
#include "cli/site_operands.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "base/glob.h"
#include "base/message.h"
#include "cli/common_options.h"
#include "env/point_location.h"
#include "site/site_edit.h"
#include "site/storeys.h"

namespace ispace {

std::vector<std::string> SiteInput::ids() const {
    std::vector<std::string> ids;
    ids.reserve(building.document.storeys.size());
    for (const Storey& storey : building.document.storeys) ids.push_back(storey.id);
    return ids;
}

std::string SiteInput::digest() const {
    return isOneRoom() ? only().digest() : building.document.digest();
}

std::vector<Record> SiteInput::environmentRecords() const {
    if (isOneRoom()) return environment().records;
    std::vector<Record> records;
    for (const Storey& storey : building.document.storeys) {
        records.push_back(storey.record);
        records.insert(records.end(), storey.room->records.begin(), storey.room->records.end());
    }
    for (const StoreyPassage& passage : building.document.passages)
        records.push_back(passage.record);
    return records;
}

std::string SiteInput::idOf(std::size_t room, const std::string& id) const {
    return wholeId(building.document.storeys[room], id);
}

void SiteInput::setLayout(Document changed) {
    layout = std::move(changed);
    if (isOneRoom()) {
        building.devices = devicesFor({&environment(), &*layout});
        building.scenes = {std::make_shared<const Scene>(
            makeScene(environment(), &*layout, building.devices, &only()))};
        return;
    }
    std::vector<const Document*> all;
    for (const Storey& storey : building.document.storeys) all.push_back(storey.room.get());
    const std::vector<Document> layouts = layoutsOf(*layout, building.document);
    for (const Document& one : layouts) all.push_back(&one);
    building = makeSiteScene(building.document, layouts,
                             devicesFor(std::span<const Document* const>(all)));
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
        site.choices = std::move(found->choices);
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
    site.storey = std::move(room.storey);
    site.storey_name = std::move(room.storey_name);
    const DeviceCatalogue& devices =
        devicesFor({&room.environment, site.layout ? &*site.layout : nullptr});
    site.building = roomAlone(std::move(room.environment),
                              std::make_shared<const Scene>(std::move(room.scene)), devices);
    return site;
}

SeenSite::SeenSite(const SiteInput& input) : input_(&input) {
    if (!input.isOneRoom()) coupling_.emplace(input.building);
}

std::shared_ptr<const Scene> SeenSite::scene(std::size_t room) const {
    if (!coupling_) return input_->rooms()[room];
    Scene scene = *input_->rooms()[room];
    scene.environment = *coupling_->surroundings(room, Coupling::Movers::OfNeighbours);
    return std::make_shared<const Scene>(std::move(scene));
}

Scene SeenSite::fromOutside(std::size_t room) const {
    Scene scene = *sceneOfSite(input_->building, room);
    if (auto opened = coupling_->opened(room)) scene.environment = *std::move(opened);
    return scene;
}

std::optional<Pose3> SeenSite::siteFromRoom(std::size_t room) const {
    if (!coupling_) return std::nullopt;
    const Storey& storey = input_->building.document.storeys[room];
    const Pose2& pose = storey.building_from_storey;
    return Pose3{{pose.position.x, pose.position.y, storey.floor}, pose.heading, {}, {}};
}

std::size_t SeenSite::roomAt(Point3 point) const {
    if (!coupling_) return 0;
    const std::vector<Storey>& storeys = input_->building.document.storeys;
    std::vector<std::size_t> from_above(storeys.size());
    std::iota(from_above.begin(), from_above.end(), std::size_t{0});
    std::stable_sort(from_above.begin(), from_above.end(), [&](std::size_t a, std::size_t b) {
        return storeys[a].floor > storeys[b].floor;
    });
    std::optional<std::size_t> highest;
    for (const std::size_t i : from_above) {
        if (storeys[i].floor > point.z) continue;
        if (!highest) highest = i;
        const Point2 local = inStorey(storeys[i], point.onFloor());
        if (input_->rooms()[i]->environment.indoorIndex().locate(local) != Side::Outside) return i;
    }
    return highest.value_or(from_above.back());
}

std::vector<std::string> operandsToEdit(const SiteInput& input) {
    std::vector<std::string> operands = input.named;
    const std::string& environment = input.environment_operand;
    if (!environment.empty() &&
        std::find(operands.begin(), operands.end(), environment) == operands.end())
        operands.insert(operands.begin(), environment);
    return operands;
}

OtherSite readOtherLayout(const SiteInput& input, const std::string& operand,
                          const SceneRules& rules) {
    if (input.isOneRoom()) {
        OtherLayout other = readOtherLayout(
            {input.environment(), input.only(), input.named, input.environment_operand}, operand,
            rules);
        SiteScene laid = input.building;
        laid.scenes = {std::make_shared<const Scene>(std::move(other.scene))};
        return {std::move(laid), std::move(other.files), std::move(other.warnings)};
    }
    std::vector<std::string> operands = input.named;
    operands.push_back(operand);
    mustReadStdinOnce(operands);
    auto other = readBuildingInput({{input.environment_operand, operand}, rules, true});
    if (!other) throw UsageError("--compare: " + operand + " is no layout of a building");
    return {std::move(other->building), std::move(other->files), std::move(other->warnings)};
}

void mustBeRecordOf(const SiteInput& input, const std::string& option, const std::string& folder) {
    if (input.isOneRoom()) {
        if (holdsBuilding(folder) && input.storey.empty())
            throw UsageError(option + ": " + folder +
                             " is the record of a building: leave out ENV, or give that of a "
                             "storey, such as " +
                             folder + "/STOREY");
    } else if (recordedBuilding(folder).empty()) {
        mustHoldRecord(option, folder);
        refuseRecordOfRoom(input, option, folder);
    }
}

void refuseRecordOfRoom(const SiteInput& building, const std::string& option,
                        const std::string& folder) {
    throw UsageError(option + ": " + folder +
                     " is the record of one room: choose it with --storey (" +
                     building.building.document.storeyList() + ')');
}

std::string recordFor(const SiteInput& input, const std::string& folder) {
    return input.isOneRoom() && !input.storey.empty() && holdsBuilding(folder)
               ? folder + '/' + input.storey
               : folder;
}

SiteScene sceneForRecord(const SiteInput& input, const std::string& folder) {
    SiteScene named = input.building;
    if (!input.isOneRoom() || input.storey.empty() ||
        !recordNamesStorey(recordFor(input, folder), input.storey))
        return named;
    Storey home = named.document.storeys.front();
    home.id = input.storey;
    named.scenes.front() = sceneWithWholeIds(named.scenes.front(), home, named.devices);
    return named;
}

void warnOfImport(const CommonOptions& options, const std::string& tool, const SiteInput& input) {
    warn(options, tool, input.choices);
    warn(options, tool, input.warnings);
}

std::vector<Diagnostic> siteWarnings(const SiteInput& input, const FindingFilter& filter) {
    return storeyWarnings(Coupling(input.building), {.checks = filter.checks}, filter.ids);
}

void mustBeOneRoom(const SiteInput& input, const std::string& option) {
    if (input.isOneRoom() || option.empty()) return;
    throw UsageError(option + " needs one room: choose one with --storey (" +
                     input.building.document.storeyList() + ')');
}

std::string inOwnStorey(const SiteInput& input, const std::string& text) {
    const std::size_t slash = text.find('/');
    if (!input.isOneRoom() || input.storey.empty() || slash == std::string::npos) return text;
    const std::string called = text.substr(0, slash);
    const bool is_own =
        Glob(called).matches(input.storey) || callsStorey(called, input.storey, input.storey_name);
    return is_own ? text.substr(slash + 1) : text;
}

std::vector<std::string> inOwnStorey(const SiteInput& input,
                                     const std::vector<std::string>& texts) {
    std::vector<std::string> own;
    own.reserve(texts.size());
    for (const std::string& text : texts) own.push_back(inOwnStorey(input, text));
    return own;
}

void forEachRoomOf(const SiteInput& input, std::string_view option, const std::string& text,
                   const std::function<void(std::size_t room, const std::string& text)>& read) {
    if (input.isOneRoom()) return read(0, inOwnStorey(input, text));
    forEachRoomOf(input.building.document, option, text, read);
}

void forEachRoomOf(const StoreyedDocument& site, std::string_view option, const std::string& text,
                   const std::function<void(std::size_t room, const std::string& text)>& read) {
    if (site.isRoomAlone()) return read(0, text);
    if (text.starts_with("rect:") || text.starts_with("poly:"))
        throw UsageError(std::string(option) + ": " + excerpt(text) + " names no storey, as in " +
                         site.storeys.front().id + '/' + text);
    const StoreyText named = splitStoreys(site, option, text);
    std::string first;
    bool is_read = false;
    for (const std::size_t room : named.storeys) {
        try {
            read(room, named.text);
            is_read = true;
        } catch (const UsageError& error) {
            if (!first.empty()) continue;
            first = site.storeys[room].prefix() + error.what();
        }
    }
    if (!is_read)
        throw UsageError(std::string(option) + ": " + first +
                         (named.storeys.size() > 1 ? "; neither does it fit another storey" : ""));
}

}  // namespace ispace
