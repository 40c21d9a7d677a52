// SPDX-License-Identifier: GPL-3.0-or-later
// LAS 1.4 and 1.3 (American Society for Photogrammetry and Remote Sensing, LAS Specification 1.4,
// 2011), point format 1. Coordinates are whole tenths of a millimetre, up to 214 748 m from the
// origin; the point source is the number of the sensor from 1, and a text record maps numbers to
// ids. Points wait in a Spool for the header, which holds their number and bounds; memory does not
// grow with them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "base/number.h"
#include "base/numpy_file.h"
#include "sense/formats/reading_format.h"

namespace ispace {

namespace {

/// Metres of one unit of a coordinate.
constexpr double kScale = 0.0001;
constexpr std::size_t kPointBytes = 28;  // of point format 1
constexpr std::size_t kTextBytes = 32;   // of names in heads

/// A text of fixed length, filled with zeros.
void appendFixed(std::string& out, std::string_view text, std::size_t bytes) {
    out.append(text.substr(0, bytes)).append(bytes - std::min(bytes, text.size()), '\0');
}

/// Returns text records that map numbers to sensors.
std::vector<std::string> sensorTexts(const Sensors& sensors) {
    constexpr std::size_t kMaxSize = std::numeric_limits<std::uint16_t>::max();
    std::vector<std::string> texts(1);
    for (std::size_t i = 0; i < sensors.read.size(); ++i) {
        const std::string line = std::to_string(i + 1) + " " + sensors.read[i].id + "\n";
        if (line.size() > kMaxSize) continue;
        if (texts.back().size() + line.size() > kMaxSize) texts.emplace_back();
        texts.back() += line;
    }
    return texts;
}

constexpr int kOldMinor = 3;  // LAS 1.3

/// Writes LAS 1.4 or 1.3, point format 1. Its header holds the number of points and their bounds,
/// so points wait for the last one.
class LasStream final : public ReadingStream {
  public:
    LasStream(ByteSink write, const Sensors& sensors, int minor)
        : write_(std::move(write)), sensors_(sensors), minor_(minor) {}

    void write(std::string_view appended) override {
        for (std::size_t at = 0; at < appended.size(); at += kPointBytes)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                std::int32_t value = 0;
                std::memcpy(&value, appended.data() + at + axis * sizeof(value), sizeof(value));
                low_[axis] = std::min(low_[axis], value);
                high_[axis] = std::max(high_[axis], value);
            }
        points_.append(appended);
    }

    void finish() override {
        const std::uint64_t count = points_.size() / kPointBytes;
        if (minor_ == kOldMinor && count > std::numeric_limits<std::uint32_t>::max())
            throw FormatError({"", 0, 0,
                               "LAS 1.3 counts points to 4294967295, and there are " +
                                   std::to_string(count) + ": take --las-version 1.4"});
        write_(head());
        points_.copyTo(write_);
    }

  private:
    [[nodiscard]] std::string head() const {
        constexpr std::uint16_t kOldHead = 235, kNewHead = 375;
        const bool is_old = minor_ == kOldMinor;
        const std::uint16_t size = is_old ? kOldHead : kNewHead;
        std::string records;
        const std::vector<std::string> texts = sensorTexts(sensors_);
        for (const std::string& text : texts) {
            constexpr std::uint16_t kTextArea = 3;
            appendLittle(records, std::uint16_t{0});
            appendFixed(records, "LASF_Spec", kTextBytes / 2);
            appendLittle(records, kTextArea);
            appendLittle(records, static_cast<std::uint16_t>(text.size()));
            appendFixed(records, "sensors by point source id", kTextBytes);
            records += text;
        }
        const std::uint64_t count = points_.size() / kPointBytes;
        const bool is_few = count <= std::numeric_limits<std::uint32_t>::max();
        const auto few = static_cast<std::uint32_t>(is_few ? count : 0);

        std::string out = "LASF";
        appendLittle(out, std::uint32_t{0});  // source unknown; GPS times are seconds
        out.append(16, '\0');                 // project unset
        out.append(is_old ? "\1\3" : "\1\4");
        appendFixed(out, "simulation", kTextBytes);
        appendFixed(out, "ispace", kTextBytes);
        appendLittle(out, std::uint32_t{0});  // date unset, so that bytes do not depend on it
        appendLittle(out, size);
        appendLittle(out, static_cast<std::uint32_t>(size + records.size()));
        appendLittle(out, static_cast<std::uint32_t>(texts.size()));
        appendLittle(out, std::uint8_t{1});  // point format
        appendLittle(out, static_cast<std::uint16_t>(kPointBytes));
        appendLittle(out, few);
        for (const std::uint32_t of_return : {few, 0U, 0U, 0U, 0U}) appendLittle(out, of_return);
        for (const double scale : {kScale, kScale, kScale, 0.0, 0.0, 0.0}) appendLittle(out, scale);
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const std::int32_t value : {high_[axis], low_[axis]})
                appendLittle(out, count == 0 ? 0.0 : kScale * value);
        appendLittle(out, std::uint64_t{0});  // no waveforms
        if (is_old) return out + records;
        appendLittle(out, std::uint64_t{0});  // no extended records
        appendLittle(out, std::uint32_t{0});
        appendLittle(out, count);
        constexpr int kReturns = 15;
        for (int i = 0; i < kReturns; ++i) appendLittle(out, i == 0 ? count : std::uint64_t{0});
        return out + records;
    }

