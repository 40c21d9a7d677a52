// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/plane_cells.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "coverage/visible_area.h"
#include "scene/sensor/sensor_keys.h"
#include "sense/scan.h"
#include "support/test_covering_sensors.h"
#include "support/test_scenes.h"
#include "support/test_sensors.h"

namespace ispace {
namespace plane_cells_test {

struct Room {
    explicit Room(const std::string& lines, int columns = 60, int rows = 40)
        : scene(sceneOf(lines)), grid{scene.environment.limits(), columns, rows} {}

    [[nodiscard]] CellSet seen(const Sensor& sensor, double plane) const {
        RayScenes worlds(scene.environment);
        const VisibleArea sight(scene.environment, plane, &worlds);
        sight.prepare(sensor);
        return sight.cellsOf(grid, sensor);
    }

    /// True if just those cells are seen whose centres are inside: `inside(centre)` gives how far
    /// (below 0: outside); places nearer to the edge than 0.1 mm are left out. False if none is
    /// inside, too.
    template <typename Inside>
    [[nodiscard]] ::testing::AssertionResult agrees(const CellSet& cells, Inside inside) const {
        std::size_t count = 0;
        for (std::size_t cell = 0; cell < grid.size(); ++cell) {
            const double depth = inside(grid.center(cell));
            if (std::fabs(depth) < 1e-4) continue;
            if (cells.test(cell) != (depth > 0))
                return ::testing::AssertionFailure()
                       << grid.center(cell).x << ", " << grid.center(cell).y
                       << (depth > 0 ? " is not seen" : " is seen");
            count += depth > 0 ? 1 : 0;
        }
        if (count == 0) return ::testing::AssertionFailure() << "no cell is inside";
        return ::testing::AssertionSuccess();
    }

