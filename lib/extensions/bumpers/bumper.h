// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/bumpers: the forces with which robots run into things, robots and people. Uses
// record, env, scene, server.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "env/body.h"
#include "geom/point.h"
#include "record/schema.h"
#include "scene/findings/findings.h"
#include "scene/scene.h"
#include "server/client_role.h"

namespace ispace::bumpers {

/// Returns the greatest force of a contact, newtons: a mass that meets a spring at a speed turns
/// all its energy into the spring's, so that the force is speed * sqrt(stiffness * mass). Two
/// bodies that meet have the reduced mass m1 m2 / (m1 + m2). Friction and damping are left out,
/// which makes it the greatest for a bumper of this stiffness. \param speed m/s, of both bodies
/// towards each other; 0 if negative \param stiffness N/m \param mass kg
double contactForce(double speed, double stiffness, double mass);

/// Returns the reduced mass of two bodies, kg.
double reducedMass(double a, double b);

/// A robot that moves, as a body meets it.
struct RobotOnItsWay {
    Point2 place;
    Vec2 velocity;
    double radius = 0, height = 0;
};
/// Returns the point of a body that a robot meets first: of its lines and footprints at the
/// robot's height, the nearest point of the one that it reaches first; without one ahead the
/// nearest of all. Empty if it has none, as a mesh.
std::optional<Point2> contactOf(const Body& body, const RobotOnItsWay& robot);

/// Checks the `of` of a bumper. Returns an error if it names no robot.
std::optional<Finding> checkBumper(const Scene& scene, std::size_t record);

/// Returns the schema of `bumper`, a placement without a pose.
std::vector<Schema> bumperSchemas();

/// Adds the kind of bumpers, for the program.
void addBumpers();

/// Makes the role BUMPER of a run that has bumpers; null without any.
///
/// When a robot with a bumper runs into something, or another mover runs into it, the service
/// computes the force by the `mass` of its record, its velocity before the step across the surface
/// that it meets, and the bumper's `stiffness`; robots have their masses, people kPersonMass.
/// `force` is a state of the bumper, as events of the run: newtons for kForceHold seconds at least
/// and until a robot that ran into something moves again, else 0; of contacts within kForceHold the
/// hardest counts. Programs, any number of them, take the role by `BUMPER GLOB`, and hear
/// `EVENT impact`; READ tells the force. A step costs O(bumpers).
/// \throws FormatError for a bumper of no robot
std::unique_ptr<RoleService> makeBumpers(std::span<const RunRoom> rooms, std::uint64_t seed);

constexpr double kPersonMass = 70;  // kg
constexpr double kForceHold = 0.1;  // seconds

}  // namespace ispace::bumpers
