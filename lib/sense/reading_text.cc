// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/reading_text.h"

#include <cmath>

#include "base/json_writer.h"
#include "base/number.h"
#include "sense/float_text.h"

namespace ispace {

void addPose(JsonWriter& json, const Pose3& pose) {
    json.key("pose").beginArray();
    for (const double part : {pose.position.x, pose.position.y, pose.position.z,
                              pose.heading.radians(), pose.tilt.radians(), pose.roll.radians()})
        json.value(part);
    json.endArray();
}

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
        json.value(roundSignificant(p.x)).value(roundSignificant(p.y)).value(roundSignificant(p.z));
    } else {
        json.value(roundSignificant(burst.simple->x)).value(roundSignificant(burst.simple->y));
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

namespace {

/// All but the depths.
void beginLine(JsonWriter& json, const Sensor& sensor, const DepthFrame& frame) {
    const Ranger& ranger = sensor.as<Ranger>();
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
}

}  // namespace

void appendLines(std::string& out, const Sensor& sensor, const DepthFrame& frame,
                 std::span<const Sensor> /*receivers*/) {
    JsonWriter json;
    beginLine(json, sensor, frame);
    appendWithRanges(out, json, "depths", frame.depths);
}

void appendFileLine(std::string& out, const Sensor& sensor, const DepthFrame& frame,
                    const std::string& file) {
    JsonWriter json;
    beginLine(json, sensor, frame);
    json.key("file").value(file);
    out.append(json.endObject().text()).append("\n");
}

void appendLines(std::string& out, const Sensor& sensor, std::span<const Scan> scans,
                 std::span<const Sensor> /*receivers*/) {
    for (const Scan& scan : scans) appendScanLine(out, sensor, scan);
}

void appendLines(std::string& out, const Sensor& tag, const Burst& burst,
                 std::span<const Sensor> receivers) {
    JsonWriter json;
    json.beginObject().key("sensor").value(tag.id);
    json.key("t").value(burst.time).key("frame").value(burst.frame);
    addPose(json, burst.pose);
    json.key("heard").beginArray();
    for (const TimeOfFlight& flight : burst.heard) {
        json.beginObject().key("receiver").value(receivers[flight.receiver].id);
        json.key("time_of_flight").value(roundSignificant(flight.time));
        json.key("range").value(roundSignificant(flight.distance));
        json.endObject();
    }
    json.endArray();
    addPosition(json, burst);
    const auto metric = [&burst](double Fix::*part) {
        return burst.fix ? std::optional(roundSignificant((*burst.fix).*part)) : std::nullopt;
    };
    json.key("residual").value(metric(&Fix::residual));
    json.key("pdop").value(metric(&Fix::pdop));
    json.key("hdop").value(metric(&Fix::hdop));
    json.key("vdop").value(metric(&Fix::vdop));
    out.append(json.endObject().text()).append("\n");
}

namespace {

/// To the nanosecond.
void appendTime(std::string& out, double seconds) { appendDouble(out, nineDecimals(seconds)); }

void appendPoint(TextTail& tail, const PointCloud& cloud, std::size_t index) {
    const float* point = &cloud.xyz[3 * index];
    for (int part = 0; part < 3; ++part) {
        tail.put(',');
        if (!std::isnan(point[part])) tail.put(point[part]);
    }
    tail.put('\n');
}

void appendNumberField(std::string& out, double value) {
    out += ',';
    appendDouble(out, value);
}

void appendPlace(std::string& out, const Burst& burst) {
    if (burst.fix) {
        const Fix& fix = *burst.fix;
        for (const double part : {fix.position.x, fix.position.y, fix.position.z, fix.residual,
                                  fix.pdop, fix.hdop, fix.vdop})
            appendNumberField(out, part);
    } else if (burst.simple) {
        appendNumberField(out, burst.simple->x);
        appendNumberField(out, burst.simple->y);
        out += ",,,,,";
    } else {
        out += ",,,,,,,";
    }
}

}  // namespace

void appendCsvField(std::string& out, std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
        out += text;
        return;
    }
    out += '"';
    for (const char c : text) {
        if (c == '"') out += '"';
        out += c;
    }
    out += '"';
}

std::string csvHeader(const Sensor& sensor) {
    if (sensor.is<Laser>()) return "sensor,frame,scan,t,beam,bearing_deg,range,x,y,z\n";
    if (sensor.is<Ranger>()) return "sensor,frame,t,column,row,depth,x,y,z\n";
    return "sensor,frame,t,x,y,z,residual,pdop,hdop,vdop,heard,times\n";
}

