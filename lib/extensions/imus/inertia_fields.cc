// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of inertial measurement units.
#include "extensions/imus/inertia.h"
#include "sense/formats/field_values.h"

namespace ispace::imus {

namespace {

using namespace fields;

template <Vec3 Inertia::*kVector>
FieldValue axesOf(const View& reading) {
    const Vec3 v = reading.as<Inertia>().*kVector;
    return std::vector<Measured>{{v.x}, {v.y}, {v.z}};
}

FieldValue ratesAsAngles(const View& reading) {
    const Vec3 v = reading.as<Inertia>().rates;
    return std::vector{Angle::radians(v.x), Angle::radians(v.y), Angle::radians(v.z)};
}

template <double Vec3::*kAxis>
FieldValue degreesAbout(const View& reading) {
    return Measured{Angle::radians(reading.as<Inertia>().rates.*kAxis).degrees()};
}

template <double Vec3::*kAxis>
FieldValue accelerationAlong(const View& reading) {
    return Measured{reading.as<Inertia>().accelerations.*kAxis};
}

template <Vec3 Inertia::*kVector>
FieldValue rowOf(const View& reading) {
    const Vec3 v = reading.as<Inertia>().*kVector;
    return std::vector<double>{v.x, v.y, v.z};
}

std::vector<std::uint64_t> threeAxes(const View& /*reading*/) { return {3}; }

constexpr ReadingField kImuFields[] = {
    {"gyro_bias", kInInfo, [](const View& r) { return fieldOf(r.sensor.as<Imu>().gyro.bias); }},
    {"gyro_noise", kInInfo, [](const View& r) { return fieldOf(r.sensor.as<Imu>().gyro.density); }},
    {"accel_bias", kInInfo, [](const View& r) { return fieldOf(r.sensor.as<Imu>().accel.bias); }},
    {"accel_noise", kInInfo,
     [](const View& r) { return fieldOf(r.sensor.as<Imu>().accel.density); }},
    {"rate", kInInfo, figure<Imu, &Imu::rate>},
    {"rates", kInJson, axesOf<&Inertia::rates>},
    {"rates", kInLine, ratesAsAngles},
    {"accelerations", kInJson | kInLine, axesOf<&Inertia::accelerations>},
    {"rate_x_deg", kInColumn, degreesAbout<&Vec3::x>},
    {"rate_y_deg", kInColumn, degreesAbout<&Vec3::y>},
    {"rate_z_deg", kInColumn, degreesAbout<&Vec3::z>},
    {"accel_x", kInColumn, accelerationAlong<&Vec3::x>},
    {"accel_y", kInColumn, accelerationAlong<&Vec3::y>},
    {"accel_z", kInColumn, accelerationAlong<&Vec3::z>},
    {"rates", kInArray, rowOf<&Inertia::rates>, kFloat64, threeAxes},
    {"accelerations", kInArray, rowOf<&Inertia::accelerations>, kFloat64, threeAxes}};

constexpr RosTopic kImuTopics[] = {
    {RosType::Imu, "imu", RosFrame::Sensor, [](const RosHeader& header, const View& r) {
         const auto& inertia = r.as<Inertia>();
         return imuMessage(header, inertia.rates, inertia.accelerations);
     }}};

}  // namespace

const ReadingKind Inertia::kKind = {.fields = kImuFields, .topics = kImuTopics};

}  // namespace ispace::imus
