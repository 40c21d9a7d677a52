// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures: PGM and PNG, and JPEG, BMP, TIFF, WebP, PBM and PPM through OpenCV, in grey and in
// colour. Colours are written as PNG and read again unchanged.
#include <algorithm>

#include "base/confined.h"
#include "fuzz.h"
#include "raster/codec.h"
#include "raster/picture.h"

namespace {

using namespace ispace;

std::size_t pixelsOf(int width, int height) {
    fuzz::require(width > 0 && height > 0, "a picture without pixels");
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

void tryGrey(std::string_view bytes) {
    const GreyPicture picture = parsePicture(bytes, "picture");
    const std::size_t pixels = pixelsOf(picture.width, picture.height);
    fuzz::require(picture.samples.size() == pixels, "samples and pixels differ in number");
    fuzz::require(picture.opacity.empty() || picture.opacity.size() == pixels,
                  "opacity and pixels differ in number");
    fuzz::require(std::all_of(picture.samples.begin(), picture.samples.end(),
                              [&](int sample) { return sample <= picture.max_value; }),
                  "a sample is lighter than white");
}

void tryColors(std::string_view bytes) {
    ConfinedReader reader;
    const ColorPicture picture = parseColorPicture(bytes, "picture", reader);
    const std::size_t pixels = pixelsOf(picture.width, picture.height);
    fuzz::require(picture.rgba.size() == 4 * pixels, "bytes and pixels differ in number");
    std::vector<std::uint32_t> shades(pixels);
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t channel = 0; channel < 3; ++channel)
            shades[i] = shades[i] << 8U | picture.rgba[4 * i + channel];
    const std::string png = pngOfShades(picture.width, picture.height, shades);
    const ColorPicture again = parseColorPicture(png, "again.png", reader);
    for (std::size_t i = 0; i < pixels; ++i)
        fuzz::require(std::equal(&again.rgba[4 * i], &again.rgba[4 * i] + 3, &picture.rgba[4 * i]),
                      "another colour after writing and reading");
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    if (!isPicture(bytes)) return;
    try {
        tryGrey(bytes);
    } catch (const FormatError&) {
        // Colours have other bounds.
    }
    tryColors(bytes);
}
