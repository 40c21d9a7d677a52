// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "io/exporters.h"
#include "io/glb/glb_write.h"
#include "io/plan/line_plan.h"
#include "io/sdf/sdf_parts.h"
#include "io/sdf/urdf.h"
#include "scene/bodies.h"
#include "scene/sensor/sensor.h"

namespace ispace {

namespace {

/// The floor extends this far beyond the walls, in metres, so that falling bodies land on it.
constexpr double kFloorRim = 1;

/// Plugins that Gazebo requires to step a world, show it, and run the sensors in it.
constexpr std::pair<const char*, const char*> kPlugins[] = {
    {"gz-sim-physics-system", "gz::sim::systems::Physics"},
    {"gz-sim-user-commands-system", "gz::sim::systems::UserCommands"},
    {"gz-sim-scene-broadcaster-system", "gz::sim::systems::SceneBroadcaster"},
    {"gz-sim-sensors-system", "gz::sim::systems::Sensors"},
};

class WorldWriter {
  public:
    WorldWriter(const Scene& scene, const std::string& name, const std::string& mesh_file)
        : scene_(scene), mesh_file_(mesh_file) {
        pugi::xml_node sdf = file_.append_child("sdf");
        sdf.append_attribute("version").set_value("1.9");
        world_ = sdf.append_child("world");
        world_.append_attribute("name").set_value(name.c_str());
    }

    ExportedFiles write() {
        addSurroundings();
        addFloor();
        for (const Element& element : scene_.environment.elements()) addElement(element);
        for (const PlacedRecord& placed : scene_.placed) addPlaced(placed);
        ExportedFiles files{xmlText(file_), ""};
        if (!mesh_nodes_.empty()) files.beside = objOf(mesh_nodes_);
        if (!left_out_.empty())
            files.left_out =
                "SDF has no such sensors, so none works in the world: " + listText(left_out_);
        return files;
    }

  private:
    /// Adds steps of time, plugins, and a sun above the walls.
    void addSurroundings() {
        pugi::xml_node physics = world_.append_child("physics");
        physics.append_attribute("name").set_value("default");
        physics.append_attribute("type").set_value("ignored");
        addText(physics, "max_step_size", "0.001");
        addText(physics, "real_time_factor", "1");
        for (const auto& [file, name] : kPlugins) {
            pugi::xml_node plugin = world_.append_child("plugin");
            plugin.append_attribute("filename").set_value(file);
            plugin.append_attribute("name").set_value(name);
            if (std::string_view(file) == "gz-sim-sensors-system")
                addText(plugin, "render_engine", "ogre2");
        }
        pugi::xml_node sun = world_.append_child("light");
        sun.append_attribute("name").set_value("sun");
        sun.append_attribute("type").set_value("directional");
        addText(sun, "pose", "0 0 10 0 0 0");
        addText(sun, "cast_shadows", "false");
        addText(sun, "diffuse", "0.8 0.8 0.8 1");
        addText(sun, "direction", "-0.3 0.2 -1");
    }

    /// Adds a static model. \return its link
    pugi::xml_node addModel(const std::string& id, const Pose3& pose) {
        pugi::xml_node model = world_.append_child("model");
        model.append_attribute("name").set_value(names_.take(id).c_str());
        addText(model, "static", "true");
        if (pose != Pose3())
            addText(model, "pose",
                    lengthsText({pose.position.x, pose.position.y, pose.position.z}) + ' ' +
                        anglesText(pose));
        pugi::xml_node link = model.append_child("link");
        link.append_attribute("name").set_value("link");
        return link;
    }

    void addFloor() {
        const Box2& limits = scene_.environment.limits();
        const Point2 middle = limits.center();
        pugi::xml_node link = addModel("ground_plane", {{middle.x, middle.y, 0}, {}, {}, {}});
        constexpr std::string_view kVisual = "visual";
        for (const char* kind : {"collision", "visual"}) {
            pugi::xml_node node = link.append_child(kind);
            node.append_attribute("name").set_value(kind == kVisual ? "floor_visual" : "floor");
            pugi::xml_node plane = node.append_child("geometry").append_child("plane");
            addText(plane, "normal", "0 0 1");
            addText(plane, "size",
                    lengthsText({limits.width() + 2 * kFloorRim, limits.depth() + 2 * kFloorRim}));
            if (kind == kVisual) addSdfMaterial(node, Material::Floor);
        }
    }

