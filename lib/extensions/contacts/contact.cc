// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/contacts/contact.h"

#include "base/error.h"
#include "base/message.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"
#include "sense/moment.h"

namespace ispace::contacts {

Contact contactOf(const Record& record) {
    Contact contact;
    contact.door = record.text("door");
    if (record.has("rate")) contact.rate = record.number("rate");
    return contact;
}

namespace {

void addContactKeys(std::vector<KeySpec>& keys) {
    keys.push_back({.name = "door",
                    .type = KeyType::Word,
                    .help = "id of the door or window that it watches",
                    .required = true,
                    .role = Role::Reference});
    keys.push_back(positiveKey("rate", Unit::Frequency, "readings a second", kMaxRate));
}

void lookUpDoor(SensorModel& model, const Record& record, const RoomRecords& room) {
    const Contact& contact = *tryModel<Contact>(model);
    std::vector<std::string> doors;
    for (std::size_t i = 0; i < room.records.size(); ++i) {
        const std::string& keyword = room.records[i].keyword();
        if (keyword != "door" && keyword != "window") continue;
        doors.push_back(room.ids[i]);
        if (doors.back() != contact.door) continue;
        const bool is_open = room.records[i].flag("open");
        changeModel<Contact>(model, [is_open](Contact& one) { one.is_open = is_open; });
        return;
    }
    throw FormatError(record.finding("door", "`door`: no door or window has the id `" +
                                                 contact.door + '`' +
                                                 didYouMean(contact.door, doors)));
}

std::vector<Mesh> contactBody() {
    Mesh box{Material::Sensor, {}, {}};
    addBox(box, {-0.01, -0.04, -0.01}, {0.01, 0.04, 0.01});
    return {std::move(box)};
}

}  // namespace

const SensorKind Contact::kKind = {
    .keyword = "contact",
    .noun = "contact",
    .help = "magnetic contact, which reports whether a door or window is open; bare: rate=10",
    .heading_help = "direction of its front, from +x",
    .sign = SensorSign::Square,
    .add_keys = addContactKeys,
    .body = contactBody,
    .read = [](const Record& record, const Record* /*device*/) -> SensorModel {
        return modelOf(contactOf(record));
    },
    .look_up = lookUpDoor,
    .bearings = [](const SensorModel& /*model*/) { return BearingSpan{}; },
    .perceives = false,
    .is_read = true,
    .measure =
        [](const Moment& now) { return std::any(ContactState{now.sensor.as<Contact>().is_open}); },
    .reading = &ContactState::kKind};

void addContacts() { addSensorKind(Contact::kKind); }

}  // namespace ispace::contacts
