// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/reading_fields.h"

#include <array>
#include <cmath>

#include "base/message.h"
#include "raster/codec.h"
#include "sense/formats/camera_info.h"
#include "sense/formats/field_values.h"
#include "sense/formats/point_cloud.h"

namespace ispace {

namespace {

using namespace fields;

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

/// On the floor in millimetres, angles in hundredths of a degree.
FieldValue pagePose(const View& reading) {
    const auto whole = [](double value) { return std::int64_t{std::llround(value)}; };
    const Pose3& pose = reading.pose;
    constexpr double kLength = 1000, kAngle = 100;
    return std::vector{whole(pose.position.x * kLength), whole(pose.position.y * kLength),
                       whole(pose.heading.degrees() * kAngle), whole(pose.tilt.degrees() * kAngle),
                       whole(pose.roll.degrees() * kAngle)};
}

FieldValue spinOf(const View& reading) {
    const double spin = laserOf(reading).spin;
    return spin == 0 ? FieldValue() : FieldValue(spin);
}

constexpr ReadingField kLaserFields[] = {
    {"pose", kInPage, pagePose},
    {"first", kInPage, figure<Laser, &Laser::first>},
    {"angle_min", kInJson | kInInfo | kInLine, figure<Laser, &Laser::first>},
    {"angle_max", kInJson | kInInfo | kInLine, figure<Laser, &Laser::last>},
    {"angle_increment", kInJson, figure<Laser, &Laser::step>},
    {"step", kInInfo | kInLine | kInPage, figure<Laser, &Laser::step>},
    {"max", kInPage, figure<Laser, &Laser::max_range>},
    {"n", kInInfo, figure<Laser, &Laser::beams>},
    {"n", kInLine, [](const View& r) { return fieldOf(r.as<Scan>().ranges.size()); }},
    {"range_min", kInJson | kInInfo, figure<Laser, &Laser::min_range>},
    {"range_max", kInJson | kInInfo, figure<Laser, &Laser::max_range>},
    {"rate", kInInfo, figure<Laser, &Laser::rate>},
    {"spin", kInInfo, spinOf},
    {"r", kInLine | kInPage, measured<Scan, &Scan::ranges>},
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
    {"width", kInJson | kInInfo, figure<Ranger, &Ranger::columns>},
    {"height", kInJson | kInInfo, figure<Ranger, &Ranger::rows>},
    {"projection", kInJson | kInInfo,
     [](const View& r) { return fieldOf(isPinhole(r.sensor) ? "pinhole" : "spherical"); }},
    {"fx", kInJson | kInInfo, ofPinhole<&Ranger::fx>},
    {"fy", kInJson | kInInfo, ofPinhole<&Ranger::fy>},
    {"cx", kInJson | kInInfo, ofPinhole<&Ranger::cx>},
    {"cy", kInJson | kInInfo, ofPinhole<&Ranger::cy>},
    {"fov", kInJson | kInInfo,
     [](const View& r) {
         return isPinhole(r.sensor) ? FieldValue()
                                    : FieldValue(std::vector{rangerOf(r).fov_x, rangerOf(r).fov_y});
     }},
    {"measures", kInJson | kInInfo,
     [](const View& r) { return fieldOf(rangerOf(r).measures_depth ? "depth" : "distance"); }},
    {"range_min", kInJson | kInInfo, figure<Ranger, &Ranger::min_range>},
    {"range_max", kInJson | kInInfo, figure<Ranger, &Ranger::max_range>},
    {"ambiguity", kInJson,
     [](const View& r) {
         return rangerOf(r).ambiguity > 0 ? FieldValue(rangerOf(r).ambiguity) : FieldValue();
     }},
    {"rate", kInInfo, figure<Ranger, &Ranger::rate>},
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
     [](const RosHeader& header, const View& r) {
         return cameraInfoMessage(header, cameraInfoOf(rangerOf(r)));
     },
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
    {"width", kInJson | kInInfo, figure<Camera, &Camera::columns>},
    {"height", kInJson | kInInfo, figure<Camera, &Camera::rows>},
    {"projection", kInJson | kInInfo,
     [](const View& r) {
         const Lens lens = cameraOf(r).lens;
         return fieldOf(lens == Lens::Pinhole   ? "pinhole"
                        : lens == Lens::Fisheye ? "fisheye"
                                                : "omni");
     }},
    {"fx", kInJson | kInInfo, ofLens<&Camera::fx>},
    {"fy", kInJson | kInInfo, ofLens<&Camera::fy>},
    {"cx", kInJson | kInInfo, ofLens<&Camera::cx>},
    {"cy", kInJson | kInInfo, ofLens<&Camera::cy>},
    {"mirror", kInJson | kInInfo, mirrorOf},
    {"coefficients", kInJson | kInInfo,
     [](const View& r) { return cameraOf(r).isDistorted() ? coefficientsOf(r) : FieldValue(); }},
    {"rate", kInInfo, figure<Camera, &Camera::rate>},
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
     [](const RosHeader& header, const View& r) {
         return cameraInfoMessage(header, cameraInfoOf(cameraOf(r)));
     },
     [](const Sensor& sensor) { return !hasMirror(sensor); }}};

constexpr std::string_view kBeamIndex[] = {"beam"}, kPixelIndices[] = {"column", "row"};

/// The rows of the readings, sorted as the alternatives of SensorModel.
template <typename Values>
constexpr int kRowsOf = 0;
template <typename... Values>
constexpr std::array<const ReadingKind*, sizeof...(Values)> kRowsOf<std::variant<Values...>>{
    &Values::kKind...};
static_assert(kRowsOf<ReadingValue>.size() == std::variant_size_v<SensorModel>);

}  // namespace

const ReadingKind Scan::kKind = {
    .fields = kLaserFields,
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
    }};

const ReadingKind DepthFrame::kKind = {
    .fields = kRangerFields,
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
        }};

const ReadingKind AddedReading::kKind = {.fields = {}};

const ReadingKind Photo::kKind = {.fields = kCameraFields, .topics = kCameraTopics};

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

const ReadingKind& readingKind(const SensorModel& model) {
    if (const auto* const added = std::get_if<AddedSensor>(&model)) return *added->kind().reading;
    return *kRowsOf<ReadingValue>[model.index()];
}

int partsOf(const Sensor& sensor) {
    const ReadingKind& kind = readingKind(sensor.model);
    return kind.parts == nullptr ? 0 : kind.parts(sensor);
}

bool isSwept(const Sensor& sensor) { return partsOf(sensor) > 0; }

}  // namespace ispace
