// SPDX-License-Identifier: GPL-3.0-or-later
// The kind `camera`: its records, parameters and shapes.
#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/message.h"
#include "base/number.h"
#include "scene/sensor/camera.h"
#include "scene/sensor/field_of_view.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/ranger.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace {

std::optional<Vec2> imageSensorSize(const std::string& text, int columns, int rows) {
    std::string_view rest = text;
    const auto take = [&rest](char end) {
        const auto at = std::min(rest.find(end), rest.size());
        const std::string_view part = rest.substr(0, at);
        rest.remove_prefix(std::min(at + 1, rest.size()));
        return part;
    };
    const auto positive = [](std::string_view number) {
        const auto value = parseDouble(number);
        return value && *value > 0 ? value : std::nullopt;
    };
    if (text.ends_with('"') || text.ends_with("in")) {
        rest.remove_suffix(text.ends_with('"') ? 1 : 2);
        const bool is_fraction = rest.find('/') != std::string_view::npos;
        const auto over = positive(take('/'));
        const auto under = is_fraction ? positive(rest) : std::optional(1.0);
        if (!over || !under) return std::nullopt;
        const double inches = *over / *under, diagonal = inches * (inches >= 0.5 ? 0.016 : 0.018);
        const double scale = diagonal / std::hypot(columns, rows);
        return Vec2{scale * columns, scale * rows};
    }
    std::string_view unit;
    const auto unit_at = rest.find_last_of("0123456789.");
    if (unit_at != std::string_view::npos) {
        unit = rest.substr(unit_at + 1);
        rest = rest.substr(0, unit_at + 1);
    }
    std::string_view first = take(',');
    if (first.ends_with(unit)) first.remove_suffix(unit.size());
    const auto width = positive(first), height = positive(rest);
    double metre = 0;
    if (unit == "mm") metre = 1e-3;
    if (unit == "cm") metre = 1e-2;
    if (unit == "m" || unit.empty()) metre = 1;
    if (!width || !height || metre == 0) return std::nullopt;
    return Vec2{*width * metre, *height * metre};
}

namespace {

/// Reads the keys of lens and picture.
class OpticsReader {
  public:
    OpticsReader(Camera& camera, const Record& record, Diagnostics& findings)
        : camera_(camera), record_(record), findings_(findings) {}

    void read() {
        readLens();
        readPixels();
        const int ways = static_cast<int>(record_.has("fov")) +
                         static_cast<int>(record_.has("focal") || record_.has("sensor")) +
                         static_cast<int>(record_.has("fx"));
        if (ways > 1)
            findings_.add(record_.finding(record_.has("fx") ? "fx" : "focal",
                                          "the focal length is given twice: wanted one of `fov`, "
                                          "`focal` with `sensor`, and `fx`"));
        camera_.widest = camera_.turningAngle();
        if (record_.has("fov"))
            applyFov(record_.tuple("fov"));
        else if (isOmni() && ways == 0)
            applyFov({kBareCircle});
        if (record_.has("focal") || record_.has("sensor")) readFocal();
        readPixelFocal();
        checkFocal();
        if (camera_.lens == Lens::Mirror || isOmni()) endCircle();
    }

  private:
    /// Default circle of an omnidirectional camera: half of all directions.
    static constexpr double kBareCircle = 180;

    [[nodiscard]] bool isOmni() const {
        return record_.has("projection") && record_.text("projection") == "omni";
    }

