// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/projection/projector_coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "extensions/projection/projection_report.h"
#include "support/test_layout.h"

namespace ispace::projection {
namespace projection_test {

// 8 x 6 x 3 m; the projector is five metres before the wall at x = 4 and shows 1000 x 500 pixels
// on 5 x 2.5 m of it.
const std::string kRoom = "ispace id=room size=8,6,3\n";
const std::string kStays =
    "projector id=p at=-1,0 height=1.5 pixels=1000,500 throw=1 lumens=2500 pan_range=0,0 "
    "tilt_range=0,0\n";
constexpr double kCell = 0.05;

Scene sceneOf(const std::string& records) { return testing::scene(kRoom + records); }

/// Returns the coverage of a surface by the first projector; a default one if it has none.
SurfaceProjection on(const ProjectionReport& projection, const std::string& name) {
    for (const SurfaceProjection& one : projection.projectors.front().surfaces)
        if (projection.surfaces[one.surface].name == name) return one;
    return {};
}

TEST(Projection, IsThatOfAPictureFromStraightAhead) {
    const Scene scene = sceneOf(kStays);
    const ProjectionReport fine = projectionOf(scene, 199, kCell);
    const SurfaceProjection wall = on(fine, "ispace room, facing 180");
    EXPECT_NEAR(wall.carries, 5 * 2.5, 1e-9);
    EXPECT_NEAR(wall.best, 200, 1e-9) << "1000 pixels on 5 m";
    ASSERT_TRUE(wall.rectangle);
    const PictureRectangle& best = *wall.rectangle;
    EXPECT_NEAR(best.width, 5, 1e-9);
    EXPECT_NEAR(best.height, 2.5, 1e-9);
    EXPECT_NEAR(best.middle.x, 4, 1e-9);
    EXPECT_NEAR(best.middle.y, 0, 1e-9);
    EXPECT_NEAR(best.middle.z, 1.5, 1e-9);
    EXPECT_NEAR(best.least, 200, 1e-9);
    EXPECT_NEAR(best.ratio(), 1, 1e-12);
    EXPECT_NEAR(best.slant.degrees(), 0, 1e-6);
    EXPECT_NEAR(best.lux, 2500 / 12.5, 1e-9);
    EXPECT_NEAR(fine.projectors.front().carries, 12.5, 1e-9) << "on no other surface";

    const ProjectionReport finer = projectionOf(scene, 201, kCell);
    EXPECT_EQ(on(finer, "ispace room, facing 180").carries, 0);
    EXPECT_FALSE(on(finer, "ispace room, facing 180").rectangle);
}

TEST(Projection, ThingsCastTheirShadows) {
    // A screen half a metre wide and 2 m high, two metres before the lens: on the wall its shadow
    // is 1.25 m wide and reaches over all of the picture's height.
    const std::string screen = "fence id=f path=1,-0.25;1,0.25 height=2\n";
    const ProjectionReport shadowed = projectionOf(sceneOf(kStays + screen), 100, kCell);
    const SurfaceProjection wall = on(shadowed, "ispace room, facing 180");
    EXPECT_NEAR(wall.shadowed, 1.25 * 2.5, 0.13) << "a column of cells";
    EXPECT_NEAR(wall.carries, 12.5 - 1.25 * 2.5, 0.13);
    EXPECT_NEAR(wall.carries + wall.shadowed, 12.5, 1e-9);
    EXPECT_EQ(wall.shadowed_by_movers, 0);
    ASSERT_TRUE(wall.rectangle);
    EXPECT_NEAR(wall.rectangle->width, (5 - 1.25) / 2, kCell) << "beside the shadow";
    // The front of the screen has it, twice and a half as fine: its part from 0.9 m up, 1 m below
    // the axis at 2 m ends the picture at 0.5 m.
    const SurfaceProjection front = on(shadowed, "fence f, facing 180");
    EXPECT_NEAR(front.best, 500, 1e-6);
    EXPECT_NEAR(front.carries, 0.5 * (2 - 1), 0.03);

    // A person is a mover.
    const ProjectionReport person =
        projectionOf(sceneOf(kStays + "human id=ann at=1,0 heading=180 height=1.8\n"), 100, kCell);
    const SurfaceProjection behind = on(person, "ispace room, facing 180");
    EXPECT_EQ(behind.shadowed, 0);
    EXPECT_GT(behind.shadowed_by_movers, 0.5);
    EXPECT_LT(behind.shadowed_by_movers, 3);
    EXPECT_NEAR(behind.carries + behind.shadowed_by_movers, 12.5, 1e-9);
}

TEST(Projection, LightPassesGlass) {
    const std::string pane =
        "fence id=f path=1,-1;1,1 height=3\nwindow wall=f size=1,0.1,1 offset=1\n";
    const SurfaceProjection wall =
        on(projectionOf(sceneOf(kStays + pane), 100, kCell), "ispace room, facing 180");
    EXPECT_GT(wall.carries, 0);
    EXPECT_LT(wall.carries, 12.5);
}

/// The density by differences: least and greatest change of the pixel over a small step.
TEST(SurfacePicture, HasTheDensityOfSmallSteps) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1, 1);
    const Scene scene = sceneOf("projector id=p at=0,0 height=1.5 pixels=1024,600 fov=50,35\n");
    const Record& record = scene.environment.elements().back().record;
    const ProjectorModel model = projectorModel(record);
    int seen = 0;
    for (int i = 0; i < 2000; ++i) {
        const Frame3 lens = projectorLens(record, Angle::degrees(180 * any(random)),
                                          Angle::degrees(80 * any(random)));
        const Vec3 raw{any(random), any(random), any(random)};
        const Vec3 normal = (1 / length(raw)) * raw;
        const Vec3 side = cross(normal, std::abs(normal.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0});
        const Vec3 along = (1 / length(side)) * side, across = cross(normal, along);
        const Point3 place =
            lens.origin + 4.0 * lens.forward + (any(random) * lens.left) + (any(random) * lens.up);
        const auto density = SurfacePicture(model, lens).at(place, along, across);
        if (!density) continue;
        const auto pixel = [&](Point3 p) {
            const Vec3 local = lens.toLocal(p);
            return Point2{local.y / local.x / model.across * model.columns / 2,
                          local.z / local.x / model.upright * model.rows / 2};
        };
        constexpr double kStep = 1e-6;
        double least = 1e9, most = 0;
        for (int k = 0; k < 720; ++k) {
            const double turn = k * std::numbers::pi / 720;
            const Point3 next =
                place + (kStep * std::cos(turn)) * along + (kStep * std::sin(turn)) * across;
            const double change = distance(pixel(place), pixel(next)) / kStep;
            least = std::min(least, change);
            most = std::max(most, change);
        }
        EXPECT_NEAR(density->most, most, 1e-3 * most);
        EXPECT_NEAR(density->least, least, 5e-3 * most);
        ++seen;
    }
    EXPECT_GT(seen, 1000);
}

