// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "geom/pose.h"
#include "record/record.h"
#include "scene/sensor/field_of_view.h"

namespace ispace {

/// How a direction becomes a place in the picture.
enum class Lens {
    Pinhole,  ///< tan of the angle to the axis, with distortion `plumb_bob` (Brown, Conrady)
    Fisheye,  ///< a polynomial of that angle (Kannala and Brandt 2006); equidistant without
    Mirror,   ///< a camera under a curved mirror, by the unified sphere (Geyer and Daniilidis 2000)
};

/// A place in a picture: pixel centres are whole numbers, (0, 0) is the upper left one, as in
/// OpenCV and ROS.
struct PixelPoint {
    double column = 0, row = 0;
};

/// A camera. In its frame (x forward, y left, z up) a direction (x, y, z) with the axis x becomes
/// the pixel (cx + fx u, cy + fy v), where (u, v) is (-y/x, -z/x) bent by the lens: OpenCV's
/// optical frame is (-y, -z, x). Of Fisheye and Mirror the axis is the middle of the circle that
/// the picture holds.
struct Camera {
    std::string model;  ///< "" for the bare camera
    Lens lens = Lens::Pinhole;
    int columns = 640, rows = 480;
    double fx = 0, fy = 0, cx = 0, cy = 0;  ///< focal lengths and centre, pixels
    /// Pinhole: k1 k2 p1 p2 k3 of OpenCV's and ROS' `plumb_bob`. Fisheye: k1 k2 k3 k4 of OpenCV's
    /// `fisheye` and ROS' `equidistant`.
    std::array<double, 5> distortion{};
    /// Of a mirror: 0 is a plane one, 1 a parabola, between them hyperbolas.
    double mirror = 0;
    /// No direction farther from the axis has a pixel: where the lens ceases to tell directions
    /// apart, or where the record's `fov` ends the circle.
    Angle widest = Angle::degrees(90);
    /// Seen from, and to, this depth along the axis (pinhole) or distance (others), metres.
    double min_range = 0, max_range = kMaxSeen;
    double rate = 30;           ///< pictures a second
    double full_well = 10'000;  ///< electrons of a white pixel: shot noise is their square root
    double read_noise = 4;      ///< electrons, standard deviation

    /// What a camera without `range` sees: metres; say `range` in larger halls.
    static constexpr double kMaxSeen = 100;

    Camera();
    /// Puts the optical centre in the middle of the picture.
    void center();
    /// Focal length in pixels by which `side` pixels span the angle.
    [[nodiscard]] double focalFor(double side, Angle fov) const;
    /// The angle off the axis beyond which the picture of a ray moves back towards the centre.
    [[nodiscard]] Angle turningAngle() const;

    [[nodiscard]] std::size_t pixels() const {
        return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    }
    [[nodiscard]] bool isDistorted() const { return distortion != std::array<double, 5>{}; }
    /// A pinhole without distortion: its field of view is a pyramid.
    [[nodiscard]] bool isStraight() const { return lens == Lens::Pinhole && !isDistorted(); }
    /// The direction of a place in the picture, of unit length; nothing where the lens shows none,
    /// as beyond the circle of a fisheye.
    [[nodiscard]] std::optional<Vec3> ray(PixelPoint place) const;
    /// The place of a direction (of any length, in its frame), on the picture or beside it; nothing
    /// where it has none.
    [[nodiscard]] std::optional<PixelPoint> project(Vec3 direction) const;
    /// True for places on the picture, the outer edges of its pixels included.
    [[nodiscard]] bool holds(PixelPoint place) const {
        return place.column >= -0.5 && place.column <= columns - 0.5 && place.row >= -0.5 &&
               place.row <= rows - 0.5;
    }
    /// Fields of view: between the rays of the middles of opposite edges.
    [[nodiscard]] Angle fovX() const;
    [[nodiscard]] Angle fovY() const;
    /// No direction in the picture is farther from the axis.
    [[nodiscard]] Angle widestInPicture() const;

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    [[nodiscard]] std::size_t rays() const { return pixels(); }
    /// True if every place on the border of the picture has a ray.
    [[nodiscard]] bool fillsPicture() const;
    /// True if distortion differs about the axis (p1, p2).
    [[nodiscard]] bool isLopsided() const {
        return lens == Lens::Pinhole && (distortion[2] != 0 || distortion[3] != 0);
    }
    /// True if its whole circle is in the picture and it faces straight up or down.
    [[nodiscard]] bool isOmnidirectional(const Pose3& mount) const;
    friend bool operator==(const Camera&, const Camera&) = default;
};

/// Width and height of an image sensor in metres: of `5.37,3.02mm`, or of a format such as
/// `1/2.8"` or `2/3"` with square pixels. An inch of format is 16 mm of diagonal from half an inch
/// on, 18 mm below, as makers count. Nothing if the text is neither.
std::optional<Vec2> imageSensorSize(const std::string& text, int columns, int rows);

/// Parameters of a `camera` record: its explicit keys, else its model's, else the bare camera's.
/// The focal length follows from `fov` (square pixels without its second number), from `focal` and
/// `sensor`, or from `fx` (fy is the same without its own); `pixels` alone keeps the field of view
/// across and square pixels, or the whole circle. \throws FormatError with all findings
Camera cameraOf(const Record& record, const Record* device = nullptr);
Camera withParameters(Camera base, const Record& record);

/// Pixels a metre that a task needs on a person (EN 62676-4).
struct PixelDensity {
    std::string_view name;
    double pixels_per_metre = 0;
};
/// The classes of the standard, the coarsest first.
std::span<const PixelDensity> pixelDensities();
/// Of a number or of a class, in either spelling of `recognise`; nothing for other text. \see
/// pixelDensities
std::optional<double> pixelDensityOf(std::string_view text);

/// How far it sees with this many pixels a metre, as `max_range` counts: the focal length in pixels
/// over the density. \pre pixels_per_metre > 0
double rangeOf(const Camera& camera, double pixels_per_metre);
/// A camera that sees no farther than that; 0 pixels a metre change nothing.
Camera withDensity(Camera camera, double pixels_per_metre);

/// What it sees at a pose if nothing is in the way.
FieldOfView fieldOfView(const Camera& camera, const Pose3& pose);

struct SensorKind;
extern const SensorKind kCameraKind;

}  // namespace ispace
