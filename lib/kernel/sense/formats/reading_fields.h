// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/sense/formats: the table of readings: the quantities that each kind of sensor
// measures, and their names. Formats, records, protocol and page read the table and do not depend
// on kinds.
//
// A field is a row: name, formats, and a function of the reading. Tables are constant and
// thread-safe; values are computed when a format asks.
//
//     for (const ReadingField& field : readingKind(sensor.model).fields)
//         if ((field.uses & kInJson) != 0) names.push_back(field.name);
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "sense/formats/ros_messages.h"
#include "sense/reading.h"

namespace ispace {

/// Pointers to the alternatives of a variant; std::monostate: none.
template <typename Variant>
struct PointersTo;
template <typename... Ones>
struct PointersTo<std::variant<Ones...>> {
    using Type = std::variant<std::monostate, const Ones*...>;
};

/// True for a value in the list, false for that of a kind which an extension adds.
template <typename One, typename Values = ReadingValue>
constexpr bool kIsListedReading = false;
template <typename One, typename... Values>
constexpr bool kIsListedReading<One, std::variant<Values...>> = (std::is_same_v<One, Values> ||
                                                                 ...);

/// A reading, or one scan of a sweep, with all inputs of its fields. Refers to its arguments.
struct ReadingView {
    using Value = PointersTo<ReadingValue>::Type;

    const Sensor& sensor;
    Value value = {};  ///< std::monostate: not measured yet, for fields of the sensor alone
    std::span<const Sensor> receivers = {};  ///< receivers of a tag's burst
    double time = 0;                         ///< seconds
    std::int64_t frame = 0;
    Pose3 pose = {};

    template <typename One>
    [[nodiscard]] const One& as() const {
        if constexpr (kIsListedReading<One>)
            return *std::get<const One*>(value);
        else
            return std::get<const AddedReading*>(value)->as<One>();
    }
};

template <typename One>
ReadingView viewOf(const Sensor& sensor, const One& one, std::span<const Sensor> receivers = {}) {
    return {sensor, &one, receivers, one.time, one.frame, one.pose};
}
/// Returns views of the scans of a sweep, or one view of another reading.
std::vector<ReadingView> viewsOf(const Sensor& sensor, const Reading& reading,
                                 std::span<const Sensor> receivers = {});

/// A measured number, which JSON rounds to 12 digits.
struct Measured {
    std::optional<double> value = {};  ///< empty: unknown
};
/// A computed number, with nine decimals in JSON.
struct Computed {
    double value = 0;
};
struct FieldRecord;
using FieldText = std::optional<std::string>;  ///< empty: unknown
/// std::monostate: this sensor or reading lacks the field. Floats are ranges, infinite without a
/// return. Spans belong to the reading.
using FieldValue =
    std::variant<std::monostate, bool, std::int64_t, double, Angle, Measured, Computed, FieldText,
                 std::vector<double>, std::vector<Angle>, std::vector<Measured>,
                 std::vector<std::int64_t>, std::vector<std::string>, std::vector<float>,
                 std::span<const float>, std::span<const std::uint8_t>, std::vector<FieldRecord>>;
/// Named values: of each receiver, of each tag.
struct FieldRecord {
    std::vector<std::pair<std::string_view, FieldValue>> values;
};

/// Formats that write a field, as bits.
enum FieldUse : unsigned {
    kInJson = 1,     ///< a line of JSON, of `scan` and of records; angles in radians
    kInColumn = 2,   ///< CSV: a value a row, or floats, one for each element
    kInArray = 4,    ///< NumPy: a row a reading
    kInFixed = 8,    ///< NumPy: an array of the sensor
    kIsFrame = 16,   ///< JSON writes a file name instead if the frame has a file
    kInInfo = 32,    ///< the protocol's description of the sensor; angles in degrees
    kInLine = 64,    ///< the protocol's line of a reading: floats last, or as bytes after it
    kInPage = 128,   ///< frames of the page, lengths in millimetres
    kIsState = 256,  ///< an event reports its changes
    kIsTotal = 512,  ///< a state that only grows: home automation sums it up
    kIsLevel = 1024  ///< a state that is a number, of which home automation keeps the course
};

struct ReadingField {
    std::string_view name;
    unsigned uses = 0;  ///< bits of FieldUse
    FieldValue (*value)(const ReadingView& reading) = nullptr;
    std::string_view type = {};  ///< of a NumPy row: "<f4", "<f8", "|u1"
    /// Of a NumPy row or array; null: the number of values.
    std::vector<std::uint64_t> (*shape)(const ReadingView& reading) = nullptr;
};

/// The ROS frame of a message.
enum class RosFrame { Sensor, Optical, World };

/// A ROS topic of a sensor.
struct RosTopic {
    RosType type;
    std::string_view name;
    RosFrame frame;
    /// Returns "" if this reading has no message. Null: one message with the points of all scans of
    /// a sweep.
    std::string (*message)(const RosHeader& header, const ReadingView& reading) = nullptr;
    bool (*is_sent)(const Sensor& sensor) = nullptr;  ///< null: always
};

/// Readings of one kind of sensor.
struct ReadingKind {
    std::span<const ReadingField> fields;
    std::span<const RosTopic> topics = {};
    /// Columns of CSV that count elements, the fastest first; empty: a row is a whole reading.
    std::span<const std::string_view> indices = {};
    /// Numbers of elements in the order of `indices`; null if that is empty.
    std::vector<std::size_t> (*counts)(const Sensor& sensor) = nullptr;
    /// The number of elements varies, up to counts(): formats of equal readings refuse the kind.
    bool varies = false;
    /// Returns a point for each element; null: the kind has no points.
    PointCloud (*points)(const Sensor& sensor, const Reading& reading, Coordinates in) = nullptr;
    /// Returns the number of scans of a sweep (0: a reading is one scan), and the index of this
    /// scan; null: readings have no parts.
    int (*parts)(const Sensor& sensor) = nullptr;
    int (*part)(const ReadingView& reading) = nullptr;
    /// Returns the seconds from a reading's time to an element, and the pose then; null:
    /// simultaneous.
    double (*delay)(const Sensor& sensor, std::size_t element) = nullptr;
    const Pose3& (*pose)(const ReadingView& reading, std::size_t element) = nullptr;
};

/// Returns the table's row of a sensor.
const ReadingKind& readingKind(const SensorModel& model);
/// Returns the number of parts of a sensor's reading; 0: it has no parts.
int partsOf(const Sensor& sensor);
bool isSwept(const Sensor& sensor);

}  // namespace ispace
