// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/setting.h"

#include <algorithm>
#include <utility>

#include "sim/people.h"

namespace ispace {

Setting::Setting(std::shared_ptr<const Scene> made_of, const RunOptions& options,
                 const Worlds::Meshes& meshes)
    : scene(std::move(made_of)),
      obstacles(obstaclesOf(scene->environment, moversOf(*scene))),
      friction(scene->environment),
      worlds(scene->environment) {
    if (meshes.opaque) worlds.prepareMesh();
    if (meshes.solid) worlds.prepareMesh(Surfaces::Solid);
    // A client that asks first must not wait for them, nor the others.
    if (std::any_of(scene->robots.begin(), scene->robots.end(),
                    [](const PlacedRobot& robot) { return !robot.model.sonar.places.empty(); }))
        worlds.prepareMesh(Surfaces::Solid);
    for (const Sensor& sensor : scene->sensors) {
        if (sensor.is<Ranger>()) worlds.prepareMesh();
        if (sensor.is<Tag>()) worlds.prepareMesh(Surfaces::Solid);
        const auto* const laser = std::get_if<Laser>(&sensor.model);
        if (laser == nullptr) continue;
        worlds.prepare(sensor.pose);
        if (laser->sweep != SweepAxis::None) worlds.prepareMesh();
    }
    const bool has_cameras = std::any_of(scene->sensors.begin(), scene->sensors.end(),
                                         [](const Sensor& sensor) { return sensor.is<Camera>(); });
    if (!has_cameras) return;
    PhotoOptions photo;
    photo.with_noise = options.sensor_noise;
    photo.seed = options.seed;
    photographer = std::make_unique<Photographer>(*scene, photo);
}

}  // namespace ispace
