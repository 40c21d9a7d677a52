// SPDX-License-Identifier: GPL-3.0-or-later
// scan: simulates what the sensors of a scene read.
#include <algorithm>
#include <iostream>

#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "cli/dependencies.h"
#include "cli/operands.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "layout/device_table.h"
#include "layout/schemas.h"
#include "layout/sensor_spec.h"
#include "scan/delivery.h"
#include "scan/options.h"
#include "sense/bodies.h"

namespace {

using namespace ispace;

constexpr std::string_view kKinds[] = {"laser", "ranger", "ultrasound", "tag"};
/// What may follow poses.
constexpr std::string_view kMovable[] = {"laser", "ranger"};

/// The record of the sensor that takes the poses: that of --model, or the only one of the scene.
Record recordForPoses(const ScanToolOptions& options, const Scene& scene,
                      const DeviceCatalogue& devices) {
    if (!options.model.empty()) {
        const std::vector<Record> records =
            readSensorSpec(options.model, kMovable, sceneSchemas(), devices);
        if (records.size() > 1)
            throw UsageError("--model: one sensor takes the poses, not several");
        return records.front();
    }
    const std::vector<std::size_t> found = sensorRecords(scene, kMovable, options.select);
    if (found.size() == 1) {
        Record record = scene.records[found.front()];
        if (!record.has("id")) record.set("id", Value(scene.ids[found.front()]));
        return record;
    }
    throw UsageError("--poses: " + std::to_string(found.size()) +
                     " sensors could take them; say which with --model or --select");
}

Sensors sensorForPoses(const ScanToolOptions& options, const Scene& scene) {
    const DeviceCatalogue devices = DeviceCatalogue::load(shareFolder() + "/devices");
    const Record record = recordForPoses(options, scene, devices);
    const std::string id = record.writtenId().empty() ? record.keyword() + "1" : record.writtenId();
    Sensors sensors;
    if (record.keyword() == "laser") {
        sensors.lasers.push_back({id, laserOf(record, devices), poseOf(record)});
        sensors.order.push_back({SensorKind::Laser, 0});
    } else {
        sensors.rangers.push_back({id, rangerOf(record, devices), poseOf(record)});
        sensors.order.push_back({SensorKind::Ranger, 0});
    }
    if (options.motion && record.keyword() == "laser" && sensors.lasers.front().laser.scans() > 1)
        throw UsageError("--motion: a laser either sweeps or drives, and " + id + " sweeps");
    return sensors;
}

Sensors placedSensors(const ScanToolOptions& options, const SceneInput& input) {
    Sensors sensors = sensorsOf(input.scene, options.select);
    if (sensors.order.empty())
        throw FormatError({displayName(input.layout_operand), 0, 0,
                           "no placed sensor: give one `at=x,y`, or let arrange place it"});
    return sensors;
}

void warn(const ScanToolOptions& options, const std::vector<std::string>& warnings) {
    if (options.common.quiet) return;
    for (const std::string& warning : warnings) std::cerr << "scan: warning: " << warning << '\n';
}

std::unique_ptr<ReadingSource> sourceFor(const ScanToolOptions& options, const Sensors& sensors) {
    if (options.poses.empty()) return std::make_unique<StillSource>(sensors, options.frames);
    if (options.poses == "-" && isTerminalInput())
        throw UsageError("stdin is a terminal: give a file of poses, or send them through a pipe");
    const auto file = std::make_shared<InputFile>(options.poses);
    PoseLines poses([file](std::string& bytes) { return file->read(bytes); },
                    displayName(options.poses));
    if (!options.motion) return std::make_unique<PoseSource>(std::move(poses));
    const Sensors::Entry& sensor = sensors.order.front();
    return std::make_unique<MotionSource>(std::move(poses), sensors.rate(sensor),
                                          durationOf(sensors, sensor));
}

FormatOptions formatOptions(const ScanCommand& command, const SceneInput& input) {
    const ScanToolOptions& options = command.options();
    History history = input.layout ? input.layout->history : History();
    history.push_back(command.historyLine(input.named));
    return {.history = std::move(history),
            .seed = options.common.seed,
            .frame = options.coordinates,
            .encoding = options.encoding,
            .depth_per_metre = options.depth_per_metre,
            .color = options.color,
            .map_pixels = options.map_pixels};
}

SceneRequest requestOf(const ScanToolOptions& options) {
    // The sensor of --poses may come from a LAYOUT, too.
    const bool wants_layout =
        options.poses.empty() || (options.model.empty() && options.poses != "-");
    const bool takes_stdin =
        std::find(options.operands.begin(), options.operands.end(), "-") != options.operands.end();
    if (options.poses == "-" && takes_stdin)
        throw UsageError("stdin cannot be read twice: only one of operands and --poses can be -");
    return {options.operands, options.any_environment, wants_layout};
}

void scan(const ScanCommand& command) {
    const ScanToolOptions& options = command.options();
    if (options.list_models) {
        writeAll(options.common.output,
                 deviceTable(DeviceCatalogue::load(shareFolder() + "/devices"), kKinds));
        return;
    }
    const ThreadLimit threads(options.common.threads);
    const SceneInput input = readScene(requestOf(options));
    const Scene& scene = input.scene;
    const bool moves = !options.poses.empty();
    const Sensors sensors = moves ? sensorForPoses(options, scene) : placedSensors(options, input);
    if (!moves) warn(options, doubtsAbout(scene, sensors));
    const auto format = makeFormat(options.format, sensors, formatOptions(command, input));
    if (format->isBinary()) refuseTerminal(options.common.output, options.format);

    Worlds worlds(scene.environment);
    const MovingBodies bodies(bodiesOf(scene));
    TakerOptions taking{.celsius = options.celsius, .follows_poses = moves};
    if (options.noise) taking.noise_seed = options.common.seed;
    ReadingTaker taker(sensors, worlds, bodies, taking);
    const auto source = sourceFor(options, sensors);
    const std::int64_t count = moves ? -1 : static_cast<const StillSource&>(*source).count();
    const auto delivery = makeDelivery(options, sensors, *format, count);
    const auto progress = makeProgress("scan", options.common.progress, options.common.quiet);
    progress->begin("readings", std::max<std::int64_t>(count, 0));
    std::int64_t done = 0;
    runReadings(*source, taker, sensors, *format, delivery->how(), options.coordinates, *progress,
                [&](const Readings& readings) {
                    delivery->write(readings);
                    done += static_cast<std::int64_t>(readings.jobs.size());
                });
    delivery->commit();
    progress->end();
    writeDependencies(options.common, filesOf(input));
    talk(options.common, "scan", std::to_string(done) + " readings written");
}

}  // namespace

int main(int argc, char** argv) {
    return ispace::runTool("scan", [&] { scan(ispace::ScanCommand(argc, argv)); });
}