    Scene scene;
    Grid grid;
};

TEST(PlaneCells, RangerLookingDownSeesARectangle) {
    const Room room("ispace size=12,8,4");
    const Point3 place{0.3, -0.2, 3};
    for (const double plane : {0.0, 0.7, 2.9, 3.8}) {
        // Looking down the left of the picture is +y, looking up its top is -x.
        const Sensor sensor = rangerAt(poseAt(place, 0, plane < 3 ? -90 : 90), 70, 40, 20);
        const double w = std::fabs(plane - 3) * tanOf(35), d = std::fabs(plane - 3) * tanOf(20);
        const Room fine("ispace size=12,8,4", 1200, 400);
        EXPECT_TRUE(fine.agrees(fine.seen(sensor, plane), [&](Point2 p) {
            return std::min(w - std::fabs(p.y - place.y), d - std::fabs(p.x - place.x));
        }));
    }
}

TEST(PlaneCells, RollTurnsThePicture) {
    const Room room("ispace size=12,8,4", 120, 80);
    const Sensor sensor = rangerAt(poseAt({0, 0, 3}, 0, -90, 90), 70, 40, 20);
    EXPECT_TRUE(room.agrees(room.seen(sensor, 0), [&](Point2 p) {
        return std::min(3 * tanOf(35) - std::fabs(p.x), 3 * tanOf(20) - std::fabs(p.y));
    }));
}

TEST(PlaneCells, RangeIsADistanceOrADepth) {
    const Room room("ispace size=12,8,4", 120, 80);
    Sensor sensor = rangerAt(poseAt({0, 0, 1}, 0, 0), 90, 100, 4);
    const auto wedge = [](Point2 p) { return std::min(p.x - std::fabs(p.y), p.x - 1 / tanOf(50)); };
    EXPECT_TRUE(room.agrees(room.seen(sensor, 0), [&](Point2 p) {
        return std::min(wedge(p), 4 - std::hypot(p.x, p.y, 1));
    }));
    sensor.as<Ranger>().measures_depth = true;
    EXPECT_TRUE(
        room.agrees(room.seen(sensor, 0), [&](Point2 p) { return std::min(wedge(p), 4 - p.x); }));
}

TEST(PlaneCells, HeadSeesBearingsAndElevations) {
    const Room room("ispace size=12,8,4", 120, 80);
    for (const double span : {30.0, 180.0, 300.0, 360.0}) {
        Sensor sensor = rangerAt(poseAt({0.05, 0, 2}, 20, 0), span, 100, 4);
        sensor.as<Ranger>().projection = Projection::Spherical;
        EXPECT_TRUE(room.agrees(room.seen(sensor, 0), [&](Point2 p) {
            const Vec2 way = p - Point2{0.05, 0};
            const Angle off = wrapped(directionOf(way.x, way.y) - Angle::degrees(20));
            const double side = span == 360 ? 1 : span / 2 - std::fabs(off.degrees());
            const double ring = length(way) - 2 / tanOf(50);
            return std::min({side, ring, 4 - std::hypot(way.x, way.y, 2)});
        }));
    }
}

// With a table of turned views, too.
TEST(PlaneCells, CellsOfSeveralViewsAreThoseThatEachHolds) {
    const Room room("ispace size=12,9,3", 150, 110);
    RayScenes worlds(room.scene.environment);
    const VisibleArea sight(room.scene.environment, 0, &worlds);
    for (const char* const lens :
         {"fov=75", "fov=110,62 range=3.1", "fx=400 cx=610 cy=50 range=6",
          "fov=90 coefficients=-0.3,0.05 range=8",
          "fov=90 coefficients=-0.3,0.1,0.02,-0.03 range=8",
          "fov=85 coefficients=0.4,-0.1,0,0.01,0.05",
          "fx=300 cx=500 cy=90 coefficients=-0.35,0,0.004,0 range=9",
          "projection=fisheye fov=106,59 pixels=1920,1080 range=100",
          "projection=fisheye fov=150 coefficients=0.02,-0.01,0.003,-0.0005 range=7",
          "projection=fisheye fx=150 cx=120 cy=-40 range=6", "projection=fisheye fov=12 range=50",
          "projection=omni fov=170 pixels=600,600 range=6",
          "projection=omni fov=250 pixels=500,480 range=5",
          "projection=omni fov=360 pixels=512,512 range=5",
          "projection=omni fov=220 mirror=0.9 pixels=480,480 range=6",
          "projection=omni mirror=0.6 fx=300 pixels=640,480 range=7"}) {
        const Camera camera =
            parametersOf<Camera>(testing::sensorRecord(std::string("camera ") + lens), nullptr);
        std::size_t held = 0;
        const auto look = [&](const SensorModel& model, double tilt, double step) {
            const auto view_at = [&](Point3 place, double heading) {
                return *fieldOfView(
                    {"",
                     model,
                     {place, Angle::degrees(heading), Angle::degrees(tilt), Angle::degrees(4)}});
            };
            std::vector<FieldOfView> views;
            std::vector<Angle> headings;
            for (int k = 0; k < 5; ++k) {
                headings.push_back(Angle::degrees(step * k));
                views.push_back(view_at({-1.3, 0.7, 2.6}, step * k));
            }
            sight.prepare({"", model, {}});
            CellParts parts, by_table;
            cellsByView(room.grid, sight.meshFor(model), views, 0, parts);
            const auto turned = turnedViews(view_at({0, 0, 2.6}, 0), headings, 0, room.grid);
            EXPECT_TRUE(turned || parts.runs.empty()) << lens;
            cellsByView(room.grid, sight.meshFor(model), views, 0, by_table,
                        {.turned = turned ? &*turned : nullptr});
            EXPECT_EQ(parts.first, by_table.first) << lens;
            EXPECT_EQ(parts.runs, by_table.runs) << lens;
            for (std::size_t k = 0; k < views.size(); ++k) {
                const CellSet cells = cellsOf(parts, k, room.grid.size());
                for (std::size_t cell = 0; cell < room.grid.size(); ++cell) {
                    const Point2 center = room.grid.center(cell);
                    ASSERT_EQ(cells.test(cell), views[k].holds({center.x, center.y, 0}))
                        << lens << " tilt " << tilt << " view " << k << " cell " << cell;
                }
                held += cells.count();
            }
        };
        for (const double tilt : {-90.0, -47.0, -3.0, 20.0}) look(camera, tilt, 71);
        for (const double tilt : {-60.0, -30.0}) {
            look(camera, tilt, 22.5);
            look(withDensity(camera, 40), tilt, 22.5);
        }
        EXPECT_GT(held, 100U) << lens;
    }
}

TEST(PlaneCells, ViewsOfCountedCellsHoldThoseThatAreSeen) {
    const Room room("ispace size=12,8,4\ncube at=1,1 size=1,1,1");
    RayScenes worlds(room.scene.environment);
    const VisibleArea sight(room.scene.environment, 0, &worlds);
    const Sensor sensor = rangerAt(poseAt({0, 0, 3}, 0, -60), 90, 60, 20);
    sight.prepare(sensor);
    std::vector<FieldOfView> views;
    for (const double heading : {0.0, 70.0, 140.0})
        views.push_back(*fieldOfView(rangerAt(poseAt({0, 0, 3}, heading, -60), 90, 60, 20)));
    const RayWorld& mesh = sight.meshFor(sensor.model);
    CellSet wanted(room.grid.size());
    for (std::size_t cell = 0; cell < wanted.size(); ++cell)
        if (cell % 7 < 2 || cell % 90 == 5) wanted.set(cell);
    const CountedCells counted(wanted);
    CellParts all, some;
    cellsByView(room.grid, mesh, views, 0, all);
    cellsByView(room.grid, mesh, views, 0, some, {.counted = &counted});
    ASSERT_EQ(some.size(), views.size());
    for (std::size_t k = 0; k < views.size(); ++k) {
        CellSet expected = cellsOf(all, k, room.grid.size());
        CellSet seen = cellsOf(some, k, room.grid.size());
        expected &= wanted;
        seen &= wanted;
        EXPECT_GT(expected.count(), 20U);
        EXPECT_EQ(seen, expected) << k;
    }
    EXPECT_LT(some.runs.size(), all.runs.size() + wanted.count() / 4) << "runs go on over others";
}

TEST(PlaneCells, AWindowLeavesOutOtherCells) {
    const Room room("ispace size=12,8,4\ncube at=1,1 size=1,1,1");
    RayScenes worlds(room.scene.environment);
    const VisibleArea sight(room.scene.environment, 0, &worlds);
    const Sensor sensor = rangerAt(poseAt({0, 0, 3}, 0, -60), 90, 60, 20);
    sight.prepare(sensor);
    const std::vector<FieldOfView> views = {*fieldOfView(sensor)};
    const RayWorld& mesh = sight.meshFor(sensor.model);
    CellParts all, part, none;
    cellsByView(room.grid, mesh, views, 0, all);
    CellSet wanted(room.grid.size());
    for (int row = 12; row < 25; ++row)
        for (int column = 33; column < 41; ++column) wanted.set(room.grid.cell(column, row));
    cellsByView(room.grid, mesh, views, 0, part, {.window = CellWindow::of(room.grid, wanted)});
    CellSet expected = cellsOf(all, 0, room.grid.size());
    expected &= wanted;
    EXPECT_GT(expected.count(), 20U);
    EXPECT_LT(expected.count(), wanted.count()) << "the cube hides some";
    EXPECT_EQ(cellsOf(part, 0, room.grid.size()), expected);
    const CellWindow empty = CellWindow::of(room.grid, CellSet(room.grid.size()));
    cellsByView(room.grid, mesh, views, 0, none, {.window = empty});
    EXPECT_EQ(none.size(), 1U);
    EXPECT_TRUE(none.runs.empty());
}

TEST(PlaneCells, ReceiverHearsACone) {
    const Room room("ispace size=12,8,4", 120, 80);
    for (const double fov : {60.0, 120.0, 180.0, 240.0, 360.0}) {
        const Pose3 pose = poseAt({0.3, 0.1, 2}, 30, -50, 77);
        const Sensor sensor = receiverAt(pose, fov, 5);
        EXPECT_TRUE(room.agrees(room.seen(sensor, 0.5), [&](Point2 p) {
            const Vec3 way = Point3{p.x, p.y, 0.5} - pose.position;
            const double cosine = dot(way, pose.beam({})) / length(way);
            const double off = std::acos(std::min(1.0, cosine)) * (180 / std::numbers::pi);
            return std::min(fov == 360 ? 1 : fov / 2 - off, 5 - length(way));
        }));
    }
}

TEST(PlaneCells, ThingsAreInTheWayOnlyFromAbove) {
    const Room room("ispace size=12,8,4\ncube at=2,0 size=1,1,1\n", 61, 41);
    const Sensor sensor = receiverAt(poseAt({0, 0, 2}, 0, -90), 360, 30);
    const CellSet floor = room.seen(sensor, 0);
    const CellSet top = room.seen(sensor, 1);
    for (std::size_t cell = 0; cell < room.grid.size(); ++cell) {
        const Point2 p = room.grid.center(cell);
        const bool hidden = p.x > 1.5 && p.x < 5 && std::fabs(p.y) < std::min(1.0, p.x / 3);
        ASSERT_EQ(floor.test(cell), !hidden) << p.x << ", " << p.y;
        ASSERT_TRUE(top.test(cell)) << "its top is no shadow on itself: " << p.x << ", " << p.y;
    }
}

TEST(PlaneCells, PlaneOutOfRangeIsNotSeen) {
    const Room room("ispace size=12,8,4");
    const Sensor sensor = receiverAt(poseAt({0, 0, 3}, 0, -90), 360, 2);
    EXPECT_EQ(room.seen(sensor, 0).count(), 0U);
    EXPECT_GT(room.seen(sensor, 1.1).count(), 0U);
    EXPECT_EQ(room.seen(receiverAt(sensor.pose, 360, 0), 0).count(), 0U);
}

TEST(PlaneCells, TiltedLaserCoversTheFloorUnderItsPlane) {
    const Room room("ispace size=12,8,20", 120, 80);
    const Laser wide = laserWith(30, -90, 180);
    EXPECT_TRUE(room.agrees(room.seen({"l", wide, poseAt({0, 0, 1}, 0, -45)}, 0),
                            [](Point2 p) { return std::min(p.x, 1 - p.x); }));
    const Laser near = laserWith(2, -90, 180);
    EXPECT_TRUE(room.agrees(room.seen({"l", near, poseAt({0, 0, 0.1}, 0, 60)}, 0),
                            [](Point2 p) { return std::min(p.x, 2 - std::hypot(2 * p.x, p.y)); }));
    const Sensor upright{"l", wide, poseAt({0, 0, 1}, 0, -90)};
    EXPECT_EQ(room.seen(upright, 0).count(), 0U);
}

TEST(PlaneCells, HallLaserThatTurnsSeesTheWholeFloor) {
    // Table 5.4 of the thesis: 7 m, looking down, 180 degrees, each heading.
    const Room room("ispace size=9,9,4.5", 90, 90);
    Sensor sensor{"l", laserWith(7, -90, 180), poseAt({0, 0, 4}, 0, -90)};
    sensor.as<Laser>().sweep = SweepAxis::Heading;
    EXPECT_TRUE(
        room.agrees(room.seen(sensor, 0), [](Point2 p) { return 7 - std::hypot(p.x, p.y, 4); }));
    // Four scans, and all between the last and the first.
    sensor.as<Laser>().sweep_step = Angle::degrees(90);
    sensor.as<Laser>().first = Angle::degrees(10);
    sensor.as<Laser>().beams = 61;
    EXPECT_TRUE(room.agrees(room.seen(sensor, 0), [](Point2 p) {
        const double off = std::hypot(p.x, p.y) / 4;  // tangent, from straight down
        return std::min({off - tanOf(10), tanOf(60) - off, 7 - std::hypot(p.x, p.y, 4)});
    }));
    sensor.as<Laser>() = laserWith(7, -90, 180);
    sensor.as<Laser>().sweep = SweepAxis::Heading;
    // A quarter of the headings, of both halves of the scan.
    sensor.as<Laser>().sweep_span = Angle::degrees(90);
    EXPECT_TRUE(room.agrees(room.seen(sensor, 0), [](Point2 p) {
        return std::min(7 - std::hypot(p.x, p.y, 4), -p.x * p.y);
    }));
}

/// The same by trying angle after angle: where the place changes sides of the scan plane.
/// \return how far inside the window of bearings it then is, in degrees: the most of all
double passesByTrying(const Sensor& sensor, Point3 place) {
    const Laser& laser = sensor.as<Laser>();
    const Vec3 way = place - sensor.pose.position;
    const double last =
        laser.sweep_span.degrees() < 360 ? (laser.scans() - 1) * laser.sweep_step.degrees() : 360;
    const auto frame = [&](double angle) {
        return Frame3(sweptPose(laser, sensor.pose, angle / laser.sweep_step.degrees()));
    };
    constexpr int kSteps = 360;
    double most = -1e9, before = dot(frame(0).up, way);
    for (int i = 1; i <= kSteps; ++i) {
        const double step = last / kSteps, end = step * i, side = dot(frame(end).up, way);
        if ((before > 0) != (side > 0)) {
            double low = end - step, high = end;
            for (int k = 0; k < 40; ++k) {
                const double middle = (low + high) / 2;
                ((dot(frame(middle).up, way) > 0) == (before > 0) ? low : high) = middle;
            }
            const Frame3 at = frame(low);
            const Angle bearing = directionOf(dot(way, at.forward), dot(way, at.left));
            const Angle middle = 0.5 * (laser.first + laser.last());
            const double half = 0.5 * (laser.last() - laser.first).degrees();
            most = std::max(most, half - std::fabs(wrapped(bearing - middle).degrees()));
        }
        before = side;
    }
    return most;
}

TEST(SweptScan, PassesWhatTryingAllAnglesFinds) {
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> turn(-200, 200), place(-4, 4), half(5, 175);
    const std::array axes{SweepAxis::Heading, SweepAxis::Tilt, SweepAxis::Roll};
    int seen = 0, unseen = 0;
    for (int trial = 0; trial < 90; ++trial) {
        Sensor sensor{"l", laserWith(30, -half(random), 2 * half(random)),
                      poseAt({place(random), place(random), place(random)}, turn(random),
                             trial % 4 == 0 ? 0 : turn(random), trial % 5 < 2 ? 0 : turn(random))};
        sensor.as<Laser>().sweep = axes[static_cast<std::size_t>(trial) % 3];
        if (sensor.pose.isLevel() && sensor.as<Laser>().sweep == SweepAxis::Heading) continue;
        if (trial % 7 != 0) sensor.as<Laser>().sweep_span = Angle::degrees(2 * half(random) + 0.5);
        const SweptScan scan(sensor);
        for (int i = 0; i < 12; ++i) {
            const Point3 target{place(random), place(random), place(random)};
            const double depth = passesByTrying(sensor, target);
            if (std::fabs(depth) < 1e-3) continue;
            ASSERT_EQ(scan.passes(target), depth > 0) << trial << ": " << depth;
            ++(depth > 0 ? seen : unseen);
        }
    }
    EXPECT_GT(seen, 100);
    EXPECT_GT(unseen, 100);
}

TEST(SweptScan, PlacesOnTheAxisAreSeenByTheirBearing) {
    Sensor sensor{"l", laserWith(30, -90, 180), poseAt({0, 0, 1}, 0, 0)};
    sensor.as<Laser>().sweep = SweepAxis::Tilt;
    sensor.as<Laser>().sweep_span = Angle::degrees(30);
    EXPECT_TRUE(SweptScan(sensor).passes({0, 2, 1}));
    sensor.as<Laser>().first = Angle::degrees(-80);
    sensor.as<Laser>().beams = 161;
    EXPECT_FALSE(SweptScan(sensor).passes({0, 2, 1}));
    sensor.as<Laser>().sweep = SweepAxis::Roll;
    EXPECT_TRUE(SweptScan(sensor).passes({2, 0, 1}));
    EXPECT_FALSE(SweptScan(sensor).passes({-2, 0, 1}));
    // A scan that turns in its own plane.
    sensor.as<Laser>().sweep = SweepAxis::Heading;
    EXPECT_TRUE(SweptScan(sensor).passes({std::cos(1.8), std::sin(1.8), 1}));
    EXPECT_FALSE(SweptScan(sensor).passes({std::cos(2.0), std::sin(2.0), 1}));
    EXPECT_FALSE(SweptScan(sensor).passes({1, 0, 1.01}));
}

TEST(SweptScan, UpsideDownBearingsRunTheOtherWay) {
    // Beams from 0 to 20 degrees to its left, which is our right; headings from 0 to 60.
    Sensor sensor{"l", laserWith(30, 0, 20), poseAt({0, 0, 1}, 0, 0, 180)};
    sensor.as<Laser>().sweep = SweepAxis::Heading;
    sensor.as<Laser>().sweep_span = Angle::degrees(60);
    const SweptScan scan(sensor);
    for (int degrees = -179; degrees < 180; ++degrees) {
        if (degrees == -20 || degrees == 60) continue;
        const Vec2 way = unitVector(Angle::degrees(degrees));
        EXPECT_EQ(scan.passes({2 * way.x, 2 * way.y, 1}), -20 < degrees && degrees < 60) << degrees;
    }
}

TEST(PlaneCells, SweptLaserSeesWhatNothingHides) {
    const Room room("ispace size=12,8,4\ncube at=2,0 size=1,1,1\n", 61, 41);
    Sensor sensor{"l", laserWith(30, -90, 180), poseAt({0, 0, 2}, 0, -90)};
    sensor.as<Laser>().sweep = SweepAxis::Tilt;
    sensor.as<Laser>().sweep_span = Angle::degrees(90);
    const CellSet floor = room.seen(sensor, 0);
    for (std::size_t cell = 0; cell < room.grid.size(); ++cell) {
        const Point2 p = room.grid.center(cell);
        const bool hidden = p.x > 1.5 && p.x < 5 && std::fabs(p.y) < std::min(1.0, p.x / 3);
        ASSERT_EQ(floor.test(cell), p.x > -1e-9 && !hidden) << p.x << ", " << p.y;
    }
}

}  // namespace plane_cells_test
}  // namespace ispace
