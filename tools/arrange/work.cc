// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/work.h"

#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "cli/outputs.h"
#include "env/door_zones.h"
#include "layout/check_scene.h"
#include "layout/scene.h"
#include "layout/schemas.h"

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
    if (!options.places_file.empty()) {
        work.places = options.places_file == "-" ? readStdin() : readAll(options.places_file);
        work.how.list =
            readSites(work.places, options.places_file,
                      headingsAround(work.how.headings.value_or(work.how.density.headings)));
        work.files.push_back(options.places_file);
    }
    return work;
}

}  // namespace ispace