    ByteSink write_;
    const Sensors& sensors_;
    int minor_;
    Spool points_;
    std::array<std::int32_t, 3> low_ = all(std::numeric_limits<std::int32_t>::max()),
                                high_ = all(std::numeric_limits<std::int32_t>::min());
    static constexpr std::array<std::int32_t, 3> all(std::int32_t value) {
        return {value, value, value};
    }
};

class Las final : public FormatBase {
  public:
    Las(const Sensors& sensors, FormatOptions options)
        : FormatBase(sensors, std::move(options), ".las") {
        accept("las", "points", hasRanges);
        if (options_.coordinates == Coordinates::Sensor)
            throw UsageError(
                "las holds the points of all sensors in the world's frame: leave "
                "--coordinates out, or take pcd or ply");
        if (sensors.read.size() > std::numeric_limits<std::uint16_t>::max())
            throw UsageError("las tells 65535 sensors apart, and there are " +
                             std::to_string(sensors.read.size()) +
                             "; choose sensors with --select");
    }
    void append(std::string& out, std::size_t index, const Reading& reading) const override {
        const PointCloud cloud = points(index, reading, Coordinates::World);
        out.reserve(out.size() + kPointBytes * cloud.size());
        const auto delay = readingKind(sensor(index).model).delay;
        const std::vector<ReadingView> views = viewsOf(sensor(index), reading);
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            if (std::isnan(cloud.xyz[3 * i])) continue;
            const std::size_t part = i * views.size() / cloud.size();
            const std::size_t element = i - part * (cloud.size() / views.size());
            appendPoint(out, index, &cloud.xyz[3 * i],
                        views[part].time + (delay == nullptr ? 0 : delay(sensor(index), element)));
        }
    }
    [[nodiscard]] std::unique_ptr<ReadingStream> stream(ByteSink write) const override {
        return std::make_unique<LasStream>(std::move(write), sensors_, options_.las_minor);
    }
    [[nodiscard]] bool isPlain() const override { return false; }
    [[nodiscard]] bool isBinary() const override { return true; }

  private:
    void appendPoint(std::string& out, std::size_t index, const float* place, double time) const {
        for (int axis = 0; axis < 3; ++axis) {
            const double units = std::round(static_cast<double>(place[axis]) / kScale);
            if (std::abs(units) > std::numeric_limits<std::int32_t>::max())
                throw FormatError({"", 0, 0,
                                   "a point of " + sensor(index).id + " lies " +
                                       formatDouble(std::abs(static_cast<double>(place[axis]))) +
                                       " m from the origin, and las ends at 214748 m"});
            appendLittle(out, static_cast<std::int32_t>(units));
        }
        constexpr std::uint8_t kOnlyReturn = 1U | 1U << 3U;
        appendLittle(out, std::uint16_t{0});  // no intensity
        appendLittle(out, kOnlyReturn);
        appendLittle(out, std::uint8_t{0});   // unclassified
        appendLittle(out, std::uint16_t{0});  // no scan angle, no user data
        appendLittle(out, static_cast<std::uint16_t>(index + 1));
        appendLittle(out, time);
    }
};

}  // namespace

std::unique_ptr<ReadingFormat> makeLas(const Sensors& sensors, FormatOptions options) {
    return std::make_unique<Las>(sensors, std::move(options));
}

}  // namespace ispace
