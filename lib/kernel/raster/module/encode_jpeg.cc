// SPDX-License-Identifier: GPL-3.0-or-later
// The JPEG encoder, in a separate module: linked into the programs, OpenCV's imgcodecs would load
// 140 libraries and cost 59 ms at each start.
#include <exception>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>

#include "raster/module/decoded_picture.h"

namespace ispace {

namespace {

void encode(JpegPicture& picture) {
    constexpr int kMax = 65500;
    if (picture.width > kMax || picture.height > kMax) {
        picture.error = "a JPEG is at most 65500 pixels wide and high";
        return;
    }
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    // OpenCV stores blue first.
    cv::Mat image(picture.height, picture.width, CV_8UC3);
    const std::uint8_t* from = picture.samples;
    for (int y = 0; y < image.rows; ++y) {
        auto* to = image.ptr(y);
        for (int x = 0; x < image.cols; ++x, from += 3, to += 3) {
            to[0] = from[2];
            to[1] = from[1];
            to[2] = from[0];
        }
    }
    if (!cv::imencode(".jpg", image, picture.bytes, {cv::IMWRITE_JPEG_QUALITY, picture.quality}))
        picture.error = "OpenCV cannot encode it";
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void ispaceEncodeJpeg(JpegPicture& picture) {
    try {
        encode(picture);
    } catch (const std::exception& error) {
        picture.error = error.what();
    }
}

}  // namespace ispace
