// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/sdf/urdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <pugixml.hpp>
#include <span>
#include <sstream>
#include <string>

#include "base/error.h"
#include "base/number.h"
#include "drawing/plan/elements.h"
#include "io/exporters.h"
#include "scene/bodies.h"
#include "scene/sensor/sensor.h"

namespace ispace {

namespace {

/// Rounds to a number of steps a unit; minus zero becomes zero.
std::string rounded(double value, double steps) {
    return formatDouble(std::round(value * steps) / steps + 0.0);
}

constexpr double kLengthSteps = 1e9, kAngleSteps = 1e12;

}  // namespace

std::string XmlNames::take(std::string_view id) {
    std::string name(id);
    for (std::size_t at = 0; (at = name.find("::", at)) != std::string::npos;)
        name.replace(at, 2, "-");
    if (name.starts_with("__")) name.insert(0, "id");
    if (name.ends_with("__")) name += "id";
    std::string free = name;
    for (int i = 2; !taken_.insert(free).second; ++i) free = name + '-' + std::to_string(i);
    return free;
}

std::string lengthsText(std::initializer_list<double> metres) {
    std::string text;
    for (const double length : metres) {
        if (!text.empty()) text += ' ';
        text += rounded(length, kLengthSteps);
    }
    return text;
}

std::string radiansText(Angle angle) { return rounded(angle.radians(), kAngleSteps); }

std::string anglesText(const Pose3& pose) {
    return radiansText(wrapped(pose.roll)) + ' ' + radiansText(wrapped(-pose.tilt)) + ' ' +
           radiansText(wrapped(pose.heading));
}

pugi::xml_node addText(pugi::xml_node parent, const char* name, const std::string& text) {
    pugi::xml_node node = parent.append_child(name);
    node.append_child(pugi::node_pcdata).set_value(text.c_str());
    return node;
}

std::string xmlText(const pugi::xml_document& document) {
    std::ostringstream text;
    document.save(text, "  ", pugi::format_indent, pugi::encoding_utf8);
    return std::move(text).str();
}

MeshBox boxAround(const std::vector<Mesh>& meshes) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Point3 low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
    for (const Mesh& mesh : meshes)
        for (const Point3& p : mesh.vertices) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
    return {low + 0.5 * (high - low), {high.x - low.x, high.y - low.y, high.z - low.z}};
}

namespace {

/// Returns ROS' optical frame in a body's: x right, y down, z forward (REP 103).
constexpr const char* kOpticalAngles = "-1.570796326795 0 -1.570796326795";
/// Turns an upright cylinder so that its axis lies along y.
constexpr const char* kAcrossAngles = "1.570796326795 0 0";

/// The sensors of a layout as links: from `world`, or from the robot or person that carries them.
class UrdfWriter {
  public:
    UrdfWriter(const Scene& scene, const std::string& name) : scene_(scene) {
        robot_ = file_.append_child("robot");
        robot_.append_attribute("name").set_value(name.c_str());
    }

    std::string write() {
        addLink("world");
        // Carriers first: joints refer to their links.
        for (const PlacedRecord& placed : scene_.placed)
            if (const std::string& keyword = keywordOf(placed);
                keyword == "robot" || keyword == "human")
                addCarrier(placed);
        for (const PlacedRecord& placed : scene_.placed)
            if (sensorKind(keywordOf(placed)) != nullptr) addSensor(placed);
        return xmlText(file_);
    }

    std::string writeRobot(std::size_t robot, const std::string& frame,
                           std::span<const std::string> wheels,
                           std::span<const std::string> sensors) {
        addRobotBody(addLink(frame), robot);
        addWheels(robot, frame, wheels);
        for (const PlacedRecord& placed : scene_.placed)
            if (placed.mount && placed.mount->robot == robot &&
                sensorKind(keywordOf(placed)) != nullptr && !sensors[placed.index].empty())
                addSensor(placed, frame, placed.mount->robot_from_sensor, sensors[placed.index],
                          sensors[placed.index] + "_optical");
        return xmlText(file_);
    }

