// SPDX-License-Identifier: GPL-3.0-or-later
// Bumpers by points on the rim, mats and gates by the outlines of bodies. Rectangles are apart if
// an axis of one of them separates them (S. Gottschalk, M. C. Lin, D. Manocha, OBBTree: a
// hierarchical structure for rapid interference detection, 1996, here in the plane).
#include "sim/robot_sensors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/predicates.h"
#include "scene/bodies.h"
#include "sense/selection.h"
#include "sim/collision.h"

namespace ispace {

std::vector<bool> pressedBumpers(
    const RobotModel& model, const Pose2& pose, Vec2 bump,
    const std::function<double(Point2 place, double farthest)>& nearest) {
    constexpr double kStep = 0.25;  // degrees
    // Half the distance between two points on the rim, plus rounding.
    const double slack =
        0.5 * kStep * std::numbers::pi / 180 * model.radius + 2 * kContactTolerance;
    std::vector<bool> pressed;
    for (const Bumper& bumper : model.bumpers) {
        const double from = bumper.from.degrees(), to = bumper.to.degrees();
        const int places = std::max(1, static_cast<int>(std::ceil((to - from) / kStep)));
        bool hit = false;
        for (int k = 0; k <= places && !hit; ++k) {
            const Angle bearing = Angle::degrees(from + (to - from) * k / places);
            const Vec2 outwards = unitVector(pose.heading + bearing);
            const double way = dot(outwards, bump);
            hit = way > 0 &&
                  nearest(pose.position + model.radius * outwards, way + slack) < way + slack;
        }
        pressed.push_back(hit);
    }
    return pressed;
}

namespace {

/// A rectangle on the floor.
struct Area {
    Pose2 pose;
    double half_length, half_width;

