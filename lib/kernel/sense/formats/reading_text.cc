// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/reading_text.h"

#include <cmath>
#include <optional>

#include "base/json_writer.h"
#include "base/number.h"

namespace ispace {

void addPose(JsonWriter& json, const Pose3& pose) {
    json.key("pose").beginArray();
    for (const double part : {pose.position.x, pose.position.y, pose.position.z,
                              pose.heading.radians(), pose.tilt.radians(), pose.roll.radians()})
        json.value(part);
    json.endArray();
}

std::string scanHeaderLine(const History& history, std::uint64_t seed) {
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-scan/1");
    json.key("history").value(history);
    json.key("seed");
    // Seeds are unsigned 64-bit integers; the writer's integers are signed.
    return json.take() + std::to_string(seed) + "}\n";
}

namespace {

/// Appends values to a line of JSON that begins in `out`.
struct JsonValue {
    std::string& out;
    JsonWriter& json;

    void operator()(std::monostate /*none*/) const {}
    void operator()(Angle angle) const { json.value(angle.radians()); }
    void operator()(const Measured& measured) const {
        measured.value ? json.value(roundSignificant(*measured.value)) : json.null();
    }
    void operator()(const Computed& computed) const { json.value(nineDecimals(computed.value)); }
    template <typename Value>
    void operator()(const std::vector<Value>& list) const {
        json.beginArray();
        for (const Value& value : list) (*this)(value);
        json.endArray();
    }
    void operator()(std::span<const float> ranges) const {
        json.beginArray();
        out += json.take();
        TextTail tail(out, kNumberRoom * ranges.size());
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
        json.endArray();
    }
    void operator()(std::span<const std::uint8_t> /*pixels*/) const {}
    void operator()(const FieldRecord& record) const {
        json.beginObject();
        for (const auto& [name, value] : record.values) {
            json.key(name);
            std::visit(*this, value);
        }
        json.endObject();
    }
    template <typename Value>
    void operator()(const Value& value) const {
        json.value(value);
    }
};

}  // namespace

void appendLine(std::string& out, const ReadingView& reading, const std::string& file) {
    const ReadingKind& kind = readingKind(reading.sensor.model);
    JsonWriter json;
    json.beginObject().key("sensor").value(reading.sensor.id);
    json.key("t").value(reading.time).key("frame").value(reading.frame);
    if (isSwept(reading.sensor)) json.key("scan").value(kind.part(reading));
    addPose(json, reading.pose);
    for (const ReadingField& field : kind.fields) {
        if ((field.uses & kInJson) == 0) continue;
        if ((field.uses & kIsFrame) != 0 && !file.empty()) {
            json.key("file").value(file);
            continue;
        }
        const FieldValue value = field.value(reading);
        if (std::holds_alternative<std::monostate>(value)) continue;
        json.key(field.name);
        std::visit(JsonValue{out, json}, value);
    }
    out.append(json.endObject().text()).append("\n");
}

std::string jsonOfField(const ReadingView& reading, std::string_view name) {
    std::string out;
    JsonWriter json;
    for (const ReadingField& field : readingKind(reading.sensor.model).fields)
        if (field.name == name && (field.uses & kInJson) != 0)
            std::visit(JsonValue{out, json}, field.value(reading));
    return out + json.take();
}

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
    const ReadingKind& kind = readingKind(sensor.model);
    std::string out = kind.part == nullptr ? "sensor,frame,t" : "sensor,frame,scan,t";
    for (const std::string_view index : kind.indices) out.append(",").append(index);
    for (const ReadingField& field : kind.fields)
        if ((field.uses & kInColumn) != 0) out.append(",").append(field.name);
    return out + (kind.points == nullptr ? "\n" : ",x,y,z\n");
}

namespace {

void putFinite(TextTail& tail, float value) {
    tail.put(',');
    if (std::isfinite(value)) tail.put(value);
}

/// Writes the fields of a row that holds a whole reading.
struct CsvValue {
    std::string& out;

