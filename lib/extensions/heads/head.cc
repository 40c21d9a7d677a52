// SPDX-License-Identifier: GPL-3.0-or-later
// The mount is pan about the upright axis, then tilt about the turned one; sensors with `on` stand
// in that frame.
#include "extensions/heads/head.h"

#include <functional>
#include <string>
#include <unordered_set>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "scene/placement_schemas.h"
#include "scene/sensor/sensor_keys.h"
#include "scene/thing_kind.h"

namespace ispace::heads {

namespace {

constexpr double kMostPan = 360, kMostTilt = 90, kFastest = 1e5;

Head::Range rangeOf(const Record& record, const std::string& axis) {
    const Tuple& ends = record.tuple(axis + "_range");
    const double angle = record.number(axis);
    if (ends[0] > ends[1])
        throw FormatError(record.finding(
            axis + "_range", "`" + axis +
                                 "_range`: wanted the least angle before the greatest, found " +
                                 formatDouble(ends[0]) + ',' + formatDouble(ends[1])));
    if (angle < ends[0] || angle > ends[1])
        throw FormatError(record.finding(axis, "`" + axis + "`: " + formatDouble(angle) +
                                                   " is beyond the " + axis +
                                                   "_range of the head, " + formatDouble(ends[0]) +
                                                   " to " + formatDouble(ends[1])));
    return {ends[0], ends[1]};
}

KeySpec angleKey(std::string name, std::string help, double most) {
    return {.name = std::move(name),
            .type = KeyType::Number,
            .unit = Unit::Angle,
            .help = std::move(help),
            .default_value = 0.0,
            .lower = -most,
            .upper = most};
}

KeySpec rangeKey(std::string name, std::string help, double most) {
    return {.name = std::move(name),
            .type = KeyType::Tuple,
            .unit = Unit::Angle,
            .help = std::move(help),
            .default_value = Tuple{-most, most},
            .min_count = 2,
            .max_count = 2,
            .lower = -most,
            .upper = most};
}

}  // namespace

Head headOf(const Record& record) {
    Head head{record.number("pan"), record.number("tilt"), rangeOf(record, "pan"),
              rangeOf(record, "tilt")};
    if (record.has("speed")) head.speed = record.number("speed");
    return head;
}

Pose3 headMount(const Record& record) {
    const Tuple& at = record.tuple("at");
    return {{at[0], at[1], at[2]},
            record.angle("heading") + record.angle("pan"),
            record.angle("tilt"),
            {}};
}

namespace {

/// Checks the heads of a scene, with a list of its carriers.
class HeadCheck {
  public:
    explicit HeadCheck(const Scene& scene) : scene_(&scene) {
        for (const Record& each : scene.records) carriers_.insert(carrierOf(each));
    }
    [[nodiscard]] std::optional<Finding> operator()(std::size_t record) const {
        const std::string& id = scene_->ids[record];
        if (carriers_.contains(id)) return std::nullopt;
        const Tuple& at = scene_->records[record].tuple("at");
        return Finding{.element = id,
                       .at = {at[0], at[1]},
                       .message = "no sensor is on head " + id,
                       .hint = "a camera or laser with on=" + id + " turns with it",
                       .source = scene_->records[record].place()};
    }

  private:
    const Scene* scene_;
    std::unordered_set<std::string> carriers_;
};

}  // namespace

std::optional<Finding> checkHead(const Scene& scene, std::size_t record) {
    return HeadCheck(scene)(record);
}

std::vector<Schema> headSchemas() {
    KeySpec on{.name = "on",
               .type = KeyType::Word,
               .help =
                   "id of the robot or object that carries it: `at` and `heading` are in its "
                   "frame, z counts from the floor or from the object's top",
               .role = Role::Carrier};
    return {
        {.keyword = "head",
         .type = RecordType::Placement,
         .help = "a joint that pans and tilts the sensors with on=ID; their `at` is in its "
                 "frame, from the point where its axes cross; it has no body",
         .keys = {idKey(),
                  std::move(on),
                  {.name = "at",
                   .type = KeyType::Tuple,
                   .unit = Unit::Length,
                   .help = "x,y,z of the point where its axes cross",
                   .default_value = Tuple{0, 0, kHeadHeight},
                   .min_count = 3,
                   .max_count = 3,
                   .lower = -kMaxDistance,
                   .upper = kMaxDistance,
                   .role = Role::Place},
                  {.name = "heading",
                   .type = KeyType::Number,
                   .unit = Unit::Angle,
                   .help = "direction that it faces at pan=0",
                   .default_value = 0.0,
                   .lower = -kMaxDistance,
                   .upper = kMaxDistance,
                   .role = Role::Heading},
                  angleKey("pan", "turn to the left of its heading, within pan_range", kMostPan),
                  angleKey("tilt", "turn upwards, within tilt_range", kMostTilt),
                  rangeKey("pan_range", "least,greatest pan", kMostPan),
                  rangeKey("tilt_range", "least,greatest tilt", kMostTilt),
                  {.name = "speed",
                   .type = KeyType::Number,
                   .unit = Unit::Angle,
                   .help = "degrees a second of both axes for TURN; without it at once",
                   .lower = 0,
                   .upper = kFastest,
                   .lower_open = true}}}};
}

void addHeads() {
    addThingKind("head", {.states = {"pan", "tilt"},
                          .check = [](const Record& record) { headOf(record); },
                          .mount = headMount});
    addRecordCheck("head", [](const Scene& scene) {
        return std::function<std::optional<Finding>(std::size_t record)>(HeadCheck(scene));
    });
}

}  // namespace ispace::heads