    void readLens() {
        if (record_.has("projection")) {
            const std::string& name = record_.text("projection");
            const Lens before = camera_.lens;
            camera_.lens = name == "pinhole" ? Lens::Pinhole : Lens::Fisheye;
            if (isOmni() && record_.has("mirror")) camera_.lens = Lens::Mirror;
            if (camera_.lens != before) camera_.distortion = {};
        }
        if (record_.has("mirror")) {
            if (camera_.lens != Lens::Mirror)
                findings_.add(record_.finding("mirror", "only projection=omni has a mirror"));
            camera_.mirror = record_.number("mirror");
        }
        const std::string named = record_.has("distortion") ? record_.text("distortion") : "";
        if (named == "fisheye" && camera_.lens != Lens::Fisheye) {
            if (camera_.lens == Lens::Mirror || record_.has("projection"))
                findings_.add(record_.finding(
                    "distortion",
                    "the distortion of a fisheye, but projection=" +
                        std::string(camera_.lens == Lens::Mirror ? "omni" : "pinhole")));
            camera_.lens = Lens::Fisheye;
        }
        if (named == "plumb_bob" && camera_.lens != Lens::Pinhole)
            findings_.add(record_.finding("distortion", "plumb_bob distorts a pinhole alone"));
        if (!record_.has("coefficients")) return;
        if (camera_.lens == Lens::Mirror) {
            findings_.add(record_.finding("coefficients", "a mirror has none"));
            return;
        }
        const Tuple& values = record_.tuple("coefficients");
        if (camera_.lens == Lens::Fisheye && values.size() > 4)
            findings_.add(record_.finding("coefficients", "a fisheye has four: k1,k2,k3,k4"));
        camera_.distortion = {};
        std::copy_n(values.begin(), std::min<std::size_t>(values.size(), 5),
                    camera_.distortion.begin());
    }

    void readPixels() {
        if (!record_.has("pixels")) return;
        const double columns = record_.tuple("pixels")[0], rows = record_.tuple("pixels")[1];
        const double wide = columns / camera_.columns, high = rows / camera_.rows;
        // Pixels stay square: the field of view across is kept, or the whole circle.
        const bool has_circle = camera_.widest < camera_.turningAngle();
        const double scale = has_circle ? std::min(wide, high) : wide;
        camera_.fx *= scale;
        camera_.fy *= scale;
        camera_.cx = (camera_.cx + 0.5) * wide - 0.5;
        camera_.cy = (camera_.cy + 0.5) * high - 0.5;
        camera_.columns = static_cast<int>(columns);
        camera_.rows = static_cast<int>(rows);
        if (camera_.pixels() > kMaxPixels)
            findings_.add(
                record_.finding("pixels", std::to_string(camera_.pixels()) + " pixels, at most " +
                                              std::to_string(kMaxPixels) + " are possible"));
    }

    void applyFov(const Tuple& fov) {
        const Angle widest = 2 * camera_.widest;
        const Angle most = Angle::degrees(*std::max_element(fov.begin(), fov.end()));
        if (most.degrees() >= 180 && camera_.lens == Lens::Pinhole) {
            findings_.add(record_.finding(
                "fov", "a pinhole sees less than 180 degrees, not " + formatDouble(most.degrees()) +
                           " (projection=fisheye and projection=omni see more)"));
            return;
        }
        if (most > widest) {
            double least = std::round(widest.degrees() * 100) / 100;
            if (least >= most.degrees()) least = std::floor(widest.degrees() * 100) / 100;
            findings_.add(record_.finding("fov", "this lens sees at most " + formatDouble(least) +
                                                     " degrees, not " +
                                                     formatDouble(most.degrees())));
            return;
        }
        const Angle first = Angle::degrees(fov[0]);
        // The circle of an omnidirectional picture fits its shorter side.
        const double side = isOmni() ? std::min(camera_.columns, camera_.rows) : camera_.columns;
        camera_.fx = camera_.fy = camera_.focalFor(side, first);
        if (fov.size() > 1) camera_.fy = camera_.focalFor(camera_.rows, Angle::degrees(fov[1]));
        camera_.center();
        if (isOmni()) circle_ = 0.5 * first;
    }

