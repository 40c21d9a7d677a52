// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan/scan_building.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "building/building_sight.h"
#include "cli/building_operands.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "scan/scan_run.h"
#include "sense/warnings.h"

namespace ispace {

namespace {

/// \throws UsageError for an option that is about one room
void mustBeAboutBuildings(const ScanToolOptions& options, const StoreyedDocument& building) {
    std::string option;
    if (!options.poses.empty()) option = "--poses";
    if (!options.view.run.empty()) option = "--run";
    if (options.batch.shard) option = "--shard";
    if (options.batch.resume) option = "--resume";
    if (!option.empty()) refuseSeveralRooms(option, building);
}

/// The sensors that are read on a storey, with ids of the building.
struct StoreySensors {
    std::size_t storey = 0;
    SceneInput input;
    Sensors sensors;
};

/// Returns the scene of a storey in its surroundings.
Scene sceneOf(const Coupling& coupling, std::size_t storey) {
    Scene scene = *coupling.building().scenes[storey];
    scene.environment = *coupling.surroundings(storey, Coupling::Movers::OfNeighbours);
    return scene;
}

/// Returns the sensors to read: of each storey those that see it alone, then those that see others.
std::vector<std::unique_ptr<StoreySensors>> sensorsIn(const ScanToolOptions& options,
                                                      const BuildingInput& input) {
    std::vector<std::unique_ptr<StoreySensors>> all;
    for (std::size_t i = 0; i < input.building.scenes.size(); ++i) {
        const Scene& scene = *input.building.scenes[i];
        const Storey& storey = input.building.document.storeys[i];
        for (const bool looks_around : {false, true}) {  // those that see other storeys last
            std::vector<std::string> chosen;             // plain ids
            for (const Sensor& sensor : scene.sensors)
                if (seesOtherStoreys(sensor) == looks_around &&
                    isSelected(wholeId(storey, sensor.id), options.select))
                    chosen.push_back(sensor.id);
            if (chosen.empty()) continue;
            auto one = std::make_unique<StoreySensors>(StoreySensors{
                i, {scene, {}, {}, {}, {}, input.named, {}}, sensorsOf(scene, chosen)});
            one->input.layout = input.layout;
            for (std::vector<Sensor>* sensors : {&one->sensors.read, &one->sensors.receivers})
                for (Sensor& sensor : *sensors) sensor.id = wholeId(storey, sensor.id);
            if (!one->sensors.read.empty()) all.push_back(std::move(one));
        }
    }
    if (all.empty())
        throw UsageError(options.select.empty()
                             ? displayName(input.environment_operand) +
                                   " has no placed sensor that is read: give a layout"
                             : "--select chooses nothing that is read: ids begin with their "
                               "storey, such as " +
                                   input.building.document.storeys.front().id + "/l1");
    return all;
}

/// Takes all readings of a storey. \param scene see sceneOf() \return their number
std::int64_t readStorey(const ScanToolOptions& options, const StoreySensors& one,
                        const Scene& scene, const ReadingFormat& format, Packing packing,
                        const std::function<void(Readings&)>& write) {
    Worlds worlds(scene.environment);
    const MovingBodies bodies(bodiesOf(scene));
    TakerOptions taking{.celsius = options.celsius, .velocities = startVelocities(scene)};
    if (options.noise) taking.noise_seed = options.common.seed;
    std::optional<Photographer> photographer;
    if (std::any_of(one.sensors.read.begin(), one.sensors.read.end(),
                    [](const Sensor& sensor) { return sensor.is<Camera>(); }))
        taking.photographer = &photographer.emplace(scene, options.photo);
    ReadingSampler taker(one.sensors, worlds, bodies, taking);
    StillSource source(one.sensors, options.frames.value_or(1));
    const std::int64_t count = source.count();
    SilentProgress progress;
    runReadings(source, taker, one.sensors, format, packing, options.coordinates, progress, write);
    return count;
}

/// \throws UsageError for a format that cannot hold several storeys in one file
void mustHoldStoreys(const ScanToolOptions& options, const ReadingFormat& format) {
    if (format.isStream() && !format.isBinary()) return;
    throw UsageError(options.format +
                     " holds the readings of one storey: name a folder (-o DIR/) or a pattern (-o "
                     "'%s-%04d." +
                     options.format + "'), or choose a storey with --storey");
}

}  // namespace

std::optional<std::int64_t> scanBuilding(const ScanCommand& command,
                                         const ScanToolOptions& options) {
    SceneRequest request = requestOf(options);
    request.layout_from_stdin = request.layout_from_stdin && options.view.views.empty();
    const auto read = readBuildingInput(request);
    if (!read) return std::nullopt;
    const BuildingInput& input = *read;
    mustBeAboutBuildings(options, input.building.document);
    warnOfImport(options.common, "scan", input);
    const Coupling coupling(input.building);
    if (options.view.views.empty())
        warn(options.common, "scan",
             storeyWarnings(coupling, {.checks = {"unplaced", "outside", "buried"}},
                            [&](const std::string& id) { return isSelected(id, options.select); }));
    if (!options.view.views.empty()) {
        takeBuildingViews(options, input);
        return 0;
    }
    const bool is_set = OutputSet::of(options.common.output).has_value();
    std::optional<OutputFile> file;
    std::int64_t done = 0;
    // All sensors are judged before the first reading.
    const auto chosen = sensorsIn(options, input);
    std::vector<Sensor> all;
    std::vector<std::unique_ptr<ReadingFormat>> formats;
    for (const auto& one : chosen) {
        all.insert(all.end(), one->sensors.read.begin(), one->sensors.read.end());
        formats.push_back(
            makeFormat(options.format, one->sensors, formatOptions(command, options, one->input)));
        if (!is_set) mustHoldStoreys(options, *formats.back());
    }
    command.checkSensors(all);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const StoreySensors* const one = chosen[i].get();
        const ReadingFormat* const format = formats[i].get();
        const Scene scene = sceneOf(coupling, one->storey);
        warn(options.common, "scan", format->warnings());
        if (is_set) {
            const std::int64_t count =
                StillSource(one->sensors, options.frames.value_or(1)).count();
            const auto delivery = makeDelivery(options, one->sensors, *format, count);
            done += readStorey(options, *one, scene, *format, delivery->how(),
                               [&](Readings& readings) { delivery->write(readings); });
            delivery->commit();
            continue;
        }
        // One header: those of the storeys are equal.
        if (!file) file.emplace(options.common.output).write(format->header());
        done += readStorey(options, *one, scene, *format, Packing::Stream,
                           [&](Readings& readings) { file->write(readings.text); });
    }
    if (file) file->commit();
    writeDependencies(options.common, input.files);
    logInfo(options.common, "scan",
            std::to_string(done) + (done == 1 ? " reading" : " readings") + " written");
    return done;
}

}  // namespace ispace