    void addElement(const Element& element) {
        const auto [pose, parts] = sdfParts(element);
        if (parts.empty()) return;
        if (!element.body.meshes.empty()) {
            if (mesh_file_.empty())
                throw UsageError(
                    "meshes stand in a file beside an SDF world: name it with -o FILE.sdf");
            mesh_nodes_.push_back({element.id, element.record.keyword(), {}, element.body.meshes});
        }
        XmlNames names;
        addSdfParts(addModel(element.id, pose), parts, mesh_file_, names);
    }

    void addPlaced(const PlacedRecord& placed) {
        const Record& record = scene_.records[placed.record];
        XmlNames names;
        if (sensorKind(record.keyword()) != nullptr) {
            if (!placed.mount) addSensor(addModel(idOf(placed), placed.pose), placed, {}, names);
        } else if (record.keyword() == "robot") {
            addRobot(placed, names);
        } else if (record.keyword() == "human") {
            std::vector<SdfPart> parts;
            for (const BodyPart& part : personParts(scene_.people[placed.index]))
                parts.push_back(sdfPart(part));
            addSdfParts(addModel(idOf(placed), placed.pose), parts, mesh_file_, names);
        } else {
            ++left_out_[record.keyword()];
        }
    }

    void addRobot(const PlacedRecord& placed, XmlNames& names) {
        const RobotModel& robot = scene_.robots[placed.index].model;
        SdfPart body;
        body.place = {robot.center, 0, robot.height / 2};
        body.height = robot.height;
        body.material = Material::Robot;
        if (robot.length > 0) {
            body.length = robot.length;
            body.width = robot.width;
        } else {
            body.shape = SdfPart::Shape::Cylinder;
            body.radius = robot.radius;
        }
        const pugi::xml_node link = addModel(idOf(placed), placed.pose);
        addSdfParts(link, {body}, mesh_file_, names);
        for (const PlacedRecord& other : scene_.placed)
            if (other.mount && other.mount->robot == placed.index)
                addSensor(link, other, other.mount->robot_from_sensor, names);
    }

    /// Adds the sensor, and its body as a box that no camera sees.
    void addSensor(pugi::xml_node link, const PlacedRecord& placed, const Pose3& link_from_sensor,
                   XmlNames& names) {
        const std::string id = names.take(idOf(placed));
        if (!addSdfSensor(link, id, scene_.sensors[placed.index].model, link_from_sensor))
            ++left_out_[scene_.records[placed.record].keyword()];
        const MeshBox box = boxAround(bodyOf(scene_, placed));
        pugi::xml_node visual = link.append_child("visual");
        visual.append_attribute("name").set_value(names.take(id + "_body").c_str());
        addText(visual, "visibility_flags", std::to_string(kSensorBodies));
        const Point3 middle = inWorld(Frame3(link_from_sensor), box.center);
        addText(visual, "pose",
                lengthsText({middle.x, middle.y, middle.z}) + ' ' + anglesText(link_from_sensor));
        addText(visual.append_child("geometry").append_child("box"), "size",
                lengthsText({box.size[0], box.size[1], box.size[2]}));
        addSdfMaterial(visual, Material::Sensor);
    }

    [[nodiscard]] const std::string& idOf(const PlacedRecord& placed) const {
        return scene_.ids[placed.record];
    }

    const Scene& scene_;
    const std::string& mesh_file_;
    pugi::xml_document file_;
    pugi::xml_node world_;
    XmlNames names_{{"world", "default", "sun"}};
    std::vector<ModelNode> mesh_nodes_;
    std::map<std::string, std::size_t> left_out_;
};

}  // namespace

ExportedFiles writeSdf(const Scene& scene, const std::string& title, const std::string& mesh_name) {
    std::string name = title.substr(0, title.find('.'));
    if (name.empty()) name = "room";
    return WorldWriter(scene, name, mesh_name).write();
}

}  // namespace ispace
