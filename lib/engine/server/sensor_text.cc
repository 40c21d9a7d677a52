// SPDX-License-Identifier: GPL-3.0-or-later
// Lines and bytes of readings, ispace-protocol(7). Ranges have three decimals, rounded half to
// even; floats and integers in bytes are little-endian on every machine.
#include "server/session_sensors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "raster/codec.h"
#include "sense/formats/camera_info.h"
#include "sense/formats/point_cloud.h"
#include "sense/formats/reading_fields.h"
#include "server/session.h"

namespace ispace {

namespace {

constexpr double kMillimetres = 1000;

void add(std::string& out, std::string_view key, std::string_view value) {
    out.append(" ").append(key).append("=").append(value);
}
void add(std::string& out, std::string_view key, std::int64_t value) {
    add(out, key, std::to_string(value));
}

void addFormats(std::string& out, const Sensor& sensor) {
    std::string all;
    for (const FrameFormat format : formatsOf(sensor))
        all.append(all.empty() ? "" : ",").append(nameOf(format));
    add(out, "formats", all);
}

/// Adds the pose of a sensor in its robot's frame, metres and degrees.
void addMount(std::string& out, const Pose3& pose) {
    std::string all;
    for (const double value : {pose.position.x, pose.position.y, pose.position.z,
                               pose.heading.degrees(), pose.tilt.degrees(), pose.roll.degrees()})
        all.append(all.empty() ? "" : ",").append(formatDouble(value));
    add(out, "mount", all);
}

}  // namespace

// Descriptions of sensors.

std::span<const FrameFormat> formatsOf(const Sensor& sensor) {
    using F = FrameFormat;
    static constexpr std::array kCamera{F::Png, F::Jpeg, F::Rgb};
    static constexpr std::array kRanger{F::Depth32, F::Depth16, F::Cloud, F::Png};
    if (sensor.tryAs<Camera>() != nullptr) return kCamera;
    if (sensor.tryAs<Ranger>() != nullptr) return kRanger;
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

bool hasBytes(const Sensor& sensor) {
    return sensor.tryAs<Laser>() != nullptr || !formatsOf(sensor).empty();
}

namespace {

/// Adds the fields of a kind that the protocol writes in one line, angles in degrees. Kinds of
/// extensions need no code here: their table of fields says which of them a line holds.
struct LineFields {
    std::string& out;
    std::span<const float> floats = {};  ///< of the last field with floats

    void addAll(const ReadingView& view, unsigned use) {
        for (const ReadingField& field : readingKind(view.sensor.model).fields) {
            if ((field.uses & use) == 0) continue;
            const FieldValue value = field.value(view);
            std::visit([&](const auto& one) { addField(field.name, one); }, value);
        }
    }

  private:
    static std::string text(bool value) { return value ? "1" : "0"; }
    static std::string text(std::int64_t value) { return std::to_string(value); }
    static std::string text(double value) { return formatDouble(value); }
    static std::string text(Angle angle) { return formatDouble(angle.degrees()); }
    static std::string text(const Measured& one) { return one.value ? measured(*one.value) : "-"; }
    static std::string text(const Computed& computed) { return formatDouble(computed.value); }
    static std::string text(const FieldText& one) { return one.value_or("-"); }
    static std::string text(const std::string& one) { return one; }
    static std::string text(const FieldRecord& /*record*/) { return ""; }
    template <typename Value>
    static std::string text(const std::vector<Value>& values) {
        std::string all;
        for (const Value& value : values) all.append(all.empty() ? "" : ",").append(text(value));
        return all;
    }

    void addField(std::string_view /*name*/, std::span<const float> values) { floats = values; }
    template <typename Value>
    void addField(std::string_view name, const Value& value) {
        if constexpr (requires { text(value); }) add(out, name, text(value));
    }
};

}  // namespace

std::string figuresOf(const Sensor& sensor) {
    std::string out;
    LineFields{out}.addAll({.sensor = sensor}, kInInfo);
    if (sensor.mount) addMount(out, sensor.mount->robot_from_sensor);
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
    constexpr float kMaxMillimetres = 65535;
    std::string out;
    out.reserve(2 * depths.size());
    for (const float depth : depths) {
        const float rounded = std::round(depth * static_cast<float>(kMillimetres));
        const auto value = static_cast<unsigned>(rounded <= kMaxMillimetres ? rounded : 0);
        out += static_cast<char>(value & 0xffU);
        out += static_cast<char>(value >> 8U);
    }
    return out;
}

/// Formats readings as lines.
class ScanText {
  public:
    ScanText(const Sensor& sensor, const SensorReading& reading, const ReplyForm& form)
        : sensor_(sensor), reading_(reading), form_(form) {
        constexpr std::size_t kHead = 192;
        out_.reserve(kHead);
        out_.append("SCAN ").append(sensor.id);
        out_.append(" t=").append(formatMilliseconds(reading.time));
        out_.append(" seq=").append(std::to_string(reading.seq));
    }

    std::string take() {
        if (const auto* const photo = std::get_if<Photo>(&reading_.value))
            write(*photo);
        else if (const auto* const frame = std::get_if<DepthFrame>(&reading_.value))
            write(*frame);
        else
            writeFields();
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

    void writeFields() {
        LineFields fields{out_};
        fields.addAll(viewOf(sensor_, reading_), kInLine);
        markStream();
        if (sensor_.is<Laser>()) return writeRanges(fields.floats);
        out_ += '\n';
    }
    void writeRanges(std::span<const float> ranges) {
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
        const Camera& camera = sensor_.as<Camera>();
        const int columns = camera.columns, rows = camera.rows;
        if (form_.format == FrameFormat::Png)
            return writeFrame(columns, rows, pngOfRgb(columns, rows, photo.rgb));
        if (form_.format == FrameFormat::Jpeg)
            return writeFrame(columns, rows, jpegOfRgb(columns, rows, photo.rgb));
        writeFrame(columns, rows,
                   {reinterpret_cast<const char*>(photo.rgb.data()), photo.rgb.size()});
    }
    void write(const DepthFrame& frame) {
        const Ranger& ranger = sensor_.as<Ranger>();
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

    const Sensor& sensor_;
    const SensorReading& reading_;
    const ReplyForm& form_;
    std::string out_;
};

}  // namespace

std::string scanText(const Sensor& sensor, const SensorReading& reading, const ReplyForm& form) {
    return ScanText(sensor, reading, form).take();
}

}  // namespace ispace
