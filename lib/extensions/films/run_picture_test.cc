// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/films/run_picture.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "drawing/drawing.h"
#include "support/test_layout.h"

namespace ispace::films {
namespace run_picture_test {

const Scene& room() {
    static const Scene kScene =
        testing::scene("ispace size=8,6\n",
                       "robot id=r1 at=-3,0\nlaser on=r1\nhuman id=h1 at=0,2\nlaser at=3,2\n");
    return kScene;
}

/// r1 goes from x = -3 to 3 in 6 s and stalls; h1 walks up.
RunReader run() {
    std::string robots = "t,id,x,y,heading_deg,stall\n", people = "t,id,x,y,heading_deg\n";
    for (int i = 0; i <= 60; ++i) {
        const std::string t = std::to_string(i / 10.0);
        robots += t + ",r1," + std::to_string(-3 + i / 10.0) + ",0,0," + (i == 60 ? "1\n" : "0\n");
        people += t + ",h1,0," + std::to_string(2 - i / 100.0) + ",-90\n";
    }
    return {robots, people};
}

std::size_t pixelsLike(const Image& image, Color color) {
    const auto part = [](double share) { return static_cast<int>(255 * share + 0.5); };
    return static_cast<std::size_t>(
        std::count_if(image.pixels.begin(), image.pixels.end(), [&](std::uint32_t pixel) {
            const auto near = [pixel](unsigned shift, int value) {
                return std::abs(static_cast<int>(pixel >> shift & 255U) - value) < 3;
            };
            return near(16, part(color.red)) && near(8, part(color.green)) &&
                   near(0, part(color.blue));
        }));
}

TEST(RunPicture, ShowsWaysAndWhoIsAtTheirEnds) {
    RunReader reader = run();
    RunPicture picture(room(), {.width = 800, .title = "drive"});
    while (reader.next()) picture.add(reader);
    const std::string svg = picture.write(PictureFormat::Svg);
    for (const char* text : {"id=\"r1\"", "r1: 6.00 m", "h1: 0.60 m", "drive", "stalls"})
        EXPECT_NE(svg.find(text), std::string::npos) << text;
    const Image image = decodePng(picture.write(PictureFormat::Png));
    EXPECT_EQ(image.width, 800);
    EXPECT_GT(pixelsLike(image, seriesColor(0)), 500U) << "r1's way";
    EXPECT_GT(pixelsLike(image, palette::kSensor), 10U) << "a cross, and the sensor that stays";
    EXPECT_EQ(picture.write(PictureFormat::Svg), svg);
    EXPECT_THROW(RunPicture(room(), {.width = 100, .title = ""}), UsageError);
}

TEST(RunPicture, FilmsGoOn) {
    RunReader reader = run();
    RunPicture picture(room(), {.width = 401, .title = ""});
    std::vector<std::size_t> drawn;
    for (int i = 0; reader.next(); ++i) {
        picture.add(reader);
        if (i % 20 != 0) continue;
        const Image frame = picture.frame();
        EXPECT_EQ(frame.width, 402);
        EXPECT_EQ(frame.height % 2, 0);
        drawn.push_back(pixelsLike(frame, seriesColor(0)));
    }
    EXPECT_TRUE(std::is_sorted(drawn.begin(), drawn.end()));
    EXPECT_GT(drawn.back(), drawn.front() + 100);
}

TEST(RunPicture, NamesAsManyAsFit) {
    std::string robots = "t,id,x,y,heading_deg\n";
    for (int i = 0; i < 40; ++i) robots += "0,x" + std::to_string(i) + ",0,0,0\n";
    RunReader reader(robots, "");
    RunPicture picture(room(), {.width = 800, .title = ""});
    ASSERT_TRUE(reader.next());
    picture.add(reader);
    EXPECT_NE(picture.write(PictureFormat::Svg).find("and 16 more"), std::string::npos);
}

TEST(RasterOf, IsWhatThePngHas) {
    Picture picture(40, 30);
    picture.circle({20, 15}, 10, {Color::rgb(0x336699)});
    const Image raster = rasterOf(picture), png = decodePng(picture.write(PictureFormat::Png));
    EXPECT_EQ(raster.width, png.width);
    EXPECT_EQ(raster.height, png.height);
    EXPECT_EQ(raster.pixels, png.pixels);
    EXPECT_EQ(raster.at(20, 15), 0x336699U);
}

}  // namespace run_picture_test
}  // namespace ispace::films
