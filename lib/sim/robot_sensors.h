// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sim: what robots feel by themselves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/polygon.h"
#include "geom/pose.h"
#include "scene/robot.h"
#include "scene/scene.h"
#include "sim/motion.h"
#include "trace/moving_bodies.h"
#include "trace/ray_world.h"

namespace ispace {

constexpr std::size_t kSonarRays = 37;

/// What each sonar of a robot at a pose measures: the nearest surface that one of 37 rays meets,
/// its axis and three circles about it up to the rim of the cone (6, 12 and 18 rays). +infinity: no
/// echo within the range; a nearer one than the least reads as the least. They are at three
/// quarters of the body's height. The floor sends sound away, never back. \param own owner of the
/// robot's body
std::vector<float> sonarRanges(const RobotModel& model, const Pose2& pose,
                               const RayWorld& environment, const MovingBodies& bodies,
                               std::uint32_t own);

/// Which bumpers touch something after a step along `bump` was cancelled: those with a place on the
/// rim (the circle of the model's radius, every quarter of a degree) that would have come to a
/// surface on that way. \param nearest distance to the nearest surface, up to the second argument
std::vector<bool> pressedBumpers(
    const RobotModel& model, const Pose2& pose, Vec2 bump,
    const std::function<double(Point2 place, double farthest)>& nearest);

/// Robots and people as they are after a step, in the order of the scene.
struct Movers {
    std::span<const Motion> robots, people;
    std::span<const Angle> swings;  ///< of the people's limbs, see humanParts
};

/// A pressure mat on the floor.
struct Mat {
    Pose2 pose;
    double half_length = 0, half_width = 0;
    double rate = 10;  ///< readings a second
};

/// A light gate: a level beam between two posts.
struct Gate {
    Pose2 pose;  ///< of the middle; `in` is the way along the heading
    double half_width = 0;
    double height = 0;  ///< of the beam: what is lower passes below it
    double rate = 10;

    /// The posts, the left one first.
    [[nodiscard]] Segment2 beam() const;
};

/// Who stands on a mat: people with a leg on it, robots whose body is over it; edges count.
struct MatState {
    std::vector<std::string> on;  ///< robots first, in the order of the scene
};

/// Who went through a gate since the start. One passes when the centre crosses the line between
/// the posts.
struct GateState {
    std::int64_t in = 0, out = 0;
    std::string last;  ///< who passed last; "" before the first
    bool last_in = false;
    bool broken = false;  ///< somebody stands in the beam
};

/// A robot or person that passed a gate in the last step.
struct Passage {
    std::size_t gate = 0;  ///< index of those given
    std::string_view who;
    bool in = false;
};

/// Robots and people, as what lies on the floor notices them. The same order as of their motions.
struct MoverShape {
    std::string id;
    bool is_person = false;
    double radius = 0;  ///< of a circle about the centre that holds it
    double height = 0;
    RobotModel model;  ///< of a robot
};
std::vector<MoverShape> moverShapes(const Scene& scene);

/// Mats and gates of a scene, followed step by step. Steps are straight from place to place, so
/// nobody slips through between two of them.
class FloorSensors {
  public:
    explicit FloorSensors(const Scene& scene);

    [[nodiscard]] const std::vector<Mat>& mats() const { return mats_; }
    [[nodiscard]] const std::vector<Gate>& gates() const { return gates_; }
    [[nodiscard]] const std::vector<std::string>& matIds() const { return mat_ids_; }
    [[nodiscard]] const std::vector<std::string>& gateIds() const { return gate_ids_; }
    [[nodiscard]] bool empty() const { return mats_.empty() && gates_.empty(); }

    /// Where everybody is after a step.
    void follow(const Movers& movers);
    /// A gate goes on counting from there.
    void goOn(std::size_t gate, const GateState& state) { gate_states_[gate] = state; }
    /// The next step begins where it ends: nobody walked there.
    void forgetPlaces() { places_.clear(); }

    [[nodiscard]] const MatState& mat(std::size_t i) const { return mat_states_[i]; }
    [[nodiscard]] const GateState& gate(std::size_t i) const { return gate_states_[i]; }
    /// Of the last step; a mover's before those of later ones.
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
