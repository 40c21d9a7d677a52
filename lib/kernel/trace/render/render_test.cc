// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/render/render.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "support/test_layout.h"
#include "trace/ray_world.h"

namespace ispace {
namespace render_test {

using testing::scene;

constexpr const char* kRoom =
    "ispace size=6,4 height=2.5\n"
    "cube id=crate at=2,0.5 size=0.6 heading=20\n"
    "table id=round at=1,-1 size=0.8\n"
    "pillar at=-1,1 kind=round\n"
    "floor at=1,0 size=3,2 kind=checker\n";

Camera camera(int columns, int rows) {
    Camera camera;
    camera.columns = columns;
    camera.rows = rows;
    camera.fx = camera.fy = 0.8 * columns;
    camera.cx = (columns - 1) / 2.0;
    camera.cy = (rows - 1) / 2.0;
    return camera;
}

const Pose3 kPose{{-2.5, -0.7, 1.4}, Angle::degrees(15), Angle::degrees(-12), Angle::degrees(3)};

std::size_t indexOf(const Scene& scene, const std::string& id) {
    for (std::size_t i = 0; i < scene.ids.size(); ++i)
        if (scene.ids[i] == id) return i;
    return scene.ids.size();
}

TEST(Viewpoint, ProjectsWhatItsLinesOfSightMeet) {
    Camera bent = camera(64, 48);
    bent.distortion = {-0.2, 0.05, 0.001, -0.002, 0.01};
    const CameraView straight(camera(64, 48), kPose), curved(bent, kPose);
    for (const CameraView* view : {&straight, &curved})
        for (const PixelPoint place :
             {PixelPoint{0, 0}, PixelPoint{63, 5}, PixelPoint{20.25, 40}}) {
            const auto line = view->sightLine(place);
            ASSERT_TRUE(line);
            const auto back = view->project(line->origin + 3 * line->direction);
            ASSERT_TRUE(back);
            EXPECT_NEAR(back->column, place.column, 1e-9);
            EXPECT_NEAR(back->row, place.row, 1e-9);
        }
    const OrthographicView above({{1, 2, 10}, Angle::degrees(90), Angle::degrees(-90), {}}, 8, 80,
                                 60);
    const PixelPoint north = above.project({1, 2.5, 0}), east = above.project({1.5, 2, 0});
    EXPECT_NEAR(north.column, 39.5, 1e-9);
    EXPECT_NEAR(north.row, 24.5, 1e-9);
    EXPECT_NEAR(east.column, 44.5, 1e-9);
    EXPECT_NEAR(east.row, 29.5, 1e-9);
}

TEST(Render, CornersAreWhereTheCameraSaysTheyAre) {
    const Scene room = scene("ispace size=6,4 height=2.5\ncube id=crate at=2,0.5 size=0.6\n");
    const RenderScene prepared(room);
    const auto label = static_cast<std::uint16_t>(indexOf(room, "crate") + 1);
    RenderOptions options;
    options.samples = 1;
    options.labels = true;
    const Camera wide = camera(640, 480);
    for (const Point3 corner : {Point3{2.3, 0.2, 0.6}, Point3{2.3, 0.8, 0.6}}) {
        const auto place = CameraView(wide, kPose).project(corner);
        ASSERT_TRUE(place);
        // A part of the picture, 400 times as fine: the corner of the crate's outline lies in its
        // middle, so that within 0.01 pixels of it some of the wide picture is crate and some not.
        constexpr double kFiner = 400;
        Camera narrow = wide;
        narrow.columns = narrow.rows = 8;
        narrow.fx *= kFiner;
        narrow.fy *= kFiner;
        narrow.cx = 3.5 - (place->column - wide.cx) * kFiner;
        narrow.cy = 3.5 - (place->row - wide.cy) * kFiner;
        const Rendering picture = render(prepared, CameraView(narrow, kPose), options);
        const auto count = std::count(picture.labels.begin(), picture.labels.end(), label);
        EXPECT_GT(count, 6);
        EXPECT_LT(count, 58);
    }
}

TEST(Render, DepthsAndLabelsAgreeWithRays) {
    const Scene room = scene(kRoom);
    const CameraView view(camera(80, 60), kPose);
    RenderOptions options;
    options.colors = false;
    options.labels = options.depths = true;
    const Rendering picture = render(RenderScene(room), view, options);
    const RayWorld world = RayWorld::ofEnvironment(room.environment);
    const auto lines = view.evenPixelRays();
    ASSERT_TRUE(lines);
    std::vector<float> depths(80 * 60);
    world.cast(lines->origin, {lines->direction, lines->right, lines->down, 80, 60}, 100, depths);
    for (std::size_t i = 0; i < depths.size(); ++i)
        if (depths[i] == kNoReturn)
            EXPECT_EQ(picture.depths[i], kNoReturn) << i;
        else
            EXPECT_NEAR(picture.depths[i], depths[i], 1e-5 * depths[i]) << i;
    EXPECT_GT(std::count(picture.labels.begin(), picture.labels.end(), indexOf(room, "crate") + 1),
              50);
    EXPECT_GT(std::count(picture.labels.begin(), picture.labels.end(), indexOf(room, "round") + 1),
              50);
}

TEST(Render, IsTheSameForAnyNumberOfThreads) {
    const Scene room = scene(std::string(kRoom) + "human at=0,0\n");
    const CameraView view(camera(75, 50), kPose);
    const RenderScene prepared(room);
    std::vector<Rendering> pictures;
    for (const std::size_t threads : {1, 2}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        pictures.push_back(render(prepared, view));
    }
    EXPECT_EQ(pictures[0].radiance, pictures[1].radiance);
}

TEST(Render, HiddenBodiesAreNotSeen) {
    const Scene room = scene("ispace size=6,4\n", "human id=h at=0,0\nhuman id=g at=1,0\n");
    const CameraView view(camera(40, 30), {{-2.5, 0, 1.4}, {}, {}, {}});
    RenderOptions options;
    options.labels = true;
    const auto count = [&](const RenderScene& scene, std::size_t record) {
        const Rendering picture = render(scene, view, options);
        return std::count(picture.labels.begin(), picture.labels.end(), record + 1);
    };
    const RenderScene prepared(room);
    const std::size_t near = indexOf(room, "h"), far = indexOf(room, "g");
    EXPECT_GT(count(prepared, near), 0);
    const auto hidden_before = count(prepared, far);
    options.hidden = {near};
    EXPECT_EQ(count(prepared, near), 0);
    EXPECT_GT(count(prepared, far), hidden_before);
    // The far one walks out of the picture.
    std::vector<Pose3> poses;
    for (const PlacedRecord& placed : room.placed) poses.push_back(placed.pose);
    for (std::size_t i = 0; i < poses.size(); ++i)
        if (room.placed[i].record == far) poses[i].position.x = -2.9;
    EXPECT_EQ(count(prepared.at(poses), far), 0);
}

TEST(Render, ShadowsAreSoft) {
    const Scene room = scene("ispace size=8,8 height=1\nbarrier at=0,0 size=3,0.02,1\n");
    RenderOptions options;
    options.light = Illumination::Sky;
    options.samples = 16;
    // A strip across the edge of the shadow that the sun in the south-west casts, on 60 cm.
    const OrthographicView above({{0, 0.5, 3}, Angle::degrees(90), Angle::degrees(-90), {}}, 0.3,
                                 30, 90);
    const Rendering picture = render(RenderScene(room), above, options);
    std::vector<float> column;
    for (std::size_t row = 0; row < 90; ++row) column.push_back(picture.radiance[30 * row + 15][1]);
    const auto [dark, bright] = std::minmax_element(column.begin(), column.end() - 10);
    ASSERT_GT(*bright, 1.7F * *dark);
    const auto between = std::count_if(column.begin(), column.end() - 10, [&](float value) {
        return value > 0.9F * *dark + 0.1F * *bright && value < 0.2F * *dark + 0.8F * *bright;
    });
    EXPECT_GE(between, 3);
    EXPECT_LE(between, 40);
}

TEST(Render, LampsStandInEveryRoomAndNoLightLeaksOut) {
    // The inner room has no lamp of the outer one's.
    const Scene room = scene("ispace size=8,8 height=2.5 ceiling=yes\ncube at=2,2 size=2,2,2.5\n");
    const CameraView inside(camera(32, 24), {{2, 2, 1}, {}, {}, {}});
    const Rendering dark = render(RenderScene(room), inside);
    for (const Rgb& color : dark.radiance) EXPECT_LT(color[1], 0.4F);
    const CameraView outside(camera(32, 24), {{-3, -3, 1.2}, Angle::degrees(45), {}, {}});
    for (const Rgb& color : render(RenderScene(room), outside).radiance) EXPECT_GT(color[1], 0.05F);
}

TEST(Render, SidesThatLieInWallsAreTheWall) {
    const Scene room = scene(
        "ispace id=r size=6,6 height=2.5\ncube at=2.5,0 size=1\n"
        "wall from=3,1.5 to=0,1.5 thickness=0.2 kind=brick\n");
    RenderOptions options;
    options.colors = false;
    options.labels = true;
    const CameraView outside(camera(64, 48), {{8, 0.5, 1.2}, Angle::degrees(180), {}, {}});
    const Rendering picture = render(RenderScene(room), outside, options);
    const auto wall = static_cast<std::uint16_t>(indexOf(room, "r") + 1);
    for (std::size_t row = 16; row < 36; ++row)
        for (std::size_t column = 16; column < 48; ++column)
            EXPECT_EQ(picture.labels[64 * row + column], wall);
}

TEST(Render, LightPassesClearGlassAndDarkens) {
    const std::string walls = "ispace id=r size=6,6 height=2.5 ceiling=yes\n";
    const CameraView view(camera(16, 12), {{0, 0, 1.4}, {}, {}, {}});
    const auto middle = [&](const std::string& glass) {
        const Scene room = scene(walls + "window wall=r at=3,0 size=2 glass=" + glass + "\n");
        RenderOptions options;
        options.background = Rgb{1, 0.5F, 0.25F};
        return render(RenderScene(room), view, options).radiance[16 * 6 + 8];
    };
    EXPECT_EQ(middle("none"), (Rgb{1, 0.5F, 0.25F}));
    const Rgb through = middle("clear");
    EXPECT_LT(through[0], 0.95F);
    EXPECT_GT(through[0], 0.7F);
}

TEST(Rendering, BecomesBytes) {
    EXPECT_EQ(toSrgb8(Rgb{0, 1, 0.2158605F}), (std::array<std::uint8_t, 3>{0, 255, 128}));
    Rendering picture{1, 2, {{0, 0.2158605F, 100}, {0.1F, 0.1F, 0.1F}}, {}, {}};
    const std::vector<std::uint8_t> bytes = toSrgb8(picture);
    EXPECT_EQ(bytes[1], 128);
    EXPECT_EQ(bytes[2], 255);
    EXPECT_GT(toSrgb8(picture, 2)[3], bytes[3]);
}

TEST(Rendering, BecomesTheSameBytesInLargePictures) {
    constexpr int kWide = 200, kHigh = 150;
    Rendering large{kWide, kHigh, {}, {}, {}};
    for (int i = 0; i < kWide * kHigh; ++i) {
        const float share = static_cast<float>(i) / (kWide * kHigh);
        large.radiance.push_back({share, 20 * share * share, 1e-3F * share - 1e-5F});
    }
    const std::vector<std::uint8_t> bytes = toSrgb8(large, 1.15);
    ASSERT_EQ(bytes.size(), 3U * kWide * kHigh);
    for (std::size_t row = 0; row < kHigh; ++row) {
        Rendering part{kWide, 1, {}, {}, {}};
        const auto begin = large.radiance.begin() + static_cast<std::ptrdiff_t>(row * kWide);
        part.radiance.assign(begin, begin + kWide);
        const std::vector<std::uint8_t> alone = toSrgb8(part, 1.15);
        EXPECT_TRUE(std::equal(alone.begin(), alone.end(),
                               bytes.begin() + static_cast<std::ptrdiff_t>(3 * row * kWide)));
    }
}

}  // namespace render_test
}  // namespace ispace
