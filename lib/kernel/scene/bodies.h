// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of placed records: closed meshes for models and pictures, and the solids of people that
// rays meet.
//
// Sensors meet the solids, see trace/moving_bodies.h. Meshes of cylinders lie within
// kCurveTolerance of them, those of balls within 2 % of the radius, and people are drawn with
// upright limbs. Metres; pure functions, O(parts).
//
//     for (const PlacedRecord& placed : scene.placed)
//         for (const Mesh& mesh : bodyOf(scene, placed)) triangles += mesh.triangles.size();
#pragma once

#include <bitset>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "env/mesh.h"
#include "scene/robot.h"
#include "scene/scene.h"

namespace ispace {

/// Returns the triangles of a placed record, one mesh per material, in its own frame: x forward, z
/// up, origin at its pose (a sensor's optical centre, on the floor for the others). All are closed
/// and seen from outside only. They are drawn, but stop neither rays nor robots.
///
/// A sensor's mesh comes from its kind; a mat is a thin plate; a gate is two posts across its
/// heading, with a head each at the beam's height; a robot is its visible body with a nose; a
/// person is humanBodyOf() of personParts().
std::vector<Mesh> bodyOf(const Scene& scene, const PlacedRecord& placed);

/// Returns the field of view of a placed sensor as a translucent sheet in its frame, see
/// SensorKind::view. It ends at the width of the plan, so that a model stays in scale. Empty for
/// all other records.
std::optional<Mesh> viewOf(const Scene& scene, const PlacedRecord& placed);

/// Builds the mesh of a robot: the box or cylinder that sensors see, with a nose; the centre of
/// rotation is on the floor at the origin.
Mesh robotMesh(const RobotModel& model);

/// A closed solid on the floor: an upright box, a ball, or a cylinder with level ends.
///
/// A cylinder stands upright or slanted: every level cut is a disc of the same radius, and its
/// centre moves ahead by `lean` metres per metre of height. Across its axis a slanted one is
/// elliptic.
struct BodyPart {
    Point2 center = {};                      ///< of the level cut at mid-height
    double half_length = 0, half_width = 0;  ///< of a box, along x and y
    double radius = 0;                       ///< of a cylinder or ball; 0: a box
    double bottom = 0, top = 0;              ///< heights
    double lean = 0;                         ///< of a cylinder, along x
    bool is_ball = false;
    bool faces_down = false;  ///< of a trunk: its chest is below
    Material material = Material::Cloth;
};

/// Builds a person as in the thesis (fig. 5.10), facing +x, on the floor at the origin: a ball for
/// the head, a box for the trunk, cylinders for legs, sleeves and hands. Proportions do not change
/// with `height`. All sensors meet exactly these solids.
///
/// Walking, the left leg is ahead of the hip by the angle `swing` and the right one behind it; arms
/// swing the other way. Limbs are slanted, not turned: level cuts stay discs, and the feet stay on
/// the floor.
///
/// They are, in order: the right leg, sleeve and hand, the left ones, the trunk, the head.
std::vector<BodyPart> humanParts(double height, Angle swing = {});
constexpr std::size_t kHumanParts = 8;

/// The body of a person that a record of an extension shapes, see ThingKind::figure: sitting,
/// lying, with arms that point.
///
/// Its frame is that of humanParts(), with the middle of the trunk above the origin. Sensors take
/// the first box of a person for the trunk.
struct PersonFigure {
    std::bitset<kHumanParts> kept;  ///< parts of humanParts() that it has, swinging limbs, too
    std::vector<BodyPart> fixed;    ///< the others, which no step swings
    std::size_t load_parts = 0;     ///< at the end of `fixed`: a thing that it carries
    double reach = 0;               ///< radius of the circle about the origin that holds all parts
    double support = 0;             ///< height of the floor or thing that bears it
    Point3 load;                    ///< the middle of the underside of a thing that it carries
    /// The reason why the person does not walk, "sits"; "" if it does.
    std::string rest;
    /// Moves points that the standing person carries: `from` + x, y and z times these, and no lower
    /// than the floor.
    Point3 from{};
    Vec3 x_axis{1, 0, 0}, y_axis{0, 1, 0}, z_axis{0, 0, 1};

    /// Returns a point of the person's frame, given for the standing person.
    [[nodiscard]] Point3 carried(Point3 standing) const;
};

/// Returns the parts of a person: those of its figure, else humanParts(). The swing is as there.
std::vector<BodyPart> personParts(double height, const PersonFigure* figure, Angle swing = {});
inline std::vector<BodyPart> personParts(const PlacedPerson& person, Angle swing = {}) {
    return personParts(person.height, person.figure.get(), swing);
}

/// Converts upright parts to triangles, for models. Vertices of round parts lie on their surfaces.
std::vector<Mesh> humanBodyOf(const std::vector<BodyPart>& parts);
/// Converts humanParts() of a standing person.
std::vector<Mesh> humanBodyOf(double height);

/// Greatest swing of the limbs (thesis 5.3.1), and the length of a stride, two steps, at that
/// swing: the feet do not slide. A stride is 0.51 of the height.
constexpr double kMaxSwingDegrees = 15;
double strideOf(double height);

/// Returns the radius of the circle about a person of that height that no object may enter: 0.15 of
/// the height, half of the trunk and an arm.
double humanRadius(double height);
/// Returns the radius of the circle about a person's position that holds its body.
double personReach(const PlacedPerson& person);

}  // namespace ispace