    void readFocal() {
        if (!record_.has("focal") || !record_.has("sensor")) {
            const bool has_focal = record_.has("focal");
            findings_.add(record_.finding(
                has_focal ? "focal" : "sensor",
                has_focal ? "a focal length says nothing without the size of the image sensor: add "
                            "`sensor`, such as sensor=1/2.8\" or sensor=5.37,3.02mm"
                          : "an image sensor says nothing without the lens: add `focal`, such as "
                            "focal=2.8mm"));
            return;
        }
        const auto size = imageSensorSize(record_.text("sensor"), camera_.columns, camera_.rows);
        constexpr double kMaxSize = 0.3;  // metres: rejects a missing unit
        if (!size || size->x > kMaxSize || size->y > kMaxSize) {
            findings_.add(
                record_.finding("sensor", excerpt(record_.text("sensor")) +
                                              " is no size of an image sensor: wanted a format "
                                              "such as 1/2.8\" or width and height such as "
                                              "5.37,3.02mm"));
            return;
        }
        const double focal = record_.number("focal");
        constexpr double kMaxFocal = 1;  // metres: likewise
        if (focal > kMaxFocal) {
            findings_.add(record_.finding("focal", "a focal length of " + formatDouble(focal) +
                                                       " m: is it " + formatDouble(focal) + "mm?"));
            return;
        }
        camera_.fx = camera_.fy = focal / size->x * camera_.columns;
        camera_.center();
    }

    void readPixelFocal() {
        if (record_.has("fx")) camera_.fx = camera_.fy = record_.number("fx");
        if (record_.has("fy")) camera_.fy = record_.number("fy");
        if (record_.has("fx") && !record_.has("cx")) camera_.center();
        if (record_.has("cx")) camera_.cx = record_.number("cx");
        if (record_.has("cy")) camera_.cy = record_.number("cy");
    }

    /// Rejects focal lengths beyond which no two pixels differ, or adjacent ones differ by more
    /// than the world.
    void checkFocal() {
        constexpr double kMin = 1e-5, kMax = 1e9;
        if (!findings_.empty()) return;
        for (const double focal : {camera_.fx, camera_.fy})
            if (!(focal >= kMin && focal <= kMax)) {
                const char* const key = record_.has("fov")  ? "fov"
                                        : record_.has("fx") ? "fx"
                                                            : "focal";
                findings_.add(record_.finding(record_.has(key) ? key : "pixels",
                                              "a focal length of " + formatDouble(focal) +
                                                  " pixels, wanted " + formatDouble(kMin) + " to " +
                                                  formatDouble(kMax)));
                return;
            }
    }

    void endCircle() {
        if (circle_ > Angle()) camera_.widest = std::min(camera_.widest, circle_);
    }

    Camera& camera_;
    const Record& record_;
    Diagnostics& findings_;
    Angle circle_;
};

}  // namespace

Camera withParameters(Camera base, const Record& record) {
    Diagnostics findings;
    if (record.has("calibration"))
        findings.add(record.finding("calibration",
                                    "a calibration is read only where a room or a layout names it; "
                                    "write its figures here"));
    applyRange(record, base.min_range, base.max_range, findings);
    if (record.has("rate")) base.rate = record.number("rate");
    if (record.has("full_well")) base.full_well = record.number("full_well");
    if (record.has("read_noise")) base.read_noise = record.number("read_noise");
    const Angle circle = base.widest;
    const bool keeps_circle = !record.has("projection") && !record.has("fov") &&
                              !record.has("distortion") && !record.has("coefficients") &&
                              !record.has("mirror");
    OpticsReader(base, record, findings).read();
    if (keeps_circle) base.widest = circle;
    findings.throwIfAny();
    return base;
}

