// SPDX-License-Identifier: GPL-3.0-or-later
// 3-D range cameras and turning scanners: the rays of their pixels. Pure functions, O(1);
// sense/depth.h takes their pictures.
//
//     const Ranger ranger;                            // 176 x 144 pixels
//     const Vec3 axis = ranger.ray(87.5, 71.5);       // (1, 0, 0): through the optical centre
#pragma once

#include <cstddef>
#include <string>

#include "geom/pose.h"
#include "record/record.h"
#include "scene/sensor/field_of_view.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace {

struct SensorKind;

/// The ray of each pixel.
enum class Projection {
    Pinhole,    ///< a lens: equal steps in the picture's plane
    Spherical,  ///< a turning head: equal steps in bearing and elevation
};

/// A 3-D range camera or a scanner with many rings. Pixel (column, row), row 0 at the top and
/// column 0 at the left, has a ray through its centre. In the sensor's frame (x forward, y left, z
/// up) that is (1, -(column - cx) / fx, -(row - cy) / fy) of a pinhole; of a spherical one bearing
/// fov_x/2 - (column + 1/2) fov_x/columns and elevation fov_y/2 - (row + 1/2) fov_y/rows.
struct Ranger {
    std::string model;  ///< "" for the bare ranger
    Projection projection = Projection::Pinhole;
    double min_range = 0, max_range = 5;
    Angle fov_x = Angle::degrees(47.5), fov_y = Angle::degrees(39.6);
    int columns = 176, rows = 144;
    double rate = 25;  ///< pictures a second
    /// The measure of readings, limits and noise: true for the depth along the axis, false for the
    /// distance along the ray (time of flight; always for a spherical one).
    bool measures_depth = false;
    /// Distances are known up to multiples of this (phase of modulated light): a surface at
    /// ambiguity + d reads d if d is within the limits. 0: unambiguous.
    double ambiguity = 0;
    RangeNoise noise;

    [[nodiscard]] std::size_t pixels() const {
        return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    }
    /// Returns the bearing of a column or the elevation of a row. \pre a spherical one
    [[nodiscard]] Angle bearing(double column) const {
        return ((columns - 1 - 2 * column) / (2.0 * columns)) * fov_x;
    }
    [[nodiscard]] Angle elevation(double row) const {
        return ((rows - 1 - 2 * row) / (2.0 * rows)) * fov_y;
    }
    /// Returns a focal length in pixels, or the optical centre (pixel centres are whole numbers).
    /// \pre a pinhole
    [[nodiscard]] double fx() const;
    [[nodiscard]] double fy() const;
    [[nodiscard]] double cx() const { return (columns - 1) / 2.0; }
    [[nodiscard]] double cy() const { return (rows - 1) / 2.0; }
    /// Returns the ray of a pixel in the sensor's frame: of a pinhole with forward component 1, to
    /// be multiplied by a depth; of a spherical one with unit length, to be multiplied by a
    /// distance.
    [[nodiscard]] Vec3 ray(double column, double row) const;
    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    [[nodiscard]] std::size_t rays() const { return pixels(); }
    [[nodiscard]] bool isNoisy() const { return !noise.isNone(); }
    [[nodiscard]] bool isOmnidirectional(const Pose3& mount) const {
        return projection == Projection::Spherical && fov_x >= Angle::degrees(360) &&
               mount.isLevel();
    }
    static const SensorKind kKind;
    friend bool operator==(const Ranger&, const Ranger&) = default;
};

/// Returns `base` with the parameters that a `ranger` record writes; the model stays. A `fov` of
/// one number gives the other by square pixels; one number in `range` is the maximum. \throws
/// FormatError with all findings: an unknown model, min above max, a pinhole of 180 degrees or
/// more, more than kMaxPixels
Ranger withParameters(Ranger base, const Record& record);
constexpr std::size_t kMaxPixels = 1U << 26U;

/// Returns the field of view at a pose, without occlusion.
FieldOfView fieldOfView(const Ranger& ranger, const Pose3& pose);

}  // namespace ispace
