// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstring>
#include <limits>
#include <set>
#include <span>

#include "base/error.h"
#include "base/message.h"
#include "base/numpy_file.h"
#include "base/spool.h"
#include "sense/format_base.h"
#include "sense/reading_picture.h"

namespace ispace {

namespace {

constexpr std::string_view kFloat = "<f4", kDouble = "<f8", kByte = "|u1";
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// An array of a sensor that each reading adds a row to.
struct GrowingArray {
    std::string name;
    std::string_view type;
    std::vector<std::uint64_t> row;  ///< shape of what one reading adds

    [[nodiscard]] std::uint64_t rowBytes() const {
        std::uint64_t bytes = type == kFloat ? 4 : type == kDouble ? 8 : 1;
        for (const std::uint64_t side : row) bytes *= side;
        return bytes;
    }
    [[nodiscard]] std::string header(std::uint64_t rows) const {
        std::vector<std::uint64_t> shape{rows};
        shape.insert(shape.end(), row.begin(), row.end());
        return npyHeader(type, shape);
    }
};

std::uint64_t size(int count) { return static_cast<std::uint64_t>(count); }

/// What a sensor's readings add to, the measured values first.
std::vector<GrowingArray> arraysOf(const Sensor& sensor, const Sensors& sensors) {
    const std::uint64_t parts = 6;
    if (sensor.is<Laser>()) {
        const Laser& laser = sensor.as<Laser>();
        const std::uint64_t beams = size(laser.beams), scans = size(laser.scans());
        if (laser.sweep == SweepAxis::None)
            return {
                {"ranges", kFloat, {beams}}, {"times", kDouble, {}}, {"poses", kDouble, {parts}}};
        return {{"ranges", kFloat, {scans, beams}},
                {"times", kDouble, {scans}},
                {"poses", kDouble, {scans, parts}}};
    }
    std::vector<GrowingArray> arrays;
    if (sensor.is<Ranger>()) {
        const Ranger& ranger = sensor.as<Ranger>();
        arrays = {{"depths", kFloat, {size(ranger.rows), size(ranger.columns)}}};
    } else if (sensor.is<Camera>()) {
        const Camera& camera = sensor.as<Camera>();
        arrays = {{"rgb", kByte, {size(camera.rows), size(camera.columns), 3}}};
    } else {
        arrays = {{"ranges", kDouble, {sensors.receivers.size()}}, {"positions", kDouble, {3}}};
    }
    arrays.push_back({"times", kDouble, {}});
    arrays.push_back({"poses", kDouble, {parts}});
    return arrays;
}

/// An array that is the same for all readings.
struct FixedArray {
    std::string name, bytes;  ///< of the whole file
};

template <typename Number>
FixedArray fixedArray(const std::string& name, std::string_view type,
                      std::vector<std::uint64_t> shape, const std::vector<Number>& values) {
    std::string bytes = npyHeader(type, shape);
    for (const Number value : values) appendLittle(bytes, value);
    return {name, std::move(bytes)};
}

/// Texts of NumPy have equal lengths, four bytes a letter.
FixedArray textArray(const std::string& name, const std::vector<std::string>& texts) {
    std::vector<std::u32string> letters;
    std::size_t most = 1;
    for (const std::string& text : texts) {
        std::u32string& one = letters.emplace_back();
        for (std::size_t i = 0; i < text.size();) {
            const std::size_t known = utf8Length(std::string_view(text).substr(i));
            const std::size_t length = std::max<std::size_t>(known, 1);
            constexpr unsigned kFirst[] = {0, 0x7f, 0x1f, 0x0f, 0x07};
            char32_t letter = U'\ufffd';
            if (known > 0) letter = static_cast<unsigned char>(text[i]) & kFirst[length];
            for (std::size_t k = 1; k < length; ++k)
                letter = letter << 6U | (static_cast<unsigned char>(text[i + k]) & 0x3fU);
            one += letter;
            i += length;
        }
        most = std::max(most, one.size());
    }
    const std::vector<std::uint64_t> shape{texts.size()};
    std::string bytes = npyHeader("<U" + std::to_string(most), shape);
    for (std::u32string& one : letters) {
        one.resize(most);
        for (const char32_t letter : one) appendLittle(bytes, static_cast<std::uint32_t>(letter));
    }
    return {name, std::move(bytes)};
}

std::vector<FixedArray> fixedArraysOf(const Sensor& sensor, const Sensors& sensors) {
    if (sensor.is<Laser>()) {
        const Laser& laser = sensor.as<Laser>();
        std::vector<double> angles;
        angles.reserve(static_cast<std::size_t>(laser.beams));
        for (int k = 0; k < laser.beams; ++k) angles.push_back(laser.bearing(k).radians());
        return {fixedArray("angles", kDouble, {angles.size()}, angles),
                fixedArray("limits", kDouble, {2},
                           std::vector<double>{laser.min_range, laser.max_range})};
    }
    if (sensor.is<Ranger>()) {
        const Ranger& ranger = sensor.as<Ranger>();
        std::vector<float> rays;
        rays.reserve(3 * ranger.pixels());
        for (int row = 0; row < ranger.rows; ++row)
            for (int column = 0; column < ranger.columns; ++column) {
                const Vec3 ray = ranger.ray(column, row);
                for (const double part : {ray.x, ray.y, ray.z})
                    rays.push_back(static_cast<float>(part));
            }
        return {fixedArray("rays", kFloat, {size(ranger.rows), size(ranger.columns), 3}, rays),
                fixedArray("limits", kDouble, {2},
                           std::vector<double>{ranger.min_range, ranger.max_range})};
    }
    if (sensor.is<Camera>()) {
        const Camera& camera = sensor.as<Camera>();
        const auto [model, coefficients] = lensModelOf(camera);
        std::vector<FixedArray> arrays{
            fixedArray(
                "matrix", kDouble, {3, 3},
                std::vector<double>{camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1}),
            fixedArray("coefficients", kDouble, {coefficients.size()},
                       std::vector<double>(coefficients.begin(), coefficients.end())),
            textArray("model", {std::string(model)})};
        if (camera.lens == Lens::Mirror)
            arrays.push_back(fixedArray("xi", kDouble, {1}, std::vector<double>{camera.mirror}));
        return arrays;
    }
    std::vector<std::string> names;
    std::vector<double> places;
    for (const Sensor& receiver : sensors.receivers) {
        names.push_back(receiver.id);
        const Point3& at = receiver.pose.position;
        places.insert(places.end(), {at.x, at.y, at.z});
    }
    return {textArray("receivers", names),
            fixedArray("receiver_positions", kDouble, {names.size(), 3}, places)};
}

/// An id as a folder in an archive: one that stays within it, wherever it is unpacked.
std::string folderOf(const std::string& id) {
    std::string name = id.empty() ? "_" : id;
    for (char& c : name)
        if (c == '/' || c == '\\' || c == ':' || static_cast<unsigned char>(c) < ' ') c = '_';
    if (name.front() == '.') name.front() = '_';
    return name;
}

/// Rows of one array, as append() hands them to the stream: its number, its size, its bytes.
void appendRow(std::string& out, std::uint32_t array, std::string_view bytes) {
    appendLittle(out, array);
    appendLittle(out, static_cast<std::uint64_t>(bytes.size()));
    out += bytes;
}

template <typename Number>
std::string_view bytesOf(const std::vector<Number>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number)};
}

