// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of projectors.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "support/test_folder.h"
#include "support/test_layout.h"
#include "trace/render/render.h"

namespace ispace {
namespace thrown_light_test {

constexpr int kSize = 80;

/// Renders the wall at x = 4 from 4 metres: a pixel is 5 cm wide, the middle of the picture is at
/// y = 0 and z = 1.5.
std::vector<Rgb> wallOf(const std::string& records, const std::string& layout = "") {
    const Scene room =
        testing::scene("ispace size=8,12 height=3 ceiling=yes\nlamp at=-3,0\n" + records, layout);
    const OrthographicView view({{0.01, 0, 1.5}, {}, {}, {}}, 4, kSize, kSize);
    return render(RenderScene(room), view).radiance;
}

float at(const std::vector<Rgb>& picture, double y, double z) {
    const auto column = static_cast<std::size_t>(std::lround(kSize / 2.0 - 0.5 - y / 0.05));
    const auto row = static_cast<std::size_t>(std::lround(kSize / 2.0 - 0.5 - (z - 1.5) / 0.05));
    return picture[row * kSize + column][1];
}

// 3 metres before the wall, level: 2 * 3 * tan(15 deg) = 1.608 m by 2 * 3 * tan(10 deg) = 1.058 m.
const std::string kProjector = "projector id=p at=1,0 height=1.5 fov=30,20 lumens=1000 on=yes";

TEST(ThrownLight, IsAQuadrilateralOnTheWall) {
    const auto dark = wallOf(""), lit = wallOf(kProjector + '\n');
    std::vector<float> inside;
    for (const double y : {-0.7, -0.3, 0.0, 0.7})
        for (const double z : {1.05, 1.5, 1.95}) inside.push_back(at(lit, y, z) - at(dark, y, z));
    // Even over the wall: lumens over its area, for the wall's own colour.
    for (const float more : inside) {
        EXPECT_GT(more, 0.3F);
        EXPECT_NEAR(more, inside.front(), 0.02F);
    }
    for (const auto& [y, z] : {std::pair(-0.9, 1.5), {0.9, 1.5}, {0, 2.15}, {0, 0.85}})
        EXPECT_NEAR(at(lit, y, z), at(dark, y, z), 1e-6F) << y << ' ' << z;
    // Half the light, and another colour.
    const auto half = wallOf(kProjector + " level=50% color=1,0.5,0\n");
    EXPECT_NEAR(at(half, 0, 1.5) - at(dark, 0, 1.5), inside.front() / 4, 0.01F);
    EXPECT_EQ(wallOf("projector at=1,0 height=1.5 fov=30,20\n"), dark) << "off";
}

TEST(ThrownLight, TurnsByPanAndTilt) {
    const auto dark = wallOf("");
    const double aside = 3 * std::tan(15 * std::acos(-1) / 180);
    const auto left = wallOf(kProjector + " pan=15\n");
    EXPECT_GT(at(left, aside, 1.5) - at(dark, aside, 1.5), 0.3F);
    EXPECT_GT(at(left, 1.6, 1.5) - at(dark, 1.6, 1.5), 0.2F);
    EXPECT_NEAR(at(left, -0.1, 1.5), at(dark, -0.1, 1.5), 1e-6F);
    const auto same = wallOf(kProjector + " heading=5 pan=10\n");
    for (const double y : {0.3, 0.8, 1.5}) EXPECT_NEAR(at(left, y, 1.4), at(same, y, 1.4), 1e-5F);
    const auto up = wallOf(kProjector + " tilt=15\n");
    EXPECT_GT(at(up, 0, 1.5 + aside) - at(dark, 0, 1.5 + aside), 0.3F);
    EXPECT_NEAR(at(up, 0, 1.4), at(dark, 0, 1.4), 1e-6F);
}

TEST(ThrownLight, BodiesCastShadows) {
    const std::string post = "cylinder at=2,0.3 size=0.2,0.2,2.9\n";
    const auto dark = wallOf(post), lit = wallOf(post + kProjector + '\n');
    // The shadow of the post, three times as far from the lens, lies at y = 0.9; the picture ends
    // before. With the lens before the post, nearer the middle.
    const std::string near = "cylinder at=2,0.1 size=0.1,0.1,2.9\n";
    const auto near_dark = wallOf(near), near_lit = wallOf(near + kProjector + '\n');
    EXPECT_NEAR(at(near_lit, 0.3, 1.2), at(near_dark, 0.3, 1.2), 1e-6F);
    EXPECT_GT(at(near_lit, 0.6, 1.2) - at(near_dark, 0.6, 1.2), 0.3F);
    EXPECT_GT(at(lit, 0, 1.2) - at(dark, 0, 1.2), 0.3F);
    const std::string person = "human at=2,0 height=1.7\n";
    const auto alone = wallOf("", person), beside = wallOf(kProjector + '\n', person);
    EXPECT_NEAR(at(beside, 0.5, 1.05), at(alone, 0.5, 1.05), 1e-6F) << "the shadow";
    EXPECT_GT(at(beside, 0, 1.5), at(alone, 0, 1.5)) << "the head";
}

TEST(ThrownLight, IsAPictureThatThePeopleInTheRoomCanRead) {
    const testing::TestFolder folder;
    const std::string file = folder.file("quarter.pgm");
    // The upper left pixel is white, the others black.
    std::ofstream(file) << "P2\n2 2\n255\n255 0\n0 0\n";
    const auto dark = wallOf(""), lit = wallOf(kProjector + " texture=\"" + file + "\"\n");
    const auto more = [&](double y, double z) { return at(lit, y, z) - at(dark, y, z); };
    EXPECT_GT(more(0.7, 1.9), 0.3F) << "left, as one sees it from the projector";
    EXPECT_NEAR(more(-0.7, 1.9), 0, 0.01F);
    EXPECT_NEAR(more(0.7, 1.1), 0, 0.01F);
    EXPECT_THROW(wallOf(kProjector + " texture=nowhere.png\n"), FormatError);
    EXPECT_THROW(wallOf("projector texture=nowhere.png\n"), FormatError) << "off";
}

}  // namespace thrown_light_test
}  // namespace ispace
