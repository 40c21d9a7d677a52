// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/session_sensors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "raster/codec.h"
#include "sense/formats/point_cloud.h"
#include "sense/formats/reading_picture.h"

namespace ispace {

namespace {

constexpr double kMillimetres = 1000;

std::string measured(double value) { return formatFixed(value, 3); }

void add(std::string& out, std::string_view key, std::string_view value) {
    out.append(" ").append(key).append("=").append(value);
}
void add(std::string& out, std::string_view key, double value) {
    add(out, key, formatDouble(value));
}
void add(std::string& out, std::string_view key, std::int64_t value) {
    add(out, key, std::to_string(value));
}
void add(std::string& out, std::string_view key, std::initializer_list<double> values) {
    std::string text;
    for (const double value : values)
        text.append(text.empty() ? "" : ",").append(formatDouble(value));
    add(out, key, text);
}

void addFormats(std::string& out, const RunSensor& sensor) {
    std::string all;
    for (const FrameFormat format : formatsOf(sensor))
        all.append(all.empty() ? "" : ",").append(nameOf(format));
    add(out, "formats", all);
}

}  // namespace

// Descriptions of sensors.

std::span<const FrameFormat> formatsOf(const RunSensor& sensor) {
    using F = FrameFormat;
    static constexpr std::array kCamera{F::Png, F::Jpeg, F::Rgb};
    static constexpr std::array kRanger{F::Depth32, F::Depth16, F::Cloud, F::Png};
    if (sensor.model<Camera>() != nullptr) return kCamera;
    if (sensor.model<Ranger>() != nullptr) return kRanger;
    return {};
}

std::string_view nameOf(FrameFormat format) {
    switch (format) {
        case FrameFormat::None:
            return "";
        case FrameFormat::Png:
            return "png";
        case FrameFormat::Jpeg:
            return "jpeg";
        case FrameFormat::Rgb:
            return "rgb";
        case FrameFormat::Depth32:
            return "depth32";
        case FrameFormat::Depth16:
            return "depth16";
        case FrameFormat::Cloud:
            break;
    }
    return "cloud";
}

bool hasBytes(const RunSensor& sensor) {
    return sensor.model<Laser>() != nullptr || !formatsOf(sensor).empty();
}

std::string laserFigures(const Laser& laser) {
    std::string out;
    add(out, "angle_min", laser.first.degrees());
    add(out, "angle_max", laser.last().degrees());
    add(out, "step", laser.step.degrees());
    add(out, "n", std::int64_t{laser.beams});
    add(out, "range_min", laser.min_range);
    add(out, "range_max", laser.max_range);
    add(out, "rate", laser.rate);
    if (laser.spin != 0) add(out, "spin", laser.spin);
    return out;
}

namespace {

std::string figuresOf(const Laser& laser) { return laserFigures(laser); }

std::string figuresOf(const Ranger& ranger) {
    std::string out;
    add(out, "width", std::int64_t{ranger.columns});
    add(out, "height", std::int64_t{ranger.rows});
    if (ranger.projection == Projection::Pinhole) {
        add(out, "projection", "pinhole");
        add(out, "fx", ranger.fx());
        add(out, "fy", ranger.fy());
        add(out, "cx", ranger.cx());
        add(out, "cy", ranger.cy());
    } else {
        add(out, "projection", "spherical");
        add(out, "fov", {ranger.fov_x.degrees(), ranger.fov_y.degrees()});
    }
    add(out, "measures", ranger.measures_depth ? "depth" : "distance");
    add(out, "range_min", ranger.min_range);
    add(out, "range_max", ranger.max_range);
    add(out, "rate", ranger.rate);
    return out;
}

std::string figuresOf(const Camera& camera) {
    std::string out;
    add(out, "width", std::int64_t{camera.columns});
    add(out, "height", std::int64_t{camera.rows});
    add(out, "projection",
        camera.lens == Lens::Pinhole   ? "pinhole"
        : camera.lens == Lens::Fisheye ? "fisheye"
                                       : "omni");
    add(out, "fx", camera.fx);
    add(out, "fy", camera.fy);
    add(out, "cx", camera.cx);
    add(out, "cy", camera.cy);
    if (camera.lens == Lens::Mirror) add(out, "mirror", camera.mirror);
    if (camera.isDistorted()) {
        const auto& k = camera.distortion;
        if (camera.lens == Lens::Fisheye)
            add(out, "coefficients", {k[0], k[1], k[2], k[3]});
        else
            add(out, "coefficients", {k[0], k[1], k[2], k[3], k[4]});
    }
    add(out, "rate", camera.rate);
    return out;
}

std::string figuresOf(const Receiver& receiver) {
    std::string out;
    add(out, "range_min", receiver.min_range);
    add(out, "range_max", receiver.max_range);
    add(out, "fov", receiver.fov.degrees());
    add(out, "rate", receiver.rate);
    return out;
}

std::string figuresOf(const Tag& tag) {
    std::string out;
    add(out, "fov", tag.fov.degrees());
    add(out, "rate", tag.rate);
    return out;
}

std::string placeOf(const Pose2& pose) {
    std::string out;
    add(out, "x", measured(pose.position.x));
    add(out, "y", measured(pose.position.y));
    add(out, "heading", measured(wrapped(pose.heading).degrees()));
    return out;
}

}  // namespace

std::string sensorFigures(const RunSensor& sensor) {
    std::string out;
    add(out, "kind", sensor.keyword());
    if (const Sensor* placed = sensor.sensor())
        out += std::visit([](const auto& model) { return figuresOf(model); }, placed->model);
    if (const auto* mat = std::get_if<Mat>(&sensor.what)) {
        out += placeOf(mat->pose);
        add(out, "size", {2 * mat->half_length, 2 * mat->half_width});
        add(out, "rate", mat->rate);
    } else if (const auto* gate = std::get_if<Gate>(&sensor.what)) {
        out += placeOf(gate->pose);
        add(out, "width", 2 * gate->half_width);
        add(out, "height", gate->height);
        add(out, "rate", gate->rate);
    }
    if (!formatsOf(sensor).empty()) addFormats(out, sensor);
    return out;
}

// Readings.

void appendRange(std::string& out, float range) {
    if (std::isinf(range)) {
        out += '-';
        return;
    }
    // A float times 1000 is exact in a double, so rounding it half to even is what a correctly
    // rounded conversion to three decimals does.
    constexpr double kMax = 1e9;
    const double value = range;
    if (!(value >= 0 && value < kMax)) {
        out += formatFixed(value, 3);
        return;
    }
    const auto millimetres = std::llrint(value * 1000);
    std::array<char, 24> digits;
    char* const end =
        std::to_chars(digits.data(), digits.data() + digits.size(), millimetres / 1000).ptr;
    const auto rest = static_cast<int>(millimetres % 1000);
    end[0] = '.';
    end[1] = static_cast<char>('0' + rest / 100);
    end[2] = static_cast<char>('0' + rest / 10 % 10);
    end[3] = static_cast<char>('0' + rest % 10);
    out.append(digits.data(), end + 4);
}

namespace {

void appendLittleEndian(std::string& out, float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>((bits >> shift) & 0xffu);
}

std::string littleEndian(std::span<const float> values) {
    std::string out;
    out.reserve(sizeof(float) * values.size());
    for (const float value : values) appendLittleEndian(out, value);
    return out;
}

std::string millimetres(std::span<const float> depths) {
    constexpr float kMost = 65535;
    std::string out;
    out.reserve(2 * depths.size());
    for (const float depth : depths) {
        const float rounded = std::round(depth * static_cast<float>(kMillimetres));
        const auto value = static_cast<unsigned>(rounded <= kMost ? rounded : 0);
        out += static_cast<char>(value & 0xffU);
        out += static_cast<char>(value >> 8U);
    }
    return out;
}

/// Formats readings as lines.
class ScanText {
  public:
    ScanText(const RunSensor& sensor, const SensorReading& reading, const ReplyForm& form)
        : sensor_(sensor), reading_(reading), form_(form) {
        constexpr std::size_t kHead = 192;
        out_.reserve(kHead);
        out_.append("SCAN ").append(sensor.id);
        out_.append(" t=").append(formatMilliseconds(reading.time));
        out_.append(" seq=").append(std::to_string(reading.seq));
    }