void appendNumbers(std::string& out, std::initializer_list<double> values) {
    for (const double value : values) appendLittle(out, value);
}

void appendPose(std::string& out, const Pose3& pose) {
    appendNumbers(out, {pose.position.x, pose.position.y, pose.position.z, pose.heading.radians(),
                        pose.tilt.radians(), pose.roll.radians()});
}

/// The rows of a reading, in the order of arraysOf().
struct RowsOf {
    const Sensors& sensors;

    std::vector<std::string> operator()(const std::vector<Scan>& scans) const {
        std::vector<std::string> rows(3);
        for (const Scan& scan : scans) {
            rows[0] += bytesOf(scan.ranges);
            appendLittle(rows[1], scan.time);
            appendPose(rows[2], scan.pose);
        }
        return rows;
    }
    std::vector<std::string> operator()(const DepthFrame& frame) const {
        return {std::string(bytesOf(frame.depths)), timeOf(frame), poseOf(frame)};
    }
    std::vector<std::string> operator()(const Photo& photo) const {
        return {std::string(bytesOf(photo.rgb)), timeOf(photo), poseOf(photo)};
    }
    std::vector<std::string> operator()(const Burst& burst) const {
        std::vector<double> ranges(sensors.receivers.size(), kUnknown);
        for (const TimeOfFlight& flight : burst.heard) ranges[flight.receiver] = flight.distance;
        std::string place;
        if (burst.fix) {
            const Point3& at = burst.fix->position;
            appendNumbers(place, {at.x, at.y, at.z});
        } else if (burst.simple) {
            appendNumbers(place, {burst.simple->x, burst.simple->y, kUnknown});
        } else {
            appendNumbers(place, {kUnknown, kUnknown, kUnknown});
        }
        return {std::string(bytesOf(ranges)), place, timeOf(burst), poseOf(burst)};
    }

