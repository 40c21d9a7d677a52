// SPDX-License-Identifier: GPL-3.0-or-later
// Free-space loss (Friis, A note on a simple transmission formula, 1946): 20 log10(range /
// distance) dB above the weakest signal, less `loss` for each wall on the straight line. No
// reflection, no interference, no loss by bodies; 6 dB halve the range.
#include "extensions/radios/radio.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "env/body.h"
#include "scene/placement_schemas.h"
#include "scene/robot.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"
#include "scene/thing_kind.h"
#include "sense/walls_between.h"

namespace ispace::radios {

namespace {

constexpr double kNearField = 0.01;  // metres: nearer, signals grow no stronger
constexpr double kHeight = 0.5;
constexpr int kChannel = 1;

KeySpec positive(std::string name, Unit unit, std::string help, double standard, double upper) {
    return {.name = std::move(name),
            .type = KeyType::Number,
            .unit = unit,
            .help = std::move(help),
            .default_value = standard,
            .lower = 0,
            .upper = upper,
            .lower_open = true};
}

KeySpec angle(std::string name, std::string help, double most, Role role) {
    return {.name = std::move(name),
            .type = KeyType::Number,
            .unit = Unit::Angle,
            .help = std::move(help),
            .default_value = 0.0,
            .lower = -most,
            .upper = most,
            .role = role};
}

/// Returns true if a point lies in the cone of a radio.
bool isInCone(const Radio& radio, const Pose3& pose, Point3 place) {
    if (radio.fov >= Angle::degrees(360)) return true;
    const Vec3 way = place - pose.position;
    const double size = length(way);
    if (size < kNearField) return true;
    constexpr double kSlack = 1e-12;
    return dot(Frame3(pose).forward, way) / size >= cosSin(0.5 * radio.fov).cos - kSlack;
}

}  // namespace

Radio radioOf(const Record& record) {
    return {record.text("kind") == "infrared",
            static_cast<int>(record.number("channel")),
            record.number("range"),
            record.number("loss"),
            record.number("drop"),
            record.angle("fov")};
}

RadioCarrier radioCarrier(const Scene& scene, const Record& record) {
    const Tuple& at = record.tuple("at");
    RadioCarrier out{"",
                     {{at[0], at[1], at[2]}, record.angle("heading"), record.angle("tilt"), {}}};
    const std::string on = carrierOf(record);
    if (on.empty()) return out;
    const auto found = std::find(scene.ids.begin(), scene.ids.end(), on);
    const Record& carrier = scene.records[static_cast<std::size_t>(found - scene.ids.begin())];
    if (carrier.keyword() == "robot" || carrier.keyword() == "human") {
        out.id = on;
        return out;
    }
    out.pose.position.z += topOf(bodyOf(carrier));
    out.pose = mountedPose(floorPoseOf(carrier), out.pose);
    return out;
}

std::optional<double> signalMargin(const Radio& sender, const Pose3& from, const Radio& receiver,
                                   const Pose3& to, const RayWorld& mesh) {
    const double distance = length(to.position - from.position);
    const double free = 20 * std::log10(sender.range / std::max(kNearField, distance));
    if (free < 0) return std::nullopt;
    if (!isInCone(sender, from, to.position) || !isInCone(receiver, to, from.position))
        return std::nullopt;
    if (distance < kNearField) return free;
    if (sender.is_infrared) {
        std::uint8_t is_free = 0;
        mesh.query(from.position, std::span(&to.position, 1), std::span(&is_free, 1));
        return is_free != 0 ? std::optional(free) : std::nullopt;
    }
    const double margin = free - receiver.loss * wallsBetween(from.position, to.position, mesh);
    return margin >= 0 ? std::optional(margin) : std::nullopt;
}

namespace {

/// Checks the radios of a scene, which it counts by kind and channel once.
class RadioCheck {
  public:
    explicit RadioCheck(const Scene& scene) : scene_(&scene) {
        for (const Record& each : scene.records)
            if (each.keyword() == "radio") ++counts_[groupOf(radioOf(each))];
    }
    [[nodiscard]] std::optional<Finding> operator()(std::size_t record) const {
        const Record& own = scene_->records[record];
        const std::string& id = scene_->ids[record];
        const Radio radio = radioOf(own);
        if (counts_.at(groupOf(radio)) > 1) return std::nullopt;
        const Tuple& at = own.tuple("at");
        return Finding{.element = id,
                       .at = {at[0], at[1]},
                       .message = std::string("no other ") +
                                  (radio.is_infrared ? "infrared " : "") + "radio is on channel " +
                                  std::to_string(radio.channel) + " of " + id,
                       .hint = "its messages reach none; add another with channel=" +
                               std::to_string(radio.channel),
                       .source = own.place()};
    }

  private:
    using Group = std::pair<bool, int>;
    static Group groupOf(const Radio& radio) { return {radio.is_infrared, radio.channel}; }

    const Scene* scene_;
    std::map<Group, std::size_t> counts_;
};

}  // namespace

std::optional<Finding> checkRadio(const Scene& scene, std::size_t record) {
    return RadioCheck(scene)(record);
}

std::vector<Schema> radioSchemas() {
    constexpr double kMostLoss = 1000, kMostChannel = 1e6, kTurn = 360;
    return {{.keyword = "radio",
             .type = RecordType::Placement,
             .help = "sends messages of programs, and receives those of its kind and channel, for "
                     "simrun; it has no body",
             .keys = {
                 idKey(),
                 {.name = "on",
                  .type = KeyType::Word,
                  .help = "id of the robot, person or object that carries it: `at` and `heading` "
                          "are in its frame, z counts from the floor or from the object's top",
                  .role = Role::Carrier},
                 {.name = "at",
                  .type = KeyType::Tuple,
                  .unit = Unit::Length,
                  .help = "x,y,z",
                  .default_value = Tuple{0, 0, kHeight},
                  .min_count = 3,
                  .max_count = 3,
                  .lower = -kMaxDistance,
                  .upper = kMaxDistance,
                  .role = Role::Place},
                 angle("heading", "direction of its axis", kMaxDistance, Role::Heading),
                 angle("tilt", "of its axis above level", 90, Role::Tilt),
                 {.name = "kind",
                  .type = KeyType::Choice,
                  .help = "radio passes walls with a loss; infrared needs a free line",
                  .default_value = "radio",
                  .choices = {"radio", "infrared"}},
                 {.name = "channel",
                  .type = KeyType::Number,
                  .help = "on which it sends and receives",
                  .default_value = static_cast<double>(kChannel),
                  .lower = 0,
                  .upper = kMostChannel,
                  .whole = true},
                 positive("range", Unit::Length, "metres that its messages reach in free air", 10,
                          kMaxDistance),
                 {.name = "loss",
                  .type = KeyType::Number,
                  .help = "dB that a wall between takes from what it receives by radio; 6 dB halve "
                          "the range",
                  .default_value = 6.0,
                  .lower = 0,
                  .upper = kMostLoss},
                 positive("fov", Unit::Angle,
                          "full angle of the cone about its axis in which it sends and receives",
                          kTurn, kTurn),
                 {.name = "drop",
                  .type = KeyType::Number,
                  .unit = Unit::Share,
                  .help = "share of messages that it loses, at random",
                  .default_value = 0.0,
                  .lower = 0,
                  .upper = 1}}}};
}

void addRadios() {
    addThingKind("radio", {.states = {"channel"}, .told = {"heard"}});
    addRecordCheck("radio", [](const Scene& scene) {
        return std::function<std::optional<Finding>(std::size_t record)>(RadioCheck(scene));
    });
}

}  // namespace ispace::radios