    std::string take() {
        std::visit([this](const auto& value) { write(value); }, reading_.value);
        return std::move(out_);
    }

  private:
    void markStream() {
        if (form_.stream) out_ += " stream=1";
    }
    void writeBytes(std::string_view bytes) {
        add(out_, "bytes", std::to_string(bytes.size()));
        out_.append("\n").append(bytes);
    }

    void write(const Scan& scan) {
        const Laser& laser = *sensor_.model<Laser>();
        const auto& ranges = scan.ranges;
        add(out_, "angle_min", laser.first.degrees());
        add(out_, "angle_max", laser.last().degrees());
        add(out_, "step", laser.step.degrees());
        add(out_, "n", std::to_string(ranges.size()));
        markStream();
        constexpr std::size_t kRange = sizeof "12.345,";
        if (form_.binary) return writeBytes(littleEndian(ranges));
        out_.reserve(out_.size() + ranges.size() * kRange);
        out_ += " r=";
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            if (i > 0) out_ += ',';
            appendRange(out_, ranges[i]);
        }
        out_ += '\n';
    }

    void writeFrame(int columns, int rows, std::string_view bytes) {
        const Pose3& pose = reading_.pose;
        std::string place;
        for (const double part :
             {pose.position.x, pose.position.y, pose.position.z, wrapped(pose.heading).degrees(),
              pose.tilt.degrees(), pose.roll.degrees()})
            place.append(place.empty() ? "" : ",").append(measured(part));
        add(out_, "pose", place);
        add(out_, "format", nameOf(form_.format));
        add(out_, "width", std::int64_t{columns});
        add(out_, "height", std::int64_t{rows});
        markStream();
        if (form_.binary) return writeBytes(bytes);
        add(out_, "base64", base64(bytes));
        out_ += '\n';
    }
    void write(const Photo& photo) {
        const Camera& camera = *sensor_.model<Camera>();
        const int columns = camera.columns, rows = camera.rows;
        if (form_.format == FrameFormat::Png)
            return writeFrame(columns, rows, pngOfRgb(columns, rows, photo.rgb));
        if (form_.format == FrameFormat::Jpeg)
            return writeFrame(columns, rows, jpegOfRgb(columns, rows, photo.rgb));
        writeFrame(columns, rows,
                   {reinterpret_cast<const char*>(photo.rgb.data()), photo.rgb.size()});
    }
    void write(const DepthFrame& frame) {
        const Ranger& ranger = *sensor_.model<Ranger>();
        const auto bytes = [&]() -> std::string {
            switch (form_.format) {
                case FrameFormat::Depth16:
                    return millimetres(frame.depths);
                case FrameFormat::Png:
                    return depthPng(ranger.columns, ranger.rows, frame.depths, kMillimetres);
                case FrameFormat::Cloud:
                    return littleEndian(cloudOf(ranger, frame, Coordinates::Sensor).xyz);
                default:
                    return littleEndian(frame.depths);
            }
        };
        writeFrame(ranger.columns, ranger.rows, bytes());
    }

