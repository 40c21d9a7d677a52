// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/rfid.h"

#include <string_view>
#include <unordered_map>

#include "base/number.h"
#include "env/body.h"
#include "env/body_shapes.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace {

Rfid withParameters(Rfid base, const Record& record) {
    Diagnostics findings;
    applyRange(record, base.min_range, base.max_range, findings);
    if (record.has("fov")) applyWindow(record, base.fov_x, base.fov_y, findings);
    if (record.has("rate")) base.rate = record.number("rate");
    if (record.has("read")) base.read = record.number("read");
    findings.throwIfAny();
    return base;
}

FieldOfView fieldOfView(const Rfid& rfid, const Pose3& pose) {
    return FieldOfView::window(pose, 0.5 * rfid.fov_x, 0.5 * rfid.fov_y, rfid.max_range);
}

namespace {

void addRfidKeys(std::vector<KeySpec>& keys) {
    keys.push_back(rangeKey("least and greatest distance of a tag, or the greatest alone"));
    keys.push_back(windowKey());
    keys.push_back(positiveKey("rate", Unit::Frequency, "rounds of inventory a second", kMaxRate));
    keys.push_back({.name = "read",
                    .type = KeyType::Number,
                    .unit = Unit::Share,
                    .help = "share of the rounds that read a tag in the field, with --noise",
                    .lower = 0,
                    .upper = 1});
}

/// Numbers of people among those of a room, by their ids.
class PersonNumbers {
  public:
    explicit PersonNumbers(const RoomRecords& room) : room_(room) {}
    /// Returns the number past all people for an unknown one.
    std::size_t operator()(const std::string& id) {
        if (numbers_.empty())
            for (std::size_t i = 0; i < room_.records.size(); ++i)
                if (room_.records[i].keyword() == "human")
                    numbers_.emplace(room_.ids[i], numbers_.size());
        const auto found = numbers_.find(id);
        return found == numbers_.end() ? numbers_.size() : found->second;
    }

  private:
    const RoomRecords& room_;
    std::unordered_map<std::string_view, std::size_t> numbers_;
};

std::vector<RfidTag> tagsOf(const RoomRecords& room) {
    using Carrier = RfidTag::Carrier;
    constexpr double kAbove = 0.01;  // a tag lies on a thing, not in its surface
    std::vector<RfidTag> tags;
    PersonNumbers number_of(room);
    std::size_t robots = 0, people = 0;
    for (const Record& record : room.records) {
        const bool is_robot = record.keyword() == "robot", is_person = record.keyword() == "human";
        const std::size_t mover = is_robot ? robots++ : is_person ? people++ : 0;
        if (record.schema().find("tag") == nullptr || !record.has("tag")) continue;
        RfidTag tag{record.text("tag"),
                    is_robot    ? Carrier::Robot
                    : is_person ? Carrier::Person
                                : Carrier::Thing,
                    mover,
                    {},
                    false};
        if (const std::string person = personWith(record); !person.empty()) {
            tag.carrier = Carrier::Person;
            tag.mover = number_of(person);
            tag.is_in_hand = true;
        }
        if (tag.carrier == Carrier::Thing) {
            const Tuple& at = record.tuple("at");
            tag.at = {at[0], at[1], topOf(bodyOf(record)) + kAbove};
        }
        tags.push_back(std::move(tag));
    }
    return tags;
}

void lookUpTags(SensorModel& model, const Record& /*record*/, const RoomRecords& room) {
    std::get<Rfid>(model).tags = sharedTags(room);
}

/// Builds the flat housing of an antenna.
std::vector<Mesh> rfidBody() {
    Mesh box{Material::Sensor, {}, {}};
    addBox(box, {-0.04, -0.12, -0.12}, {0, 0.12, 0.12});
    return {std::move(box)};
}

}  // namespace

SharedList<RfidTag> sharedTags(const RoomRecords& room) {
    return room.shared<RfidTag>([&room] { return tagsOf(room); });
}

const SensorKind Rfid::kKind = {
    .keyword = "rfid",
    .noun = "RFID reader",
    .help =
        "RFID reader, which lists the tags in its field: the key `tag` of people, robots and "
        "things; bare: range=0,3 fov=70,70 rate=10",
    .heading_help = "direction of the axis of its antenna, from +x",
    .device_help = "an RFID reader or antenna one can buy",
    .sign = SensorSign::Square,
    .add_keys = addRfidKeys,
    .body = rfidBody,
    .read = readModel<Rfid>,
    .look_up = lookUpTags,
    .summary = [](const SensorModel& model) -> DeviceSummary {
        const Rfid& rfid = std::get<Rfid>(model);
        return {rangeText(rfid.min_range, rfid.max_range),
                degreesText(rfid.fov_x) + "x" + degreesText(rfid.fov_y), "-",
                formatDouble(rfid.rate)};
    },
    .view = windowViewOf<Rfid>,
    .bearings = windowBearings<Rfid>,
    .field_of_view = fieldOfViewOf<Rfid>,
    .stopped_by = Surfaces::Solid,
    .is_read = true,
    .is_arranged = true,
    .follows_poses = true};

}  // namespace ispace
