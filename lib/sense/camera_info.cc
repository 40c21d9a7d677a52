// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <initializer_list>

#include "base/json_writer.h"
#include "base/number.h"
#include "sense/depth_picture.h"
#include "sense/float_text.h"

namespace ispace {

namespace {

void appendMatrix(std::string& out, std::string_view key, int rows, int columns,
                  std::initializer_list<double> data) {
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

}  // namespace

std::string cameraInfoYaml(const Ranger& ranger, std::string_view name) {
    const double fx = nineDecimals(ranger.fx()), fy = nineDecimals(ranger.fy());
    const double cx = ranger.cx(), cy = ranger.cy();
    std::string out =
        "# Pixel centres are whole numbers: the middle of the picture is (columns - 1) / 2.\n";
    out.append("image_width: ").append(std::to_string(ranger.columns));
    out.append("\nimage_height: ").append(std::to_string(ranger.rows));
    // A string of JSON is one of YAML.
    out.append("\ncamera_name: ").append(JsonWriter().value(name).text()).append("\n");
    appendMatrix(out, "camera_matrix", 3, 3, {fx, 0, cx, 0, fy, cy, 0, 0, 1});
    out += "distortion_model: plumb_bob\n";
    appendMatrix(out, "distortion_coefficients", 1, 5, {0, 0, 0, 0, 0});
    appendMatrix(out, "rectification_matrix", 3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1});
    appendMatrix(out, "projection_matrix", 3, 4, {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0});
    return out;
}

}  // namespace ispace