    [[nodiscard]] Vec2 toLocal(Point2 p) const {
        const Vec2 way = p - pose.position, along = unitVector(pose.heading);
        return {dot(way, along), cross(along, way)};
    }
    [[nodiscard]] double reach() const { return std::hypot(half_length, half_width); }
};

bool touchesDisc(const Area& area, Point2 center, double radius) {
    const Vec2 local = area.toLocal(center);
    const double x = std::max(0.0, std::fabs(local.x) - area.half_length);
    const double y = std::max(0.0, std::fabs(local.y) - area.half_width);
    return std::hypot(x, y) <= radius;
}

/// Returns true if an axis of `area` separates the two.
bool isApart(const Area& area, const Area& other) {
    const Vec2 middle = area.toLocal(other.pose.position);
    const Vec2 along = unitVector(other.pose.heading - area.pose.heading);
    const double x = other.half_length * std::fabs(along.x) + other.half_width * std::fabs(along.y);
    const double y = other.half_length * std::fabs(along.y) + other.half_width * std::fabs(along.x);
    return std::fabs(middle.x) > area.half_length + x || std::fabs(middle.y) > area.half_width + y;
}

/// \pre the body is upright
bool touches(const Area& area, const MovingBody& body) {
    if (body.radius > 0) return touchesDisc(area, body.pose.position, body.radius);
    const Area other{body.pose, body.half_length, body.half_width};
    return !isApart(area, other) && !isApart(other, area);
}

/// Returns the parts of a mover that touch the floor, or those that block beams.
std::vector<MovingBody> bodiesOfMover(const MoverShape& shape, const Pose2& pose, Angle swing) {
    if (shape.is_person) return humanBodies(shape.height, pose, 0, swing, shape.figure.get());
    return {robotBody(shape.model, pose, 0)};
}

bool standsIn(const MovingBody& body, const Gate& gate) {
    if (gate.height < body.bottom || gate.height > body.top) return false;
    const Segment2 beam = gate.beam();
    const Vec2 way = beam.b - beam.a;
    // Represents the beam between the posts as a sheet, which a box or a disc may touch.
    const Area sheet{{gate.pose.position, gate.pose.heading}, 0, length(way) / 2};
    return touches(sheet, body.cutAt(gate.height));
}

}  // namespace

std::vector<MoverShape> moverShapes(const Scene& scene) {
    std::vector<MoverShape> shapes;
    for (const PlacedRobot& robot : scene.robots) {
        const RobotModel& m = robot.model;
        const double body =
            m.length > 0 ? std::fabs(m.center) + std::hypot(m.length / 2, m.width / 2) : m.radius;
        shapes.push_back({robot.id, false, std::max(m.radius, body), m.height, m});
    }
    for (const PlacedRecord& placed : scene.placed) {
        const Record& record = scene.records[placed.record];
        if (record.keyword() != "human") continue;
        const PlacedPerson& person = scene.people[placed.index];
        shapes.push_back({scene.ids[placed.record],
                          true,
                          personReach(person),
                          person.height,
                          {},
                          person.figure});
    }
    return shapes;
}

FloorSensors::FloorSensors(const Scene& scene) : movers_(moverShapes(scene)) {
    for (const PlacedRecord& placed : scene.placed) {
        const Record& record = scene.records[placed.record];
        const Pose2 pose{placed.pose.position.onFloor(), placed.pose.heading};
        if (record.keyword() == "mat") {
            mats_.push_back(matOf(record));
            mats_.back().pose = pose;
            mat_ids_.push_back(scene.ids[placed.record]);
        } else if (record.keyword() == "gate") {
            gates_.push_back(gateOf(record));
            gates_.back().pose = pose;
            gate_ids_.push_back(scene.ids[placed.record]);
        }
    }
    mat_states_.resize(mats_.size());
    gate_states_.resize(gates_.size());
}

void FloorSensors::follow(const Movers& movers) {
    passages_.clear();
    if (empty()) return;
    for (MatState& state : mat_states_) state.on.clear();
    for (GateState& state : gate_states_) state.broken = false;
    const bool has_places = places_.size() == movers_.size();
    places_.resize(movers_.size());
    for (std::size_t i = 0; i < movers_.size(); ++i) {
        const std::size_t count = movers.robots.size();
        const bool is_robot = i < count;
        const Pose2& pose = (is_robot ? movers.robots[i] : movers.people[i - count]).pose;
        if (has_places && places_[i] != pose.position) pass(i, places_[i], pose.position);
        places_[i] = pose.position;
        look(i, pose, is_robot ? Angle() : movers.swings[i - count]);
    }
}

/// Updates the mats and gates near a mover.
void FloorSensors::look(std::size_t mover, const Pose2& pose, Angle swing) {
    const MoverShape& shape = movers_[mover];
    std::vector<MovingBody> bodies;  // built when a mat or gate is near
    const auto any = [&](const Area& area, auto test) {
        if (distance(area.pose.position, pose.position) > area.reach() + shape.radius) return false;
        if (bodies.empty()) bodies = bodiesOfMover(shape, pose, swing);
        return std::any_of(bodies.begin(), bodies.end(), test);
    };
    for (std::size_t k = 0; k < mats_.size(); ++k) {
        const Area area{mats_[k].pose, mats_[k].half_length, mats_[k].half_width};
        const auto presses = [&](const MovingBody& body) {
            return body.bottom <= 0 && touches(area, body.cutAt(0));
        };
        if (any(area, presses)) mat_states_[k].on.push_back(shape.id);
    }
    for (std::size_t k = 0; k < gates_.size(); ++k) {
        const Gate& gate = gates_[k];
        const auto breaks = [&](const MovingBody& body) { return standsIn(body, gate); };
        if (any({gate.pose, 0, gate.half_width}, breaks)) gate_states_[k].broken = true;
    }
}

/// Counts the gates on the way. A point on a gate's line counts as before it, so that a way of many
/// steps crosses it as often as it changes sides.
void FloorSensors::pass(std::size_t mover, Point2 from, Point2 to) {
    const MoverShape& shape = movers_[mover];
    for (std::size_t k = 0; k < gates_.size(); ++k) {
        if (shape.height < gates_[k].height) continue;
        const auto [left, right] = gates_[k].beam();
        const bool was_behind = orientation(left, right, from) == Turn::Right;
        const bool is_behind = orientation(left, right, to) == Turn::Right;
        if (was_behind == is_behind) continue;
        const Turn of_left = orientation(from, to, left), of_right = orientation(from, to, right);
        const bool between = was_behind ? of_left != Turn::Right && of_right != Turn::Left
                                        : of_left != Turn::Left && of_right != Turn::Right;
        if (!between) continue;
        GateState& state = gate_states_[k];
        ++(was_behind ? state.in : state.out);
        state.last = shape.id;
        state.last_in = was_behind;
        passages_.push_back({k, shape.id, was_behind});
    }
}

}  // namespace ispace
