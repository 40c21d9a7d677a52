// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "base/json_writer.h"
#include "base/number.h"
#include "raster/codec.h"
#include "sense/formats/camera_info.h"
#include "sense/formats/reading_format.h"
#include "sense/formats/reading_text.h"
#include "sense/photo.h"

namespace ispace {

std::string labelPng(const Camera& camera, const Photo& photo) {
    return pngOfGrey16(camera.columns, camera.rows, photo.labels);
}

std::string labelTable(const Scene& scene, const Photo& photo) {
    std::vector<std::size_t> pixels(scene.records.size() + 1);
    for (const std::uint16_t label : photo.labels)
        if (label < pixels.size()) ++pixels[label];
    std::string out = "label,id,keyword,pixels\n";
    for (std::size_t label = 0; label < pixels.size(); ++label) {
        if (pixels[label] == 0) continue;
        out.append(std::to_string(label)).append(",");
        if (label > 0) {
            appendCsvField(out, scene.ids[label - 1]);
            out.append(",").append(scene.records[label - 1].keyword());
        } else {
            out += ',';
        }
        out.append(",").append(std::to_string(pixels[label])).append("\n");
    }
    return out;
}

void appendRgb24(std::string& out, const Photo& photo) {
    out.append(reinterpret_cast<const char*>(photo.rgb.data()), photo.rgb.size());
}

std::string y4mHeader(const Camera& camera) {
    constexpr std::int64_t kDecimals = 1'000'000;
    const std::int64_t rate = std::max<std::int64_t>(1, std::llround(camera.rate * kDecimals));
    const std::int64_t common = std::gcd(rate, kDecimals);
    return "YUV4MPEG2 W" + std::to_string(camera.columns) + " H" + std::to_string(camera.rows) +
           " F" + std::to_string(rate / common) + ":" + std::to_string(kDecimals / common) +
           " Ip A1:1 C444 XCOLORRANGE=LIMITED\n";
}

namespace {

/// A row of the matrix from red, green and blue to one channel, in steps of 2^-16.
struct ChannelOfYuv {
    int red, green, blue, offset;
};

/// BT.601 from 0..255 to 16..235, and to 16..240 for differences; the rows sum exactly.
constexpr std::array<ChannelOfYuv, 3> kBt601 = {
    {{16829, 33039, 6416, 16}, {-9714, -19071, 28785, 128}, {28785, -24103, -4682, 128}}};

}  // namespace

void appendY4mFrame(std::string& out, const Photo& photo) {
    out += "FRAME\n";
    const std::size_t begin = out.size(), pixels = photo.rgb.size() / 3;
    out.resize(begin + 3 * pixels);
    constexpr int kShift = 16, kHalf = 1 << (kShift - 1);
    for (std::size_t c = 0; c < kBt601.size(); ++c) {
        const ChannelOfYuv& by = kBt601[c];
        char* const to = out.data() + begin + c * pixels;
        for (std::size_t i = 0; i < pixels; ++i) {
            const std::uint8_t* const rgb = photo.rgb.data() + 3 * i;
            const int sum = by.red * rgb[0] + by.green * rgb[1] + by.blue * rgb[2] +
                            (by.offset << kShift) + kHalf;
            to[i] = static_cast<char>(static_cast<std::uint8_t>(sum >> kShift));
        }
    }
}

namespace {

constexpr const char *kLabels = "-labels.png", *kLabelTable = "-labels.csv", *kDepth = "-depth.png",
                     *kCameraInfo = ".yaml";

}  // namespace

void addFilesBeside(const Sensor& sensor, const SensorRoom* room, const Photo& photo,
                    const FormatOptions& options, std::vector<ReadingFile>& files) {
    const Camera& camera = sensor.as<Camera>();
    if (options.labels) {
        files.push_back({kLabels, labelPng(camera, photo)});
        files.push_back({kLabelTable, labelTable(*room->scene, photo)});
    }
    if (options.depths)
        files.push_back(
            {kDepth, depthPng(camera.columns, camera.rows, photo.depths, options.depth_per_metre)});
    files.push_back({kCameraInfo, cameraInfoYaml(cameraInfoOf(camera), sensor.id)});
}

void addEndingsBeside(const FormatOptions& options, std::vector<std::string>& endings) {
    std::vector<std::string> beside;
    if (options.labels) beside = {kLabels, kLabelTable};
    if (options.depths) beside.emplace_back(kDepth);
    beside.emplace_back(kCameraInfo);
    for (std::string& ending : beside)
        if (std::find(endings.begin(), endings.end(), ending) == endings.end())
            endings.push_back(std::move(ending));
}

namespace {

std::vector<std::uint16_t> scaled(const std::vector<float>& depths, double per_metre) {
    constexpr double kEnd = 1U << 16U;
    std::vector<std::uint16_t> samples(depths.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double units = static_cast<double>(depths[i]) * per_metre + 0.5;
        const bool fits = units >= 0 && units < kEnd;  // false for no return
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
        // Readers that infer types read 0 as an integer.
        const std::string text = formatDouble(value);
        out += text;
        if (text.find_first_of(".e") == std::string::npos) out += ".0";
    }
    out += "]\n";
}

}  // namespace

LensModel lensModelOf(const Camera& camera) {
    const std::span<const double> all(camera.distortion);
    if (camera.lens == Lens::Pinhole) return {"plumb_bob", all};
    return {camera.lens == Lens::Fisheye ? "equidistant" : "omnidir", all.first(4)};
}

CameraInfo cameraInfoOf(const Ranger& ranger) {
    static constexpr std::array<double, 5> kNoDistortion{};
    return {.columns = ranger.columns,
            .rows = ranger.rows,
            .fx = ranger.fx(),
            .fy = ranger.fy(),
            .cx = ranger.cx(),
            .cy = ranger.cy(),
            .lens = {"plumb_bob", kNoDistortion}};
}

CameraInfo cameraInfoOf(const Camera& camera) {
    return {.columns = camera.columns,
            .rows = camera.rows,
            .fx = camera.fx,
            .fy = camera.fy,
            .cx = camera.cx,
            .cy = camera.cy,
            .lens = lensModelOf(camera),
            .xi = camera.mirror};
}

std::string cameraInfoYaml(CameraInfo info, std::string_view name) {
    for (double* const value : {&info.fx, &info.fy, &info.cx, &info.cy})
        *value = nineDecimals(*value);
    // OpenCV's FileStorage requires the first two lines, ROS does not.
    std::string out =
        "%YAML 1.0\n---\n"
        "# Pixel centres are whole numbers: the middle of the picture is (columns - 1) / 2.\n";
    out.append("image_width: ").append(std::to_string(info.columns));
    out.append("\nimage_height: ").append(std::to_string(info.rows));
    // A JSON string is a YAML string, too.
    out.append("\ncamera_name: ").append(JsonWriter().value(name).text()).append("\n");
    appendMatrix(out, "camera_matrix", 3, 3, info.matrix());
    out.append("distortion_model: ").append(info.lens.name).append("\n");
    if (info.xi > 0) out.append("xi: ").append(formatDouble(info.xi)).append("\n");
    appendMatrix(out, "distortion_coefficients", 1, static_cast<int>(info.lens.coefficients.size()),
                 info.lens.coefficients);
    appendMatrix(out, "rectification_matrix", 3, 3, {{1, 0, 0, 0, 1, 0, 0, 0, 1}});
    appendMatrix(out, "projection_matrix", 3, 4, info.projection());
    return out;
}

}  // namespace ispace
