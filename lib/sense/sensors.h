// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "layout/scene.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// The sensors of a run.
struct Sensors {
    std::vector<Sensor> read;       ///< what gives readings, tags among them, in order
    std::vector<Sensor> receivers;  ///< what hears the tags
};

/// The placed sensors of a scene whose ids match one of the globs, or all without globs; receivers
/// as far as tags are among them, all or those that match. \throws UsageError for a glob that
/// matches no sensor
Sensors sensorsOf(const Scene& scene, const std::vector<std::string>& globs);

/// Indices in Scene::records of the sensors of these keywords whose ids match one of the globs, or
/// of all without globs, placed or not.
std::vector<std::size_t> sensorRecords(const Scene& scene, std::span<const std::string_view> kinds,
                                       const std::vector<std::string>& globs);

/// True if an id matches one of the globs (* ? [a-z]), or there are none.
bool isSelected(const std::string& id, const std::vector<std::string>& globs);

/// A time in seconds as the nearest whole nanosecond, which prints as short as it should.
double wholeNanoseconds(double seconds);

/// The robots and people of a scene where they start; those of a robot are owned by its index in
/// Scene::robots.
std::vector<MovingBody> bodiesOf(const Scene& scene);

MovingBody robotBody(const RobotModel& model, const Pose2& pose, std::uint32_t owner);
/// A person's legs, trunk, arms and head.
std::vector<MovingBody> humanBodies(double height, const Pose2& pose, std::uint32_t owner);

}  // namespace ispace