    void write(const Hearings& hearings) {
        std::string tags, times;
        for (const HeardTag& heard : hearings.tags) {
            tags.append(tags.empty() ? "" : ",").append(heard.tag);
            times.append(times.empty() ? "" : ",");
            times += heard.time_of_flight ? formatFixed(*heard.time_of_flight, 6) : "-";
        }
        add(out_, "tags", tags);
        add(out_, "tof", times);
        markStream();
        out_ += '\n';
    }
    void write(const Burst& burst) {
        add(out_, "heard", std::to_string(burst.heard.size()));
        const auto place = [&](std::optional<double> value) {
            return value ? measured(*value) : "-";
        };
        std::optional<double> x, y, z, residual;
        if (burst.fix) {
            x = burst.fix->position.x;
            y = burst.fix->position.y;
            z = burst.fix->position.z;
            residual = burst.fix->residual;
        } else if (burst.simple) {
            x = burst.simple->x;
            y = burst.simple->y;
        }
        add(out_, "x", place(x));
        add(out_, "y", place(y));
        add(out_, "z", place(z));
        add(out_, "residual", place(residual));
        markStream();
        out_ += '\n';
    }
    void write(const MatState& mat) {
        add(out_, "n", std::to_string(mat.on.size()));
        std::string ids;
        for (const std::string& id : mat.on) ids.append(ids.empty() ? "" : ",").append(id);
        add(out_, "on", ids);
        markStream();
        out_ += '\n';
    }
    void write(const GateState& gate) {
        add(out_, "in", gate.in);
        add(out_, "out", gate.out);
        add(out_, "last", gate.last.empty() ? "-" : gate.last);
        add(out_, "way", gate.last.empty() ? "-" : gate.last_in ? "in" : "out");
        add(out_, "broken", gate.broken ? "1" : "0");
        markStream();
        out_ += '\n';
    }

    const RunSensor& sensor_;
    const SensorReading& reading_;
    const ReplyForm& form_;
    std::string out_;
};

}  // namespace

std::string scanText(const RunSensor& sensor, const SensorReading& reading, const ReplyForm& form) {
    return ScanText(sensor, reading, form).take();
}

}  // namespace ispace
