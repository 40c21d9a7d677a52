// SPDX-License-Identifier: GPL-3.0-or-later
#include "drawing/film.h"

#include <gif_lib.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "drawing/drawing.h"

namespace ispace {
namespace gif_film_test {

/// What a film shows, read by giflib.
struct Shown {
    std::vector<Image> pictures;
    std::vector<int> delays;  // hundredths of a second
    std::vector<int> areas;   // pixels that each picture holds itself
};

int takeBytes(GifFileType* gif, GifByteType* to, int size) {
    auto& left = *static_cast<std::string_view*>(gif->UserData);
    const std::size_t count = std::min(left.size(), static_cast<std::size_t>(size));
    std::memcpy(to, left.data(), count);
    left.remove_prefix(count);
    return static_cast<int>(count);
}

Shown shownBy(std::string_view bytes) {
    Shown shown;
    int error = 0;
    GifFileType* const gif = DGifOpen(&bytes, takeBytes, &error);
    EXPECT_EQ(DGifSlurp(gif), GIF_OK);
    Image image{gif->SWidth, gif->SHeight, {}};
    image.pixels.resize(static_cast<std::size_t>(image.width) *
                        static_cast<std::size_t>(image.height));
    for (int i = 0; i < gif->ImageCount; ++i) {
        const SavedImage& saved = gif->SavedImages[i];
        const GifImageDesc& part = saved.ImageDesc;
        for (int k = 0; k < part.Width * part.Height; ++k) {
            const GifColorType color = part.ColorMap->Colors[saved.RasterBits[k]];
            const auto at = static_cast<std::ptrdiff_t>(part.Top + k / part.Width) * image.width;
            image.pixels.begin()[at + part.Left + k % part.Width] =
                static_cast<std::uint32_t>(color.Red << 16 | color.Green << 8 | color.Blue);
        }
        GraphicsControlBlock control{};
        EXPECT_EQ(DGifSavedExtensionToGCB(gif, i, &control), GIF_OK);
        shown.pictures.push_back(image);
        shown.delays.push_back(control.DelayTime);
        shown.areas.push_back(part.Width * part.Height);
    }
    DGifCloseFile(gif, &error);
    return shown;
}

std::string filmOf(const std::vector<Image>& pictures, double fps) {
    GifFilm film(fps);
    std::string bytes;
    for (const Image& picture : pictures) bytes += film.add(picture);
    return bytes + film.end();
}

Image dotAt(double x) {
    Picture picture(60, 40);
    picture.circle({x, 20}, 8, {Color::rgb(0x336699)});
    return rasterOf(picture);
}

TEST(GifFilm, ShowsEachPicture) {
    const std::vector<Image> pictures{dotAt(20), dotAt(24.5), dotAt(24.5), dotAt(40)};
    const std::string bytes = filmOf(pictures, 20);
    EXPECT_EQ(bytes.substr(0, 6), "GIF89a");
    EXPECT_NE(bytes.find("NETSCAPE2.0"), std::string::npos) << "it goes round";
    EXPECT_EQ(bytes.back(), ';');
    const Shown shown = shownBy(bytes);
    ASSERT_EQ(shown.pictures.size(), pictures.size());
    for (std::size_t i = 0; i < pictures.size(); ++i)
        EXPECT_EQ(shown.pictures[i].pixels, pictures[i].pixels) << i;
    EXPECT_EQ(shown.delays, (std::vector<int>{5, 5, 5, 5}));
    EXPECT_EQ(shown.areas[0], 60 * 40);
    EXPECT_LT(shown.areas[1], 25 * 18) << "what has changed";
    EXPECT_EQ(shown.areas[2], 1);
}

TEST(GifFilm, KeepsTimeOverall) {
    const Shown shown = shownBy(filmOf(std::vector<Image>(30, dotAt(30)), 30));
    EXPECT_EQ(shown.delays[0], 3);
    EXPECT_EQ(shown.delays[1], 4);
    int sum = 0;
    for (const int delay : shown.delays) sum += delay;
    EXPECT_EQ(sum, 100) << "thirty pictures in a second";
    EXPECT_EQ(shownBy(filmOf({dotAt(1)}, GifFilm::kFastest)).delays[0], 2);
    EXPECT_EQ(shownBy(filmOf({dotAt(1)}, GifFilm::kSlowest)).delays[0], 10'000);
}

TEST(GifFilm, OfMoreColorsTheMostFrequentAreRight) {
    // Two flat halves over a row of a thousand shades.
    Image image{1000, 9, std::vector<std::uint32_t>(9000, 0x336699)};
    std::fill_n(image.pixels.begin(), 4000, 0xFFFFFFU);
    for (std::uint32_t x = 0; x < 1000; ++x) image.pixels[8000 + x] = x * 16 + (x % 7 << 16);
    const Shown shown = shownBy(filmOf({image}, 25));
    const Image& seen = shown.pictures.at(0);
    EXPECT_TRUE(std::equal(seen.pixels.begin(), seen.pixels.begin() + 8000, image.pixels.begin()));
    EXPECT_EQ((std::set<std::uint32_t>(seen.pixels.begin(), seen.pixels.end()).size()), 256U);
}

TEST(GifFilm, OnePixelOfOneColor) {
    const Image pixel{1, 1, {0x010203}};
    const Shown shown = shownBy(filmOf({pixel, pixel}, 10));
    ASSERT_EQ(shown.pictures.size(), 2U);
    EXPECT_EQ(shown.pictures[1].pixels, pixel.pixels);
}

TEST(GifFilm, RefusesWhatTheFormatCannotHold) {
    GifFilm film(25);
    const Image wide{65536, 1, std::vector<std::uint32_t>(65536)};
    EXPECT_THROW(film.add(wide), FormatError);
}

}  // namespace gif_film_test
}  // namespace ispace
