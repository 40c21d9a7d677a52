// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// The sensors that take part in a run.
struct Sensors {
    std::vector<Sensor> read;       ///< those with readings, including tags, in order
    std::vector<Sensor> receivers;  ///< those that hear the tags
};

/// The placed sensors of a scene whose ids match one of the globs, or all without globs. Receivers
/// are those that match, or all if none does. \throws UsageError for a glob that matches no sensor
Sensors sensorsOf(const Scene& scene, const std::vector<std::string>& globs);

/// Indices in Scene::records of the sensors with these keywords, placed or not, whose ids match one
/// of the globs, or of all without globs.
std::vector<std::size_t> sensorRecords(const Scene& scene, std::span<const std::string_view> kinds,
                                       const std::vector<std::string>& globs);

/// True if an id matches one of the globs (* ? [a-z]), or there are none.
bool isSelected(const std::string& id, const std::vector<std::string>& globs);

/// Rounds seconds to whole nanoseconds, which print short.
double wholeNanoseconds(double seconds);

/// The robots and people of a scene where they start. The owner of a robot's body is its index in
/// Scene::robots, that of a person's parts kFirstPerson and the index among the people.
std::vector<MovingBody> bodiesOf(const Scene& scene);
constexpr std::uint32_t kFirstPerson = 1U << 31U;

/// Owner of the bodies that do not hide anything from a sensor: the robot or person that carries
/// it, or MovingBodies::kNoOwner.
std::uint32_t carrierOf(const Sensor& sensor);

MovingBody robotBody(const RobotModel& model, const Pose2& pose, std::uint32_t owner);
/// A person's limbs, trunk and head: humanParts() where she stands.
std::vector<MovingBody> humanBodies(double height, const Pose2& pose, std::uint32_t owner,
                                    Angle swing = {});
/// True if one of these heights passes the body; also if there are none.
bool isAtSome(const MovingBody& body, std::span<const double> heights);
/// Adds those of them that isAtSome() of these heights.
void addHumanBodies(double height, const Pose2& pose, std::uint32_t owner, Angle swing,
                    std::span<const double> heights, std::vector<MovingBody>& bodies);

}  // namespace ispace
