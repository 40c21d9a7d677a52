// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/sensor.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <type_traits>

#include "env/environment.h"
#include "geom/rotation.h"
#include "scene/bodies.h"
#include "scene/sensor/sensor_keys.h"
#include "scene/thing_kind.h"

namespace ispace {

const std::string& deviceName(const SensorModel& model) {
    return std::visit([](const auto& one) -> const std::string& { return one.model; }, model);
}

double maxRange(const SensorModel& model) {
    return std::visit([](const auto& one) { return one.max_range; }, model);
}

double readingRate(const SensorModel& model) {
    return std::visit([](const auto& one) { return one.readingRate(); }, model);
}

double readingTime(const SensorModel& model) {
    return std::visit([](const auto& one) { return one.readingTime(); }, model);
}

std::size_t rayCount(const SensorModel& model) {
    return std::visit([](const auto& one) { return one.rays(); }, model);
}

bool isNoisy(const SensorModel& model) {
    return std::visit([](const auto& one) { return one.isNoisy(); }, model);
}

bool isOmnidirectional(const SensorModel& model, const Pose3& mount) {
    return std::visit([&](const auto& one) { return one.isOmnidirectional(mount); }, model);
}

std::optional<FieldOfView> fieldOfView(const Sensor& sensor) {
    const auto view_of = kindOf(sensor.model).field_of_view;
    if (view_of == nullptr) return std::nullopt;
    FieldOfView view = view_of(sensor);
    if (const auto* const added = std::get_if<AddedSensor>(&sensor.model))
        view.max_range = std::min(view.max_range, added->max_range);
    return view;
}

Pose3 poseOf(const Record& record) {
    const bool placed = record.has("at");
    const Tuple at = placed ? record.tuple("at") : Tuple{0, 0};
    return {{at[0], at[1], at.size() > 2 ? at[2] : kScanHeight},
            record.angle("heading"),
            record.angle("tilt"),
            record.angle("roll")};
}

Pose3 poseOnPerson(const Record& sensor, const Record& person) {
    constexpr double kEyes = 0.94;  // as a share of the person
    Pose3 pose = poseOf(sensor);
    const bool has_height = sensor.has("at") && sensor.tuple("at").size() > 2;
    if (!has_height) pose.position.z = kEyes * person.number("height");
    if (const auto figure = figureOf(person)) pose.position = figure->carried(pose.position);
    return pose;
}

Pose3 poseOnJoint(const Pose3& world_from_carrier, const Pose3& carrier_from_sensor) {
    const Eigen::Vector3d place =
        isometryOf(world_from_carrier) * vectorOf(carrier_from_sensor.position - Point3());
    const Point3 at = Point3() + vecOf(place);
    if (world_from_carrier.isLevel())
        return {at, wrapped(world_from_carrier.heading + carrier_from_sensor.heading) + Angle(),
                carrier_from_sensor.tilt, carrier_from_sensor.roll};
    return poseOf(at, quaternionOf(world_from_carrier) * quaternionOf(carrier_from_sensor));
}

Pose3 mountedPose(const Pose2& world_from_robot, const Pose3& robot_from_sensor) {
    const Point2 place = world_from_robot * robot_from_sensor.position.onFloor();
    // Adding 0 makes -0 plain 0.
    const Angle heading = wrapped(world_from_robot.heading + robot_from_sensor.heading) + Angle();
    return {{place.x, place.y, robot_from_sensor.position.z},
            heading,
            robot_from_sensor.tilt,
            robot_from_sensor.roll};
}

namespace {

/// The rows of the kinds, sorted as the alternatives of SensorModel.
template <typename Models>
struct Rows;
template <typename... Models>
struct Rows<std::variant<Models...>> {
    static constexpr std::array<const SensorKind*, sizeof...(Models)> kAll{&Models::kKind...};
    static constexpr std::size_t kOnFloor = (0U + ... + std::is_base_of_v<FloorSensor, Models>);
};
constexpr auto kRows = Rows<SensorModel>::kAll;

Schema schemaOf(const SensorKind& kind) {
    Schema schema{.keyword = std::string(kind.keyword),
                  .type = RecordType::Placement,
                  .help = std::string(kind.help),
                  .keys = {}};
    schema.keys.push_back(idKey());
    schema.keys.push_back(modelKey());
    addSensorPose(schema.keys, std::string(kind.heading_help));
    kind.add_keys(schema.keys);
    schema.keys.push_back(onKey());
    schema.keys.push_back(costKey());
    return schema;
}

std::vector<const SensorKind*>& kinds() {
    constexpr std::size_t kBehind = Rows<SensorModel>::kOnFloor + 1;  // and AddedSensor
    static std::vector<const SensorKind*> all(kRows.begin(), kRows.end() - kBehind);
    return all;
}

}  // namespace

const SensorKind AddedSensor::kKind = {.keyword = "", .noun = "sensor", .perceives = false};

std::span<const SensorKind* const> sensorKinds() { return kinds(); }

void addSensorKind(const SensorKind& kind) {
    assert(!kind.is_read || (kind.measure != nullptr && kind.reading != nullptr));
    if (sensorKind(kind.keyword) != nullptr) return;
    kinds().push_back(&kind);
}

const SensorKind* sensorKind(std::string_view keyword) {
    const auto kinds = sensorKinds();
    const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const SensorKind* kind) {
        return kind->keyword == keyword;
    });
    return found == kinds.end() ? nullptr : *found;
}

