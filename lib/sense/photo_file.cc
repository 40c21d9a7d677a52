// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "raster/encode.h"
#include "sense/photo.h"
#include "sense/reading_format.h"
#include "sense/reading_picture.h"
#include "sense/reading_text.h"

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

/// BT.601 from 0..255 to 16..235, and to 16..240 for differences; each row adds up.
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

void addFilesBeside(const Sensor& sensor, const Photo& photo, const FormatOptions& options,
                    std::vector<ReadingFile>& files) {
    const Camera& camera = sensor.as<Camera>();
    if (options.labels) {
        files.push_back({kLabels, labelPng(camera, photo)});
        files.push_back({kLabelTable, labelTable(*options.scene, photo)});
    }
    if (options.depths)
        files.push_back(
            {kDepth, depthPng(camera.columns, camera.rows, photo.depths, options.depth_per_metre)});
    files.push_back({kCameraInfo, cameraInfoYaml(camera, sensor.id)});
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

}  // namespace ispace
