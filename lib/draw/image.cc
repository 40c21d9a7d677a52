// SPDX-License-Identifier: GPL-3.0-or-later
#include "draw/image.h"

#include <cairo.h>

#include <cstring>
#include <memory>
#include <string>

#include "base/error.h"

namespace ispace {

namespace {

/// Hands out the bytes of a string_view piece by piece.
cairo_status_t takeBytes(void* closure, unsigned char* to, unsigned int length) {
    auto& left = *static_cast<std::string_view*>(closure);
    if (left.size() < length) return CAIRO_STATUS_READ_ERROR;
    std::memcpy(to, left.data(), length);
    left.remove_prefix(length);
    return CAIRO_STATUS_SUCCESS;
}

}  // namespace

Image decodePng(std::string_view bytes) {
    const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
        cairo_image_surface_create_from_png_stream(takeBytes, &bytes), cairo_surface_destroy);
    if (const cairo_status_t status = cairo_surface_status(surface.get());
        status != CAIRO_STATUS_SUCCESS)
        throw FormatError(
            Diagnostic{"", 0, 0, std::string("no PNG: ") + cairo_status_to_string(status)});
    Image image{cairo_image_surface_get_width(surface.get()),
                cairo_image_surface_get_height(surface.get()),
                {}};
    const auto width = static_cast<std::size_t>(image.width);
    const auto height = static_cast<std::size_t>(image.height);
    image.pixels.resize(width * height);
    const unsigned char* row = cairo_image_surface_get_data(surface.get());
    for (std::size_t y = 0; y < height; ++y) {
        std::memcpy(&image.pixels[y * width], row, width * sizeof(std::uint32_t));
        row += cairo_image_surface_get_stride(surface.get());
    }
    for (std::uint32_t& pixel : image.pixels) pixel &= 0xFFFFFFU;
    return image;
}

}  // namespace ispace
