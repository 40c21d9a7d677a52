// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/views/view.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "extensions/views/contact_sheet.h"
#include "extensions/views/run_record.h"
#include "support/test_layout.h"
#include "trace/render/render.h"

namespace ispace::views {
namespace view_test {

using testing::scene;

Scene room() {
    return scene("ispace size=6,4 height=2.5\ncube id=crate at=2,0.5 size=0.6\n",
                 "robot id=r1 at=-1,-1 heading=90\nlaser id=l1 on=r1 at=0.1,0,0.3\n"
                 "camera id=c1 at=-2.8,1.8,2.2 heading=-35 tilt=-25\n");
}

constexpr PictureSize kSmall{160, 120};

TEST(Projector, FindsWhatItsLinesOfSightMeet) {
    const Scene scene = room();
    for (const char* text : {"bird", "first-person:-2,0,20,-10", "omni:0.5,-1,1.2", "orbit",
                             "orbit:30,20,9", "central:1,1", "robot:r1", "camera:c1"}) {
        const Standpoint standpoint = standpointOf(parseView(text), scene, kSmall);
        for (const PixelPoint pixel : {PixelPoint{3, 5}, {80.25, 60.5}, {140, 110}}) {
            const auto line = standpoint.eye->viewpoint().sightLine(pixel);
            ASSERT_TRUE(line) << text;
            const auto found = standpoint.eye->find(line->origin + 2.5 * line->direction);
            ASSERT_TRUE(found) << text;
            EXPECT_NEAR(found->pixel.column, pixel.column, 1e-6) << text;
            EXPECT_NEAR(found->pixel.row, pixel.row, 1e-6) << text;
            EXPECT_NEAR(found->depth, 2.5, 1e-9) << text;
        }
    }
}

TEST(Projector, OrbitFillsThePictureWithTheRoom) {
    const Scene scene = room();
    for (const char* text : {"orbit", "orbit:10,15", "orbit:170,89"}) {
        const Standpoint standpoint = standpointOf(parseView(text), scene, kSmall);
        EXPECT_TRUE(standpoint.looks_in);
        Box2 seen;
        for (const double x : {-3, 3})
            for (const double y : {-2, 2})
                for (const double z : {0.0, 2.5}) {
                    const auto found = standpoint.eye->find({x, y, z});
                    ASSERT_TRUE(found) << text;
                    seen.add({found->pixel.column, found->pixel.row});
                }
        EXPECT_GE(seen.low.x, 0);
        EXPECT_GE(seen.low.y, 0);
        EXPECT_LE(seen.high.x, kSmall.columns);
        EXPECT_LE(seen.high.y, kSmall.rows);
        EXPECT_GT(std::max(seen.width() / kSmall.columns, seen.depth() / kSmall.rows), 0.88);
    }
}

TEST(Projector, SizesFollowTheView) {
    const Scene scene = room();
    const auto size = [&](const char* text, std::optional<PictureSize> wanted) {
        return sizeOf(parseView(text), scene, wanted);
    };
    EXPECT_EQ(size("orbit", {}), (PictureSize{1280, 960}));
    EXPECT_EQ(size("orbit", PictureSize{400, 0}), (PictureSize{400, 300}));
    EXPECT_EQ(size("orbit", PictureSize{400, 100}), (PictureSize{400, 100}));
    EXPECT_EQ(size("omni:0,0", PictureSize{400, 0}), (PictureSize{400, 200}));
    EXPECT_EQ(size("camera:c1", {}), (PictureSize{640, 480}));
    EXPECT_EQ(size("camera:c1", PictureSize{400, 100}), (PictureSize{133, 100}));
}

TEST(View, WallsInBetweenAreLeftOut) {
    const Scene scene = room();
    // From the right, where the wall hides the crate from so low an eye.
    ViewOptions options;
    options.highlight = {"crate"};
    const Image picture = viewPicture(scene, parseView("orbit:0,5"), kSmall, options);
    constexpr std::uint32_t kOutline = 0xE6007E;
    EXPECT_GT(std::count(picture.pixels.begin(), picture.pixels.end(), kOutline), 20);
}

TEST(View, IsTheSameForAnyNumberOfThreads) {
    const Scene scene = room();
    ViewOptions options;
    options.show = OverlayLayers::Area;
    std::vector<Image> pictures;
    for (const std::size_t threads : {1U, 2U}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        pictures.push_back(viewPicture(scene, parseView("orbit"), kSmall, options));
    }
    EXPECT_EQ(pictures[0].pixels, pictures[1].pixels);
}

TEST(View, LayersOverEachOtherAreThePicturesOverEachOther) {
    const Scene near = room();
    const Scene far = scene("ispace size=9,3 height=1.5\ncube id=box at=3.5,-0.5 size=0.8\n");
    const ViewSpec spec = parseView("orbit:30,35");
    for (const int samples : {1, 16}) {
        ViewOptions options;
        options.labels = false;
        options.samples = samples;
        ViewSpec of_far = spec;
        of_far.contents = {{-3, -2, 0}, {3, 2, 0}, {-3, 2, 2.5}, {3, -2, 2.5}};
        ViewSpec of_near = of_far;
        const Image behind = viewPicture(far, of_far, kSmall, options);
        ViewOptions before = options;
        before.behind = &behind;
        const Image expected = viewPicture(near, of_near, kSmall, before);

        std::vector<bool> hidden(behind.pixels.size());
        const ViewLayer top = viewLayer(near, of_near, kSmall, options, hidden);
        top.hide(hidden);
        const auto count = std::count(hidden.begin(), hidden.end(), true);
        EXPECT_GT(count, 1000);
        EXPECT_LT(count, static_cast<std::ptrdiff_t>(hidden.size()));
        Image white{kSmall.columns, kSmall.rows, {}};
        white.pixels.assign(hidden.size(), 0xFFFFFF);
        const ViewLayer bottom = viewLayer(far, of_far, kSmall, options, hidden);
        EXPECT_EQ(top.over(bottom.over(white)).pixels, expected.pixels) << samples;
    }
}

TEST(View, CoveredFloorHasTheSensorsColour) {
    const Scene scene = room();
    ViewOptions options;
    options.labels = false;
    const ViewSpec spec = parseView("bird");
    const Image plain = viewPicture(scene, spec, kSmall, options);
    options.show = OverlayLayers::Area;
    const Image painted = viewPicture(scene, spec, kSmall, options);
    const Standpoint standpoint = standpointOf(spec, scene, kSmall);
    const auto at = [&](const Image& image, Point3 place) {
        const PixelPoint pixel = standpoint.eye->find(place)->pixel;
        return image.at(static_cast<int>(std::lround(pixel.column)),
                        static_cast<int>(std::lround(pixel.row)));
    };
    const Point3 seen{0, 0, 0};
    EXPECT_NE(at(plain, seen), at(painted, seen));
    EXPECT_EQ(at(plain, {-2.9, -1.9, 0}), at(painted, {-2.9, -1.9, 0}));
}

TEST(View, NamesWhatItDoesNotKnow) {
    const Scene scene = room();
    const auto error_of = [&](const std::string& text, const ViewOptions& options = {}) {
        try {
            viewPicture(scene, parseView(text), kSmall, options);
        } catch (const UsageError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(error_of("robot:r2"), "no robot has the id `r2`, did you mean `r1`?");
    EXPECT_EQ(error_of("camera:l1"), "`l1` is no camera");
    EXPECT_EQ(error_of("central:crat"), "nothing has the id `crat`, did you mean `crate`?");
    ViewOptions options;
    options.highlight = {"crtae"};
    EXPECT_EQ(error_of("bird", options), "nothing has the id `crtae`, did you mean `crate`?");
}

TEST(View, WarnsOfViewersInTheWrongPlace) {
    const Scene scene = room();
    const auto warning = [&](const char* text) {
        return standpointWarning(parseView(text), scene);
    };
    EXPECT_EQ(warning("first-person:0,0,0"), "");
    EXPECT_EQ(warning("omni:9,0"), "omni: the viewer stands outside the room");
    EXPECT_EQ(warning("omni:2,0.5,0.3"), "omni: the viewer stands inside something solid");
}

TEST(Bands, JoinToTheWholePicture) {
    const Scene scene = room();
    const RenderScene prepared(scene);
    RenderOptions options;
    options.samples = 1;
    options.labels = options.depths = true;
    for (const char* text : {"orbit", "omni:0,0"}) {
        const Standpoint standpoint = standpointOf(parseView(text), scene, kSmall);
        const Viewpoint& viewpoint = standpoint.eye->viewpoint();
        const Rendering whole = render(prepared, viewpoint, options);
        const Rendering joined = renderInBands(prepared, viewpoint, options, 6000);
        EXPECT_EQ(joined.labels, whole.labels);
        ASSERT_EQ(joined.depths.size(), whole.depths.size());
        for (std::size_t i = 0; i < whole.depths.size(); ++i)
            if (std::isfinite(whole.depths[i])) {
                EXPECT_NEAR(joined.depths[i], whole.depths[i], 1e-5 * whole.depths[i]);
            }
        EXPECT_EQ(joined.radiance.size(), whole.radiance.size());
    }
}

TEST(ContactSheet, HasTheOthersInRowsBelow) {
    const std::vector<PictureSize> shapes = {{200, 150}, {640, 480}, {640, 480}, {100, 200}};
    const ContactSheet sheet(shapes);
    EXPECT_EQ(sheet.sizeOf(0), shapes[0]);
    const PictureSize below = sheet.sizeOf(1);
    EXPECT_EQ(below, sheet.sizeOf(2));
    EXPECT_NEAR(3 * below.columns, 200, 10);
    EXPECT_NEAR(below.rows, 0.75 * below.columns, 0.6);
    std::vector<Image> images;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const auto [columns, rows] = sheet.sizeOf(i);
        const auto pixels = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
        images.push_back({columns, rows, std::vector<std::uint32_t>(pixels, 0xFF0000)});
    }
    const Image page = sheet.draw(images, {"a", "b", "c", "d"});
    EXPECT_EQ(page.width, 200);
    EXPECT_GT(page.height, 150 + 2 * below.columns);
    EXPECT_EQ(page.at(199, 149), 0xFF0000U);
    EXPECT_EQ(page.at(100, page.height - 1), 0xFFFFFFU);
    EXPECT_EQ(page.at(199, page.height - 1), 0xFFFFFFU);
    EXPECT_EQ(page.at(2 * (below.columns + 2) + 1, page.height - 1), 0xFF0000U);
}

TEST(RunRecord, PutsRobotsWhereTheyWere) {
    const RunRecord run(RunReader(
        "# history\nt,id,x,y,heading_deg,speed\n0,r1,0,0,0,0\n1,r1,1,0.5,90,0\n2,r1,2,1,180,0\n",
        ""));
    EXPECT_EQ(run.begin(), 0);
    EXPECT_EQ(run.end(), 2);
    Scene moved = room();
    run.apply(moved, 1.5);
    EXPECT_EQ(moved.robots[0].pose, (Pose2{{1, 0.5}, Angle::degrees(90)}));
    // The laser rides along.
    EXPECT_NEAR(moved.sensors[0].pose.position.x, 1, 1e-12);
    EXPECT_NEAR(moved.sensors[0].pose.position.y, 0.6, 1e-12);
    const std::vector<Point2> way{{0, 0}, {1, 0.5}};
    ASSERT_EQ(run.waysUntil(1.5).size(), 1U);
    EXPECT_EQ(run.waysUntil(1.5).front(), way);
    EXPECT_TRUE(run.waysUntil(0.5).empty());
}

TEST(RunRecord, PutsPeopleWhereTheyWalked) {
    const RunRecord run(RunReader("t,id,x,y,heading_deg\n0,r1,0,0,0\n1,r1,0,0,0\n",
                                  "t,id,x,y,heading_deg,speed,phase,sidespeed\n0,h1,0,0,0,0,0,0\n"
                                  "1,h1,0.5,0,90,0,0.25,-0.25\n"));
    Scene scene =
        testing::scene("ispace size=6,4\n",
                       "human id=h0 at=2,1\nhuman id=h1 at=0,0\ncamera id=c on=h1 at=0.1,0,1.6\n");
    run.apply(scene, 0.5);
    run.apply(scene, 1);
    EXPECT_EQ(scene.people[1].pose, (Pose2{{0.5, 0}, Angle::degrees(90)}));
    EXPECT_EQ(scene.placed[1].pose.position, (Point3{0.5, 0, 0}));
    EXPECT_LT(distance(scene.sensors[0].pose.position.onFloor(), {0.5, 0.1}), 1e-12);
    EXPECT_EQ(scene.placed[2].pose.position, scene.sensors[0].pose.position);
    EXPECT_EQ(run.swingsAt(scene, 0.5), std::vector<Angle>(2));
    // A quarter of a stride on, at half of the speed of full swing.
    const std::vector<Angle> swings = run.swingsAt(scene, 1);
    EXPECT_EQ(swings[0], Angle());
    EXPECT_NEAR(swings[1].degrees(), 7.5, 1e-9);
}

TEST(View, PeopleWalk) {
    const Scene scene =
        testing::scene("ispace size=6,4\n", "human at=0,0\ncamera id=c at=0,-1.5,0.4 heading=90\n");
    ViewOptions options;
    const auto picture = [&] {
        return viewPicture(scene, parseView("camera:c"), kSmall, options).pixels;
    };
    const auto standing = picture();
    options.swings = {Angle()};
    EXPECT_EQ(picture(), standing);
    options.swings = {Angle::degrees(15)};
    EXPECT_NE(picture(), standing);
}

TEST(RunRecord, RefusesOtherRuns) {
    EXPECT_THROW(RunRecord(RunReader("t,id,x,y,heading_deg\n", "")), FormatError);
    const Scene scene = room();
    const RunRecord other(RunReader("t,id,x,y,heading_deg\n0,r9,0,0,0\n", ""));
    EXPECT_THROW(other.checkStart(scene), FormatError);
}

TEST(RunRecord, PassesOverWhoJoinedLater) {
    Scene scene = room();
    const RunRecord run(
        RunReader("t,id,x,y,heading_deg\n0,r1,0,0,0\n1,r1,1,0.5,90\n1,r9,3,3,0\n", ""));
    run.checkStart(scene);
    run.apply(scene, 1);
    EXPECT_EQ(scene.robots[0].pose, (Pose2{{1, 0.5}, Angle::degrees(90)}));
}

}  // namespace view_test
}  // namespace ispace::views