  private:
    template <typename One>
    static std::string timeOf(const One& reading) {
        std::string out;
        appendLittle(out, reading.time);
        return out;
    }
    template <typename One>
    static std::string poseOf(const One& reading) {
        std::string out;
        appendPose(out, reading.pose);
        return out;
    }
};

/// Hands the rows in the results of append() to where their arrays are kept.
template <typename Take>
void forEachRow(std::string_view appended, Take take) {
    constexpr std::size_t kHead = sizeof(std::uint32_t) + sizeof(std::uint64_t);
    while (!appended.empty()) {
        std::uint32_t array = 0;
        std::uint64_t bytes = 0;
        std::memcpy(&array, appended.data(), sizeof(array));
        std::memcpy(&bytes, appended.data() + sizeof(array), sizeof(bytes));
        take(array, appended.substr(kHead, bytes));
        appended.remove_prefix(kHead + bytes);
    }
}

std::uint64_t rowsIn(const Spool& spool, const GrowingArray& array) {
    return array.rowBytes() == 0 ? 0 : spool.size() / array.rowBytes();
}

/// The arrays of all sensors.
struct Layout {
    std::vector<GrowingArray> growing;
    std::vector<std::uint32_t> first;  ///< of each sensor, in `growing`
    std::vector<FixedArray> fixed;
};

class NpzStream final : public ReadingStream {
  public:
    NpzStream(ByteSink write, const Layout& arrays)
        : zip_(std::move(write)), arrays_(arrays), rows_(arrays.growing.size()) {}
    void write(std::string_view appended) override {
        forEachRow(appended,
                   [this](std::uint32_t array, std::string_view row) { rows_[array].append(row); });
    }
    void finish() override {
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            const GrowingArray& array = arrays_.growing[i];
            const std::string header = array.header(rowsIn(rows_[i], array));
            zip_.begin(array.name + ".npy", header.size() + rows_[i].size(),
                       crcOfBoth(crcOf(header), rows_[i].crc(), rows_[i].size()));
            zip_.data(header);
            rows_[i].copyTo([this](std::string_view bytes) { zip_.data(bytes); });
        }
        for (const FixedArray& array : arrays_.fixed) zip_.add(array.name + ".npy", array.bytes);
        zip_.finish();
    }

  private:
    ZipWriter zip_;
    const Layout& arrays_;
    std::vector<Spool> rows_;
};

