// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/arrange_run.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "arrange/search/problem.h"
#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/outputs.h"
#include "env/zone.h"
#include "scene/findings/findings.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "scene/sensor/ultrasound.h"
#include "scene/sensor_spec.h"

namespace ispace {

namespace {

std::vector<NamedZone> zonesOf(const ArrangeToolOptions& options, const std::string& text,
                               const Environment& environment) {
    std::vector<NamedZone> zones = readZones(text, environment);
    for (const NamedZone& zone : zones)
        if (zone.is_center_outside)
            warn(options.common, "arrange",
                 "the centre of gravity of " + zone.name +
                     " lies outside of it; a point inside is (" + formatFixed(zone.inside.x, 2) +
                     ", " + formatFixed(zone.inside.y, 2) + "): is it the zone that is meant?");
    return zones;
}

/// Reads all zones and rules, those of a building each for its storeys.
void takeGoals(const ArrangeToolOptions& options, ArrangeWork& work) {
    const SiteInput& input = work.input;
    const ZoneWords& words = options.zones;
    ArrangeOptions& how = work.how;
    work.goals.resize(input.rooms().size());
    const auto room_of = [&](std::size_t room) -> const Environment& {
        return input.rooms()[room]->environment;
    };
    const auto each = [&](const char* option, const std::vector<std::string>& texts,
                          const std::function<void(std::size_t, const NamedZone&)>& add) {
        for (const std::string& text : texts)
            forEachRoomOf(input, option, text, [&](std::size_t room, const std::string& own) {
                for (const NamedZone& zone : zonesOf(options, own, room_of(room))) add(room, zone);
            });
    };
    each("--zone", words.targets, [&](std::size_t room, const NamedZone& zone) {
        work.goals[room].weights.targets.push_back(zone);
        how.weights.targets.push_back(zone);
    });
    each("--keep-out", words.keep_out, [&](std::size_t room, const NamedZone& zone) {
        work.goals[room].keep_out.push_back(zone);
    });
    each("--keep-in", words.keep_in, [&](std::size_t room, const NamedZone& zone) {
        work.goals[room].keep_in.push_back(zone);
        how.mount.keep_in.push_back(zone);
    });
    for (const std::string& text : words.weights) {
        const double weight = splitWeight(text).second;
        each("--weight", {splitWeight(text).first}, [&](std::size_t room, const NamedZone& zone) {
            work.goals[room].weights.weights.emplace_back(zone, weight);
            how.weights.weights.emplace_back(zone, weight);
        });
    }
    for (RoomGoals& goals : work.goals) {
        goals.counts = how.weights.targets.empty() || !goals.weights.targets.empty();
        goals.takes_sensors = how.mount.keep_in.empty() || !goals.keep_in.empty();
    }
}

}  // namespace

namespace {

/// Reads the sites of --places, those of a building each for its storeys.
void takePlaces(const ArrangeToolOptions& options, ArrangeWork& work) {
    const std::string& file = options.places_file;
    if (file.empty()) return;
    work.places = file == "-" ? readStdin() : readAll(file);
    work.files.push_back(file);
    const std::vector<Angle> headings =
        headingsAround(work.how.headings.value_or(work.how.density.headings));
    if (work.input.isOneRoom()) {
        work.goals.front().places = readSites(work.places, file, headings);
        return;
    }
    const StoreyedDocument& building = work.input.building.document;
    const PlaceRooms rooms{work.input.ids(), [&building](const std::string& name) {
                               return storeysNamed(building, name);
                           }};
    std::vector<std::vector<Site>> sites = readSites(work.places, file, headings, rooms);
    const bool is_any = std::any_of(sites.begin(), sites.end(),
                                    [](const std::vector<Site>& own) { return !own.empty(); });
    for (std::size_t i = 0; i < sites.size(); ++i) {
        RoomGoals& goals = work.goals[i];
        goals.places = std::move(sites[i]);
        goals.takes_sensors = goals.takes_sensors && !(is_any && goals.places.empty());
    }
}

/// Makes the demand that counts instead of the floor, those of a building each for its storeys.
void takeDemand(const ArrangeToolOptions& options, ArrangeWork& work) {
    std::vector<std::shared_ptr<const Demand>> demands;
    if (options.objective)
        demands = options.objective->demandsIn(work.input, work.goals, work.how, options.common,
                                               work.files);
    if (demands.empty()) return;
    work.how.demand = demands.front();
    for (std::size_t i = 0; i < work.goals.size(); ++i) {
        work.goals[i].counts = !demands[i]->weights().empty();
        work.goals[i].demand = std::move(demands[i]);
    }
}

/// \throws UsageError for a sensor whose id names a storey, in a building or a storey of one
void mustHavePlainIds(const SiteInput& input, const std::vector<SensorGroup>& groups) {
    if (input.isOneRoom() && input.storey.empty()) return;
    for (const SensorGroup& group : groups)
        if (group.id.find('/') != std::string::npos)
            throw UsageError("--sensor id=" + group.id + ": " +
                             (input.isOneRoom() ? "ids in a storey alone have no storey before them"
                                                : "the storey comes before it by itself") +
                             "; leave it out");
}

}  // namespace

ArrangeWork readWork(const ArrangeToolOptions& options) {
    std::vector<std::string> streams = options.operands;
    streams.push_back(options.places_file);
    mustReadStdinOnce(streams);
    const DeviceCatalogue& devices = devicesForSensors(options.sensors);
    const std::vector<std::string_view> kinds = keywordsOf(&SensorKind::is_arranged);
    std::vector<SensorSpec> added;
    added.reserve(options.sensors.size());
    for (const std::string& spec : options.sensors)
        added.push_back(ofOption(
            "--sensor", [&] { return readSensorSpec(spec, kinds, sceneSchemas(), devices); }));
    ArrangeWork work;
    work.input = readSite({options.operands, options.rules, false});
    work.how = options.how;
    SiteInput& input = work.input;
    warnOfImport(options.common, "arrange", input);
    mustBeOneRoom(input, needsOneRoom(options.how));
    std::vector<std::string> fixed;
    for (const std::string& id : options.fixed) fixed.push_back(inOwnStorey(input, id));
    if (!fixed.empty()) {
        if (!input.layout) throw UsageError("--fixed is about the sensors of a LAYOUT: give one");
        input.setLayout(withoutPlaces(*input.layout, fixed));
    }
    warn(options.common, "arrange", siteWarnings(input, {.checks = {"outside", "buried"}}));
    const bool open = options.how.target || options.how.budget;
    std::vector<const Scene*> scenes;
    for (const auto& room : input.rooms()) scenes.push_back(room.get());
    work.groups = groupsToPlace(scenes, added, devices, open);
    if (work.groups.empty())
        throw UsageError(
            "nothing to place: give --sensor MODEL[:COUNT], such as dome-2.8-1080p:4, or a LAYOUT "
            "with a sensor without `at`");
    work.files = input.files;
    mustHavePlainIds(input, work.groups);
    // Devices of --sensor are not among those of the records.
    if (!input.isOneRoom() && input.building.devices.devices().empty())
        input.building.devices = devices;
    takeGoals(options, work);
    takePlaces(options, work);
    options.groups->aim({input, options.common, options.rules, options.fixed, work.files}, work.how,
                        work.goals);
    takeDemand(options, work);
    if (work.how.objective) options.objective->aim(input, work.how);
    work.site = searchedSite(input, work.how, work.goals);
    return work;
}

Arrangement ArrangeWork::run(Progress& progress, std::ostream* mps) const {
    return arrange(*site, groups, how, progress, mps);
}

std::vector<ServedDemand> ArrangeWork::served(const Arrangement& arrangement) const {
    return servedByRoom(*site, arrangement.served);
}

std::string ArrangeWork::contentOfDemand() const {
    if (!how.demand) return "";
    if (site->isOneRoom()) return how.demand->content();
    std::string text;
    for (const SiteRoom& room : site->rooms) text += room.goals.demand->content() + '\n';
    return text;
}

namespace {

/// Numbers of fixed sensors and of those that may be placed.
struct Numbers {
    std::size_t receivers = 0, others = 0;
};

Numbers numbersOf(const ArrangeWork& work) {
    Numbers numbers;
    for (const auto& room : work.input.rooms())
        for (const Sensor& sensor : room->sensors)
            if (kindOf(sensor.model).perceives)
                ++(isPartial(sensor.model) ? numbers.receivers : numbers.others);
    for (const SensorGroup& group : work.groups) {
        auto most = static_cast<std::size_t>(group.most);
        if (work.how.budget)
            most = affordableCount(*work.how.budget, 0, group.record.number("cost"), most);
        (isPartial(group.model) ? numbers.receivers : numbers.others) += most;
    }
    return numbers;
}

/// Returns the reason why a camera has too few pixels; "" without a camera or a required density.
std::string reasonOfDensity(const ArrangeWork& work) {
    const double density = work.how.pixel_density;
    if (!(density > 0)) return "";
    for (const SensorGroup& group : work.groups)
        if (const auto* camera = std::get_if<Camera>(&group.model))
            return "nowhere on the " + std::string(work.how.plane > 0 ? "plane" : "floor") +
                   " are there " + formatDouble(density) + " pixels a metre (--density): " +
                   (camera->model.empty() ? "a camera" : camera->model) + " has so many up to " +
                   formatFixed(withDensity(*camera, density).max_range, 2) + " m away";
    return "";
}

/// Returns the reason why coverage is zero; "" if it is not.
std::string reasonForNothing(const ArrangeWork& work, const Arrangement& arrangement) {
    const auto [receivers, others] = numbersOf(work);
    const std::size_t together = others + receivers / kMinReceivers;
    const auto times = static_cast<std::size_t>(work.how.redundancy);
    if (receivers > 0 && receivers < kMinReceivers)
        return "ultrasound covers nothing: at least " + std::to_string(kMinReceivers) +
               " receivers have to hear a tag, here are " + std::to_string(receivers);
    if (times > 1 && together < times)
        return "no floor counts: it has to be seen by " + std::to_string(times) +
               " sensors, and there are " + std::to_string(together);
    if (work.how.demand && arrangement.value == 0.0 && !arrangement.sensors.empty())
        return "the sensors see none of the " + std::string(work.how.demand->many()) +
               ": look at their heights, tilts and ranges";
    if (arrangement.coverage > 0 || arrangement.sensors.empty()) return "";
    if (!work.how.indoor_only && arrangement.candidate_value > 0) return "";
    if (std::string text = reasonOfDensity(work); !text.empty()) return text;
    return "the sensors cover nothing: look at their heights, tilts and ranges, and at what "
           "`coverage` draws (-o map.png)";
}

/// Section 4.4.5 of the thesis; "" if it does not apply.
std::string hintAlongWalls(const ArrangeWork& work) {
    constexpr double kSlack = 1e-9;  // degrees
    const bool has_headings = work.how.headings.has_value();
    if (work.how.strategy != Strategy::Wall || has_headings || work.how.mount.on == MountOn::Frame)
        return "";
    for (const SensorGroup& group : work.groups) {
        const auto* laser = std::get_if<Laser>(&group.model);
        const double span = laser == nullptr ? 0 : laser->sweptSpan().degrees();
        if (span > 180 + kSlack)
            return "along walls " + formatDouble(roundSignificant(span - 180, 4)) + " of the " +
                   formatDouble(roundSignificant(span, 4)) +
                   " degrees of a laser's field of view face the wall: --strategy grid or random "
                   "may cover more";
    }
    return "";
}

/// Warns of sensors above a room. \param prefix of the message
void warnOfHeights(const ArrangeToolOptions& options, const MountRules& mount,
                   const Environment& room, const std::string& prefix) {
    const double top = room.height();
    for (const double height : mount.heights)
        if (height > top)
            warn(options.common, "arrange",
                 prefix + "--z " + formatDouble(height) + ": the room is " +
                     formatDouble(std::round(1000 * top) / 1000) +
                     " m high, and nothing is there to mount a sensor on");
}

/// Warns with a reason if coverage is zero, and of redundant sensors.
void warnOfNothing(const ArrangeToolOptions& options, const ArrangeWork& work,
                   const Arrangement& arrangement) {
    std::string text = reasonForNothing(work, arrangement);
    if (text.empty()) text = idleText(arrangement);
    if (!text.empty()) warn(options.common, "arrange", text);
}

}  // namespace

void warnOfSearch(const ArrangeToolOptions& options, const ArrangeWork& work) {
    for (const std::string& note : options.groups->notes(work.how))
        report(options.common, "arrange", note);
    if (const std::string hint = hintAlongWalls(work); !hint.empty())
        warn(options.common, "arrange", hint);
    for (std::size_t i = 0; i < work.input.rooms().size(); ++i)
        warnOfHeights(options, work.how.mount, work.input.rooms()[i]->environment,
                      work.input.prefix(i));
}

void checkGoals(const ArrangeToolOptions& options, const ArrangeWork& work,
                const Arrangement& arrangement) {
    warnOfNothing(options, work, arrangement);
    for (const std::string& text : {doubledText(arrangement), inexactText(work.how, arrangement)})
        if (!text.empty()) warn(options.common, "arrange", text);
    if (!arrangement.is_reached) {
        std::string text = shortfallText(work.how, arrangement);
        if (arrangement.candidate_bound <= 0)
            if (const std::string reason = reasonOfDensity(work); !reason.empty())
                text += "; " + reason;
        throw UnmetError(text);
    }
    if (arrangement.unplaced > 0)
        throw UnmetError(std::to_string(arrangement.unplaced) +
                         " of the sensors are not placed: there are " +
                         (work.how.is_connected
                              ? "no candidates left from which views hang together (--connected)"
                              : "fewer candidates than sensors"));
}

}  // namespace ispace