  private:
    [[nodiscard]] const std::string& keywordOf(const PlacedRecord& placed) const {
        return scene_.records[placed.record].keyword();
    }
    [[nodiscard]] const std::string& idOf(const PlacedRecord& placed) const {
        return scene_.ids[placed.record];
    }

    pugi::xml_node addLink(const std::string& name) {
        pugi::xml_node link = robot_.append_child("link");
        link.append_attribute("name").set_value(name.c_str());
        return link;
    }

    static void setOrigin(pugi::xml_node parent, Point3 place, const std::string& angles) {
        pugi::xml_node origin = parent.append_child("origin");
        origin.append_attribute("xyz").set_value(lengthsText({place.x, place.y, place.z}).c_str());
        origin.append_attribute("rpy").set_value(angles.c_str());
    }

    pugi::xml_node addJoint(const char* type, const std::string& parent, const std::string& child,
                            Point3 place, const std::string& angles) {
        pugi::xml_node joint = robot_.append_child("joint");
        joint.append_attribute("name").set_value((child + "_joint").c_str());
        joint.append_attribute("type").set_value(type);
        setOrigin(joint, place, angles);
        joint.append_child("parent").append_attribute("link").set_value(parent.c_str());
        joint.append_child("child").append_attribute("link").set_value(child.c_str());
        return joint;
    }

    /// Adds a link's appearance; materials are defined at their first use.
    pugi::xml_node addVisual(pugi::xml_node link, Point3 middle, Material material) {
        pugi::xml_node visual = link.append_child("visual");
        setOrigin(visual, middle, "0 0 0");
        const pugi::xml_node geometry = visual.append_child("geometry");
        pugi::xml_node look = visual.append_child("material");
        look.append_attribute("name").set_value(lookOf(material).name);
        const Color color = displayColor(material);
        look.append_child("color").append_attribute("rgba").set_value(
            lengthsText({color.red, color.green, color.blue, color.alpha}).c_str());
        return geometry;
    }

    static void setBox(pugi::xml_node geometry, double length, double width, double height) {
        geometry.append_child("box").append_attribute("size").set_value(
            lengthsText({length, width, height}).c_str());
    }
    static void setCylinder(pugi::xml_node geometry, double radius, double height) {
        pugi::xml_node cylinder = geometry.append_child("cylinder");
        cylinder.append_attribute("radius").set_value(lengthsText({radius}).c_str());
        cylinder.append_attribute("length").set_value(lengthsText({height}).c_str());
    }
    static void setBall(pugi::xml_node geometry, double radius) {
        geometry.append_child("sphere").append_attribute("radius").set_value(
            lengthsText({radius}).c_str());
    }

    /// Adds a robot or a person; another program publishes its pose once it moves.
    void addCarrier(const PlacedRecord& placed) {
        const std::string name = names_.take(idOf(placed));
        carriers_[{keywordOf(placed), placed.index}] = name;
        const pugi::xml_node link = addLink(name);
        if (keywordOf(placed) == "robot") {
            addRobotBody(link, placed.index);
        } else {
            for (const BodyPart& part : personParts(scene_.people[placed.index])) {
                const pugi::xml_node geometry =
                    addVisual(link, {part.center.x, part.center.y, (part.bottom + part.top) / 2},
                              part.material);
                if (part.is_ball)
                    setBall(geometry, part.radius);
                else if (part.radius > 0)
                    setCylinder(geometry, part.radius, part.top - part.bottom);
                else
                    setBox(geometry, 2 * part.half_length, 2 * part.half_width,
                           part.top - part.bottom);
            }
        }
        addJoint("floating", "world", name, placed.pose.position, anglesText(placed.pose));
        if (keywordOf(placed) != "robot" ||
            scene_.robots[placed.index].model.drive != Drive::Differential)
            return;
        const std::array<std::string, 2> wheels{names_.take(idOf(placed) + "_left_wheel"),
                                                names_.take(idOf(placed) + "_right_wheel")};
        addWheels(placed.index, name, wheels);
    }

