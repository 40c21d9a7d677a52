// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/reading_fields.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "base/message.h"
#include "raster/codec.h"
#include "sense/formats/point_cloud.h"
#include "sense/formats/reading_picture.h"

namespace ispace {

namespace {

using View = ReadingView;

constexpr std::string_view kFloat32 = "<f4", kFloat64 = "<f8", kByte8 = "|u1";
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

FieldValue fieldOf(double value) { return value; }
FieldValue fieldOf(Angle value) { return value; }
FieldValue fieldOf(int value) { return std::int64_t{value}; }
FieldValue fieldOf(std::size_t value) { return static_cast<std::int64_t>(value); }
FieldValue fieldOf(const char* value) { return FieldText(value); }
FieldValue fieldOf(const std::vector<float>& values) { return std::span(values); }
FieldValue fieldOf(const std::vector<std::uint8_t>& values) { return std::span(values); }

/// Reads a member of the model, or of the measured value.
template <typename Model, auto kMember>
FieldValue figure(const View& reading) {
    return fieldOf(std::invoke(kMember, reading.sensor.as<Model>()));
}
template <typename One, auto kMember>
FieldValue measured(const View& reading) {
    return fieldOf(std::invoke(kMember, reading.as<One>()));
}

template <typename Model>
FieldValue limitsOf(const View& reading) {
    const Model& model = reading.sensor.as<Model>();
    return std::vector<double>{model.min_range, model.max_range};
}

template <typename Model>
std::vector<std::uint64_t> sizeOf(const View& reading) {
    const Model& model = reading.sensor.as<Model>();
    return {static_cast<std::uint64_t>(model.rows), static_cast<std::uint64_t>(model.columns)};
}

template <typename Model>
std::vector<std::uint64_t> sizeTimesThree(const View& reading) {
    std::vector<std::uint64_t> shape = sizeOf<Model>(reading);
    shape.push_back(3);
    return shape;
}

// Lasers.

const Laser& laserOf(const View& reading) { return reading.sensor.as<Laser>(); }

FieldValue bearingsOf(const View& reading) {
    std::vector<float> bearings(reading.as<Scan>().ranges.size());
    for (std::size_t k = 0; k < bearings.size(); ++k)
        bearings[k] = static_cast<float>(laserOf(reading).bearing(static_cast<int>(k)).degrees());
    return bearings;
}

FieldValue anglesOf(const View& reading) {
    std::vector<double> angles(static_cast<std::size_t>(laserOf(reading).beams));
    for (std::size_t k = 0; k < angles.size(); ++k)
        angles[k] = laserOf(reading).bearing(static_cast<int>(k)).radians();
    return angles;
}

constexpr ReadingField kLaserFields[] = {
    {"angle_min", kInJson, figure<Laser, &Laser::first>},
    {"angle_max", kInJson, figure<Laser, &Laser::last>},
    {"angle_increment", kInJson, figure<Laser, &Laser::step>},
    {"range_min", kInJson, figure<Laser, &Laser::min_range>},
    {"range_max", kInJson, figure<Laser, &Laser::max_range>},
    {"bearing_deg", kInColumn, bearingsOf},
    {"range", kInColumn, measured<Scan, &Scan::ranges>},
    {"ranges", kInJson | kInArray, measured<Scan, &Scan::ranges>, kFloat32,
     [](const View& r) { return std::vector{static_cast<std::uint64_t>(laserOf(r).beams)}; }},
    {"angles", kInFixed, anglesOf},
    {"limits", kInFixed, limitsOf<Laser>}};

std::string scanMessage(const RosHeader& header, const View& reading) {
    const Laser& laser = laserOf(reading);
    const int last = laser.beams - 1;
    const double step = last > 0 ? (laser.timeOf(last) - laser.timeOf(0)) / last : 0;
    return laserScanMessage(header, laser, step, reading.as<Scan>().ranges);
}

constexpr RosTopic kLaserTopics[] = {
    {RosType::LaserScan, "scan", RosFrame::Sensor, scanMessage},
    {RosType::PointCloud2, "points", RosFrame::World, nullptr, isSwept}};

// Rangers.

const Ranger& rangerOf(const View& reading) { return reading.sensor.as<Ranger>(); }
bool isPinhole(const Sensor& sensor) {
    return sensor.as<Ranger>().projection == Projection::Pinhole;
}

template <auto kMember>
FieldValue ofPinhole(const View& reading) {
    return isPinhole(reading.sensor) ? FieldValue(Computed{std::invoke(kMember, rangerOf(reading))})
                                     : FieldValue();
}

FieldValue raysOfPixels(const View& reading) {
    const Ranger& ranger = rangerOf(reading);
    std::vector<float> rays;
    rays.reserve(3 * ranger.pixels());
    for (int row = 0; row < ranger.rows; ++row)
        for (int column = 0; column < ranger.columns; ++column) {
            const Vec3 ray = ranger.ray(column, row);
            for (const double part : {ray.x, ray.y, ray.z})
                rays.push_back(static_cast<float>(part));
        }
    return rays;
}

constexpr ReadingField kRangerFields[] = {
    {"width", kInJson, figure<Ranger, &Ranger::columns>},
    {"height", kInJson, figure<Ranger, &Ranger::rows>},
    {"projection", kInJson,
     [](const View& r) { return fieldOf(isPinhole(r.sensor) ? "pinhole" : "spherical"); }},
    {"fx", kInJson, ofPinhole<&Ranger::fx>},
    {"fy", kInJson, ofPinhole<&Ranger::fy>},
    {"cx", kInJson, ofPinhole<&Ranger::cx>},
    {"cy", kInJson, ofPinhole<&Ranger::cy>},
    {"fov", kInJson,
     [](const View& r) {
         return isPinhole(r.sensor) ? FieldValue()
                                    : FieldValue(std::vector{rangerOf(r).fov_x, rangerOf(r).fov_y});
     }},
    {"measures", kInJson,
     [](const View& r) { return fieldOf(rangerOf(r).measures_depth ? "depth" : "distance"); }},
    {"range_min", kInJson, figure<Ranger, &Ranger::min_range>},
    {"range_max", kInJson, figure<Ranger, &Ranger::max_range>},
    {"ambiguity", kInJson,
     [](const View& r) {
         return rangerOf(r).ambiguity > 0 ? FieldValue(rangerOf(r).ambiguity) : FieldValue();
     }},
    {"depth", kInColumn, measured<DepthFrame, &DepthFrame::depths>},
    {"depths", kInJson | kInArray | kIsFrame, measured<DepthFrame, &DepthFrame::depths>, kFloat32,
     sizeOf<Ranger>},
    {"rays", kInFixed, raysOfPixels, kFloat32, sizeTimesThree<Ranger>},
    {"limits", kInFixed, limitsOf<Ranger>}};

PointCloud cloudOfFrame(const View& reading) {
    return cloudOf(rangerOf(reading), reading.as<DepthFrame>(), Coordinates::Sensor);
}

constexpr RosTopic kRangerTopics[] = {
    {RosType::PointCloud2, "points", RosFrame::Sensor,
     [](const RosHeader& header, const View& r) {
         return pointCloudMessage(header, cloudOfFrame(r));
     }},
    {RosType::Image, "depth/image_rect", RosFrame::Optical,
     [](const RosHeader& header, const View& r) {
         return depthImageMessage(header, rangerOf(r), r.as<DepthFrame>().depths);
     },
     isPinhole},
    {RosType::CameraInfo, "depth/camera_info", RosFrame::Optical,
     [](const RosHeader& header, const View& r) { return cameraInfoMessage(header, rangerOf(r)); },
     isPinhole}};

// Cameras.

const Camera& cameraOf(const View& reading) { return reading.sensor.as<Camera>(); }
bool hasMirror(const Sensor& sensor) { return sensor.as<Camera>().lens == Lens::Mirror; }

template <auto kMember>
FieldValue ofLens(const View& reading) {
    return Computed{cameraOf(reading).*kMember};
}

FieldValue mirrorOf(const View& reading) {
    return hasMirror(reading.sensor) ? FieldValue(cameraOf(reading).mirror) : FieldValue();
}

FieldValue coefficientsOf(const View& reading) {
    const auto coefficients = lensModelOf(cameraOf(reading)).coefficients;
    return std::vector<double>(coefficients.begin(), coefficients.end());
}

FieldValue matrixOf(const View& reading) {
    const Camera& c = cameraOf(reading);
    return std::vector<double>{c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1};
}

std::string pngOfPhoto(const View& reading) {
    return pngOfRgb(cameraOf(reading).columns, cameraOf(reading).rows, reading.as<Photo>().rgb);
}

constexpr ReadingField kCameraFields[] = {
    {"width", kInJson, figure<Camera, &Camera::columns>},
    {"height", kInJson, figure<Camera, &Camera::rows>},
    {"projection", kInJson,
     [](const View& r) {
         const Lens lens = cameraOf(r).lens;
         return fieldOf(lens == Lens::Pinhole   ? "pinhole"
                        : lens == Lens::Fisheye ? "fisheye"
                                                : "omni");
     }},
    {"fx", kInJson, ofLens<&Camera::fx>},
    {"fy", kInJson, ofLens<&Camera::fy>},
    {"cx", kInJson, ofLens<&Camera::cx>},
    {"cy", kInJson, ofLens<&Camera::cy>},
    {"mirror", kInJson, mirrorOf},
    {"coefficients", kInJson,
     [](const View& r) { return cameraOf(r).isDistorted() ? coefficientsOf(r) : FieldValue(); }},
    {"png", kInJson | kIsFrame,
     [](const View& r) { return FieldValue(FieldText(base64(pngOfPhoto(r)))); }},
    {"rgb", kInArray, measured<Photo, &Photo::rgb>, kByte8, sizeTimesThree<Camera>},
    {"matrix", kInFixed, matrixOf, kFloat64,
     [](const View&) { return std::vector<std::uint64_t>(2, 3); }},
    {"coefficients", kInFixed, coefficientsOf},
    {"model", kInFixed,
     [](const View& r) {
         return FieldValue(FieldText(std::string(lensModelOf(cameraOf(r)).name)));
     }},
    {"xi", kInFixed, mirrorOf}};

constexpr RosTopic kCameraTopics[] = {
    {RosType::CompressedImage, "image_raw/compressed", RosFrame::Optical,
     [](const RosHeader& header, const View& r) {
         return compressedImageMessage(header, "png", pngOfPhoto(r));
     }},
    {RosType::CameraInfo, "camera_info", RosFrame::Optical,
     [](const RosHeader& header, const View& r) { return cameraInfoMessage(header, cameraOf(r)); },
     [](const Sensor& sensor) { return !hasMirror(sensor); }}};

// Tags and receivers.

const Burst& burstOf(const View& reading) { return reading.as<Burst>(); }

/// Returns the position by either method of locating, unknown coordinates empty.
std::array<std::optional<double>, 3> positionOf(const Burst& burst) {
    if (burst.fix) return {burst.fix->position.x, burst.fix->position.y, burst.fix->position.z};
    if (burst.simple) return {burst.simple->x, burst.simple->y, std::nullopt};
    return {};
}

template <std::size_t kAxis>
FieldValue coordinate(const View& reading) {
    return Measured{positionOf(burstOf(reading))[kAxis]};
}

template <double PositionFix::*kPart>
FieldValue ofFix(const View& reading) {
    const Burst& burst = burstOf(reading);
    return burst.fix ? Measured{(*burst.fix).*kPart} : Measured{};
}

FieldValue knownPosition(const View& reading) {
    std::vector<Measured> known;
    for (const auto& part : positionOf(burstOf(reading)))
        if (part) known.push_back({part});
    return known.empty() ? FieldValue(Measured{}) : FieldValue(known);
}

FieldValue wholePosition(const View& reading) {
    std::vector<double> parts;
    for (const auto& part : positionOf(burstOf(reading))) parts.push_back(part.value_or(kNoValue));
    return parts;
}

FieldValue heardReceivers(const View& reading) {
    std::vector<FieldRecord> heard;
    for (const TimeOfFlight& flight : burstOf(reading).heard)
        heard.push_back({{{"receiver", FieldText(reading.receivers[flight.receiver].id)},
                          {"time_of_flight", Measured{flight.time}},
                          {"range", Measured{flight.distance}}}});
    return heard;
}

/// Formats RECEIVER=SECONDS pairs, separated by blanks.
FieldValue timesOfFlight(const View& reading) {
    std::string times;
    for (const TimeOfFlight& flight : burstOf(reading).heard) {
        if (!times.empty()) times += ' ';
        times.append(reading.receivers[flight.receiver].id).append("=");
        appendDouble(times, flight.time);
    }
    return FieldText(times);
}

FieldValue rangesOfReceivers(const View& reading) {
    std::vector<double> ranges(reading.receivers.size(), kNoValue);
    for (const TimeOfFlight& flight : burstOf(reading).heard)
        ranges[flight.receiver] = flight.distance;
    return ranges;
}

FieldValue receiverIds(const View& reading) {
    std::vector<std::string> ids;
    for (const Sensor& receiver : reading.receivers) ids.push_back(receiver.id);
    return ids;
}

FieldValue receiverPositions(const View& reading) {
    std::vector<double> parts;
    for (const Sensor& receiver : reading.receivers) {
        const Point3& at = receiver.pose.position;
        parts.insert(parts.end(), {at.x, at.y, at.z});
    }
    return parts;
}

FieldValue heardCount(const View& reading) { return fieldOf(burstOf(reading).heard.size()); }

constexpr ReadingField kTagFields[] = {
    {"heard", kInJson, heardReceivers},
    {"position", kInJson, knownPosition},
    {"x", kInColumn, coordinate<0>},
    {"y", kInColumn, coordinate<1>},
    {"z", kInColumn, coordinate<2>},
    {"residual", kInJson | kInColumn, ofFix<&PositionFix::residual>},
    {"pdop", kInJson | kInColumn, ofFix<&PositionFix::pdop>},
    {"hdop", kInJson | kInColumn, ofFix<&PositionFix::hdop>},
    {"vdop", kInJson | kInColumn, ofFix<&PositionFix::vdop>},
    {"heard", kInColumn, heardCount},
    {"times", kInColumn, timesOfFlight},
    {"ranges", kInArray, rangesOfReceivers, kFloat64,
     [](const View& r) { return std::vector<std::uint64_t>{r.receivers.size()}; }},
    {"positions", kInArray, wholePosition, kFloat64,
     [](const View&) { return std::vector<std::uint64_t>{3}; }},
    {"receivers", kInFixed, receiverIds},
    {"receiver_positions", kInFixed, receiverPositions, kFloat64, [](const View& r) {
         return std::vector<std::uint64_t>{r.receivers.size(), 3};
     }}};

constexpr RosTopic kTagTopics[] = {
    {RosType::PointStamped, "position", RosFrame::World,
     [](const RosHeader& header, const View& r) {
         const auto [x, y, z] = positionOf(burstOf(r));
         if (!x) return std::string();
         return pointMessage(header, {*x, *y, z.value_or(r.pose.position.z)});
     }}};

constexpr std::string_view kBeamIndex[] = {"beam"}, kPixelIndices[] = {"column", "row"};

/// Sorted as the alternatives of SensorModel.
constexpr ReadingKind kReadingKinds[] = {
    {.fields = kLaserFields,
     .topics = kLaserTopics,
     .indices = kBeamIndex,
     .counts =
         [](const Sensor& sensor) {
             return std::vector{static_cast<std::size_t>(sensor.as<Laser>().beams)};
         },
     .points =
         [](const Sensor& sensor, const Reading& reading, Coordinates in) {
             return cloudOf(sensor.as<Laser>(), std::get<std::vector<Scan>>(reading), in);
         },
     .parts =
         [](const Sensor& sensor) {
             const Laser& laser = sensor.as<Laser>();
             return laser.sweep == SweepAxis::None ? 0 : laser.scans();
         },
     .part = [](const View& r) { return r.as<Scan>().number; },
     .delay = [](const Sensor& sensor,
                 std::size_t beam) { return sensor.as<Laser>().timeOf(static_cast<int>(beam)); },
     .pose = [](const View& r, std::size_t beam) -> const Pose3& {
         return r.as<Scan>().poseAt(beam);
     }},
    {.fields = kRangerFields,
     .topics = kRangerTopics,
     .indices = kPixelIndices,
     .counts =
         [](const Sensor& sensor) {
             const Ranger& ranger = sensor.as<Ranger>();
             return std::vector{static_cast<std::size_t>(ranger.columns),
                                static_cast<std::size_t>(ranger.rows)};
         },
     .points =
         [](const Sensor& sensor, const Reading& reading, Coordinates in) {
             return cloudOf(sensor.as<Ranger>(), std::get<DepthFrame>(reading), in);
         }},
    {},
    {.fields = kTagFields, .topics = kTagTopics},
    {.fields = kCameraFields, .topics = kCameraTopics}};
static_assert(std::size(kReadingKinds) == std::variant_size_v<SensorModel>);

}  // namespace

std::vector<ReadingView> viewsOf(const Sensor& sensor, const Reading& reading,
                                 std::span<const Sensor> receivers) {
    std::vector<ReadingView> views;
    if (const auto* const scans = std::get_if<std::vector<Scan>>(&reading))
        for (const Scan& scan : *scans) views.push_back(viewOf(sensor, scan));
    else
        std::visit(
            [&](const auto& one) {
                if constexpr (!std::is_same_v<decltype(one), const std::vector<Scan>&>)
                    views.push_back(viewOf(sensor, one, receivers));
            },
            reading);
    return views;
}

const ReadingKind& readingKind(const SensorModel& model) { return kReadingKinds[model.index()]; }

int partsOf(const Sensor& sensor) {
    const ReadingKind& kind = readingKind(sensor.model);
    return kind.parts == nullptr ? 0 : kind.parts(sensor);
}

bool isSwept(const Sensor& sensor) { return partsOf(sensor) > 0; }

}  // namespace ispace
