// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras: from directions to pixels and back, by three lens models.
//
// Pinholes with distortion (D. C. Brown, Decentering distortion of lenses, 1966), fisheyes (J.
// Kannala, S. S. Brandt, A generic camera model and calibration method for conventional,
// wide-angle, and fish-eye lenses, 2006), cameras under mirrors (C. Geyer, K. Daniilidis, A
// unifying theory for central panoramic systems and practical implications, 2000). Coefficients are
// those of OpenCV and ROS.
//
// project() is a closed form. ray() inverts it: in closed form for straight pinholes and mirrors;
// by Newton's method for the others, until the point of the picture's plane is off by less than
// 1e-14 focal lengths of a pinhole, or the angle of a fisheye no longer changes. Both are empty
// beyond `widest`, where the projection folds. O(1), without allocation; thread-safe.
//
//     const Camera camera;                           // 640 x 480 pixels, 45 degrees across
//     const auto pixel = camera.project({2, 0.1, -0.2});
//     const auto ray = camera.ray(*pixel);           // that direction, of unit length
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

struct SensorKind;

/// The projection of directions to points of the picture.
enum class Lens {
    Pinhole,  ///< tan of the angle to the axis, with distortion `plumb_bob` (Brown, Conrady)
    Fisheye,  ///< a polynomial of that angle (Kannala and Brandt 2006); equidistant without
    Mirror,   ///< a camera under a curved mirror, by the unified sphere (Geyer and Daniilidis 2000)
};

/// A point in a picture: pixel centres are whole numbers, (0, 0) is the upper left one, as in
/// OpenCV and ROS.
struct PixelPoint {
    double column = 0, row = 0;
};

/// A camera. In its frame (x forward, y left, z up) it maps a direction (x, y, z) at the axis x to
/// the pixel (cx + fx u, cy + fy v), where (u, v) is (-y/x, -z/x) distorted by the lens: OpenCV's
/// optical frame is (-y, -z, x). For Fisheye and Mirror the axis is the centre of the image circle.
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
    /// Directions farther from the axis have no pixel: beyond it the projection ceases to be
    /// injective, or the record's `fov` ends the circle.
    Angle widest = Angle::degrees(90);
    /// Limits of the depth along the axis (pinhole) or distance (others), metres.
    double min_range = 0, max_range = kMaxSeen;
    /// Pixels a metre that points in view have at least, by LensResolution; 0 for any.
    double least_density = 0;
    double rate = 30;           ///< pictures a second
    double full_well = 10'000;  ///< electrons of a white pixel: shot noise is their square root
    double read_noise = 4;      ///< electrons, standard deviation

    /// Range of a camera without `range`, in metres; larger halls require `range`.
    static constexpr double kMaxSeen = 100;

    Camera();
    /// Moves the optical centre to the middle of the picture.
    void center();
    /// Computes the focal length in pixels by which `side` pixels span the angle.
    [[nodiscard]] double focalFor(double side, Angle fov) const;
    /// Returns the angle off the axis beyond which the picture of a ray moves back towards the
    /// centre, of radial distortion, to some 1e-7 rad. Looks at 2048 angles: a narrower fold is
    /// missed.
    [[nodiscard]] Angle turningAngle() const;

    [[nodiscard]] std::size_t pixels() const {
        return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    }
    [[nodiscard]] bool isDistorted() const { return distortion != std::array<double, 5>{}; }
    /// Returns true for a pinhole without distortion: its field of view is a pyramid.
    [[nodiscard]] bool isStraight() const { return lens == Lens::Pinhole && !isDistorted(); }
    /// Computes the direction of a pixel as a unit vector; empty outside the lens, as beyond the
    /// circle of a fisheye.
    [[nodiscard]] std::optional<Vec3> ray(PixelPoint place) const;
    /// Projects a direction (of any length, in its frame) to the picture or beside it; empty if the
    /// lens does not see it.
    [[nodiscard]] std::optional<PixelPoint> project(Vec3 direction) const;
    /// Returns true for points on the picture, including the outer edges of its pixels.
    [[nodiscard]] bool holds(PixelPoint place) const {
        return place.column >= -0.5 && place.column <= columns - 0.5 && place.row >= -0.5 &&
               place.row <= rows - 0.5;
    }
    /// Computes the field of view between the rays of the middles of opposite edges.
    [[nodiscard]] Angle fovX() const;
    [[nodiscard]] Angle fovY() const;
    /// Returns the greatest angle off the axis in the picture: by its corners, with a slack of 1 %
    /// of the tangent; `widest` if a corner has no ray or lies 90 degrees or more off the axis.
    [[nodiscard]] Angle widestInPicture() const;

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    [[nodiscard]] std::size_t rays() const { return pixels(); }
    /// Returns true if every point on the border of the picture has a ray; tests 257 on each side.
    [[nodiscard]] bool fillsPicture() const;
    /// Returns true if distortion is not radially symmetric (p1, p2).
    [[nodiscard]] bool isLopsided() const {
        return lens == Lens::Pinhole && (distortion[2] != 0 || distortion[3] != 0);
    }
    /// The noise of light is always there.
    [[nodiscard]] static bool isNoisy() { return true; }
    /// Returns true if its whole circle is in the picture and it faces straight up or down.
    [[nodiscard]] bool isOmnidirectional(const Pose3& mount) const;
    static const SensorKind kKind;
    friend bool operator==(const Camera&, const Camera&) = default;
};

/// Parses the width and height of an image sensor in metres: `5.37,3.02mm`, or a format such as
/// `1/2.8"` or `2/3"` with square pixels. By the makers' convention an inch of format is 16 mm of
/// diagonal from half an inch on, 18 mm below. Empty for other text.
std::optional<Vec2> imageSensorSize(const std::string& text, int columns, int rows);

/// Returns `base` with the parameters that a `camera` record writes; the model stays. The focal
/// length follows from `fov` (square pixels without its second number), from `focal` and `sensor`,
/// or from `fx` (fy defaults to it); `pixels` alone keeps the horizontal field of view and square
/// pixels, or the whole circle. \throws FormatError with all findings
Camera withParameters(Camera base, const Record& record);

/// Pixels per metre that a task requires on a person.
struct PixelDensity {
    std::string_view name;
    double pixels_per_metre = 0;
};
/// The classes of EN 62676-4:2015, the coarsest first.
std::span<const PixelDensity> pixelDensities();
/// The levels of IEC 62676-4:2025, the coarsest first.
std::span<const PixelDensity> pixelLevels();
/// Parses a number, a class or a level, in either spelling of `recognise`, `characterise` and
/// `scrutinise`; empty for other text. \see pixelDensities, pixelLevels
std::optional<double> pixelDensityOf(std::string_view text);

/// Limits the view to the points of which the picture has at least this many pixels a metre (see
/// LensResolution); 0 keeps the view. Clips the range to the greatest at which a point of the
/// picture has them, and sets `least_density` unless that range is the same in all directions.
Camera withDensity(Camera camera, double pixels_per_metre);

/// Returns the field of view at a pose, without occlusion.
FieldOfView fieldOfView(const Camera& camera, const Pose3& pose);

}  // namespace ispace
