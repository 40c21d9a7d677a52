// SPDX-License-Identifier: GPL-3.0-or-later
// What is placed on a plan: sensors with what they face, tags, mats, gates, robots, people.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "base/number.h"
#include "env/body.h"
#include "plan/display_color.h"
#include "plan/drawing.h"
#include "layout/schemas.h"

namespace ispace {

namespace {

using namespace plan_colors;

constexpr Color kRobot = Color::rgb(0x8E2C2C);
constexpr Color kPerson = Color::rgb(0x33507A);
constexpr Color kMat = Color::rgb(0x2F6B45);

/// Span of bearings that a mark's fan shows; nothing for what looks nowhere.
struct View {
    Angle from, to;
    double range = 5;
};

View viewOf(const Scene& scene, const Placed& placed) {
    const Record& record = scene.records[placed.record];
    if (record.keyword() == "laser") {
        const Laser& laser = scene.lasers[placed.index].laser;
        return {laser.first, laser.first + laser.span(), laser.max_range};
    }
    const auto about = [](Angle span, double range) {
        return View{-0.5 * span, 0.5 * span, range};
    };
    if (record.keyword() == "ranger") {
        const Ranger& ranger = scene.rangers[placed.index].ranger;
        return about(ranger.fov_x, ranger.max_range);
    }
    if (record.keyword() == "ultrasound") {
        const Receiver& receiver = scene.receivers[placed.index].receiver;
        return about(receiver.fov, receiver.max_range);
    }
    View view = about(Angle::degrees(45), 5);
    if (record.has("fov")) view = about(Angle::degrees(record.tuple("fov").front()), 5);
    if (record.has("range")) view.range = record.tuple("range").back();
    return view;
}

/// Puts names beside their marks where they cover least.
class Names {
  public:
    explicit Names(PlanDrawing& plan) : plan_(plan), em_(plan.metres()) {}

    void addMark(Point2 place) { taken_.push_back(around(place, 0.5 * em_, 0.5 * em_)); }

    /// Right, left, above, below, then aslant; no name where all of these are taken.
    void add(Point2 place, Angle heading, const std::string& id, Color color) {
        constexpr std::array<double, 7> kTurns = {180, 135, -135, 90, -90, 45, -45};
        const TextStyle style{0.85 * plan_.em, true, Align::Center, color, {}};
        const double half = textWidth(id, style) * em_ / plan_.em / 2 + 0.1 * em_;
        for (const double turn : kTurns) {
            const Vec2 away = unitVector(heading + Angle::degrees(turn));
            const Point2 middle = place + Vec2{away.x * (0.7 * em_ + half), away.y * 1.2 * em_};
            const Box2 box = around(middle, half, 0.5 * em_);
            if (!isFree(box)) continue;
            taken_.push_back(box);
            DrawnText name{{middle.x, middle.y - 0.3 * em_}, id, 0.85, Align::Center, color, true};
            name.halo = true;
            plan_.items.push_back({PlanLayer::Labels, "", ""});
            plan_.items.back().texts.push_back(std::move(name));
            return;
        }
    }

  private:
    static Box2 around(Point2 p, double x, double y) {
        return {{p.x - x, p.y - y}, {p.x + x, p.y + y}};
    }
    [[nodiscard]] bool isFree(const Box2& box) const {
        return std::none_of(taken_.begin(), taken_.end(), [&](const Box2& other) {
            return other.low.x < box.high.x && box.low.x < other.high.x &&
                   other.low.y < box.high.y && box.low.y < other.high.y;
        });
    }

