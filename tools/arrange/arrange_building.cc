// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/arrange_building.h"

#include <algorithm>
#include <string>
#include <vector>

#include "arrange/arrange_run.h"
#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "base/run_files.h"
#include "building/building_arrange.h"
#include "cli/building_operands.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "record/text.h"
#include "report/coverage_report.h"
#include "scene/placement_schemas.h"

namespace ispace {

namespace {

/// \throws UsageError for an option that is about one room
void mustBeAboutBuildings(const ArrangeToolOptions& options, const BuildingInput& input) {
    const ZoneWords& zones = options.zones;
    std::string option;
    if (options.how.target) option = "--target";
    if (options.how.budget) option = "--budget";
    if (options.how.refine) option = options.how.over_poses ? "--proof poses" : "--refine";
    if (options.how.robust.isAsked())
        option = options.how.robust.of == RobustChoice::Of::Crowd ? "--crowd" : "--robust";
    if (!options.how.objective.isCoverage()) option = "--objective";
    if (!zones.targets.empty()) option = "--zone";
    if (!zones.weights.empty()) option = "--weight";
    if (!zones.keep_out.empty()) option = "--keep-out";
    if (!zones.keep_in.empty()) option = "--keep-in";
    if (!zones.facing.empty()) option = "--facing";
    if (!zones.privacy.empty()) option = "--privacy";
    if (options.presence) option = "--presence";
    if (!options.places_file.empty()) option = "--places";
    if (!options.fixed.empty()) option = "--fixed";
    if (!options.trace_file.empty()) option = "--trace";
    if (!options.curve_file.empty()) option = "--curve";
    if (!options.mps_file.empty()) option = "--export-mps";
    if (!options.report_file.empty()) option = "--report";
    if (!options.page.material.empty()) option = "--material";
    if (options.batch.shard) option = "--shard";
    if (options.batch.resume) option = "--resume";
    if (input.layout) option = "a LAYOUT";
    if (options.sensors.size() > 1) option = "several --sensor";
    for (const auto& scene : input.building.scenes)
        if (!scene->sensors.empty() || !scene->pending.empty()) option = "a room with sensors";
    if (!option.empty())
        throw UsageError(option +
                         " is about one storey of the building: choose it with --storey (" +
                         input.building.document.storeyList() + ')');
    if (options.sensors.empty())
        throw UsageError("nothing to place: give --sensor MODEL:COUNT for the building");
}

SensorSpec sensorOf(const ArrangeToolOptions& options) {
    const DeviceCatalogue& devices = devicesForSensors(options.sensors);
    return ofOption("--sensor", [&] {
        return readSensorSpec(options.sensors.front(), keywordsOf(&SensorKind::is_arranged),
                              sceneSchemas(), devices);
    });
}

std::string countText(std::size_t count) {
    return std::to_string(count) + (count == 1 ? " sensor" : " sensors");
}

/// Returns a line for each storey and one for the building.
std::string buildingText(const BuildingScene& building, const BuildingArrangement& found) {
    std::string text;
    std::size_t sensors = 0;
    for (std::size_t i = 0; i < found.storeys.size(); ++i) {
        const Arrangement& storey = found.storeys[i];
        sensors += storey.sensors.size();
        text += "arrange: storey " + building.document.storeys[i].id + ": " +
                (found.has_floor[i] ? countText(storey.sensors.size()) + ", coverage " +
                                          percentText(storey.coverage)
                                    : "left out, all of its floor is open") +
                '\n';
    }
    const double gap = found.bound > 0 ? std::max(0.0, 1 - found.value / found.bound) : 0;
    constexpr double kProven = 1e-9;
    text += "arrange: building: " + countText(sensors) + ", coverage " +
            percentText(found.coverage) + "; value " + percentText(found.value) +
            ", bound for every split " + percentText(found.bound) + " (" +
            (gap > kProven + found.rounding ? "gap " + percentText(gap) : "proven best") + ')' +
            (found.is_complete ? "" : ", cut short") + '\n';
    return text;
}

void mustBePlaced(const BuildingArrangement& found) {
    std::size_t unplaced = 0;
    for (const Arrangement& storey : found.storeys) unplaced += storey.unplaced;
    if (unplaced > 0)
        throw UnmetError(std::to_string(unplaced) +
                         " of the sensors are not placed: there are fewer candidates than sensors");
}

}  // namespace

bool arrangeInBuilding(const ArrangeCommand& command) {
    const ArrangeToolOptions& options = command.options();
    auto read = readBuildingInput({options.operands, options.rules, false});
    if (!read) return false;
    BuildingInput& input = *read;
    mustBeAboutBuildings(options, input);
    const SensorSpec sensor = sensorOf(options);
    if (input.building.devices.devices().empty())
        input.building.devices = devicesForSensors(options.sensors);
    limitThreads(options.common.threads);
    claimOutputs(options.common);
    mustBeWritable(options.common.output);
    warn(options.common, "arrange", input.warnings);
    for (std::size_t i = 0; i < input.building.scenes.size(); ++i)
        warnOfHeights(options, options.how.mount, input.building.scenes[i]->environment,
                      input.building.document.storeys[i].id);
    SearchWatch watch(makeProgress("arrange", options.common.progress, options.common.quiet),
                      options.time_limit);
    const BuildingArrangement found =
        arrangeBuilding(input.building, sensor, sensor.count.value_or(1), options.how, watch);
    LayoutParts parts{{},
                      environmentFileFor(options.common.output, input.environment_operand),
                      input.building.document.digest(),
                      std::string(nameOf(options.how.strategy)),
                      std::string(nameOf(options.how.search.optimizer))};
    parts.history.push_back(command.historyLine(input.named));
    writeAll(options.common.output, writeRecordText(buildingLayout(parts, input.building, found)));
    writeDependencies(options.common, input.files);
    if (!options.common.quiet) writeLines("arrange", buildingText(input.building, found));
    if (watch.signal() != 0) endBySignal(watch.signal());
    mustBePlaced(found);
    return true;
}

}  // namespace ispace
