// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/arrange_run.h"

#include <algorithm>
#include <cmath>
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

}  // namespace

void takeZones(const ArrangeToolOptions& options, const Environment& environment,
               ArrangeOptions& how) {
    const ZoneWords& words = options.zones;
    const auto add = [&](const std::vector<std::string>& texts, std::vector<NamedZone>& zones) {
        for (const std::string& text : texts)
            for (NamedZone& zone : zonesOf(options, text, environment))
                zones.push_back(std::move(zone));
    };
    add(words.targets, how.weights.targets);
    add(words.keep_out, how.mount.keep_out);
    add(words.keep_in, how.mount.keep_in);
    for (const std::string& text : words.weights) {
        const auto [name, weight] = splitWeight(text);
        for (NamedZone& zone : zonesOf(options, name, environment))
            how.weights.weights.emplace_back(std::move(zone), weight);
    }
}

namespace {

/// Reads the rooms of --robust, each with the layout.
void takeRooms(const ArrangeToolOptions& options, ArrangeWork& work) {
    if (options.robust_rooms.empty()) return;
    RobustChoice& robust = work.how.robust;
    robust.name = baseName(work.input.environment_operand);
    for (const std::string& file : options.robust_rooms) {
        if (isStream(file)) throw UsageError("--robust rooms: stdin is not read: give files");
        SceneRequest request{{file}, options.rules, false};
        request.rules.same_environment = false;
        if (!work.input.layout_operand.empty())
            request.operands.push_back(work.input.layout_operand);
        SceneInput room = readScene(request);
        if (!options.fixed.empty() && room.layout) {
            room.layout = withoutPlaces(*room.layout, options.fixed);
            room.scene = makeScene(room.environment, &*room.layout,
                                   devicesFor({&room.environment, &*room.layout}), &room.scene);
        }
        warnOfImport(options.common, "arrange", room);
        for (const std::string& source : filesOf(room)) work.files.push_back(source);
        robust.rooms.push_back({baseName(file), std::make_shared<Scene>(std::move(room.scene))});
    }
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
    ArrangeWork work{readScene({options.operands, options.rules, false}), {}, options.how, {}, {}};
    SceneInput& input = work.input;
    warnOfImport(options.common, "arrange", input);
    if (!options.fixed.empty()) {
        if (!input.layout) throw UsageError("--fixed is about the sensors of a LAYOUT: give one");
        input.layout = withoutPlaces(*input.layout, options.fixed);
        input.scene = makeScene(input.environment, &*input.layout,
                                devicesFor({&input.environment, &*input.layout}), &input.scene);
    }
    warn(options.common, "arrange", sceneWarnings(input.scene, {.checks = {"outside", "buried"}}));
    const bool open = options.how.target || options.how.budget;
    work.groups = groupsToPlace(input.scene, added, devices, open);
    if (work.groups.empty())
        throw UsageError("nothing to place: give --sensor, or a LAYOUT with a sensor without `at`");
    takeZones(options, input.scene.environment, work.how);
    work.files = filesOf(input);
    takeRooms(options, work);
    if (options.presence) {
        work.how.ways = std::make_shared<PeopleWays>(
            readWays(*options.presence, input.scene, options.common.seed));
        if (!options.presence->record.empty())
            work.files.push_back(RecordedFiles(options.presence->record).robots);
    }
    if (work.how.objective.of == ObjectiveChoice::Of::Path)
        for (const std::string* zone : {&work.how.objective.way.from, &work.how.objective.way.to})
            static_cast<void>(
                ofOption("--objective", [&] { return readZone(*zone, input.scene.environment); }));
    work.how.facing = facingIn(input.scene.environment, options.how.facing);
    for (const PrivacyRule& rule : options.how.privacy)
        static_cast<void>(privateZones(rule, input.scene.environment));
    if (!options.places_file.empty()) {
        work.places = options.places_file == "-" ? readStdin() : readAll(options.places_file);
        work.how.list =
            readSites(work.places, options.places_file,
                      headingsAround(work.how.headings.value_or(work.how.density.headings)));
        work.files.push_back(options.places_file);
    }
    return work;
}

namespace {

/// Numbers of fixed sensors and of those that may be placed.
struct Numbers {
    std::size_t receivers = 0, others = 0;
};

Numbers numbersOf(const ArrangeWork& work) {
    const Scene& scene = work.input.scene;
    Numbers numbers;
    for (const Sensor& sensor : scene.sensors)
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
        return "nothing counts: floor has to be seen by " + std::to_string(times) +
               " sensors, and there are " + std::to_string(together);
    if (arrangement.coverage > 0 || arrangement.sensors.empty()) return "";
    if (!work.how.judges_inside && arrangement.candidate_value > 0) return "";
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

}  // namespace

void warnOfHeights(const ArrangeToolOptions& options, const MountRules& mount,
                   const Environment& room, const std::string& storey) {
    const double top = room.height();
    for (const double height : mount.heights)
        if (height > top)
            warn(options.common, "arrange",
                 (storey.empty() ? "" : storey + ": ") + "--z " + formatDouble(height) +
                     ": the room is " + formatDouble(std::round(1000 * top) / 1000) +
                     " m high, and nothing is there to mount a sensor on");
}

namespace {

/// Warns with a reason if coverage is zero, and of redundant sensors.
void warnOfNothing(const ArrangeToolOptions& options, const ArrangeWork& work,
                   const Arrangement& arrangement) {
    std::string text = reasonForNothing(work, arrangement);
    if (text.empty()) text = idleText(arrangement);
    if (!text.empty()) warn(options.common, "arrange", text);
}

}  // namespace

void warnOfSearch(const ArrangeToolOptions& options, const ArrangeWork& work) {
    if (const std::string hint = hintAlongWalls(work); !hint.empty())
        warn(options.common, "arrange", hint);
    warnOfHeights(options, work.how.mount, work.input.scene.environment);
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
