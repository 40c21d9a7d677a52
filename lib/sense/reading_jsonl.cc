// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/reading_jsonl.h"

#include <cmath>

#include "base/json_writer.h"
#include "base/number.h"
#include "sense/float_text.h"
#include "sense/pose_json.h"

namespace ispace {

namespace {

/// Appends what is written so far, the long list of `key`, and the end of line and object.
void appendWithRanges(std::string& out, JsonWriter& json, std::string_view key,
                      std::span<const float> ranges) {
    json.key(key).beginArray();
    out += json.text();
    TextTail tail(out, kNumberRoom * ranges.size() + 3);
    bool comma = false;
    for (const float range : ranges) {
        if (comma) tail.put(',');
        comma = true;
        if (std::isfinite(range)) {
            tail.put(range);
        } else {
            tail.put("null");
        }
    }
    tail.put("]}\n");
}

void addPosition(JsonWriter& json, const Burst& burst) {
    json.key("position");
    if (!burst.fix && !burst.simple) {
        json.null();
        return;
    }
    json.beginArray();
    if (burst.fix) {
        const Point3& p = burst.fix->position;
        json.value(tidy(p.x)).value(tidy(p.y)).value(tidy(p.z));
    } else {
        json.value(tidy(burst.simple->x)).value(tidy(burst.simple->y));
    }
    json.endArray();
}

}  // namespace

std::string scanHeaderLine(const History& history, std::uint64_t seed) {
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-scan/1");
    json.key("history").value(history);
    json.key("seed");
    // Every seed of 64 bits, unsigned; the writer's integers are signed.
    return json.take() + std::to_string(seed) + "}\n";
}

void appendScanLine(std::string& out, const Sensor& sensor, const Scan& scan) {
    const Laser& laser = sensor.as<Laser>();
    JsonWriter json;
    json.beginObject().key("sensor").value(sensor.id);
    json.key("t").value(scan.time).key("frame").value(scan.frame);
    if (laser.sweep != SweepAxis::None) json.key("scan").value(scan.number);
    addPose(json, scan.pose);
    json.key("angle_min").value(laser.first.radians());
    json.key("angle_max").value(laser.last().radians());
    json.key("angle_increment").value(laser.step.radians());
    json.key("range_min").value(laser.min_range);
    json.key("range_max").value(laser.max_range);
    appendWithRanges(out, json, "ranges", scan.ranges);
}

void appendDepthLine(std::string& out, const Sensor& sensor, const DepthFrame& frame) {
    const Ranger& ranger = sensor.as<Ranger>();
    JsonWriter json;
    json.beginObject().key("sensor").value(sensor.id);
    json.key("t").value(frame.time).key("frame").value(frame.frame);
    addPose(json, frame.pose);
    json.key("width").value(ranger.columns).key("height").value(ranger.rows);
    json.key("projection");
    if (ranger.projection == Projection::Pinhole) {
        json.value("pinhole");
        json.key("fx").value(nineDecimals(ranger.fx()));
        json.key("fy").value(nineDecimals(ranger.fy()));
        json.key("cx").value(ranger.cx()).key("cy").value(ranger.cy());
    } else {
        json.value("spherical").key("fov").beginArray();
        json.value(ranger.fov_x.radians()).value(ranger.fov_y.radians()).endArray();
    }
    json.key("measures").value(ranger.measures_depth ? "depth" : "distance");
    json.key("range_min").value(ranger.min_range);
    json.key("range_max").value(ranger.max_range);
    if (ranger.ambiguity > 0) json.key("ambiguity").value(ranger.ambiguity);
    appendWithRanges(out, json, "depths", frame.depths);
}

void appendBurstLine(std::string& out, const Sensor& tag, const Burst& burst,
                     std::span<const Sensor> receivers) {
    JsonWriter json;
    json.beginObject().key("sensor").value(tag.id);
    json.key("t").value(burst.time).key("frame").value(burst.frame);
    addPose(json, burst.pose);
    json.key("heard").beginArray();
    for (const TimeOfFlight& flight : burst.heard) {
        json.beginObject().key("receiver").value(receivers[flight.receiver].id);
        json.key("time_of_flight").value(tidy(flight.time));
        json.key("range").value(tidy(flight.distance));
        json.endObject();
    }
    json.endArray();
    addPosition(json, burst);
    const auto figure = [&burst](double Fix::*part) {
        return burst.fix ? std::optional(tidy((*burst.fix).*part)) : std::nullopt;
    };
    json.key("residual").value(figure(&Fix::residual));
    json.key("pdop").value(figure(&Fix::pdop));
    json.key("hdop").value(figure(&Fix::hdop));
    json.key("vdop").value(figure(&Fix::vdop));
    out.append(json.endObject().text()).append("\n");
}

}  // namespace ispace
