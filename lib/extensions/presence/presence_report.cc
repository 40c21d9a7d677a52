// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/presence/presence_report.h"

#include <vector>

#include "base/message.h"
#include "base/number.h"
#include "report/coverage_report.h"

namespace ispace::presence {

namespace {

void writeNumber(JsonWriter& json, const char* key, double value) {
    json.key(key).value(roundSignificant(value));
}

void writePresenceOf(JsonWriter& json, const PresenceFigures& figures) {
    json.beginObject();
    if (!figures.id.empty()) json.key("id").value(figures.id);
    writeNumber(json, "length", figures.length);
    if (figures.length > 0)
        writeNumber(json, "share", figures.share);
    else
        json.key("share").null();
    writeNumber(json, "longest_undetected", figures.longest_gap);
    json.endObject();
}

std::string lengthText(double length) { return formatFixed(length, 2) + " m"; }

TextRow peopleRow(const PresenceFigures& figures) {
    return {"  " + (figures.id.empty() ? "all" : "person " + printable(figures.id)),
            lengthText(figures.length), figures.length > 0 ? percentText(figures.share) : "-",
            lengthText(figures.longest_gap)};
}

std::string presenceText(const Presence& presence) {
    std::vector<TextRow> people = {{"presence within " + formatDouble(kPresenceDelay) + " s", "way",
                                    "detected", "longest undetected"}};
    for (const PresenceFigures& person : presence.people) people.push_back(peopleRow(person));
    if (presence.people.size() != 1) people.push_back(peopleRow(presence.all));
    std::string text = aligned(people, "lr");
    if (presence.sensors.empty()) return text + "no sensor detects motion\n";
    std::vector<TextRow> sensors = {{"share of the ways by", "it detects", "it alone detects"}};
    for (const SensorPresence& sensor : presence.sensors)
        sensors.push_back(
            {"  " + printable(sensor.id), percentText(sensor.share), percentText(sensor.marginal)});
    return text + aligned(sensors, "lr");
}

}  // namespace

void PresenceSection::writeJson(JsonWriter& json) const {
    json.key("presence").beginObject();
    writeNumber(json, "within", kPresenceDelay);
    json.key("people").beginArray();
    for (const PresenceFigures& person : presence_.people) writePresenceOf(json, person);
    json.endArray();
    json.key("all");
    writePresenceOf(json, presence_.all);
    json.key("sensors").beginArray();
    for (const SensorPresence& sensor : presence_.sensors) {
        json.beginObject();
        json.key("id").value(sensor.id);
        writeNumber(json, "share", sensor.share);
        writeNumber(json, "marginal_share", sensor.marginal);
        json.endObject();
    }
    json.endArray().endObject();
}

std::string PresenceSection::text() const { return '\n' + presenceText(presence_); }

PageAdditions PresenceSection::page(const PageSubject& subject) const {
    PageAdditions added;
    if (subject.of == PageSubject::Of::Site)
        added.figures.push_back({"presence", "Presence", {PageCode{presenceText(presence_)}}});
    return added;
}

}  // namespace ispace::presence