class NpyStream final : public ReadingStream {
  public:
    NpyStream(ByteSink write, const GrowingArray& array)
        : write_(std::move(write)), array_(array) {}
    void write(std::string_view appended) override {
        forEachRow(appended,
                   [this](std::uint32_t /*array*/, std::string_view row) { rows_.append(row); });
    }
    void finish() override {
        write_(array_.header(rowsIn(rows_, array_)));
        rows_.copyTo(write_);
    }

  private:
    ByteSink write_;
    const GrowingArray& array_;
    Spool rows_;
};

class Npz final : public FormatBase {
  public:
    Npz(const Sensors& sensors, FormatOptions options)
        : FormatBase(sensors, std::move(options), ".npz") {
        std::set<std::string> folders;
        for (const Sensor& one : sensors.read) {
            const std::string folder = folderOf(one.id);
            if (!folders.insert(folder).second)
                throw UsageError("npz: two sensors would have the arrays " + folder +
                                 "/…; choose sensors with --select, or give them other ids");
            arrays_.first.push_back(static_cast<std::uint32_t>(arrays_.growing.size()));
            for (GrowingArray& array : arraysOf(one, sensors)) {
                array.name.insert(0, folder + "/");
                arrays_.growing.push_back(std::move(array));
            }
            for (FixedArray& array : fixedArraysOf(one, sensors)) {
                array.name.insert(0, folder + "/");
                arrays_.fixed.push_back(std::move(array));
            }
        }
    }
    void append(std::string& out, std::size_t index, const Reading& reading) const override {
        std::uint32_t array = arrays_.first[index];
        for (const std::string& row : std::visit(RowsOf{sensors_}, reading))
            appendRow(out, array++, row);
    }
    [[nodiscard]] std::unique_ptr<ReadingStream> stream(ByteSink write) const override {
        return std::make_unique<NpzStream>(std::move(write), arrays_);
    }
    [[nodiscard]] bool isPlain() const override { return false; }
    [[nodiscard]] bool isBinary() const override { return true; }

  private:
    Layout arrays_;
};

class Npy final : public FormatBase {
  public:
    Npy(const Sensors& sensors, FormatOptions options)
        : FormatBase(sensors, std::move(options), ".npy") {
        accept("npy", "ranges, depths or pictures",
               [](const Sensor& one) { return hasRanges(one) || isCamera(one); });
        for (const Sensor& one : sensors.read) arrays_.push_back(arraysOf(one, sensors).front());
    }
    void checkStream() const override {
        if (sensors_.read.size() == 1) return;
        throw UsageError("npy is the array of one sensor, and there are " +
                         std::to_string(sensors_.read.size()) +
                         ": choose one with --select, take npz, or name a folder (-o DIR/)");
    }
    void append(std::string& out, std::size_t index, const Reading& reading) const override {
        appendRow(out, static_cast<std::uint32_t>(index),
                  std::visit(RowsOf{sensors_}, reading).front());
    }
    [[nodiscard]] std::string whole(std::size_t index, const Reading& reading) const override {
        return arrays_[index].header(1) + std::visit(RowsOf{sensors_}, reading).front();
    }
    [[nodiscard]] std::unique_ptr<ReadingStream> stream(ByteSink write) const override {
        return std::make_unique<NpyStream>(std::move(write), arrays_.front());
    }
    [[nodiscard]] bool isPlain() const override { return false; }
    [[nodiscard]] bool isBinary() const override { return true; }

  private:
    std::vector<GrowingArray> arrays_;
};

}  // namespace

std::unique_ptr<ReadingFormat> makeNpz(const Sensors& sensors, FormatOptions options) {
    return std::make_unique<Npz>(sensors, std::move(options));
}

std::unique_ptr<ReadingFormat> makeNpy(const Sensors& sensors, FormatOptions options) {
    return std::make_unique<Npy>(sensors, std::move(options));
}

}  // namespace ispace
