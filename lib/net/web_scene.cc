// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/web_scene.h"

#include <cmath>

#include "base/json_writer.h"
#include "draw/color.h"
#include "plan/drawing.h"
#include "plan/plan_json.h"
#include "sim/people.h"

namespace ispace {

namespace {

double rounded(double value) { return std::round(value * 1000) / 1000; }

void addPose(JsonWriter& json, const Pose3& pose) {
    json.key("pose").beginArray();
    json.value(rounded(pose.position.x)).value(rounded(pose.position.y));
    json.value(rounded(pose.heading.degrees())).endArray();
}

/// In the order of World::movers().
void addMovers(JsonWriter& json, const Scene& scene) {
    json.key("movers").beginArray();
    for (const Mover& mover : moversOf(scene)) {
        const RobotModel& model = mover.model;
        json.beginObject().key("id").value(mover.id);
        json.key("kind").value(mover.is_person ? "person" : "robot");
        json.key("model").value(model.model).key("radius").value(model.radius);
        json.key("length").value(model.length).key("width").value(model.width);
        json.key("center").value(model.center).key("height").value(model.height);
        json.key("side").value(model.max_sidespeed).endObject();
    }
    json.endArray();
}

/// Also mats, gates and tags, in the order of the scene.
void addSensors(JsonWriter& json, const Scene& scene) {
    json.key("sensors").beginArray();
    for (const Placed& placed : scene.placed) {
        const Record& record = scene.records[placed.record];
        const std::string& keyword = record.keyword();
        if (keyword == "human" || keyword == "robot") continue;
        json.beginObject().key("id").value(scene.ids[placed.record]).key("kind").value(keyword);
        if (placed.mount) json.key("on").value(placed.mount->robot);
        if (sensorKind(keyword) != nullptr)
            if (const auto& person = scene.sensors[placed.index].person)
                json.key("on").value(scene.robots.size() + *person);
        addPose(json, placed.mount ? placed.mount->robot_from_sensor : placed.pose);
        if (keyword == "mat") {
            json.key("size").value(std::vector<double>(record.tuple("size")));
        } else if (keyword == "gate") {
            json.key("size").value(std::vector<double>{0, record.number("width")});
        } else if (keyword != "tag" && headingOf(placed.pose)) {
            const BearingSpan span = bearingsOf(scene, placed);
            json.key("view").beginArray();
            json.value(rounded(span.from.degrees())).value(rounded(span.to.degrees()));
            json.value(rounded(span.range)).endArray();
        }
        json.endObject();
    }
    json.endArray();
}

void addColors(JsonWriter& json) {
    using namespace palette;
    json.key("colors").beginObject();
    for (const auto& [name, color] : {std::pair{"ink", kInk},
                                      {"faint", kFaintInk},
                                      {"grid", kGrid},
                                      {"robot", kRobot},
                                      {"person", kPerson},
                                      {"sensor", kSensor},
                                      {"mat", kMat}})
        json.key(name).value(cssColor(color));
    json.key("series").beginArray();
    for (std::size_t i = 0; i < kSeriesColors; ++i) json.value(cssColor(seriesColor(i)));
    json.endArray().endObject();
}

}  // namespace

std::string webScene(const Scene& scene, std::int64_t version, const std::string& title) {
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-web-scene/1").key("scene").value(version);
    json.key("title").value(title).key("plan");
    writePlan(json, scene);
    addMovers(json, scene);
    addSensors(json, scene);
    addColors(json);
    json.endObject();
    return json.take();
}

}  // namespace ispace
