// SPDX-License-Identifier: GPL-3.0-or-later
// Files beside pictures that other programs read: depths as PNG, and camera_info. Pure functions.
//
//     writeAll("camera_info.yaml", cameraInfoYaml(cameraInfoOf(camera), "c1"));
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/sensor/sensor.h"

namespace ispace {

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