    void operator()(std::int64_t value) const { out += std::to_string(value); }
    void operator()(const Measured& measured) const {
        if (measured.value) appendDouble(out, *measured.value);
    }
    void operator()(const FieldText& text) const { appendCsvField(out, text.value_or("")); }
    template <typename Value>
    void operator()(const Value& /*value*/) const {}
};

/// Appends a row for each element, with its floats and its point.
void appendElements(std::string& out, const ReadingView& reading, const std::string& prefix,
                    const float* point) {
    const Sensor& sensor = reading.sensor;
    const ReadingKind& kind = readingKind(sensor.model);
    std::vector<FieldValue> values;
    for (const ReadingField& field : kind.fields)
        if ((field.uses & kInColumn) != 0) values.push_back(field.value(reading));
    std::vector<std::span<const float>> columns;
    for (const FieldValue& value : values) {
        const auto* const own = std::get_if<std::vector<float>>(&value);
        columns.push_back(own != nullptr ? std::span<const float>(*own)
                                         : std::get<std::span<const float>>(value));
    }
    const std::size_t count = columns.front().size();
    const std::vector<std::size_t> sizes = kind.counts(sensor);
    constexpr std::size_t kPointNumbers = 3;
    const std::size_t numbers = 1 + sizes.size() + columns.size() + kPointNumbers;
    TextTail tail(out, count * (prefix.size() + numbers * kNumberRoom));
    for (std::size_t k = 0; k < count; ++k) {
        tail.put(prefix);
        tail.putNineDecimals(reading.time + (kind.delay == nullptr ? 0 : kind.delay(sensor, k)));
        std::size_t index = k;
        for (const std::size_t size : sizes) {
            tail.put(',');
            tail.put(index % size);
            index /= size;
        }
        for (const std::span<const float> column : columns) putFinite(tail, column[k]);
        for (std::size_t axis = 0; axis < kPointNumbers; ++axis) putFinite(tail, *point++);
        tail.put('\n');
    }
}

}  // namespace

void appendRows(std::string& out, const Sensor& sensor, const Reading& reading, Coordinates in,
                std::span<const Sensor> receivers) {
    const ReadingKind& kind = readingKind(sensor.model);
    const PointCloud cloud =
        kind.points == nullptr ? PointCloud() : kind.points(sensor, reading, in);
    std::size_t part = 0;
    for (const ReadingView& view : viewsOf(sensor, reading, receivers)) {
        std::string prefix;
        appendCsvField(prefix, sensor.id);
        prefix.append(",").append(std::to_string(view.frame)).append(",");
        if (kind.part != nullptr) prefix.append(std::to_string(kind.part(view))).append(",");
        if (kind.points != nullptr) {
            const std::size_t width = cloud.size() / (kind.part == nullptr ? 1 : cloud.height);
            appendElements(out, view, prefix, cloud.xyz.data() + 3 * width * part++);
            continue;
        }
        out += prefix;
        appendDouble(out, nineDecimals(view.time));
        for (const ReadingField& field : kind.fields) {
            if ((field.uses & kInColumn) == 0) continue;
            out += ',';
            std::visit(CsvValue{out}, field.value(view));
        }
        out += '\n';
    }
}

namespace {

constexpr int kSimulatedLaser = 3;  // of CARMEN's laser types

void appendCarmenNumber(std::string& out, double value) {
    out += ' ';
    appendDouble(out, value);
}

void appendCarmenPose(std::string& out, Point2 position, Angle heading) {
    appendCarmenNumber(out, position.x);
    appendCarmenNumber(out, position.y);
    appendCarmenNumber(out, wrapped(heading).radians());
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
    appendCarmenNumber(out, (-0.5 * fov).radians());
    appendCarmenNumber(out, fov.radians());
    appendCarmenNumber(out, laser.step.radians());
    appendCarmenNumber(out, laser.max_range);
    appendCarmenNumber(out, laser.noise.sigma[0]);
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
    appendCarmenPose(out, scan.pose.position.onFloor(), scan.pose.heading + middle);
    appendCarmenPose(out, robot.position, robot.heading);
    // Speeds and safety distances of a scan are unknown.
    out += " 0 0 0 0 0";
    appendCarmenNumber(out, scan.time);
    out += " sim";
    appendCarmenNumber(out, scan.time);
    out += '\n';
}

}  // namespace ispace
