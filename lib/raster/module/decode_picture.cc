// SPDX-License-Identifier: GPL-3.0-or-later
// A module of its own: linked into the programs, OpenCV's imgcodecs would draw in 140 libraries and
// cost 59 ms at each start.
#include <fcntl.h>
#include <unistd.h>

#include <exception>
#include <limits>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>

#include "raster/module/decoded_picture.h"

namespace ispace {

namespace {

/// Keeps standard error shut: libjpeg and others write warnings there, whatever OpenCV's log level.
class Silence {
  public:
    Silence() : kept_(::dup(STDERR_FILENO)) {
        if (const int null = ::open("/dev/null", O_WRONLY | O_CLOEXEC); null >= 0) {
            ::dup2(null, STDERR_FILENO);
            ::close(null);
        }
    }
    ~Silence() {
        if (kept_ < 0) return;
        ::dup2(kept_, STDERR_FILENO);
        ::close(kept_);
    }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;

  private:
    int kept_;
};

cv::Mat decode(const std::uint8_t* bytes, std::size_t size) {
    const Silence silence;
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    if (size > std::numeric_limits<int>::max()) return {};
    // OpenCV takes what it does not write to as an array that it could.
    const cv::Mat file(1, static_cast<int>(size), CV_8UC1, const_cast<std::uint8_t*>(bytes));
    return cv::imdecode(file, cv::IMREAD_UNCHANGED);
}

void take(const cv::Mat& image, DecodedPicture& out) {
    if (image.empty()) {
        out.error = "OpenCV cannot decode it";
        return;
    }
    if (image.depth() != CV_8U && image.depth() != CV_16U) {
        out.error = "its samples are no whole numbers of 8 or 16 bits";
        return;
    }
    out.channels = image.channels();
    if (out.channels != 1 && out.channels != 3 && out.channels != 4) {
        out.error = "it has " + std::to_string(out.channels) + " channels, wanted 1, 3 or 4";
        return;
    }
    cv::Mat bytes;
    image.convertTo(bytes, CV_8U, image.depth() == CV_16U ? 1.0 / 257 : 1.0);
    out.width = bytes.cols;
    out.height = bytes.rows;
    const std::size_t row = static_cast<std::size_t>(bytes.cols) * bytes.elemSize();
    out.samples.reserve(row * static_cast<std::size_t>(bytes.rows));
    for (int y = 0; y < bytes.rows; ++y)
        out.samples.insert(out.samples.end(), bytes.ptr(y), bytes.ptr(y) + row);
}

void encode(JpegPicture& picture) {
    constexpr int kMax = 65500;
    if (picture.width > kMax || picture.height > kMax) {
        picture.error = "a JPEG is at most 65500 pixels wide and high";
        return;
    }
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    // OpenCV has blue first.
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

extern "C" __attribute__((visibility("default"))) void ispaceDecodePicture(
    const std::uint8_t* bytes, std::size_t size, DecodedPicture& out) {
    try {
        take(decode(bytes, size), out);
    } catch (const std::exception& error) {  // cv::Exception is one
        out.error = error.what();
    }
}

extern "C" __attribute__((visibility("default"))) void ispaceEncodeJpeg(JpegPicture& picture) {
    try {
        encode(picture);
    } catch (const std::exception& error) {
        picture.error = error.what();
    }
}

}  // namespace ispace
