// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/scan_jsonl.h"

#include <cmath>

#include "base/json_writer.h"
#include "base/number.h"

namespace ispace {

std::string scanHeaderLine(const History& history, std::uint64_t seed) {
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-scan/1");
    json.key("history").value(history);
    json.key("seed");
    // Every seed of 64 bits, unsigned; the writer's integers are signed.
    return json.take() + std::to_string(seed) + "}\n";
}

void appendScanLine(std::string& out, const PlacedLaser& sensor, const Scan& scan) {
    const Laser& laser = sensor.laser;
    const Pose3& pose = sensor.pose;
    JsonWriter json;
    json.beginObject().key("sensor").value(sensor.id);
    json.key("t").value(scan.time).key("frame").value(scan.frame);
    json.key("pose").beginArray();
    for (const double part : {pose.position.x, pose.position.y, pose.position.z,
                              pose.heading.radians(), pose.tilt.radians(), pose.roll.radians()})
        json.value(part);
    json.endArray();
    json.key("angle_min").value(laser.first.radians());
    json.key("angle_max").value(laser.last().radians());
    json.key("angle_increment").value(laser.step.radians());
    json.key("range_min").value(laser.min_range);
    json.key("range_max").value(laser.max_range);
    json.key("ranges").beginArray();
    out += json.text();

    // The long list goes straight to the output; the longest float has 15 characters.
    out.reserve(out.size() + 16 * scan.ranges.size() + 4);
    bool comma = false;
    for (const float range : scan.ranges) {
        if (comma) out += ',';
        comma = true;
        if (std::isinf(range)) {
            out += "null";
        } else {
            appendFloat(out, range);
        }
    }
    out += "]}\n";
}

}  // namespace ispace
