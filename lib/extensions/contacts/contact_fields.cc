// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of contacts.
#include "extensions/contacts/contact.h"
#include "sense/formats/field_values.h"

namespace ispace::contacts {

namespace {

using namespace fields;

FieldValue openAsNumber(const View& reading) {
    return fieldOf(int{reading.as<ContactState>().open});
}

constexpr ReadingField kContactFields[] = {
    {"door", kInInfo,
     [](const View& r) { return FieldValue(FieldText(r.sensor.as<Contact>().door)); }},
    {"rate", kInInfo, figure<Contact, &Contact::rate>},
    {"open", kInJson | kInLine | kIsState, measured<ContactState, &ContactState::open>},
    {"open", kInColumn | kInPage, openAsNumber},
    {"open", kInArray,
     [](const View& r) { return FieldValue(r.as<ContactState>().open ? 1.0 : 0.0); }, kFloat64,
     [](const View&) { return std::vector<std::uint64_t>(); }}};

constexpr RosTopic kContactTopics[] = {
    {RosType::Bool, "open", RosFrame::Sensor, [](const RosHeader& /*header*/, const View& r) {
         return boolMessage(r.as<ContactState>().open);
     }}};

}  // namespace

const ReadingKind ContactState::kKind = {.fields = kContactFields, .topics = kContactTopics};

}  // namespace ispace::contacts
