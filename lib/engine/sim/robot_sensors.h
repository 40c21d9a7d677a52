// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/sim: sonars and bumpers of robots, mats and gates of the floor.
//
// A sonar's cone is sampled by 37 rays, so an object narrower than their spacing may be missed: at
// a cone of 30 degrees the rays are some 0.27 m apart at 3 m. Gates count crossings by exact
// orientation: a mover passes as often as its steps, each a straight line, change sides. Mats and
// gates know the outlines of bodies at their heights, not circles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/polygon.h"
#include "geom/pose.h"
#include "scene/robot.h"
#include "scene/scene.h"
#include "sense/reading.h"
#include "sim/motion.h"
#include "trace/moving_bodies.h"
#include "trace/ray_world.h"

namespace ispace {

constexpr std::size_t kSonarRays = 37;

/// Computes the range of each sonar of a robot at a pose: the nearest surface that one of 37 rays
/// meets, its axis and three circles about it up to the rim of the cone (6, 12 and 18 rays).
/// +infinity: no echo within the range; an echo below the least range reads as the least. Sonars
/// are at three quarters of the body's height. The floor sends sound away, never back. \param own
/// owner of the robot's body
std::vector<float> sonarRanges(const RobotModel& model, const Pose2& pose,
                               const RayWorld& environment, const MovingBodies& bodies,
                               std::uint32_t own);

/// Finds the bumpers that touch a body after a step along `bump` was cancelled: those with a point
/// on the rim (the circle of the model's radius, every quarter of a degree) that would have come to
/// a surface on that way. \param nearest distance to the nearest surface, up to the second argument
std::vector<bool> pressedBumpers(
    const RobotModel& model, const Pose2& pose, Vec2 bump,
    const std::function<double(Point2 place, double farthest)>& nearest);

/// Robots and people after a step, in the order of the scene.
struct Movers {
    std::span<const Motion> robots, people;
    std::span<const Angle> swings;  ///< of the people's limbs, see humanParts
};

/// A passage of a gate by a robot or person in the last step.
struct Passage {
    std::size_t gate = 0;  ///< index into the given gates
    std::string_view who;
    bool in = false;
};

/// Shapes of robots and people for sensors of the floor, in the order of their motions.
struct MoverShape {
    std::string id;
    bool is_person = false;
    double radius = 0;  ///< of a circle about the centre that holds it
    double height = 0;
    RobotModel model;                                 ///< of a robot
    std::shared_ptr<const PersonFigure> figure = {};  ///< of a person, null for the usual one
};
std::vector<MoverShape> moverShapes(const Scene& scene);

/// Updates mats and gates of a scene step by step. Steps are straight lines between positions, so a
/// mover cannot slip through between two of them. After forgetPlaces() no gate counts the next
/// step. O(movers * (mats + gates)) a step.
class FloorSensors {
  public:
    explicit FloorSensors(const Scene& scene);

    [[nodiscard]] const std::vector<Mat>& mats() const { return mats_; }
    [[nodiscard]] const std::vector<Gate>& gates() const { return gates_; }
    [[nodiscard]] const std::vector<std::string>& matIds() const { return mat_ids_; }
    [[nodiscard]] const std::vector<std::string>& gateIds() const { return gate_ids_; }
    [[nodiscard]] bool empty() const { return mats_.empty() && gates_.empty(); }

    /// Reads the poses of all movers after a step.
    void follow(const Movers& movers);
    /// Continues a gate's count from this state.
    void goOn(std::size_t gate, const GateState& state) { gate_states_[gate] = state; }
    /// Starts the next step at its end: movers were set there and did not walk.
    void forgetPlaces() { places_.clear(); }

    [[nodiscard]] const MatState& mat(std::size_t i) const { return mat_states_[i]; }
    [[nodiscard]] const GateState& gate(std::size_t i) const { return gate_states_[i]; }
    /// Returns the passages of the last step, sorted by mover.
    [[nodiscard]] std::span<const Passage> passages() const { return passages_; }

  private:
    void look(std::size_t mover, const Pose2& pose, Angle swing);
    void pass(std::size_t mover, Point2 from, Point2 to);

    std::vector<MoverShape> movers_;
    std::vector<std::string> mat_ids_, gate_ids_;
    std::vector<Mat> mats_;
    std::vector<Gate> gates_;
    std::vector<MatState> mat_states_;
    std::vector<GateState> gate_states_;
    std::vector<Point2> places_;  // of the movers after the last step; empty: unknown
    std::vector<Passage> passages_;
};

}  // namespace ispace
