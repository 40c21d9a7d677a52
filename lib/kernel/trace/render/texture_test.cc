// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/render/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "support/test_folder.h"
#include "support/test_layout.h"
#include "support/test_png.h"
#include "trace/render/render.h"

namespace ispace {
namespace texture_test {

using testing::scene;

/// A folder for the pictures of one test.
class TextureTest : public ::testing::Test {
  protected:
    std::string write(const std::string& name, const std::string& bytes) const {
        const std::string path = folder_.file(name);
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    }
    /// What is said about a cube with this texture.
    static std::string errorOf(const std::string& file) {
        try {
            const RenderScene prepared(scene("ispace size=4,4\ncube texture=" + file + "\n"));
        } catch (const FormatError& error) {
            return error.what();
        }
        return "";
    }

  private:
    testing::TestFolder folder_;
};

ColorPicture picture(int width, int height, const std::vector<std::uint8_t>& greys) {
    ColorPicture out{width, height, {}};
    for (const std::uint8_t grey : greys)
        for (const std::uint8_t value : {grey, grey, grey, std::uint8_t{255}})
            out.rgba.push_back(value);
    return out;
}

TEST_F(TextureTest, PixelsHaveTheirColourInTheirMiddle) {
    const Texture texture(picture(2, 2, {255, 0, 0, 255}));
    const auto grey = [&](double u, double v) { return texture.at(u, v, {})[0]; };
    EXPECT_FLOAT_EQ(grey(0.25, 0.25), 1);
    EXPECT_FLOAT_EQ(grey(0.75, 0.25), 0);
    EXPECT_FLOAT_EQ(grey(0.25, 0.75), 0);
    EXPECT_FLOAT_EQ(grey(0.5, 0.5), 0.5);
    EXPECT_FLOAT_EQ(grey(0.5, 0.25), 0.5);
    // Up to the edge, and beyond it, the outermost colour.
    EXPECT_FLOAT_EQ(grey(0, 0), 1);
    EXPECT_FLOAT_EQ(grey(-3, 0.1), 1);
    EXPECT_FLOAT_EQ(grey(1, 0), 0);
}

TEST_F(TextureTest, ClearPixelsShowWhatIsBehind) {
    ColorPicture clear = picture(1, 1, {255});
    clear.rgba[3] = 0;
    EXPECT_EQ(Texture(clear).at(0.5, 0.5, {0.25F, 0.5F, 0.75F}), (Rgb{0.25F, 0.5F, 0.75F}));
}

/// Brightness of what a viewer at `from` sees at `at`.
float seen(const RenderScene& scene, Point3 from, Point3 at) {
    Camera camera;
    camera.columns = camera.rows = 4;
    camera.cx = camera.cy = 1.5;
    camera.fx = camera.fy = 1e5;
    const Vec3 way = at - from;
    const Pose3 pose{
        from, directionOf(way.x, way.y), directionOf(std::hypot(way.x, way.y), way.z), {}};
    RenderOptions options;
    options.samples = 1;
    const Rendering picture = render(scene, CameraView(camera, pose), options);
    return picture.radiance[5][1];
}

TEST_F(TextureTest, LiesEdgeToEdgeAndUprightOnBothSidesOfAWall) {
    // White only in its upper left quarter.
    const std::string file = write("quarter.pgm", "P2\n2 2\n255\n255 0\n0 0\n");
    for (const char* thickness : {"0", "0.2"}) {
        const Scene room = scene("ispace size=8,8\nwall from=-1,0 to=1,0 height=2 thickness=" +
                                 std::string(thickness) + " texture=" + file + "\n");
        const RenderScene prepared(room);
        const double half = std::stod(thickness) / 2;
        for (const double side : {-1.0, 1.0}) {
            const Point3 eye{0, 3 * side, 1};
            const auto at = [&](double left, double z) {
                // Left of the viewer: -x from the south, +x from the north.
                return seen(prepared, eye, {side * left, side * half, z});
            };
            EXPECT_GT(at(0.98, 1.98), 0.2F);
            EXPECT_GT(at(0.6, 1.6), 0.2F);
            for (const auto& [left, z] : {std::pair(-0.6, 1.6), {-0.98, 1.98}, {0.6, 0.4}})
                EXPECT_LT(at(left, z), 0.01F) << side << ' ' << left << ' ' << z;
        }
    }
}

TEST_F(TextureTest, LiesOnFloorsCubesAndScreens) {
    const std::string file = write("quarter.pgm", "P2\n2 2\n255\n255 0\n0 0\n");
    const Scene room =
        scene("ispace size=8,8\nfloor at=-2,0 size=2,1 heading=90 kind=checker texture=" + file +
              "\ncube at=0,0 size=1 texture=" + file +
              "\nscreen at=2,2.5 size=2,0.4,2 texture=" + file + "\n");
    const RenderScene prepared(room);
    // On the floor the upper left quarter is behind, to the left.
    EXPECT_GT(seen(prepared, {-2, 0, 5}, {-2.25, -0.5, 0}), 0.2F);
    EXPECT_LT(seen(prepared, {-2, 0, 5}, {-2.25, 0.5, 0}), 0.01F);
    EXPECT_LT(seen(prepared, {-2, 0, 5}, {-1.75, -0.5, 0}), 0.01F);
    // Four sides, and the top.
    for (const Vec2 to : {Vec2{1, 0}, Vec2{0, 1}, Vec2{-1, 0}, Vec2{0, -1}}) {
        const Point3 eye{1.2 * to.x, 1.2 * to.y, 0.5};
        const Vec2 left{to.y, -to.x};
        const auto at = [&](double aside, double z) {
            return seen(prepared, eye, {to.x / 2 + aside * left.x, to.y / 2 + aside * left.y, z});
        };
        EXPECT_GT(at(0.25, 0.75), 0.1F);
        EXPECT_LT(at(-0.25, 0.75), 0.01F);
        EXPECT_LT(at(0.25, 0.25), 0.01F);
    }
    EXPECT_GT(seen(prepared, {0, 0, 4}, {-0.25, 0.25, 1}), 0.2F);
    EXPECT_LT(seen(prepared, {0, 0, 4}, {0.25, 0.25, 1}), 0.01F);
    for (const double side : {-1.0, 1.0}) {
        EXPECT_GT(seen(prepared, {2, 2.5 + side, 1.2}, {2 + 0.5 * side, 2.5 + 0.01 * side, 1.6}),
                  0.2F);
        EXPECT_LT(seen(prepared, {2, 2.5 + side, 1.2}, {2 - 0.5 * side, 2.5 + 0.01 * side, 1.6}),
                  0.01F);
    }
}

TEST_F(TextureTest, EdgesAreWhereTheCameraSeesThem) {
    const std::string file = write("halves.pgm", "P2\n2 1\n255\n255 0\n");
    const Scene room =
        scene("ispace size=8,8\nwall from=0.3,1 to=1.7,-1.2 height=2 texture=" + file + "\n");
    const RenderScene prepared(room);
    // Across the line between both pixels, bilinear: half as bright as the mean of a little left
    // and right of it.
    const Point3 eye{-2.5, -0.4, 1.3};
    const auto at = [&](double offset) {
        const double share = 0.5 + offset;
        return static_cast<double>(seen(prepared, eye, {0.3 + share * 1.4, 1 - share * 2.2, 1}));
    };
    for (const double offset : {0.02, 0.1, 0.2})
        EXPECT_NEAR(at(offset) + at(-offset), 2 * at(0), 0.05 * at(0));
}

TEST_F(TextureTest, WhatCannotBeReadIsSaidWithItsPlace) {
    EXPECT_EQ(errorOf("nowhere.png"),
              "room.env:3:14: error: texture `nowhere.png` cannot be opened: No such file or "
              "directory");
    EXPECT_NE(errorOf(write("text.png", "no picture")).find(": not a picture"), std::string::npos);
    EXPECT_NE(errorOf("/dev/zero").find(": not a regular file"), std::string::npos);
    // A bomb: little more than its header says 2.5 gigapixels.
    const std::string header =
        bigEndian32(50'000) + bigEndian32(50'000) + std::string("\x08\x02\0\0\0", 5);
    const std::string bomb = "\x89PNG\r\n\x1a\n" + pngChunk("IHDR", header) +
                             pngChunk("IDAT", stored("")) + pngChunk("IEND", "");
    EXPECT_NE(errorOf(write("bomb.png", bomb)).find("50000 x 50000 pixels, wanted at most"),
              std::string::npos);
}

}  // namespace texture_test
}  // namespace ispace