    PlanDrawing& plan_;
    double em_;
    std::vector<Box2> taken_;
};

bool looksAside(const Record& record, const Pose3& pose) {
    return isSensor(record.schema()) && std::abs(pose.tilt.degrees()) < 70;
}

/// A sector about the mark that shows the field of view; not the range, which mostly is longer.
DrawnItem viewItem(const PlanDrawing& plan, const Scene& scene, const Placed& placed) {
    const Point2 place = placed.pose.position.onFloor();
    const Angle heading = placed.pose.heading;
    const View view = viewOf(scene, placed);
    const double radius = std::min(4.5 * plan.metres(), view.range);
    std::vector<Point2> curve = planArc(place, radius, heading + view.from, heading + view.to);
    if (view.to - view.from < Angle::degrees(359)) curve.push_back(place);
    DrawnItem item{PlanLayer::Views, "", "field of view of " + scene.ids[placed.record]};
    item.paths.push_back({{std::move(curve)}, true, kSensor.faded(0.2), Stroke{kSensor, 0.05}});
    return item;
}

DrawnItem tagItem(const std::string& id, Point2 place, double size) {
    DrawnItem item{PlanLayer::Sensors, id, id + ": tag"};
    item.paths.push_back({{{{place.x + size, place.y},
                            {place.x, place.y + size},
                            {place.x - size, place.y},
                            {place.x, place.y - size}}},
                          true,
                          kMat,
                          Stroke{kPaper, 0.08}});
    return item;
}

DrawnItem sensorItem(const PlanDrawing& plan, const Record& record, const std::string& id,
                     const Pose3& pose) {
    const double em = plan.metres(), radius = 0.34 * em;
    const Point2 place = pose.position.onFloor();
    const Vec2 forward = unitVector(pose.heading), left = perpendicular(forward);
    DrawnItem item{PlanLayer::Sensors, id, id};
    item.title.append(": ").append(record.keyword()).append(" at height ");
    item.title.append(formatDouble(std::round(pose.position.z * 1000) / 1000)).append(" m");
    const Stroke rim{kPaper, 0.08};
    if (looksAside(record, pose)) {
        const Point2 tip = place + 1.1 * em * forward, neck = place + 0.2 * em * forward;
        item.paths.push_back(
            {{{tip, neck + radius * left, neck - radius * left}}, true, kSensor, rim});
    } else {
        // Upwards or downwards.
        item.paths.push_back(
            {{planCircle(place, 2 * radius)}, true, {}, Stroke{kSensor, 0.08, {0.25, 0.2}}});
    }
    item.paths.push_back({{planCircle(place, radius)}, true, kSensor, rim});
    return item;
}

DrawnItem matItem(const Record& record, const std::string& id, Point2 place, Angle heading) {
    const Tuple& size = record.tuple("size");
    DrawnItem item{PlanLayer::Sensors, id, id + ": mat"};
    item.paths.push_back({{rectangle(place, size[0], size[1], heading)},
                          true,
                          kMat.faded(0.25),
                          Stroke{kMat, 0.09}});
    return item;
}

DrawnItem gateItem(const PlanDrawing& plan, const Record& record, const std::string& id,
                   const Pose2& pose) {
    const double half = record.number("width") / 2, post = 0.25 * plan.metres();
    const Point2 left = pose * Point2{0, half}, right = pose * Point2{0, -half};
    DrawnItem item{PlanLayer::Sensors, id, id + ": gate"};
    item.paths.push_back({{{left, right}}, false, {}, Stroke{kSensor, 0.08, {0.25, 0.2}}});
    for (const Point2 p : {left, right})
        item.paths.push_back({{planCircle(p, post)}, true, kSensor, Stroke{kPaper, 0.06}});
    return item;
}

/// Where it goes by itself.
void addCourse(DrawnItem& item, const Record& record, Point2 place, Color color) {
    if (!record.has("path")) return;
    std::vector<Point2> way{place};
    for (const Tuple& point : record.list("path")) way.push_back({point[0], point[1]});
    item.paths.push_back({{std::move(way)}, false, {}, Stroke{color.faded(0.7), 0.07, {0.3, 0.3}}});
}

DrawnItem robotItem(const Record& record, const std::string& id, const Pose2& pose,
                    const RobotModel& model) {
    DrawnItem item{PlanLayer::Robots, id, id + ": robot"};
    addCourse(item, record, pose.position, kRobot);
    const double half = model.length > 0 ? model.length / 2 : model.radius;
    const Color fill = mixed(kRobot, kPaper, 0.45);
    const std::vector<Point2> outline =
        model.length > 0
            ? rectangle(pose * Point2{model.center, 0}, model.length, model.width, pose.heading)
            : planCircle(pose * Point2{model.center, 0}, model.radius);
    item.paths.push_back({{outline}, true, fill, Stroke{kRobot, 0.09}});
    item.paths.push_back({{{pose * Point2{model.center + 0.85 * half, 0},
                            pose * Point2{model.center + 0.2 * half, 0.35 * half},
                            pose * Point2{model.center + 0.2 * half, -0.35 * half}}},
                          true,
                          kRobot,
                          {}});
    return item;
}

DrawnItem personItem(const Record& record, const std::string& id, const Pose2& pose) {
    const double tall = record.number("height");
    DrawnItem item{PlanLayer::Robots, id, id + ": person"};
    addCourse(item, record, pose.position, kPerson);
    const Color fill = mixed(kPerson, kPaper, 0.4);
    const Stroke edge{kPerson, 0.07};
    // Shoulders, head, nose.
    item.paths.push_back(
        {{ellipse(pose.position, 0.14 * tall, 0.27 * tall, pose.heading)}, true, fill, edge});
    item.paths.push_back({{{pose * Point2{0.1 * tall, 0}, pose * Point2{0.04 * tall, 0.03 * tall},
                            pose * Point2{0.04 * tall, -0.03 * tall}}},
                          true,
                          kPerson,
                          {}});
    item.paths.push_back({{planCircle(pose.position, 0.06 * tall)},
                          true,
                          mixed(displayColor(Material::Skin), kPaper, 0.2),
                          edge});
    return item;
}

DrawnItem placedItem(const PlanDrawing& plan, const Scene& scene, const Placed& placed) {
    const Record& record = scene.records[placed.record];
    const std::string& id = scene.ids[placed.record];
    const std::string& keyword = record.keyword();
    const Pose2 pose{placed.pose.position.onFloor(), placed.pose.heading};
    if (keyword == "mat") return matItem(record, id, pose.position, pose.heading);
    if (keyword == "gate") return gateItem(plan, record, id, pose);
    if (keyword == "human") return personItem(record, id, pose);
    if (keyword == "robot") return robotItem(record, id, pose, scene.robots[placed.index].model);
    if (keyword == "tag") return tagItem(id, pose.position, 0.4 * plan.metres());
    return sensorItem(plan, record, id, placed.pose);
}

}  // namespace

std::vector<Point2> planArc(Point2 center, double radius, Angle from, Angle to) {
    constexpr double kStep = 5;  // degrees
    const double count = std::max(1.0, std::ceil((to - from).degrees() / kStep));
    std::vector<Point2> points;
    for (double i = 0; i <= count; ++i)
        points.push_back(center + radius * unitVector(from + i / count * (to - from)));
    return points;
}

std::vector<Point2> planCircle(Point2 center, double radius) {
    std::vector<Point2> points = planArc(center, radius, Angle(), Angle::degrees(360));
    points.pop_back();
    return points;
}

void addPlaced(PlanDrawing& plan, const Scene& scene) {
    constexpr std::size_t kMostNames = 500;  // more are no use on one page
    const bool with_names = scene.placed.size() <= kMostNames;
    Names names(plan);
    for (const Placed& placed : scene.placed) names.addMark(placed.pose.position.onFloor());
    for (const Placed& placed : scene.placed) {
        if (looksAside(scene.records[placed.record], placed.pose))
            plan.items.push_back(viewItem(plan, scene, placed));
        plan.items.push_back(placedItem(plan, scene, placed));
        if (!with_names) continue;
        const bool is_robot = plan.items.back().layer == PlanLayer::Robots;
        const bool is_person = scene.records[placed.record].keyword() == "human";
        names.add(placed.pose.position.onFloor(), placed.pose.heading, scene.ids[placed.record],
                  is_person  ? kPerson
                  : is_robot ? kRobot
                             : mixed(kSensor, kInk, 0.5));
    }
}

}  // namespace ispace
