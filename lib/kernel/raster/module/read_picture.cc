// SPDX-License-Identifier: GPL-3.0-or-later
// read-picture PARENT SIZE MEMORY SECONDS: decodes the picture on standard input with OpenCV and
// writes the answer to the socket on standard output, see base/confined.h and
// raster/module/decoded_picture.h. Started by raster/picture.cc alone.
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <opencv2/core/utility.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>

#include "base/module/confine.h"
#include "raster/module/decoded_picture.h"
#include "raster/picture.h"

namespace {

using namespace ispace;

cv::Mat decoded(std::size_t size) {
    const MappedInput input(size);
    if (size > std::numeric_limits<int>::max()) return {};
    // OpenCV requires a mutable array, although it only reads it.
    const cv::Mat file(1, static_cast<int>(size), CV_8UC1, const_cast<char*>(input.bytes().data()));
    return cv::imdecode(file, cv::IMREAD_UNCHANGED);
}

std::string packed(const cv::Mat& image) {
    if (image.empty()) throw std::runtime_error("OpenCV cannot decode it");
    if (image.depth() != CV_8U && image.depth() != CV_16U)
        throw std::runtime_error("its samples are no whole numbers of 8 or 16 bits");
    const int channels = image.channels();
    if (channels != 1 && channels != 3 && channels != 4)
        throw std::runtime_error("it has " + std::to_string(channels) +
                                 " channels, wanted 1, 3 or 4");
    cv::Mat bytes;
    image.convertTo(bytes, CV_8U, image.depth() == CV_16U ? 1.0 / 257 : 1.0);
    const PackedHead head{bytes.cols, bytes.rows, channels};
    const std::size_t row = static_cast<std::size_t>(bytes.cols) * bytes.elemSize();
    std::string out;
    out.reserve(sizeof head + row * static_cast<std::size_t>(bytes.rows));
    out.append(reinterpret_cast<const char*>(head.data()), sizeof head);
    for (int y = 0; y < bytes.rows; ++y)
        out.append(reinterpret_cast<const char*>(bytes.ptr(y)), row);
    return out;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 7) return 2;
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    cv::setNumThreads(1);
    // A file may contain many pictures, one after another.
    const ConfinedLimits most{pictureLimits(kMaxDecodedPixels).memory, SIZE_MAX};
    return runConfined(argc, argv, most,
                       [](std::size_t size, Budget& /*work*/) { return packed(decoded(size)); });
}
