// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures as PNG and PDF, by the module that links Cairo.
#include "draw/module/painting.h"

#include <algorithm>

#include "base/error.h"
#include "base/message.h"
#include "draw/picture.h"
#include "draw/raster.h"
#include "raster/encode.h"
#include "raster/module/decoded_picture.h"
#include "raster/module_symbol.h"
#include "raster/picture.h"

namespace ispace {

namespace {

const Painting& painting() {
    static const Painting& opened = [&]() -> const Painting& {
        std::string error;
        if (const void* found = moduleSymbol("drawing.so", kPainting, error))
            return *static_cast<const Painting*>(found);
        throw FormatError(
            Diagnostic{"", 0, 0, "drawing needs Cairo (Debian: libcairo2): " + printable(error)});
    }();
    return opened;
}

std::vector<Segment2> hatchOf(const Hatch& hatch, const Picture& picture,
                              const DisplayList::Shape& shape) {
    return hatchLines(hatch, visibleBox(picture, shape));
}

}  // namespace

double textWidth(std::string_view text, const TextStyle& style) {
    return painting().text_width(printable(text), style);
}

Image rasterOf(const Picture& picture) { return painting().pixels(picture, hatchOf); }

std::string writePng(const Picture& picture) { return encodePng(rasterOf(picture)); }

std::string writePdf(const Picture& picture) { return painting().pdf(picture, hatchOf); }

std::string encodePng(const Image& image) {
    return pngOfDrawing(image.width, image.height, image.pixels,
                        static_cast<std::size_t>(image.width));
}

Image decodePng(std::string_view bytes) {
    const DecodedPicture decoded = decodePng(bytes, "");
    Image image{decoded.width, decoded.height, {}};
    const auto channels = static_cast<std::size_t>(decoded.channels);
    image.pixels.reserve(decoded.samples.size() / channels);
    for (std::size_t i = 0; i < decoded.samples.size(); i += channels) {
        const std::uint8_t* const sample = &decoded.samples[i];
        const std::uint32_t opacity = channels == 4 ? sample[3] : 255;
        std::uint32_t pixel = 0;
        for (std::size_t c = 0; c < 3; ++c) pixel = pixel << 8U | (sample[c] * opacity + 127) / 255;
        image.pixels.push_back(pixel);
    }
    return image;
}

}  // namespace ispace
