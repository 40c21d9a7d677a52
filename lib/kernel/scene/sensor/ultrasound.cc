// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/ultrasound.h"

#include "base/number.h"
#include "scene/sensor/field_of_view.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace {

Receiver withParameters(Receiver base, const Record& record) {
    Diagnostics findings;
    applyRange(record, base.min_range, base.max_range, findings);
    if (record.has("fov")) base.fov = record.angle("fov");
    if (record.has("rate")) base.rate = record.number("rate");
    applyNoise(record, base.noise, findings);
    findings.throwIfAny();
    return base;
}

Tag withParameters(Tag base, const Record& record) {
    if (record.has("rate")) base.rate = record.number("rate");
    if (record.has("fov")) base.fov = record.angle("fov");
    if (record.has("locate")) base.is_simple = record.text("locate") == "simple";
    if (record.has("sigma")) base.simple_sigma = record.number("sigma");
    return base;
}

bool Receiver::isOmnidirectional(const Pose3& mount) {
    const Frame3 frame(mount);
    return frame.forward.x == 0 && frame.forward.y == 0;
}

FieldOfView fieldOfView(const Receiver& receiver, const Pose3& pose) {
    return FieldOfView::cone(pose, 0.5 * receiver.fov, receiver.max_range);
}

namespace {

void addUltrasoundKeys(std::vector<KeySpec>& keys) {
    keys.push_back(rangeKey("least and greatest distance heard, or the greatest alone"));
    keys.push_back(
        positiveKey("fov", Unit::Angle, "full angle of the cone in which it hears", 360));
    keys.push_back(positiveKey("rate", Unit::Frequency, "measurements a second", kMaxRate));
    addNoiseKeys(keys);
}

void addTagKeys(std::vector<KeySpec>& keys) {
    keys.push_back(positiveKey("rate", Unit::Frequency, "bursts a second", kMaxRate));
    keys.push_back(
        positiveKey("fov", Unit::Angle, "full angle of the cone into which it emits", 360));
    keys.push_back({.name = "locate",
                    .type = KeyType::Choice,
                    .help = "by times of flight to receivers, or simply where it is, give or take",
                    .choices = {"flight", "simple"}});
    keys.push_back({.name = "sigma",
                    .type = KeyType::Number,
                    .unit = Unit::Length,
                    .help = "of locate=simple: standard deviation of x and of y, with scan --noise",
                    .lower = 0,
                    .upper = 1e3});
}

Mesh coneOf(const Receiver& receiver, ViewLimits limits) {
    Mesh mesh{Material::View, {}, {}, true};
    const Angle half = 0.5 * receiver.fov, turn = Angle::degrees(360);
    const auto at = [&](Angle off, Angle around, double range) {
        const auto [c, s] = cosSin(off);
        const auto [ca, sa] = cosSin(around);
        return range * Vec3{c, s * ca, s * sa};
    };
    const int around = piecesOf(turn);
    if (half < Angle::degrees(180))
        addSheet(mesh, around, 1, [&](double u, double v) {
            return at(half, u * turn, limits.near + v * (limits.far - limits.near));
        });
    addSheet(mesh, around, piecesOf(half),
             [&](double u, double v) { return at(v * half, u * turn, limits.far); });
    return mesh;
}

Mesh receiverView(const Sensor& sensor, double reach) {
    const Receiver& receiver = sensor.as<Receiver>();
    return coneOf(receiver, viewLimits(receiver.min_range, receiver.max_range, reach));
}

std::vector<Mesh> receiverBody() {
    Mesh housing{Material::Sensor, {}, {}}, front{Material::Metal, {}, {}};
    addDisc(housing, {-0.03, 0, 0}, 0.03, 0.025);
    addDisc(front, {-0.005, 0, 0}, 0.024, 0.005);
    return {std::move(housing), std::move(front)};
}

std::vector<Mesh> tagBody() {
    Mesh ball{Material::Sensor, {}, {}};
    addBall(ball, {}, 0.025);
    return {std::move(ball)};
}

}  // namespace

const SensorKind Receiver::kKind = {
    .keyword = "ultrasound",
    .noun = "receiver",
    .help = "ultrasonic receiver; bare: range=8 fov=120",
    .heading_help = "direction of its axis, from +x",
    .device_help = "an ultrasonic receiver one can buy",
    .sign = SensorSign::Triangle,
    .add_keys = addUltrasoundKeys,
    .body = receiverBody,
    .read = readModel<Receiver>,
    .summary = [](const SensorModel& model) -> DeviceSummary {
        const Receiver& receiver = std::get<Receiver>(model);
        return {rangeText(receiver.min_range, receiver.max_range), degreesText(receiver.fov), "-",
                formatDouble(receiver.rate)};
    },
    .view = receiverView,
    .bearings = [](const SensorModel& model) -> BearingSpan {
        const Receiver& receiver = std::get<Receiver>(model);
        return {-0.5 * receiver.fov, 0.5 * receiver.fov, receiver.max_range};
    },
    .field_of_view = fieldOfViewOf<Receiver>,
    .stopped_by = Surfaces::Solid,
    .is_read = true,
    .is_arranged = true,
    .together = kMinReceivers,
    .sight_errors = [](const SensorModel& model, double range) -> SightErrors {
        return {distanceSigma(std::get<Receiver>(model).noise, range), 0};
    }};

const SensorKind Tag::kKind = {.keyword = "tag",
                               .noun = "tag",
                               .help = "ultrasonic emitter, to be located",
                               .heading_help = "where it faces, from +x",
                               .device_help = "an ultrasonic emitter one can buy",
                               .sign = SensorSign::Diamond,
                               .add_keys = addTagKeys,
                               .body = tagBody,
                               .read = readModel<Tag>,
                               .summary = [](const SensorModel& model) -> DeviceSummary {
                                   const Tag& tag = std::get<Tag>(model);
                                   return {"-", degreesText(tag.fov), "-", formatDouble(tag.rate)};
                               },
                               .stopped_by = Surfaces::Solid,
                               .perceives = false,
                               .is_read = true};

}  // namespace ispace
