// SPDX-License-Identifier: GPL-3.0-or-later
#include "sensor/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "base/message.h"
#include "base/number.h"
#include "sensor/drawing.h"
#include "sensor/keys.h"
#include "sensor/kind.h"
#include "sensor/ranger.h"

namespace ispace {

namespace {

/// A pinhole's picture plane ends here.
constexpr double kWidestPinhole = 89.9 * std::numbers::pi / 180;

/// Distance from the centre of the picture plane, over the focal length, of what lies `angle`
/// radians off the axis; radial distortion alone.
double radiusOf(const Camera& camera, double angle) {
    const auto& d = camera.distortion;
    const double square = angle * angle;
    switch (camera.lens) {
        case Lens::Pinhole: {
            const double r = std::tan(angle), s = r * r;
            return r * (1 + s * (d[0] + s * (d[1] + s * d[4])));
        }
        case Lens::Fisheye:
            return angle *
                   (1 + square * (d[0] + square * (d[1] + square * (d[2] + square * d[3]))));
        case Lens::Mirror:
            return std::sin(angle) / (std::cos(angle) + camera.mirror);
    }
    return 0;
}

/// Beyond this angle, in radians, the picture of a ray moves back towards the centre.
double turningAngle(const Camera& camera) {
    double end = std::numbers::pi;
    if (camera.lens == Lens::Pinhole) end = kWidestPinhole;
    if (camera.lens == Lens::Mirror)
        // Where the sphere's ray leaves the plane, or touches the sphere.
        end = std::acos(-std::min(camera.mirror, 1 / std::max(camera.mirror, 1e-9))) - 1e-6;
    constexpr int kSteps = 2048;
    const auto rises = [&](double angle) {
        constexpr double kSmall = 1e-7;
        return radiusOf(camera, angle + kSmall) > radiusOf(camera, angle);
    };
    for (int i = 1; i < kSteps; ++i) {
        if (rises(end * i / kSteps)) continue;
        double low = end * (i - 1) / kSteps, high = end * i / kSteps;
        for (int halving = 0; halving < 30; ++halving) {
            const double middle = (low + high) / 2;
            (rises(middle) ? low : high) = middle;
        }
        return low;
    }
    return end;
}

/// The angle off the axis, in radians, at which a radius stands. \pre radius is 0 or more
std::optional<double> angleOf(const Camera& camera, double radius) {
    double low = 0, high = camera.widest.radians();
    if (radius > radiusOf(camera, high)) return std::nullopt;
    // Newton's steps, kept between bounds that close in.
    double angle = std::min(radius, high);
    for (int i = 0; i < 60; ++i) {
        const double value = radiusOf(camera, angle) - radius;
        if (value == 0) return angle;
        (value > 0 ? high : low) = angle;
        constexpr double kSmall = 1e-6;
        const double slope =
            (radiusOf(camera, angle + kSmall) - radiusOf(camera, angle - kSmall)) / (2 * kSmall);
        double next = angle - value / slope;
        if (!(next > low && next < high)) next = (low + high) / 2;
        if (std::fabs(next - angle) <= 1e-16 * (1 + angle)) return next;
        angle = next;
    }
    return angle;
}

/// `plumb_bob` of a place on the plane x = 1.
Vec2 bent(const std::array<double, 5>& d, Vec2 p) {
    const double s = p.x * p.x + p.y * p.y, radial = 1 + s * (d[0] + s * (d[1] + s * d[4]));
    return {p.x * radial + 2 * d[2] * p.x * p.y + d[3] * (s + 2 * p.x * p.x),
            p.y * radial + d[2] * (s + 2 * p.y * p.y) + 2 * d[3] * p.x * p.y};
}

/// The place that is bent to `to`, by Newton's method; nothing if it does not get there.
std::optional<Vec2> unbent(const std::array<double, 5>& d, Vec2 to, double most) {
    Vec2 p = to;
    const double radius = std::hypot(p.x, p.y);
    if (radius > most) p = (most / radius) * p;
    for (int i = 0; i < 50; ++i) {
        const Vec2 off = bent(d, p) - to;
        if (std::hypot(off.x, off.y) < 1e-14 * (1 + radius))
            return std::hypot(p.x, p.y) <= most * (1 + 1e-9) ? std::optional(p) : std::nullopt;
        constexpr double kSmall = 1e-7;
        const Vec2 a =
            (0.5 / kSmall) * (bent(d, {p.x + kSmall, p.y}) - bent(d, {p.x - kSmall, p.y}));
        const Vec2 b =
            (0.5 / kSmall) * (bent(d, {p.x, p.y + kSmall}) - bent(d, {p.x, p.y - kSmall}));
        const double det = a.x * b.y - a.y * b.x;
        if (!(std::fabs(det) > 1e-12)) return std::nullopt;
        Vec2 step = {(off.x * b.y - off.y * b.x) / det, (a.x * off.y - a.y * off.x) / det};
        const double size = std::hypot(step.x, step.y), bound = 0.5 * (1 + std::hypot(p.x, p.y));
        if (size > bound) step = (bound / size) * step;
        p = p - step;
    }
    const Vec2 off = bent(d, p) - to;
    const bool there = std::hypot(off.x, off.y) < 1e-9 && std::hypot(p.x, p.y) <= most;
    return there ? std::optional(p) : std::nullopt;
}

void center(Camera& camera) {
    camera.cx = (camera.columns - 1) / 2.0;
    camera.cy = (camera.rows - 1) / 2.0;
}

/// Focal length in pixels by which `side` pixels span the angle.
double focalOf(const Camera& camera, double side, Angle fov) {
    return side / 2 / radiusOf(camera, fov.radians() / 2);
}

}  // namespace

Camera::Camera() {
    fx = fy = focalOf(*this, columns, Angle::degrees(45));
    center(*this);
    widest = Angle::radians(kWidestPinhole);
}

std::optional<Vec3> Camera::ray(PixelPoint place) const {
    const Vec2 p{(place.column - cx) / fx, (place.row - cy) / fy};
    if (lens == Lens::Pinhole) {
        const double most = tan(widest);
        const auto flat = isDistorted() ? unbent(distortion, p, most) : std::optional(p);
        if (!flat || std::hypot(flat->x, flat->y) > most) return std::nullopt;
        return (1 / std::sqrt(1 + flat->x * flat->x + flat->y * flat->y)) *
               Vec3{1, -flat->x, -flat->y};
    }
    const double radius = std::hypot(p.x, p.y);
    if (radius == 0) return Vec3{1, 0, 0};
    const auto angle = angleOf(*this, radius);
    if (!angle) return std::nullopt;
    const double s = std::sin(*angle) / radius;
    return Vec3{std::cos(*angle), -s * p.x, -s * p.y};
}

std::optional<PixelPoint> Camera::project(Vec3 direction) const {
    const double across = std::hypot(direction.y, direction.z);
    const double angle = std::atan2(across, direction.x);
    if (angle > widest.radians()) return std::nullopt;
    if (across == 0) return PixelPoint{cx, cy};
    Vec2 p;
    if (lens == Lens::Pinhole) {
        p = {-direction.y / direction.x, -direction.z / direction.x};
        if (isDistorted()) p = bent(distortion, p);
    } else {
        const double s = radiusOf(*this, angle) / across;
        p = {-s * direction.y, -s * direction.z};
    }
    return PixelPoint{cx + fx * p.x, cy + fy * p.y};
}

namespace {

Angle angleBetween(const Camera& camera, PixelPoint a, PixelPoint b) {
    const auto off = [&](PixelPoint p) {
        const auto ray = camera.ray(p);
        return ray ? std::atan2(std::hypot(ray->y, ray->z), ray->x) : camera.widest.radians();
    };
    return Angle::radians(off(a) + off(b));
}

}  // namespace

Angle Camera::fovX() const { return angleBetween(*this, {-0.5, cy}, {columns - 0.5, cy}); }
Angle Camera::fovY() const { return angleBetween(*this, {cx, -0.5}, {cx, rows - 0.5}); }

Angle Camera::widestInPicture() const {
    // The farthest is a corner, but for what the tangential terms of distortion bend.
    constexpr double kSlack = 1.01;
    double most = 0;
    for (const double column : {-0.5, columns - 0.5})
        for (const double row : {-0.5, rows - 0.5}) {
            const auto corner = ray({column, row});
            if (!corner) return widest;
            most = std::max(most, std::hypot(corner->y, corner->z) / corner->x);
            if (!(corner->x > 0)) return widest;
        }
    return std::min(widest, Angle::radians(std::atan(kSlack * most)));
}

bool Camera::looksAround(const Pose3& mount) const {
    if (lens == Lens::Pinhole || fx != fy) return false;
    const double radius = fx * radiusOf(*this, widest.radians()) * (1 - 1e-9);
    const bool whole = holds({cx - radius, cy}) && holds({cx + radius, cy}) &&
                       holds({cx, cy - radius}) && holds({cx, cy + radius});
    return whole && std::fabs(mount.tilt.degrees()) == 90;
}

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

/// Reads what a record says about lens and picture.
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
        camera_.widest = Angle::radians(turningAngle(camera_));
        if (record_.has("fov")) readFov();
        if (record_.has("focal") || record_.has("sensor")) readFocal();
        readPixelFocal();
        if (camera_.lens == Lens::Mirror || isOmni()) endCircle();
    }

  private:
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
        camera_.fx *= wide;
        camera_.fy *= high;
        camera_.cx = (camera_.cx + 0.5) * wide - 0.5;
        camera_.cy = (camera_.cy + 0.5) * high - 0.5;
        camera_.columns = static_cast<int>(columns);
        camera_.rows = static_cast<int>(rows);
        if (camera_.pixels() > kMaxPixels)
            findings_.add(
                record_.finding("pixels", std::to_string(camera_.pixels()) + " pixels, at most " +
                                              std::to_string(kMaxPixels) + " are possible"));
    }

    void readFov() {
        const Tuple& fov = record_.tuple("fov");
        const Angle widest = 2 * camera_.widest;
        const Angle most = Angle::degrees(*std::max_element(fov.begin(), fov.end()));
        if (most.degrees() >= 180 && camera_.lens == Lens::Pinhole) {
            findings_.add(record_.finding(
                "fov", "a pinhole sees less than 180 degrees, not " + formatDouble(most.degrees()) +
                           " (projection=fisheye and projection=omni see more)"));
            return;
        }
        if (most > widest) {
            findings_.add(record_.finding("fov", "this lens ends at " + degreesText(widest) +
                                                     " degrees, before " +
                                                     formatDouble(most.degrees())));
            return;
        }
        const Angle first = Angle::degrees(fov[0]);
        // The circle of an omnidirectional picture fits its shorter side.
        const double side = isOmni() ? std::min(camera_.columns, camera_.rows) : camera_.columns;
        camera_.fx = camera_.fy = focalOf(camera_, side, first);
        if (fov.size() > 1) camera_.fy = focalOf(camera_, camera_.rows, Angle::degrees(fov[1]));
        center(camera_);
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
        if (!size) {
            findings_.add(
                record_.finding("sensor", excerpt(record_.text("sensor")) +
                                              " is no size of an image sensor: wanted a format "
                                              "such as 1/2.8\" or width and height such as "
                                              "5.37,3.02mm"));
            return;
        }
        const double focal = record_.number("focal");
        camera_.fx = focal / size->x * camera_.columns;
        camera_.fy = focal / size->y * camera_.rows;
        center(camera_);
    }

    void readPixelFocal() {
        if (record_.has("fx")) camera_.fx = camera_.fy = record_.number("fx");
        if (record_.has("fy")) camera_.fy = record_.number("fy");
        if (record_.has("fx") && !record_.has("cx")) center(camera_);
        if (record_.has("cx")) camera_.cx = record_.number("cx");
        if (record_.has("cy")) camera_.cy = record_.number("cy");
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

Camera cameraOf(const Record& record, const Record* device) {
    return parametersOf<Camera>(record, device);
}

std::span<const PixelDensity> pixelDensities() {
    static constexpr std::array<PixelDensity, 6> kClasses = {{{"monitor", 12.5},
                                                              {"detect", 25},
                                                              {"observe", 62.5},
                                                              {"recognise", 125},
                                                              {"identify", 250},
                                                              {"inspect", 1000}}};
    return kClasses;
}

std::optional<double> pixelDensityOf(std::string_view text) {
    if (text == "recognize") text = "recognise";
    for (const PixelDensity& density : pixelDensities())
        if (density.name == text) return density.pixels_per_metre;
    const auto number = parseDouble(text);
    return number && *number > 0 && std::isfinite(*number) ? number : std::nullopt;
}

double rangeOf(const Camera& camera, double pixels_per_metre) {
    // Pixels a radian in the middle, where all these lenses have fewest.
    const double focal = std::min(camera.fx, camera.fy) / (1 + camera.mirror);
    return focal / pixels_per_metre;
}

Camera withDensity(Camera camera, double pixels_per_metre) {
    if (pixels_per_metre > 0)
        camera.max_range = std::min(camera.max_range, rangeOf(camera, pixels_per_metre));
    return camera;
}

FieldOfView fieldOfView(const Camera& camera, const Pose3& pose) {
    if (!camera.isStraight()) return FieldOfView::picture(pose, camera);
    const double left = (camera.cx + 0.5) / camera.fx, up = (camera.cy + 0.5) / camera.fy;
    return FieldOfView::pyramid(
        pose, {left, camera.columns / camera.fx - left, up, camera.rows / camera.fy - up},
        camera.max_range, true);
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
    keys.push_back(positiveKey("focal", Unit::Length, "focal length; needs `sensor`", 10));
    keys.push_back({.name = "sensor",
                    .type = KeyType::Text,
                    .help = "size of the image sensor: a format such as 1/2.8\", or width,height "
                            "such as 5.37,3.02mm; needs `focal`"});
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

/// What it looks at, up to `limits.far`: the picture's edges as a bent surface.
Mesh viewOf(const Sensor& sensor, double reach) {
    const Camera& camera = sensor.as<Camera>();
    const ViewLimits limits = viewLimits(camera.min_range, camera.max_range, reach);
    // A place -1..1 across and upright in the picture; beyond the circle of the lens, on it.
    const auto at = [&](double across, double upright, double range) {
        const PixelPoint place{camera.cx + across * camera.columns / 2,
                               camera.cy - upright * camera.rows / 2};
        if (const auto ray = camera.ray(place))
            return (camera.isStraight() ? range / ray->x : range) * *ray;
        const Angle around = Angle::radians(std::atan2(upright, -across));
        const double s = sin(camera.widest);
        return range * Vec3{cos(camera.widest), s * cos(around), s * sin(around)};
    };
    Mesh mesh{Material::View, {}, {}, true};
    const int columns = piecesOf(camera.fovX()), rows = piecesOf(camera.fovY());
    const double deep = limits.far - limits.near;
    addSheet(mesh, columns, rows,
             [&](double u, double v) { return at(2 * u - 1, 2 * v - 1, limits.far); });
    for (const double side : {-1.0, 1.0}) {
        addSheet(mesh, columns, 1,
                 [&](double u, double v) { return at(2 * u - 1, side, limits.near + v * deep); });
        addSheet(mesh, rows, 1,
                 [&](double u, double v) { return at(side, 2 * u - 1, limits.near + v * deep); });
    }
    return mesh;
}

}  // namespace

const SensorKind kCameraKind = {
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
    .read = [](const Record& record, const Record* device) -> SensorModel {
        return cameraOf(record, device);
    },
    .summary = [](const SensorModel& model) -> DeviceSummary {
        const Camera& camera = std::get<Camera>(model);
        return {"-", degreesText(camera.fovX()) + "x" + degreesText(camera.fovY()),
                std::to_string(camera.columns) + "x" + std::to_string(camera.rows),
                formatDouble(camera.rate)};
    },
    .view = viewOf,
    .bearings = [](const SensorModel& model) -> BearingSpan {
        const Camera& camera = std::get<Camera>(model);
        const Angle half = 0.5 * camera.fovX();
        return {-half, half, camera.max_range};
    },
    .is_read = true,
    .is_arranged = true,
    .is_overhead = true,
    .follows_poses = true};

}  // namespace ispace
