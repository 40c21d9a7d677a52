// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/record_lines.h"

#include <algorithm>
#include <initializer_list>
#include <span>
#include <utility>

#include "base/json_writer.h"
#include "base/number.h"
#include "raster/encode.h"
#include "sense/reading_picture.h"
#include "sense/reading_text.h"

namespace ispace {

namespace {

void appendRow(std::string& out, const std::string& t, const std::string& id,
               std::initializer_list<double> values) {
    out.append(t).append(",").append(id);  // a word: nothing to quote
    for (const double value : values) {
        out += ',';
        appendDouble(out, value);
    }
}

}  // namespace

void appendRobotRows(std::string& out, const World& world) {
    const std::string t = formatSimTime(world.time());
    for (std::size_t i = 0; i < world.robots().size(); ++i) {
        const RobotStatus status = world.status(i);
        appendRow(
            out, t, world.robots()[i].id,
            {status.pose.position.x, status.pose.position.y, status.pose.heading.degrees(),
             status.speed, status.rotspeed.degrees(), status.accel, status.rotaccel.degrees()});
        out += status.stall ? ",1\n" : ",0\n";
    }
}

void appendOdometryRows(std::string& out, const World& world) {
    const std::string t = formatSimTime(world.time());
    for (std::size_t i = 0; i < world.robots().size(); ++i) {
        const Pose2 pose = world.odometry(i).pose;
        appendRow(out, t, world.robots()[i].id,
                  {pose.position.x, pose.position.y, pose.heading.degrees()});
        out += '\n';
    }
}

void appendPeopleRows(std::string& out, const World& world) {
    const std::string t = formatSimTime(world.time());
    for (std::size_t i = 0; i < world.people().size(); ++i) {
        const RobotStatus status = world.status(world.robots().size() + i);
        appendRow(out, t, world.people()[i].id,
                  {status.pose.position.x, status.pose.position.y, status.pose.heading.degrees(),
                   status.speed, status.rotspeed.degrees(), status.phase, status.sidespeed});
        out += status.stall ? ",1\n" : ",0\n";
    }
}

void appendSonarRows(std::string& out, World& world) {
    const std::string t = formatSimTime(world.time());
    const auto all = world.sonars();
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].empty()) continue;
        out.append(t).append(",").append(world.robots()[i].id);
        char before = ',';
        for (const float range : all[i]) {
            out += std::exchange(before, ';');
            appendFloat(out, range);
        }
        out += '\n';
    }
}

void appendBumperRows(std::string& out, const World& world, std::vector<std::vector<bool>>& felt) {
    felt.resize(world.robots().size());
    for (std::size_t i = 0; i < felt.size(); ++i) {
        if (world.robots()[i].model.bumpers.empty()) continue;
        std::vector<bool> now = world.bumper(i);
        if (now == felt[i]) continue;
        out.append(formatSimTime(world.time())).append(",").append(world.robots()[i].id);
        char before = ',';
        for (const bool is_hit : now) {
            out += std::exchange(before, ';');
            out += is_hit ? '1' : '0';
        }
        out += '\n';
        felt[i] = std::move(now);
    }
}

namespace {

/// Lines by kind.
struct LineWriter {
    std::string& out;
    const RunSensor& sensor;
    const SensorReading& reading;
    std::span<const Sensor> receivers;
    const std::string& file;

    void operator()(const Hearings& hearings) const {
        JsonWriter json = begin();
        json.key("tags").beginArray();
        for (const HeardTag& heard : hearings.tags) {
            json.beginObject().key("tag").value(heard.tag);
            json.key("time_of_flight")
                .value(heard.time_of_flight ? std::optional(roundSignificant(*heard.time_of_flight))
                                            : std::nullopt);
            json.endObject();
        }
        json.endArray();
        end(json);
    }
    void operator()(const MatState& mat) const {
        JsonWriter json = begin();
        json.key("on").beginArray();
        for (const std::string& id : mat.on) json.value(id);
        json.endArray();
        end(json);
    }
    void operator()(const GateState& gate) const {
        JsonWriter json = begin();
        json.key("in").value(gate.in).key("out").value(gate.out);
        json.key("last");
        gate.last.empty() ? json.null() : json.value(gate.last);
        json.key("way");
        gate.last.empty() ? json.null() : json.value(gate.last_in ? "in" : "out");
        json.key("broken").value(gate.broken);
        end(json);
    }
    template <typename One>
    void operator()(const One& one) const {
        appendLine(out, viewOf(*sensor.sensor(), one, receivers), file);
    }

  private:
    [[nodiscard]] JsonWriter begin() const {
        JsonWriter json;
        json.beginObject().key("sensor").value(sensor.id);
        json.key("t").value(seconds(reading.time)).key("frame").value(reading.seq);
        addPose(json, reading.pose);
        return json;
    }
    void end(JsonWriter& json) const { out.append(json.endObject().text()).append("\n"); }
};

}  // namespace

void appendReadingLine(std::string& out, const RunSensor& sensor, const SensorReading& reading,
                       std::span<const Sensor> receivers, const std::string& file) {
    std::visit(LineWriter{out, sensor, reading, receivers, file}, reading.value);
}

std::string frameName(const std::string& id, std::int64_t seq, std::string_view ending) {
    constexpr std::size_t kDigits = 6;
    std::string name;
    for (const char c : id) {
        // The only sign of a word that a file's name cannot have; % is none of theirs.
        if (c == '/')
            name += "%2F";
        else
            name += c;
    }
    const std::string number = std::to_string(seq);
    name.append("-").append(kDigits - std::min(kDigits, number.size()), '0');
    return name.append(number).append(ending);
}

std::string frameBytes(const RunSensor& sensor, const SensorReading& reading) {
    constexpr double kMillimetres = 1000;
    if (const auto* photo = std::get_if<Photo>(&reading.value)) {
        const Camera& camera = *sensor.model<Camera>();
        return pngOfRgb(camera.columns, camera.rows, photo->rgb);
    }
    const Ranger& ranger = *sensor.model<Ranger>();
    return depthPng(ranger.columns, ranger.rows, std::get<DepthFrame>(reading.value).depths,
                    kMillimetres);
}

}  // namespace ispace