TEST(TurnedAngles, PutADirectionAtAPlaceOfThePicture) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-1, 1);
    int found = 0;
    for (int i = 0; i < 2000; ++i) {
        const double heading = 400 * any(random);
        const Scene& scene = [&]() -> const Scene& {
            static const Scene one = sceneOf("projector id=p at=0,0 height=1\n");
            return one;
        }();
        Record record = scene.environment.elements().back().record;
        record.set("heading", heading);
        const Vec3 way{any(random), any(random), any(random)};
        const double across = 0.6 * any(random), upright = 0.5 * any(random);
        const auto angles = anglesTowards(way, across, upright, Angle::degrees(heading));
        if (!angles) continue;
        EXPECT_GT(angles->pan, -180 - 1e-9);
        EXPECT_LE(angles->pan, 180);
        const Frame3 lens =
            projectorLens(record, Angle::degrees(angles->pan), Angle::degrees(angles->tilt));
        const Vec3 local = lens.toLocal(lens.origin + way);
        if (local.x <= 1e-3) continue;
        EXPECT_NEAR(local.y / local.x, across, 1e-9);
        EXPECT_NEAR(local.z / local.x, upright, 1e-9);
        ++found;
    }
    EXPECT_GT(found, 1000);
    EXPECT_NEAR(anglesTowards({0, 0, -1}, 0, 0, {})->tilt, -90, 1e-9);
    EXPECT_FALSE(anglesTowards({0, 0, 1}, 0.5, 0, {})) << "no tilt up to 90 degrees";
}

