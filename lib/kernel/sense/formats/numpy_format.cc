// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstring>
#include <set>
#include <span>

#include "base/error.h"
#include "base/message.h"
#include "base/numpy_file.h"
#include "sense/formats/reading_format.h"

namespace ispace {

namespace {

constexpr std::string_view kFloat = "<f4", kDouble = "<f8";

/// An array to which each reading of a sensor adds a row.
struct GrowingArray {
    std::string name;
    std::string_view type;
    std::vector<std::uint64_t> row;  ///< shape of a row

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

/// Returns the arrays of a sensor's readings, the measured values first.
std::vector<GrowingArray> arraysOf(const Sensor& sensor, std::span<const Sensor> receivers) {
    const ReadingView view{.sensor = sensor, .receivers = receivers};
    constexpr std::uint64_t kPoseParts = 6;
    std::vector<GrowingArray> arrays;
    for (const ReadingField& field : readingKind(sensor.model).fields)
        if ((field.uses & kInArray) != 0)
            arrays.push_back({std::string(field.name), field.type, field.shape(view)});
    arrays.push_back({"times", kDouble, {}});
    arrays.push_back({"poses", kDouble, {kPoseParts}});
    if (isSwept(sensor))
        for (GrowingArray& array : arrays)
            array.row.insert(array.row.begin(), static_cast<std::uint64_t>(partsOf(sensor)));
    return arrays;
}

/// An array that is constant for all readings.
struct FixedArray {
    std::string name, bytes;  ///< bytes of the whole file
};

/// Writes texts as NumPy stores them: of equal lengths, four bytes a letter.
std::string textArray(const std::vector<std::string>& texts) {
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
    return bytes;
}

/// Returns the bytes of a field's numbers; "" for other fields.
struct NumberBytes {
    template <typename Number>
    std::string operator()(std::span<const Number> values) const {
        return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
    }
    std::string operator()(const std::vector<float>& values) const {
        return (*this)(std::span<const float>(values));
    }
    std::string operator()(const std::vector<double>& values) const {
        return (*this)(std::span<const double>(values));
    }
    std::string operator()(double value) const {
        return (*this)(std::span<const double>(&value, 1));
    }
    template <typename Value>
    std::string operator()(const Value& /*value*/) const {
        return {};
    }
};

/// Writes a whole file of an array with the field's value.
std::string fixedArray(const ReadingField& field, const ReadingView& view) {
    const FieldValue value = field.value(view);
    if (const auto* const text = std::get_if<FieldText>(&value)) return textArray({text->value()});
    if (const auto* const texts = std::get_if<std::vector<std::string>>(&value))
        return textArray(*texts);
    const std::string_view type = field.type.empty() ? kDouble : field.type;
    const std::string bytes = std::visit(NumberBytes(), value);
    const std::vector<std::uint64_t> shape =
        field.shape == nullptr ? std::vector<std::uint64_t>{bytes.size() / sizeof(double)}
                               : field.shape(view);
    return npyHeader(type, shape) + bytes;
}

std::vector<FixedArray> fixedArraysOf(const Sensor& sensor, std::span<const Sensor> receivers) {
    const ReadingView view{.sensor = sensor, .receivers = receivers};
    std::vector<FixedArray> arrays;
    for (const ReadingField& field : readingKind(sensor.model).fields)
        if ((field.uses & kInFixed) != 0 &&
            !std::holds_alternative<std::monostate>(field.value(view)))
            arrays.push_back({std::string(field.name), fixedArray(field, view)});
    return arrays;
}

/// Maps an id to a folder of an archive that stays within it when unpacked.
std::string folderOf(const std::string& id) {
    std::string name = id.empty() ? "_" : id;
    for (char& c : name)
        if (c == '/' || c == '\\' || c == ':' || static_cast<unsigned char>(c) < ' ') c = '_';
    if (name.front() == '.') name.front() = '_';
    return name;
}

/// Appends a row of one array, as append() passes it to the stream: its number, its size, its
/// bytes.
void appendRow(std::string& out, std::uint32_t array, std::string_view bytes) {
    appendLittle(out, array);
    appendLittle(out, static_cast<std::uint64_t>(bytes.size()));
    out += bytes;
}

/// Returns the rows of a reading, in the order of arraysOf().
std::vector<std::string> rowsOf(const Sensor& sensor, std::span<const Sensor> receivers,
                                const Reading& reading) {
    std::vector<std::string> rows;
    for (const ReadingView& view : viewsOf(sensor, reading, receivers)) {
        std::size_t row = 0;
        const auto append = [&](std::string_view bytes) {
            if (row == rows.size()) rows.emplace_back();
            rows[row++] += bytes;
        };
        for (const ReadingField& field : readingKind(sensor.model).fields)
            if ((field.uses & kInArray) != 0) append(std::visit(NumberBytes(), field.value(view)));
        append(NumberBytes()(view.time));
        const Pose3& pose = view.pose;
        append(NumberBytes()(std::vector<double>{pose.position.x, pose.position.y, pose.position.z,
                                                 pose.heading.radians(), pose.tilt.radians(),
                                                 pose.roll.radians()}));
    }
    return rows;
}

/// Passes the rows in the results of append() to their arrays.
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
struct ArrayTable {
    std::vector<GrowingArray> growing;
    std::vector<std::uint32_t> first;  ///< of each sensor, index in `growing`
    std::vector<FixedArray> fixed;
};

class NpzStream final : public ReadingStream {
  public:
    NpzStream(ByteSink write, const ArrayTable& arrays)
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
    const ArrayTable& arrays_;
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
        for (std::size_t i = 0; i < sensors.read.size(); ++i) {
            const Sensor& one = sensors.read[i];
            const std::string folder = folderOf(one.id);
            if (!folders.insert(folder).second)
                throw UsageError("npz: two sensors would have the arrays " + folder +
                                 "/…; choose sensors with --select, or give them other ids");
            arrays_.first.push_back(static_cast<std::uint32_t>(arrays_.growing.size()));
            for (GrowingArray& array : arraysOf(one, receivers(i))) {
                array.name.insert(0, folder + "/");
                arrays_.growing.push_back(std::move(array));
            }
            for (FixedArray& array : fixedArraysOf(one, receivers(i))) {
                array.name.insert(0, folder + "/");
                arrays_.fixed.push_back(std::move(array));
            }
        }
    }
    void append(std::string& out, std::size_t index, const Reading& reading) const override {
        std::uint32_t array = arrays_.first[index];
        for (const std::string& row : rowsOf(sensor(index), receivers(index), reading))
            appendRow(out, array++, row);
    }
    [[nodiscard]] std::unique_ptr<ReadingStream> stream(ByteSink write) const override {
        return std::make_unique<NpzStream>(std::move(write), arrays_);
    }
    [[nodiscard]] bool isPlain() const override { return false; }
    [[nodiscard]] bool isBinary() const override { return true; }

  private:
    ArrayTable arrays_;
};

class Npy final : public FormatBase {
  public:
    Npy(const Sensors& sensors, FormatOptions options)
        : FormatBase(sensors, std::move(options), ".npy") {
        accept("npy", "ranges, depths or pictures",
               [](const Sensor& one) { return hasRanges(one) || isCamera(one); });
        for (std::size_t i = 0; i < sensors.read.size(); ++i)
            arrays_.push_back(arraysOf(sensors.read[i], receivers(i)).front());
    }
    void checkStream() const override {
        if (sensors_.read.size() == 1) return;
        throw UsageError("npy is the array of one sensor, and there are " +
                         std::to_string(sensors_.read.size()) +
                         ": choose one with --select, take npz, or name a folder (-o DIR/)");
    }
    void append(std::string& out, std::size_t index, const Reading& reading) const override {
        appendRow(out, static_cast<std::uint32_t>(index),
                  rowsOf(sensor(index), receivers(index), reading).front());
    }
    [[nodiscard]] std::string whole(std::size_t index, const Reading& reading) const override {
        return arrays_[index].header(1) + rowsOf(sensor(index), receivers(index), reading).front();
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
