// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sense/depth.h"
#include "sense/scan.h"

namespace ispace {

// Readings as PNG pictures for people. Equal input gives equal bytes.

/// Depths of the colours at the ends of a scale, in metres. Colour is linear in depth between them
/// and constant beyond; either may be greater.
struct DepthSpectrum {
    double warm = 0, cold = 1;
};

/// Draws depths in colours, with a legend: near is warm, far is cold, no return is black. Without a
/// spectrum, the scale spans the ranger's limits (of an ambiguous one: 0 to its ambiguity), so that
/// pictures of one device are comparable.
std::string colorDepthPng(const Sensor& sensor, const DepthFrame& frame,
                          std::optional<DepthSpectrum> spectrum = std::nullopt);

/// Draws the returns of a scan as points on a polar grid (thesis fig. 3.24): the sensor at the
/// centre, bearing 0 upwards, labelled rings at round distances, a spoke every 30 degrees, the
/// field of view shaded up to max_range. `pixels` wide and high.
std::string obstacleMapPng(const Sensor& sensor, const Scan& scan, int pixels);

/// Returns `id (model), frame k`, followed by tilt and roll unless they are 0.
std::string pictureTitle(std::string_view id, std::string_view model, std::string_view kind,
                         int frame, const Pose3& pose);
/// Formats a round number of metres with its unit: "0.25 m".
std::string metres(double value);
/// Formats to a tenth of a degree, with a typographic minus sign: "−7.5°".
std::string degrees(Angle angle);

/// Writes depths as a 16-bit grey PNG in units of 1 / per_metre (1000: millimetres), rounded. 0
/// means no return, or a depth outside 16 bits.
std::string depthPng(int columns, int rows, const std::vector<float>& depths, double per_metre);

/// Lens distortion by the model names of ROS' camera_info: `plumb_bob` (k1 k2 p1 p2 k3),
/// `equidistant` (k1 k2 k3 k4), or OpenCV's `omnidir` (four zeros, with Camera::mirror as xi).
struct LensModel {
    std::string_view name;
    std::span<const double> coefficients;  ///< stored in the camera
};
LensModel lensModelOf(const Camera& camera);

/// The content of ROS' camera_info: size, focal lengths and principal point in pixels, distortion.
/// Pixel centres are integers, so cx of a ranger is (columns - 1) / 2.
struct CameraInfo {
    int columns = 0, rows = 0;
    double fx = 0, fy = 0, cx = 0, cy = 0;
    LensModel lens;
    double xi = 0;  ///< of a mirror, for the model `omnidir`

    /// Row-major camera matrix (3 x 3) and projection matrix (3 x 4).
    [[nodiscard]] std::array<double, 9> matrix() const { return {fx, 0, cx, 0, fy, cy, 0, 0, 1}; }
    [[nodiscard]] std::array<double, 12> projection() const {
        return {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0};
    }
};
/// \pre a ranger is a pinhole
CameraInfo cameraInfoOf(const Ranger& ranger);
CameraInfo cameraInfoOf(const Camera& camera);  ///< valid as long as the camera

/// Writes camera_info as YAML, which applyCalibration() reads, with nine decimals.
std::string cameraInfoYaml(CameraInfo info, std::string_view name);

}  // namespace ispace