/// Over all poses in steps of two degrees no cell is finer than projectionOf() finds, and few cells
/// that these poses show are missing.
TEST(Projection, FindsTheBestPoses) {
    for (const char* ranges : {"", "pan_range=-40,60 tilt_range=-30,10"}) {
        const Scene scene =
            sceneOf("projector id=p at=1,1 height=2.4 pixels=800,600 fov=40,30 heading=20 " +
                    std::string(ranges) + "\n");
        const Record& record = scene.environment.elements().back().record;
        const ProjectorModel model = projectorModel(record);
        constexpr double kDensity = 170;
        const ProjectionReport projection = projectionOf(scene, kDensity, 0.25);
        for (const SurfaceProjection& one : projection.projectors.front().surfaces) {
            const ProjectionSurface& surface = projection.surfaces[one.surface];
            const FlatFace& facet = surface.facets.front();
            std::vector<double> best(facet.cells.size(), 0);
            for (double pan = model.pan.least; pan <= model.pan.most; pan += 2)
                for (double tilt = model.tilt.least; tilt <= model.tilt.most; tilt += 2) {
                    const SurfacePicture picture(
                        model, projectorLens(record, Angle::degrees(pan), Angle::degrees(tilt)));
                    for (std::size_t i = 0; i < best.size(); ++i)
                        if (const auto density = picture.at(facet.middleOf(facet.cells[i]),
                                                            facet.frame.left, facet.frame.up))
                            best[i] = std::max(best[i], density->least);
                }
            std::size_t by_steps = 0, found = 0;
            for (std::size_t i = 0; i < best.size(); ++i) {
                const bool carries = one.cells.front()[i] == CellState::Carries;
                if (best[i] >= 1.02 * kDensity) {
                    EXPECT_TRUE(carries) << surface.name << ' ' << best[i];
                }
                by_steps += best[i] >= kDensity ? 1U : 0U;
                found += carries ? 1U : 0U;
            }
            // Steps of two degrees miss some of the best positions.
            EXPECT_LE(static_cast<double>(by_steps), 1.02 * static_cast<double>(found) + 1);
            EXPECT_LE(static_cast<double>(found), 1.15 * static_cast<double>(by_steps) + 2)
                << surface.name;
            if (one.rectangle) {
                EXPECT_GE(one.rectangle->least, kDensity);
                EXPECT_GE(one.rectangle->pan.degrees(), model.pan.least);
                EXPECT_LE(one.rectangle->tilt.degrees(), model.tilt.most);
                // Not beyond the picture: the corners have the density, too.
                const SurfacePicture picture(
                    model, projectorLens(record, one.rectangle->pan, one.rectangle->tilt));
                for (const double x : {0.0, one.rectangle->width})
                    for (const double y : {0.0, one.rectangle->height}) {
                        const Point3 corner =
                            facet.at(one.rectangle->left + x, one.rectangle->bottom + y);
                        const auto density = picture.at(corner, facet.frame.left, facet.frame.up);
                        ASSERT_TRUE(density) << surface.name;
                        EXPECT_GE(density->least, kDensity) << surface.name;
                    }
            }
        }
        EXPECT_GT(projection.projectors.front().carries, 1);
    }
}

TEST(Projection, ATurnedPictureIsNoSmallerThanAFixedOne) {
    const std::string turns = "projector id=p at=-1,0 height=1.5 pixels=1000,500 throw=1\n";
    const SurfaceProjection fixed =
        on(projectionOf(sceneOf(kStays), 150, kCell), "ispace room, facing 180");
    const SurfaceProjection turned =
        on(projectionOf(sceneOf(turns), 150, kCell), "ispace room, facing 180");
    EXPECT_GT(turned.carries, fixed.carries);
    EXPECT_GE(turned.rectangle->width * turned.rectangle->height,
              fixed.rectangle->width * fixed.rectangle->height - 1e-9);
}