const SensorKind& kindOf(const SensorModel& model) {
    const auto* const added = std::get_if<AddedSensor>(&model);
    return added != nullptr ? added->kind() : *kRows[model.index()];
}

std::size_t kindRank(const SensorModel& model) {
    const auto known = sensorKinds();
    const auto found = std::find(known.begin(), known.end(), &kindOf(model));
    // Those on the floor are last.
    return found == known.end() ? known.size() + model.index()
                                : static_cast<std::size_t>(found - known.begin());
}

std::vector<std::string_view> keywordsOf(bool SensorKind::*flag) {
    std::vector<std::string_view> keywords;
    for (const SensorKind* kind : sensorKinds())
        if (kind->*flag) keywords.push_back(kind->keyword);
    return keywords;
}

std::vector<std::string> manualKeywords(bool (*is_meant)(const SensorKind& kind)) {
    std::vector<std::string> keywords;
    for (const SensorKind* kind : sensorKinds())
        if (is_meant(*kind)) keywords.emplace_back(kind->keyword);
    return keywords;
}

std::vector<Schema> sensorSchemas() {
    std::vector<Schema> schemas;
    schemas.reserve(sensorKinds().size());
    for (const SensorKind* kind : sensorKinds()) schemas.push_back(schemaOf(*kind));
    return schemas;
}

std::vector<Schema> sensorDeviceSchemas() {
    std::vector<Schema> schemas;
    for (const SensorKind* kind : sensorKinds())
        if (!kind->device_help.empty())
            schemas.push_back(deviceSchema(std::string(kind->keyword),
                                           std::string(kind->device_help), kind->add_keys));
    return schemas;
}

Schema deviceSchema(std::string keyword, std::string help,
                    void (*add_keys)(std::vector<KeySpec>&)) {
    Schema schema{.keyword = std::move(keyword),
                  .type = RecordType::Placement,
                  .help = std::move(help),
                  .keys = {}};
    schema.keys.push_back(idKey());
    schema.keys.push_back({.name = "model",
                           .type = KeyType::Word,
                           .help = "what " + schema.keyword + " records call it",
                           .required = true});
    schema.keys.push_back({.name = "name", .type = KeyType::Text, .help = "maker and type"});
    add_keys(schema.keys);
    schema.keys.push_back({.name = "source",
                           .type = KeyType::Text,
                           .help = "public documents the parameters come from",
                           .required = true});
    schema.keys.push_back({.name = "confidence",
                           .type = KeyType::Choice,
                           .help = "A maker's document, B second source, U unsure",
                           .choices = {"A", "B", "U"},
                           .required = true});
    return schema;
}

}  // namespace ispace