namespace {

void addCameraKeys(std::vector<KeySpec>& keys) {
    addPictureKeys(keys, 360);
    keys.push_back({.name = "projection",
                    .type = KeyType::Choice,
                    .help = "lens: a pinhole, a fisheye, or a full circle about the axis",
                    .choices = {"pinhole", "fisheye", "omni"}});
    keys.push_back({.name = "mirror",
                    .type = KeyType::Number,
                    .help = "with projection=omni, a camera under a curved mirror (unified model): "
                            "1 is a parabola, between 0 and 1 are hyperbolas; without, equidistant",
                    .lower = 0,
                    .upper = 1,
                    .lower_open = true});
    keys.push_back(
        positiveKey("focal", Unit::Length, "focal length, such as 2.8mm; needs `sensor`", 1000));
    keys.push_back({.name = "sensor",
                    .type = KeyType::Text,
                    .help = "size of the image sensor: a format such as 1/2.8\", or width,height "
                            "such as 5.37,3.02mm, of which the width counts, since pixels are "
                            "square; needs `focal`"});
    for (const char* name : {"fx", "fy"})
        keys.push_back(positiveKey(name, Unit::None, "focal length in pixels", 1e7));
    for (const char* name : {"cx", "cy"})
        keys.push_back({.name = name,
                        .type = KeyType::Number,
                        .help = "optical centre in pixels; the middle of the upper left one is 0",
                        .lower = -1e7,
                        .upper = 1e7});
    keys.push_back({.name = "distortion",
                    .type = KeyType::Choice,
                    .help = "model of the coefficients, as OpenCV and ROS have them",
                    .choices = {"plumb_bob", "fisheye"}});
    keys.push_back({.name = "coefficients",
                    .type = KeyType::Tuple,
                    .help = "k1,k2,p1,p2,k3 of plumb_bob, or k1,k2,k3,k4 of fisheye",
                    .min_count = 1,
                    .max_count = 5,
                    .lower = -1000,
                    .upper = 1000});
    keys.push_back({.name = "calibration",
                    .type = KeyType::Text,
                    .help = "calibration file, relative to the folder of the file that names it: "
                            "camera_info of ROS or a file of OpenCV, as YAML; it gives pixels, fx, "
                            "fy, cx, cy, lens and coefficients",
                    .role = Role::File});
    keys.push_back(positiveKey("full_well", Unit::None,
                               "electrons of a white pixel, for --noise; default 10000", 1e9));
    keys.push_back({.name = "read_noise",
                    .type = KeyType::Number,
                    .help = "electrons, standard deviation, for --noise; default 4",
                    .lower = 0,
                    .upper = 1e6});
}

/// Builds the view up to `limits.far`: the picture's edges as a curved surface.
Mesh cameraView(const Sensor& sensor, double reach) {
    const Camera& camera = sensor.as<Camera>();
    const ViewLimits limits = viewLimits(camera.min_range, camera.max_range, reach);
    // A point -1..1 across and upright in the picture; beyond the circle of the lens, clipped to
    // it.
    const auto at = [&](double across, double upright, double range) {
        const PixelPoint place{camera.cx + across * camera.columns / 2,
                               camera.cy - upright * camera.rows / 2};
        if (const auto ray = camera.ray(place))
            return (camera.isStraight() ? range / ray->x : range) * *ray;
        const Angle around = Angle::radians(std::atan2(upright, -across));
        const double s = sin(camera.widest);
        return range * Vec3{cos(camera.widest), s * cos(around), s * sin(around)};
    };
    return pictureView(camera.fovX(), camera.fovY(), limits, false, at);
}

}  // namespace

const SensorKind Camera::kKind = {
    .keyword = "camera",
    .noun = "camera",
    .help = "camera; bare: fov=45 pixels=640,480 range=0,100",
    .heading_help = "direction of its axis, from +x",
    .device_help = "a camera one can buy",
    .sign = SensorSign::Square,
    .add_keys = addCameraKeys,
    .body =
        [] {
            return lensBox({0.07, 0.06, 0.06}, {0}, 0.022);
        },
    .read = readModel<Camera>,
    .summary = [](const SensorModel& model) -> DeviceSummary {
        const Camera& camera = std::get<Camera>(model);
        return {"-", degreesText(camera.fovX()) + "x" + degreesText(camera.fovY()),
                std::to_string(camera.columns) + "x" + std::to_string(camera.rows),
                formatDouble(camera.rate)};
    },
    .view = cameraView,
    .bearings = [](const SensorModel& model) -> BearingSpan {
        const Camera& camera = std::get<Camera>(model);
        const Angle half = 0.5 * camera.fovX();
        return {-half, half, camera.max_range};
    },
    .field_of_view = fieldOfViewOf<Camera>,
    .is_read = true,
    .is_arranged = true,
    .is_overhead = true,
    .follows_poses = true,
    .sight_errors = [](const SensorModel& model, double /*range*/) -> SightErrors {
        return {0, uniformSigma(1 / std::get<Camera>(model).fx)};
    }};

}  // namespace ispace