    /// Adds the left and the right wheel; those without a name are left out.
    void addWheels(std::size_t robot, const std::string& parent,
                   std::span<const std::string> names) {
        constexpr double kThickness = 0.4;  // shares of the radius
        const Wheels wheels = wheelsOf(scene_.robots[robot].model);
        double side = 1;
        for (const std::string& name : names) {
            const double place = side * wheels.track / 2;
            side = -side;
            if (name.empty()) continue;
            const pugi::xml_node geometry = addVisual(addLink(name), {}, Material::Robot);
            setCylinder(geometry, wheels.radius, kThickness * wheels.radius);
            geometry.parent().child("origin").attribute("rpy").set_value(kAcrossAngles);
            pugi::xml_node joint =
                addJoint("continuous", parent, name, {0, place, wheels.radius}, "0 0 0");
            joint.append_child("axis").append_attribute("xyz").set_value("0 1 0");
        }
    }

    void addRobotBody(pugi::xml_node link, std::size_t index) {
        const RobotModel& robot = scene_.robots[index].model;
        const pugi::xml_node geometry =
            addVisual(link, {robot.center, 0, robot.height / 2}, Material::Robot);
        if (robot.length > 0)
            setBox(geometry, robot.length, robot.width, robot.height);
        else
            setCylinder(geometry, robot.radius, robot.height);
    }

    void addSensor(const PlacedRecord& placed) {
        const Sensor& sensor = scene_.sensors[placed.index];
        std::string parent = "world";
        Pose3 pose = placed.pose;
        if (placed.mount) {
            parent = carriers_.at({"robot", placed.mount->robot});
            pose = placed.mount->robot_from_sensor;
        } else if (sensor.person) {
            parent = carriers_.at({"human", *sensor.person});
            pose = inFrameOf(scene_.people[*sensor.person].pose, placed.pose);
        }
        const std::string name = names_.take(idOf(placed));
        const bool has_lens = hasPicture(sensor);
        addSensor(placed, parent, pose, name,
                  has_lens ? names_.take(idOf(placed) + "_optical") : "");
    }

    void addSensor(const PlacedRecord& placed, const std::string& parent, const Pose3& pose,
                   const std::string& name, const std::string& optical) {
        const MeshBox box = boxAround(bodyOf(scene_, placed));
        setBox(addVisual(addLink(name), box.center, Material::Sensor), box.size[0], box.size[1],
               box.size[2]);
        addJoint("fixed", parent, name, pose.position, anglesText(pose));
        if (!hasPicture(scene_.sensors[placed.index])) return;
        addLink(optical);
        addJoint("fixed", name, optical, {}, kOpticalAngles);
    }

    static bool hasPicture(const Sensor& sensor) {
        if (sensor.is<Ranger>()) return sensor.as<Ranger>().projection == Projection::Pinhole;
        return sensor.is<Camera>();
    }

    static Pose3 inFrameOf(const Pose2& frame, const Pose3& pose) {
        const Vec2 way = pose.position.onFloor() - frame.position;
        const Vec2 along = unitVector(frame.heading);
        return {{dot(way, along), cross(along, way), pose.position.z},
                pose.heading - frame.heading,
                pose.tilt,
                pose.roll};
    }

    const Scene& scene_;
    pugi::xml_document file_;
    pugi::xml_node robot_;
    XmlNames names_;
    std::map<std::pair<std::string, std::size_t>, std::string>
        carriers_;  // links of robots, people
};

}  // namespace

std::string writeRobotUrdf(const Scene& scene, std::size_t robot, const std::string& frame,
                           std::span<const std::string> wheels,
                           std::span<const std::string> sensors) {
    return UrdfWriter(scene, frame).writeRobot(robot, frame, wheels, sensors);
}

std::string writeUrdf(const Scene& scene, const std::string& title) {
    std::string name = title.substr(0, title.find('.'));
    if (name.empty()) name = "room";
    return UrdfWriter(scene, name).write();
}

}  // namespace ispace
