// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan/pose_sensor.h"

#include <algorithm>

#include "base/error.h"
#include "layout/schemas.h"
#include "layout/sensor_spec.h"
#include "sensor/kind.h"

namespace ispace {

namespace {

/// Keywords of what may follow poses.
std::vector<std::string_view> movable() { return keywordsOf(&SensorKind::follows_poses); }

Record recordOfModel(const std::string& model, const DeviceCatalogue& devices) {
    const SensorSpec spec = readSensorSpec(model, movable(), sceneSchemas(), devices);
    const Record& record = spec.record;
    // What is wrong with its figures is wrong on the command line.
    try {
        static_cast<void>(sensorModelOf(record, devices));
    } catch (const FormatError& error) {
        throw UsageError(error.diagnostics().front().message);
    }
    if (spec.count.value_or(1) > 1) throw UsageError("one sensor takes the poses, not several");
    for (const char* key : {"at", "heading", "tilt", "roll", "on"})
        if (record.has(key))
            throw UsageError(std::string("`") + key + "` is told by the poses; leave it out");
    return record;
}

std::size_t onlySensor(const Scene& scene, const std::vector<std::string>& globs) {
    const std::vector<std::size_t> found = sensorRecords(scene, movable(), globs);
    if (found.size() == 1) return found.front();
    throw UsageError("--poses: " + std::to_string(found.size()) +
                     " sensors could take them; say which with --model or --select");
}

/// The mount of a sensor that the scene has placed.
std::optional<Mount> mountOf(const Scene& scene, const std::string& id) {
    const auto found = std::find_if(scene.sensors.begin(), scene.sensors.end(),
                                    [&id](const Sensor& sensor) { return sensor.id == id; });
    return found == scene.sensors.end() ? std::nullopt : found->mount;
}

}  // namespace

Sensors sensorForPoses(const ScanToolOptions& options, const Scene& scene,
                       const DeviceCatalogue& devices) {
    std::optional<Record> of_model;
    std::string id;
    if (!options.model.empty()) {
        try {
            of_model = recordOfModel(options.model, devices);
        } catch (const UsageError& error) {
            throw UsageError(std::string("--model: ") + error.what());
        }
        id = of_model->writtenId().empty() ? of_model->keyword() + "1" : of_model->writtenId();
    }
    const std::size_t only = of_model ? 0 : onlySensor(scene, options.select);
    const Record& record = of_model ? *of_model : scene.records[only];
    if (!of_model) id = scene.ids[only];

    Sensors sensors;
    const auto mount = of_model ? std::nullopt : mountOf(scene, id);
    sensors.read.push_back({id, sensorModelOf(record, devices), {}, mount});
    const Sensor& sensor = sensors.read.front();
    if (options.motion && sensor.is<Laser>() && sensor.as<Laser>().sweep != SweepAxis::None)
        throw UsageError("--motion: a laser either sweeps or drives, and " + id + " sweeps");
    return sensors;
}

}  // namespace ispace