TEST(LargestRectangle, IsThatOfAllRectangles) {
    std::mt19937 random(11);
    for (int round = 0; round < 300; ++round) {
        const std::size_t columns = 1 + random() % 9, rows = 1 + random() % 9;
        std::vector<char> cells(columns * rows);
        for (char& cell : cells) cell = random() % 4 != 0 ? 1 : 0;
        std::size_t most = 0;
        for (std::size_t left = 0; left < columns; ++left)
            for (std::size_t low = 0; low < rows; ++low)
                for (std::size_t right = left; right < columns; ++right)
                    for (std::size_t top = low; top < rows; ++top) {
                        bool is_full = true;
                        for (std::size_t y = low; y <= top; ++y)
                            for (std::size_t x = left; x <= right; ++x)
                                is_full = is_full && cells[y * columns + x] != 0;
                        if (is_full) most = std::max(most, (right - left + 1) * (top - low + 1));
                    }
        const CellRectangle found = largestRectangle(cells, columns);
        EXPECT_EQ(found.size(), most);
        for (std::size_t y = found.row; y < found.row + found.rows; ++y)
            for (std::size_t x = found.column; x < found.column + found.columns; ++x)
                EXPECT_NE(cells[y * columns + x], 0);
    }
}

TEST(ProjectionSurfaces, HaveTheAreasOfWallsAndFloor) {
    const Scene scene = sceneOf(
        "door id=d at=4,0 size=1,0.1,2 open=yes\npillar id=q at=-2,1 size=0.6,0.6,3 kind=round\n");
    double floor = 0, wall = 0, pillar = 0;
    for (const ProjectionSurface& surface : projectionSurfaces(scene.environment, kCell)) {
        double cells = 0;
        for (const FlatFace& facet : surface.facets)
            cells += static_cast<double>(facet.cells.size()) * facet.cellArea();
        EXPECT_LE(cells, surface.area() + 1e-9);
        if (surface.element == "floor") floor += surface.area();
        if (surface.name == "ispace room, facing 180" && surface.facets.front().frame.origin.x > 0)
            wall += surface.area();
        if (surface.name == "pillar q, narrow faces") pillar += surface.area();
    }
    EXPECT_NEAR(floor, 8 * 6, 1e-6);
    EXPECT_NEAR(wall, 6 * 3 - 1 * 2, 1e-6) << "the pieces beside the door are one surface";
    EXPECT_NEAR(pillar, std::numbers::pi * 0.6 * 3, 0.02);
}

TEST(ProjectionSurfaces, HaveDifferentNames) {
    const Scene scene = sceneOf("fence id=f path=-2,-1;-1,-1;-1,0;0,0;0,1\n");
    std::set<std::string> names;
    const std::vector<ProjectionSurface> surfaces = projectionSurfaces(scene.environment, 0.25);
    for (const ProjectionSurface& surface : surfaces)
        EXPECT_TRUE(names.insert(surface.name).second) << surface.name;
    EXPECT_EQ(names.count("fence f, facing 90 (2)"), 1U);
}

TEST(Projection, ReportsSurfacesOfModels) {
    const Scene scene = sceneOf("projector id=p model=v-1100 at=0,0 height=1.5\n");
    const ProjectionReport projection = projectionOf(scene, 300, 0.1);
    ASSERT_EQ(projection.projectors.size(), 1U);
    EXPECT_EQ(projection.projectors.front().figures.columns, 1024);
    EXPECT_NEAR(projection.projectors.front().figures.across, 0.25, 1e-12);
    const std::string text = projectionText(projection);
    EXPECT_NE(text.find("v-1100, 1024 x 768 pixels"), std::string::npos) << text;
    EXPECT_NE(projectionJson(projection).find("\"schema\":\"ispace-projection/1\""),
              std::string::npos);
    EXPECT_THROW(projectionPicture(projection, "", 10), UsageError);
    EXPECT_EQ(projectionPicture(projection, "t", 800).width(), 800);
}

}  // namespace projection_test
}  // namespace ispace::projection
