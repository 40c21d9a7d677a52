// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of radars.
#include <cmath>

#include "extensions/radars/radar_frame.h"
#include "sense/formats/field_values.h"

namespace ispace::radars {

namespace {

using namespace fields;

const Radar& radarOf(const View& reading) { return reading.sensor.as<Radar>(); }
const std::vector<Detection>& detectionsOf(const View& reading) {
    return reading.as<RadarFrame>().detections;
}

Vec3 placeOf(const Detection& one) {
    const auto [cb, sb] = cosSin(one.bearing);
    const auto [ce, se] = cosSin(one.elevation);
    return one.range * Vec3{cb * ce, sb * ce, se};
}

PointCloud cloudOf(const RadarFrame& frame, const Pose3& pose, Coordinates in) {
    PointCloud cloud;
    cloud.width = frame.detections.size();
    if (in == Coordinates::Sensor) cloud.viewpoint = pose;
    const Frame3 axes(pose);
    for (const Detection& one : frame.detections) {
        const Vec3 local = placeOf(one);
        const Point3 at = in == Coordinates::Sensor ? Point3{} + local : axes.origin + axes * local;
        for (const double part : {at.x, at.y, at.z}) cloud.xyz.push_back(static_cast<float>(part));
    }
    return cloud;
}

double rangeOf(const Detection& one) { return one.range; }
double bearingOf(const Detection& one) { return one.bearing.degrees(); }
double elevationOf(const Detection& one) { return one.elevation.degrees(); }
double speedOf(const Detection& one) { return one.speed; }

/// Lists a number of each detection.
template <double (*kNumber)(const Detection&)>
FieldValue measuredNumbers(const View& reading) {
    std::vector<Measured> numbers;
    for (const Detection& one : detectionsOf(reading)) numbers.push_back({kNumber(one)});
    return numbers;
}
template <double (*kNumber)(const Detection&)>
FieldValue floatsOf(const View& reading) {
    std::vector<float> numbers;
    for (const Detection& one : detectionsOf(reading))
        numbers.push_back(static_cast<float>(kNumber(one)));
    return numbers;
}

FieldValue wholeDetections(const View& reading) {
    std::vector<FieldRecord> all;
    for (const Detection& one : detectionsOf(reading))
        all.push_back({{{"range", Measured{one.range}},
                        {"bearing", Measured{one.bearing.radians()}},
                        {"elevation", Measured{one.elevation.radians()}},
                        {"speed", Measured{one.speed}}}});
    return all;
}

/// Rows of range, bearing, elevation and speed; NaN after the last detection.
FieldValue rowsOfDetections(const View& reading) {
    const auto count = static_cast<std::size_t>(radarOf(reading).detections);
    std::vector<float> rows;
    for (const Detection& one : detectionsOf(reading))
        for (const double part :
             {one.range, one.bearing.radians(), one.elevation.radians(), one.speed})
            rows.push_back(static_cast<float>(part));
    rows.resize(4 * count, std::numeric_limits<float>::quiet_NaN());
    return rows;
}

/// Lists x and y of each detection in the room, in millimetres.
FieldValue pagePoints(const View& reading) {
    std::vector<std::int64_t> points;
    const Frame3 axes(reading.pose);
    for (const Detection& one : detectionsOf(reading)) {
        const Point3 at = axes.origin + axes * placeOf(one);
        points.push_back(std::llround(at.x * 1000));
        points.push_back(std::llround(at.y * 1000));
    }
    return points;
}

constexpr ReadingField kRadarFields[] = {
    {"range_min", kInJson | kInInfo, figure<Radar, &Radar::min_range>},
    {"range_max", kInJson | kInInfo, figure<Radar, &Radar::max_range>},
    {"fov", kInJson | kInInfo,
     [](const View& r) {
         return FieldValue(std::vector{radarOf(r).fov_x, radarOf(r).fov_y});
     }},
    {"min_speed", kInJson | kInInfo, figure<Radar, &Radar::min_speed>},
    {"max_speed", kInJson | kInInfo,
     [](const View& r) {
         return radarOf(r).max_speed > 0 ? FieldValue(radarOf(r).max_speed) : FieldValue();
     }},
    {"detections", kInInfo, figure<Radar, &Radar::detections>},
    {"rate", kInInfo, figure<Radar, &Radar::rate>},
    {"n", kInLine, [](const View& r) { return fieldOf(detectionsOf(r).size()); }},
    {"range", kInLine, measuredNumbers<rangeOf>},
    {"bearing", kInLine, measuredNumbers<bearingOf>},
    {"elevation", kInLine, measuredNumbers<elevationOf>},
    {"speed", kInLine, measuredNumbers<speedOf>},
    {"range", kInColumn, floatsOf<rangeOf>},
    {"bearing_deg", kInColumn, floatsOf<bearingOf>},
    {"elevation_deg", kInColumn, floatsOf<elevationOf>},
    {"speed", kInColumn, floatsOf<speedOf>},
    {"detections", kInJson, wholeDetections},
    {"detections", kInArray, rowsOfDetections, kFloat32,
     [](const View& r) {
         return std::vector<std::uint64_t>{static_cast<std::uint64_t>(radarOf(r).detections), 4};
     }},
    {"limits", kInFixed, limitsOf<Radar>},
    {"points", kInPage, pagePoints}};

std::string returnsMessage(const RosHeader& header, const View& reading) {
    std::vector<RosRadarReturn> returns;
    for (const Detection& one : detectionsOf(reading))
        returns.push_back({one.range, one.bearing, one.elevation, one.speed});
    return radarMessage(header, returns);
}

constexpr RosTopic kRadarTopics[] = {
    {RosType::PointCloud2, "points", RosFrame::Sensor,
     [](const RosHeader& header, const View& r) {
         const FieldValue speeds = floatsOf<speedOf>(r);
         const PointField velocity{"velocity", std::get<std::vector<float>>(speeds)};
         return pointCloudMessage(header, cloudOf(r.as<RadarFrame>(), r.pose, Coordinates::Sensor),
                                  std::span(&velocity, 1));
     }},
    {RosType::RadarScan, "returns", RosFrame::Sensor, returnsMessage}};

constexpr std::string_view kDetectionIndex[] = {"detection"};

}  // namespace

const ReadingKind RadarFrame::kKind = {
    .fields = kRadarFields,
    .topics = kRadarTopics,
    .indices = kDetectionIndex,
    .counts =
        [](const Sensor& sensor) {
            return std::vector{static_cast<std::size_t>(sensor.as<Radar>().detections)};
        },
    .varies = true,
    .points =
        [](const Sensor& /*sensor*/, const Reading& reading, Coordinates in) {
            const auto& frame = std::get<AddedReading>(reading);
            return cloudOf(frame.as<RadarFrame>(), frame.pose, in);
        }};

}  // namespace ispace::radars
