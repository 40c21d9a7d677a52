// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/reading_picture.h"

#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "base/json_writer.h"
#include "base/number.h"
#include "raster/encode.h"
#include "sense/float_text.h"

namespace ispace {

namespace {

std::vector<std::uint16_t> scaled(const std::vector<float>& depths, double per_metre) {
    constexpr double kEnd = 1U << 16U;
    std::vector<std::uint16_t> samples(depths.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double units = static_cast<double>(depths[i]) * per_metre + 0.5;
        const bool fits = units >= 0 && units < kEnd;  // no return does not
        samples[i] = static_cast<std::uint16_t>(static_cast<std::int32_t>(fits ? units : 0));
    }
    return samples;
}

}  // namespace

std::string depthPng(int columns, int rows, const std::vector<float>& depths, double per_metre) {
    return pngOfGrey16(columns, rows, scaled(depths, per_metre));
}

namespace {

void appendMatrix(std::string& out, std::string_view key, int rows, int columns,
                  std::span<const double> data) {
    out.append(key).append(":\n  rows: ").append(std::to_string(rows));
    out.append("\n  cols: ").append(std::to_string(columns)).append("\n  data: [");
    bool comma = false;
    for (const double value : data) {
        if (comma) out += ", ";
        comma = true;
        // Readers that guess types by the look take 0 for a whole number.
        const std::string text = formatDouble(value);
        out += text;
        if (text.find_first_of(".e") == std::string::npos) out += ".0";
    }
    out += "]\n";
}

/// What camera_info says of a picture.
struct CameraInfo {
    int columns = 0, rows = 0;
    double fx = 0, fy = 0, cx = 0, cy = 0;
    std::string model = "plumb_bob";
    std::vector<double> coefficients = {0, 0, 0, 0, 0};
    double xi = 0;  ///< of a mirror
};

std::string yamlOf(const CameraInfo& info, std::string_view name) {
    const double fx = nineDecimals(info.fx), fy = nineDecimals(info.fy);
    const double cx = nineDecimals(info.cx), cy = nineDecimals(info.cy);
    // ROS does without the first two lines; OpenCV's FileStorage does not.
    std::string out =
        "%YAML 1.0\n---\n"
        "# Pixel centres are whole numbers: the middle of the picture is (columns - 1) / 2.\n";
    out.append("image_width: ").append(std::to_string(info.columns));
    out.append("\nimage_height: ").append(std::to_string(info.rows));
    // A string of JSON is one of YAML.
    out.append("\ncamera_name: ").append(JsonWriter().value(name).text()).append("\n");
    appendMatrix(out, "camera_matrix", 3, 3, {{fx, 0, cx, 0, fy, cy, 0, 0, 1}});
    out.append("distortion_model: ").append(info.model).append("\n");
    if (info.xi > 0) out.append("xi: ").append(formatDouble(info.xi)).append("\n");
    appendMatrix(out, "distortion_coefficients", 1, static_cast<int>(info.coefficients.size()),
                 info.coefficients);
    appendMatrix(out, "rectification_matrix", 3, 3, {{1, 0, 0, 0, 1, 0, 0, 0, 1}});
    appendMatrix(out, "projection_matrix", 3, 4, {{fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0}});
    return out;
}

}  // namespace

LensModel lensModelOf(const Camera& camera) {
    const std::span<const double> all(camera.distortion);
    if (camera.lens == Lens::Pinhole) return {"plumb_bob", all};
    return {camera.lens == Lens::Fisheye ? "equidistant" : "omnidir", all.first(4)};
}

std::string cameraInfoYaml(const Ranger& ranger, std::string_view name) {
    return yamlOf({.columns = ranger.columns,
                   .rows = ranger.rows,
                   .fx = ranger.fx(),
                   .fy = ranger.fy(),
                   .cx = ranger.cx(),
                   .cy = ranger.cy()},
                  name);
}

std::string cameraInfoYaml(const Camera& camera, std::string_view name) {
    CameraInfo info{.columns = camera.columns,
                    .rows = camera.rows,
                    .fx = camera.fx,
                    .fy = camera.fy,
                    .cx = camera.cx,
                    .cy = camera.cy};
    const auto [model, coefficients] = lensModelOf(camera);
    info.model = model;
    info.coefficients.assign(coefficients.begin(), coefficients.end());
    info.xi = camera.mirror;
    return yamlOf(info, name);
}

}  // namespace ispace
