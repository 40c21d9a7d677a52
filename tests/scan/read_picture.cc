// SPDX-License-Identifier: GPL-3.0-or-later
// For tests: prints pictures and camera files as other libraries read them.
//
//     read_picture depth FILE.png     COLUMNS ROWS BITS CHANNELS, then the samples, one a line
//     (OpenCV) read_picture camera FILE.yaml   KEY VALUE… for each key (yaml-cpp)
#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <string>

namespace {

int readDepth(const std::string& file) {
    const cv::Mat image = cv::imread(file, cv::IMREAD_UNCHANGED);
    if (image.empty()) {
        std::cerr << "read_picture: OpenCV reads nothing from " << file << '\n';
        return 1;
    }
    std::cout << image.cols << ' ' << image.rows << ' ' << 8 * image.elemSize1() << ' '
              << image.channels() << '\n';
    if (image.type() != CV_16UC1) return 0;
    for (int row = 0; row < image.rows; ++row)
        for (int column = 0; column < image.cols; ++column)
            std::cout << image.at<std::uint16_t>(row, column) << '\n';
    return 0;
}

void print(const std::string& key, const YAML::Node& node) {
    if (node.IsMap()) {
        for (const auto& entry : node)
            print(key + '.' + entry.first.as<std::string>(), entry.second);
        return;
    }
    std::cout << key;
    if (node.IsScalar()) std::cout << ' ' << node.as<std::string>();
    for (const auto& item : node) std::cout << ' ' << item.as<double>();
    std::cout << '\n';
}

int readCamera(const std::string& file) {
    for (const auto& entry : YAML::LoadFile(file))
        print(entry.first.as<std::string>(), entry.second);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    std::cout.precision(12);
    if (argc == 3 && std::string(argv[1]) == "depth") return readDepth(argv[2]);
    if (argc == 3 && std::string(argv[1]) == "camera") return readCamera(argv[2]);
    std::cerr << "read_picture: wanted depth FILE.png or camera FILE.yaml\n";
    return 2;
}
