// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/postures: people that sit, lie, fall, point, reach and carry things: the keys
// `posture`, `support`, `left_arm` and `right_arm` of the record `human`. Uses server and below.
#pragma once

#include <memory>
#include <optional>

#include "geom/point.h"
#include "geom/pose.h"
#include "record/record.h"
#include "scene/bodies.h"
#include "scene/findings/findings.h"

namespace ispace::postures {

enum class Posture { Stand, Sit, Lie, Fallen };

/// The direction in which an arm holds its hand.
struct ArmPose {
    Angle yaw;         ///< from the heading, counter-clockwise
    Angle pitch;       ///< above level; -90 degrees: the arm hangs
    double reach = 0;  ///< from the shoulder to the hand, metres
    friend bool operator==(const ArmPose&, const ArmPose&) = default;
};

/// How a record holds the body of a person.
struct PersonPosture {
    double height = 1.7;
    Posture posture = Posture::Stand;
    double support = 0;  ///< height of the seat, the bed or the floor under it, metres
    std::optional<ArmPose> left = {}, right = {};  ///< unset: as they are in the posture
    std::optional<Vec3> load = {};  ///< length, width and height of the thing that it carries
    bool is_load_round = false;     ///< it is a cylinder, as long as it is wide
};

/// Reads a `human` record. \param thing that it carries, in the right hand ahead of it; may be null
/// \throws FormatError for angles and reaches out of range, and arms of a
/// person that lies
PersonPosture postureOf(const Record& person, const Record* thing = nullptr);

/// Longest reach of a hand, with the arm stretched: 0.43 of the height. A hand without a given
/// reach is kUsualReach of the height away, 0.6 m of 1.7 m.
double longestReach(double height);
constexpr double kUsualReach = 0.6 / 1.7;
/// Height of a seat that `support` does not tell, metres.
constexpr double kSeatHeight = 0.45;

/// Length, width and height of a thing that a person carries, at most, metres.
constexpr double kLargestLoad = 0.6;
bool mayBeCarried(const Record& thing);

/// Returns the joint of a shoulder in the person's frame. \param side 1: left, -1: right
Point3 shoulderOf(const PersonPosture& posture, double side);
/// Returns the middle of a hand that an arm holds.
Point3 handOf(const PersonPosture& posture, const ArmPose& arm, double side);
/// Returns the arm that holds the hand at a point, or in its direction if that is too far.
ArmPose armTo(const PersonPosture& posture, Point3 point, double side);

/// Builds the body, in parts whose level cuts are discs and upright boxes; null for a person that
/// stands with both arms at its sides.
///
/// A sitting person has its trunk above the seat, the lower arms level, level thighs and shanks
/// down to the floor, at most 0.28 of the height. A lying one has its head ahead; its limbs are
/// boxes. The elbow of an arm that points or reaches hangs as low as both halves of the arm allow:
/// a row of balls with the arm's radius, two thirds of it apart.
std::shared_ptr<const PersonFigure> figureOf(const PersonPosture& posture);

/// Finds people that sit or lie in the air, in a thing, or through a wall.
std::optional<Finding> checkBody(const Scene& scene, std::size_t record);

/// Adds the keys and states of `human`, its bodies, and the verbs `sits on`, `lies on`, `falls`,
/// `stands`, `points at`, `reaches` and `carries` of plans of days.
void addPostures();

}  // namespace ispace::postures
