// SPDX-License-Identifier: GPL-3.0-or-later
// Sensors that a run reads, and the bodies that block their rays: the start of a scene, in its
// order.
//
//     const Sensors sensors = sensorsOf(scene, {"front-*"});
//     const MovingBodies bodies(bodiesOf(scene));
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

/// The sensors of a run.
struct Sensors {
    std::vector<Sensor> read;       ///< sensors with readings, including tags, in order
    std::vector<Sensor> receivers;  ///< receivers that hear the tags
};

/// Returns the placed sensors of a scene with an id that matches one of the globs, or all without
/// globs. Returns the matching receivers, or all if no receiver matches. \throws UsageError for a
/// glob that matches no sensor
Sensors sensorsOf(const Scene& scene, const std::vector<std::string>& globs);

/// Returns indices in Scene::records of the sensors with these keywords, placed or not, with an id
/// that matches one of the globs, or of all without globs.
std::vector<std::size_t> sensorRecords(const Scene& scene, std::span<const std::string_view> kinds,
                                       const std::vector<std::string>& globs);

/// True if an id matches one of the globs (* ? [a-z]), or `globs` is empty.
bool isSelected(const std::string& id, const std::vector<std::string>& globs);

/// Rounds seconds to whole nanoseconds, which print short; from 9e6 s on, where doubles are
/// coarser, returns them unchanged.
double wholeNanoseconds(double seconds);

/// Returns the robots and people of a scene at their start. The owner of a robot's body is its
/// index in Scene::robots, the owner of a person's parts kFirstPerson plus the index among the
/// people.
std::vector<MovingBody> bodiesOf(const Scene& scene);
constexpr std::uint32_t kFirstPerson = 1U << 31U;

/// Returns the owner of the bodies that do not block a sensor: the mover that carries it, or
/// MovingBodies::kNoOwner.
std::uint32_t carrierOf(const Sensor& sensor);

/// Motion of a mover on the floor, of its limbs too.
struct MoverVelocity {
    Point2 center;    ///< of rotation
    Vec2 linear;      ///< m/s, of the centre
    double turn = 0;  ///< radians a second
    [[nodiscard]] Vec2 at(Point2 point) const {
        const Vec2 arm = point - center;
        return linear + turn * Vec2{-arm.y, arm.x};
    }
};

/// Motions of robots and people, in the order of the scene; missing ones are at rest.
struct MoverVelocities {
    std::vector<MoverVelocity> robots, people;
    [[nodiscard]] MoverVelocity of(std::uint32_t owner) const;
};

/// Returns the motions at the start: movers with a path go towards its first point, wanderers along
/// their heading, at the speed of their model; others stand.
MoverVelocities startVelocities(const Scene& scene);

MovingBody robotBody(const RobotModel& model, const Pose2& pose, std::uint32_t owner);
/// Returns a person's limbs, trunk and head: personParts() at its pose. \param figure null: the
/// usual one
std::vector<MovingBody> humanBodies(double height, const Pose2& pose, std::uint32_t owner,
                                    Angle swing = {}, const PersonFigure* figure = nullptr);
/// True if the body extends through one of these heights, or `heights` is empty.
bool isAtSome(const MovingBody& body, std::span<const double> heights);
/// Adds the parts of humanBodies() that isAtSome() of these heights.
void addHumanBodies(double height, const Pose2& pose, std::uint32_t owner, Angle swing,
                    std::span<const double> heights, std::vector<MovingBody>& bodies,
                    const PersonFigure* figure = nullptr);

}  // namespace ispace