void appendRows(std::string& out, const Sensor& sensor, std::span<const Scan> scans, Coordinates in,
                std::span<const Sensor> /*receivers*/) {
    const Laser& laser = sensor.as<Laser>();
    const PointCloud cloud = cloudOf(laser, scans, in);
    std::size_t point = 0;
    for (const Scan& scan : scans) {
        std::string prefix;
        appendCsvField(prefix, sensor.id);
        prefix.append(",").append(std::to_string(scan.frame)).append(",");
        prefix.append(std::to_string(scan.number)).append(",");
        TextTail tail(out, scan.ranges.size() * (prefix.size() + 8 * kNumberRoom));
        for (std::size_t k = 0; k < scan.ranges.size(); ++k) {
            tail.put(prefix);
            tail.putNineDecimals(scan.time + laser.timeOf(static_cast<int>(k)));
            tail.put(',');
            tail.put(k);
            tail.put(',');
            tail.put(static_cast<float>(laser.bearing(static_cast<int>(k)).degrees()));
            tail.put(',');
            if (std::isfinite(scan.ranges[k])) tail.put(scan.ranges[k]);
            appendPoint(tail, cloud, point++);
        }
    }
}

void appendRows(std::string& out, const Sensor& sensor, const DepthFrame& frame, Coordinates in,
                std::span<const Sensor> /*receivers*/) {
    const PointCloud cloud = cloudOf(sensor.as<Ranger>(), frame, in);
    std::string prefix;
    appendCsvField(prefix, sensor.id);
    prefix.append(",").append(std::to_string(frame.frame)).append(",");
    appendTime(prefix, frame.time);
    TextTail tail(out, cloud.size() * (prefix.size() + 6 * kNumberRoom));
    std::size_t index = 0;
    for (std::size_t row = 0; row < cloud.height; ++row) {
        for (std::size_t column = 0; column < cloud.width; ++column, ++index) {
            tail.put(prefix);
            tail.put(',');
            tail.put(column);
            tail.put(',');
            tail.put(row);
            tail.put(',');
            if (std::isfinite(frame.depths[index])) tail.put(frame.depths[index]);
            appendPoint(tail, cloud, index);
        }
    }
}

void appendRows(std::string& out, const Sensor& tag, const Burst& burst, Coordinates /*in*/,
                std::span<const Sensor> receivers) {
    appendCsvField(out, tag.id);
    out.append(",").append(std::to_string(burst.frame)).append(",");
    appendTime(out, burst.time);
    appendPlace(out, burst);
    out.append(",").append(std::to_string(burst.heard.size())).append(",");
    std::string times;
    for (const TimeOfFlight& flight : burst.heard) {
        if (!times.empty()) times += ' ';
        times.append(receivers[flight.receiver].id).append("=");
        appendDouble(times, flight.time);
    }
    appendCsvField(out, times);
    out += '\n';
}

namespace {

constexpr int kSimulatedLaser = 3;  // of CARMEN's laser types

void appendNumber(std::string& out, double value) {
    out += ' ';
    appendDouble(out, value);
}

void appendPose(std::string& out, Point2 position, Angle heading) {
    appendNumber(out, position.x);
    appendNumber(out, position.y);
    appendNumber(out, wrapped(heading).radians());
}

}  // namespace

std::string carmenHeader() {
    return "# CARMEN Logfile\n"
           "# file format is one message per line; metres, radians, seconds\n"
           "# message_name [message contents] ipc_timestamp ipc_hostname logger_timestamp\n"
           "# ROBOTLASER1 laser_type start_angle field_of_view angular_resolution maximum_range "
           "accuracy remission_mode num_readings [range_readings] num_remissions "
           "[remission values] laser_pose_x laser_pose_y laser_pose_theta robot_pose_x "
           "robot_pose_y robot_pose_theta laser_tv laser_rv forward_safety_dist "
           "side_safety_dist turn_axis\n"
           "# a reading of maximum_range is no return\n";
}

void appendCarmenLine(std::string& out, std::size_t number, const Sensor& sensor, const Scan& scan,
                      const Pose2& robot) {
    const Laser& laser = sensor.as<Laser>();
    const Angle fov = laser.last() - laser.first;
    const Angle middle = laser.first + 0.5 * fov;
    out.append("ROBOTLASER").append(std::to_string(number)).append(" ");
    out += std::to_string(kSimulatedLaser);
    appendNumber(out, (-0.5 * fov).radians());
    appendNumber(out, fov.radians());
    appendNumber(out, laser.step.radians());
    appendNumber(out, laser.max_range);
    appendNumber(out, laser.noise.sigma[0]);
    out.append(" 0 ").append(std::to_string(scan.ranges.size()));
    {
        TextTail tail(out, kNumberRoom * scan.ranges.size());
        const auto none = static_cast<float>(laser.max_range);
        for (const float range : scan.ranges) {
            tail.put(' ');
            tail.put(std::isfinite(range) ? range : none);
        }
    }
    out += " 0";
    appendPose(out, scan.pose.position.onFloor(), scan.pose.heading + middle);
    appendPose(out, robot.position, robot.heading);
    // Neither speeds nor safety distances are known of a scan.
    out += " 0 0 0 0 0";
    appendNumber(out, scan.time);
    out += " sim";
    appendNumber(out, scan.time);
    out += '\n';
}

}  // namespace ispace
