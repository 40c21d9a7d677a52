// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "coverage/plane_cells.h"
#include "coverage/shadow_footprint.h"
#include "geom/predicates.h"
#include "support/test_covering_sensors.h"
#include "support/test_scenes.h"

namespace ispace {
namespace shadow_caster_test {

constexpr double kPi = std::numbers::pi;

Sensor laserAt(const Pose3& pose, double range, double first, double span) {
    return {"l", laserWith(range, first, span), pose};
}

ShadowCaster casterOf(const std::string& lines) { return ShadowCaster(sceneOf(lines).environment); }

double areaOf(const std::vector<Curve>& curves) { return signedArea(curves); }

constexpr const char* kEmpty = "ispace size=40,40,9";

TEST(ShadowCaster, RangerLookingDownSeesARectangle) {
    const ShadowCaster caster = casterOf(kEmpty);
    for (const double plane : {0.0, 1.25, 5.0}) {
        const Sensor sensor = rangerAt(poseAt({1, 2, 3}, 33, plane < 3 ? -90 : 90, 12), 70, 40, 20);
        const double drop = std::fabs(plane - 3);
        const auto curves = caster.regionSeen(sensor, plane).value();
        ASSERT_EQ(curves.size(), 1U);
        EXPECT_NEAR(areaOf(curves), 4 * drop * drop * tanOf(35) * tanOf(20), 1e-6);
        EXPECT_NEAR(bounds(curves[0]).center().x, 1, 1e-7);
        EXPECT_NEAR(bounds(curves[0]).center().y, 2, 1e-7);
    }
}

TEST(ShadowCaster, RangeCutsAroundOrAcross) {
    const ShadowCaster caster = casterOf(kEmpty);
    // The disc lies within the square of the picture.
    Sensor sensor = rangerAt(poseAt({0, 0, 3}, 0, -90), 120, 120, 5);
    EXPECT_NEAR(areaOf(caster.regionSeen(sensor, 0).value()), 16 * kPi, 1e-6);
    // It is cut on two sides.
    sensor.as<Ranger>().fov_y = Angle::degrees(40);
    const double d = 3 * tanOf(20), w = std::sqrt(16 - d * d);
    EXPECT_NEAR(areaOf(caster.regionSeen(sensor, 0).value()), 2 * (d * w + 16 * std::asin(d / 4)),
                1e-6);
    // Ahead, a quarter turn wide: a triangle up to a depth.
    sensor = rangerAt(poseAt({0, 0, 1}, 20, 0), 90, 90, 6);
    EXPECT_NEAR(areaOf(caster.regionSeen(sensor, 0).value()), kPi / 4 * 35 - 1, 0.5);
    sensor.as<Ranger>().measures_depth = true;
    EXPECT_NEAR(areaOf(caster.regionSeen(sensor, 0).value()), 36 - 1, 1e-6);
}

TEST(ShadowCaster, TiltedPinholeSeesATrapezium) {
    const ShadowCaster caster = casterOf(kEmpty);
    const double h = 1.5, near = h * tanOf(25), far = h * tanOf(65);
    const auto half = [h](double x) { return tanOf(30) * (x + h) * std::sqrt(0.5); };
    for (const double heading : {0.0, 77.0, -130.0}) {
        const auto curves =
            caster.regionSeen(rangerAt(poseAt({1, 1, h}, heading, -45), 60, 40, 30), 0).value();
        EXPECT_NEAR(areaOf(curves), (far - near) * (half(near) + half(far)), 1e-6);
        // Looking up, and with the camera upside down beyond the vertical: the same.
        EXPECT_NEAR(
            areaOf(caster.regionSeen(rangerAt(poseAt({1, 1, 2}, heading, 135), 60, 40, 30), 2 + h)
                       .value()),
            areaOf(curves), 1e-6);
    }
}

TEST(ShadowCaster, ReceiverHearsADiscOrAnEllipse) {
    const ShadowCaster caster = casterOf(kEmpty);
    const double h = 2.5;
    EXPECT_NEAR(areaOf(caster.regionSeen(receiverAt(poseAt({0, 0, h}, 0, -90), 60, 20), 0).value()),
                kPi * std::pow(h * tanOf(30), 2), 1e-5);
    for (const double off : {10.0, 25.0, 40.0}) {
        const double far = h * tanOf(off + 30), near = h * tanOf(off - 30);
        const double long_half = (far - near) / 2;
        const double eccentricity = sin(Angle::degrees(off)) / cos(Angle::degrees(30));
        const double area =
            kPi * long_half * long_half * std::sqrt(1 - eccentricity * eccentricity);
        const auto curves =
            caster.regionSeen(receiverAt(poseAt({3, -4, h}, 50, off - 90), 60, 15), 0).value();
        EXPECT_NEAR(areaOf(curves), area, 1e-5);
    }
    // All around, half around, and all but a cone upwards that does not meet the plane.
    const double disc = kPi * (36 - h * h);
    EXPECT_NEAR(areaOf(caster.regionSeen(receiverAt(poseAt({0, 0, h}, 0, -90), 360, 6), 0).value()),
                disc, 1e-6);
    EXPECT_NEAR(areaOf(caster.regionSeen(receiverAt(poseAt({0, 0, h}, 70, 0), 180, 6), 0).value()),
                disc / 2, 1e-6);
    EXPECT_NEAR(areaOf(caster.regionSeen(receiverAt(poseAt({0, 0, h}, 0, -90), 240, 6), 0).value()),
                disc, 1e-6);
    // All but a cone that does.
    EXPECT_NEAR(areaOf(caster.regionSeen(receiverAt(poseAt({0, 0, h}, 0, 90), 300, 6), 0).value()),
                disc - kPi * std::pow(h * tanOf(30), 2), 1e-5);
    EXPECT_TRUE(caster.regionSeen(receiverAt(poseAt({0, 0, h}, 0, 90), 60, 6), 0).value().empty());
}

TEST(ShadowCaster, HeadSeesARing) {
    const ShadowCaster caster = casterOf(kEmpty);
    for (const double span : {40.0, 180.0, 270.0, 360.0}) {
        const auto curves =
            caster
                .regionSeen(rangerAt(poseAt({1, 0, 2}, 15, 0), span, 80, 6, Projection::Spherical),
                            0)
                .value();
        const double ring = kPi * (36 - 4 - std::pow(2 / tanOf(40), 2));
        EXPECT_NEAR(areaOf(curves), ring * span / 360, 1e-5) << span;
    }
    EXPECT_NEAR(
        areaOf(caster
                   .regionSeen(
                       rangerAt(poseAt({1, 0, 2}, 15, -30), 90, 0, 6, Projection::Spherical), 0)
                   .value()),
        0, 1e-6);
    // It measures distances, whatever is said of it.
    Sensor told = rangerAt(poseAt({1, 0, 2}, 15, 0), 180, 180, 6, Projection::Spherical);
    told.as<Ranger>().measures_depth = true;
    EXPECT_NEAR(areaOf(caster.regionSeen(told, 0).value()), kPi * 16, 1e-5);
    // Upside down it is the same.
    const auto curves =
        caster
            .regionSeen(rangerAt(poseAt({1, 0, 2}, 15, 0, 180), 360, 80, 6, Projection::Spherical),
                        0)
            .value();
    EXPECT_NEAR(areaOf(curves), kPi * (32 - std::pow(2 / tanOf(40), 2)), 1e-5);
}

TEST(ShadowCaster, BoxThrowsAShadow) {
    const ShadowCaster caster = casterOf(std::string(kEmpty) + "\ncube at=2,0 size=1,1,1\n");
    const Sensor sensor = receiverAt(poseAt({0, 0, 2}, 0, -90), 360, 8);
    // From its near edge to where its top falls, twice as large and as far.
    EXPECT_NEAR(areaOf(caster.regionSeen(sensor, 0).value()), kPi * 60 - 6.25, 1e-5);
    EXPECT_NEAR(areaOf(caster.regionSeen(sensor, 1).value()), kPi * 63, 1e-5);
    // On half its height, where its top falls 1.5 times as far.
    EXPECT_NEAR(areaOf(caster.regionSeen(sensor, 0.5).value()),
                kPi * (64 - 2.25) - 0.75 * (1 + 1.5) / 2 - 1.5 * 1.5, 1e-5);
    // From below, looking up past its bottom, it hides no cell.
    EXPECT_NEAR(
        areaOf(caster.regionSeen(receiverAt(poseAt({0, 0, 1.5}, 0, 90), 360, 8), 3).value()),
        kPi * (64 - 2.25), 1e-5);
}

TEST(ShadowCaster, WallsHideWhatIsBehind) {
    const std::string wall = std::string(kEmpty) + "\ncube at=2,0 size=0.2,39.9,8\n";
    const Sensor receiver = receiverAt(poseAt({0, 0, 2}, 0, -90), 360, 8);
    const auto curves = casterOf(wall).regionSeen(receiver, 0).value();
    for (const Curve& curve : curves) EXPECT_LE(bounds(curve).high.x, 1.9 + kChordError);
    // A disc of radius sqrt(60) up to the wall's face.
    const double area =
        60 * (kPi - std::acos(1.9 / std::sqrt(60.0))) + 1.9 * std::sqrt(60 - 1.9 * 1.9);
    EXPECT_NEAR(areaOf(curves), area, 1e-5);
    // A screen as high as the receiver throws its shadow to the rim.
    const auto less =
        casterOf(wall + "fence path=-2,-1;-2,1 height=2\n").regionSeen(receiver, 0).value();
    EXPECT_NEAR(areaOf(less), area - (60 * std::atan(0.5) - 2), 1e-5);
}

TEST(ShadowCaster, UnderATableThereIsNothingToSeeAbove) {
    const ShadowCaster caster =
        casterOf(std::string(kEmpty) + "\ntable at=0,0 size=2,2 height=0.75\n");
    const Pose3 under = poseAt({0.4, 0, 0.3}, 0, 90);
    EXPECT_TRUE(caster.regionSeen(receiverAt(under, 60, 8), 2).value().empty());
    EXPECT_GT(areaOf(caster.regionSeen(receiverAt(under, 60, 8), 0.6).value()), 0.05);
    // From far above the plane on the floor has a hole as large as the top looks.
    const auto curves =
        caster.regionSeen(receiverAt(poseAt({0, 0, 8.5}, 0, -90), 90, 30), 0).value();
    ASSERT_EQ(curves.size(), 2U);
    const double scale = 8.5 / (8.5 - 0.75);
    EXPECT_NEAR(areaOf(curves), kPi * (8.5 * 8.5 - scale * scale), 2e-3);
    EXPECT_LT(std::min(signedArea(curves[0]), signedArea(curves[1])), 0);
}

TEST(ShadowCaster, SurfacesInContactDoNotHide) {
    const ShadowCaster caster =
        casterOf("ispace size=12,8,3 ceiling=yes\ncube at=2,0 size=1,1,1\n");
    // On the ceiling, and on the wall.
    EXPECT_NEAR(areaOf(caster.regionSeen(receiverAt(poseAt({-3, 0, 3}, 0, -90), 60, 9), 0).value()),
                kPi * 3, 1e-5);
    EXPECT_NEAR(
        areaOf(caster.regionSeen(receiverAt(poseAt({-6, 0, 1.5}, 0, 0), 180, 3), 0).value()),
        kPi * 6.75 / 2, 1e-5);
    // On the box: its sides are in the way, but neither its top nor its bottom.
    EXPECT_NEAR(areaOf(caster.regionSeen(receiverAt(poseAt({2, 0, 1}, 0, -90), 180, 9), 0).value()),
                1, 1e-5);
}

TEST(ShadowCaster, NothingInRangeIsNothing) {
    const ShadowCaster caster = casterOf(kEmpty);
    EXPECT_TRUE(caster.regionSeen(receiverAt(poseAt({0, 0, 3}, 0, -90), 60, 0), 0).value().empty());
    EXPECT_TRUE(caster.regionSeen(receiverAt(poseAt({0, 0, 3}, 0, -90), 60, 0), 3).value().empty());
    EXPECT_TRUE(caster.regionSeen(receiverAt(poseAt({0, 0, 3}, 0, -90), 60, 3), 0).value().empty());
    EXPECT_TRUE(caster.regionSeen(receiverAt(poseAt({0, 0, 3}, 0, -90), 0, 9), 0).value().empty());
    EXPECT_TRUE(
        caster.regionSeen(rangerAt(poseAt({0, 0, 3}, 0, 90), 60, 40, 9), 0).value().empty());
    EXPECT_TRUE(
        caster.regionSeen(laserAt(poseAt({0, 0, 1}, 0, -90), 5, -90, 180), 0).value().empty());
}

TEST(ShadowCaster, PlaneThroughTheSensorIsItsSlice) {
    const ShadowCaster caster = casterOf("ispace size=12,8,3\ncube at=2,0 size=1,1,2\n");
    const Pose3 pose = poseAt({0, 0, 1}, 0, 0);
    // A triangle up to the box, 1.5 m ahead, and on its sides up to the range.
    const double side = std::atan2(0.5, 1.5);
    const double narrow = 2 * side * 180 / kPi;
    EXPECT_NEAR(areaOf(caster.regionSeen(receiverAt(pose, narrow, 3), 1).value()), 1.5 * 0.5, 1e-6);
    EXPECT_NEAR(areaOf(caster.regionSeen(receiverAt(pose, 90, 3), 1).value()),
                1.5 * 0.5 + (kPi / 4 - side) * 9, 1e-6);
    EXPECT_NEAR(areaOf(caster.regionSeen(rangerAt(pose, 90, 40, 3), 1).value()),
                1.5 * 0.5 + (kPi / 4 - side) * 9, 1e-6);
    EXPECT_NEAR(
        areaOf(caster.regionSeen(rangerAt(pose, 90, 40, 3, Projection::Spherical), 1).value()),
        1.5 * 0.5 + (kPi / 4 - side) * 9, 1e-6);
    EXPECT_NEAR(areaOf(caster.regionSeen(receiverAt(pose, 360, 3), 1).value()),
                1.5 * 0.5 + (kPi - side) * 9, 1e-6);
}

TEST(ShadowCaster, TiltedLaserCoversTheFloorUnderItsPlane) {
    const ShadowCaster caster = casterOf("ispace size=12,8,20");
    const auto area = [&](const Sensor& sensor) {
        return areaOf(caster.regionSeen(sensor, 0).value());
    };
    EXPECT_NEAR(area(laserAt(poseAt({0, 0, 1}, 0, -45), 30, -90, 180)), 8, 1e-5);
    EXPECT_NEAR(area(laserAt(poseAt({0, 0, 1}, 0, -45), 2, -90, 180)), (2 + kPi) / std::sqrt(2.0),
                1e-5);
    // The whole turn: the surface behind rises to 3 m.
    EXPECT_NEAR(area(laserAt(poseAt({0, 0, 1}, 0, -45), 2, -180, 360)),
                (2 + 3 * kPi) / std::sqrt(2.0), 1e-5);
    EXPECT_NEAR(area(laserAt(poseAt({0, 0, 0.1}, 30, 60), 2, -90, 180)), kPi, 1e-5);
    // Upside down, and from below the floor.
    EXPECT_NEAR(area(laserAt(poseAt({0, 0, 1}, 180, 180 + 45), 2, -90, 180)),
                (2 + kPi) / std::sqrt(2.0), 1e-5);
    EXPECT_NEAR(area(laserAt(poseAt({-9, 0, -1}, 0, 45), 2, -90, 180)), (kPi - 2) / std::sqrt(2.0),
                1e-5);
    Sensor swept = laserAt(poseAt({0, 0, 1}, 0, -45), 2, -90, 180);
    swept.as<Laser>().sweep = SweepAxis::Tilt;
    EXPECT_FALSE(caster.regionSeen(swept, 0));
}

/// Tables, boxes and their kin at random in a room of 12 x 8 m.
std::string furniture(std::mt19937_64& random, int count) {
    std::uniform_real_distribution<double> x(-5, 5), y(-3, 3), turn(-180, 180), size(0.3, 1.5);
    std::string lines;
    const char* const kinds[] = {"table", "desk", "chair", "cube", "cylinder", "screen", "pillar"};
    for (int i = 0; i < count; ++i) {
        const std::string kind = kinds[random() % 7];
        lines += kind + " at=" + std::to_string(x(random)) + "," + std::to_string(y(random)) +
                 " heading=" + std::to_string(turn(random));
        if (kind == "cube" || kind == "cylinder")
            lines += " size=" + std::to_string(size(random)) + "," + std::to_string(size(random)) +
                     "," + std::to_string(size(random));
        if (kind == "desk" && random() % 2 == 0) lines += " kind=closed";
        lines += '\n';
    }
    return lines;
}

double distanceFrom(const std::vector<Polygon>& polygons, Point2 p) {
    double nearest = 1e9;
    for (const Polygon& polygon : polygons)
        forEachEdge(polygon,
                    [&](const Segment2& s) { nearest = std::min(nearest, distance(p, s)); });
    return nearest;
}

struct Furnished {
    explicit Furnished(const std::string& lines)
        : scene(sceneOf("ispace size=12,8,2.5\n" + lines)),
          grid{scene.environment.limits(), 97, 61},
          mesh(RayWorld::ofEnvironment(scene.environment)),
          caster(scene.environment) {}

    /// Cells are those whose centre lies in the region; on its boundary float32 decides. How many.
    std::size_t compare(const CellSet& cells, const std::vector<Curve>& curves,
                        const std::string& what) const {
        std::vector<Polygon> polygons;
        polygons.reserve(curves.size());
        for (const Curve& curve : curves) polygons.push_back(chords(curve, 1e-6));
        std::vector<bool> inside(grid.size());  // by the even-odd rule
        for (const Polygon& polygon : polygons) {
            const Region region{polygon, {}};
            const CellSet more = cellsIn(grid, {{region}});
            more.forEach([&](std::size_t cell) { inside[cell] = !inside[cell]; });
        }
        std::size_t wrong = 0;
        for (std::size_t cell = 0; cell < grid.size(); ++cell) {
            if (cells.test(cell) == inside[cell]) continue;
            const Point2 p = grid.center(cell);
            const double off = distanceFrom(polygons, p);
            if (off < 3e-4) continue;
            if (++wrong <= 3)
                ADD_FAILURE() << what << ": " << p.x << ", " << p.y << " is "
                              << (cells.test(cell) ? "seen" : "not seen") << ", " << off
                              << " m from the boundary";
        }
        EXPECT_EQ(wrong, 0U) << what;
        return cells.count();
    }

    /// Returns how many cells sensors at one position see.
    std::size_t compareAll(const Pose3& pose, Angle fov_x, Angle fov_y, double range,
                           bool is_by_depth, double height, const std::string& what) const {
        const double wide = fov_x.degrees(), upright = fov_y.degrees();
        Sensor ranger = rangerAt(pose, wide, upright, range);
        ranger.as<Ranger>().measures_depth = is_by_depth;
        std::size_t seen = compare(cellsOnPlane(grid, mesh, ranger, height),
                                   caster.regionSeen(ranger, height).value(), what + " pinhole");
        const Sensor head = rangerAt(pose, 2 * wide, upright, range, Projection::Spherical);
        seen += compare(cellsOnPlane(grid, mesh, head, height),
                        caster.regionSeen(head, height).value(), what + " spherical");
        const Sensor receiver = receiverAt(pose, 2 * upright, range);
        seen += compare(cellsOnPlane(grid, mesh, receiver, height),
                        caster.regionSeen(receiver, height).value(), what + " receiver");
        const Sensor laser = laserAt(pose, range, -wide, 2 * wide);
        seen += compare(cellsOnPlane(grid, mesh, laser, height),
                        caster.regionSeen(laser, 0).value(), what + " laser");
        return seen;
    }

    Scene scene;
    Grid grid;
    RayWorld mesh;
    ShadowCaster caster;
};

TEST(ShadowCaster, CellsAreThoseInTheRegion) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> x(-7, 7), y(-5, 5), z(0.05, 3.5), turn(-180, 180),
        fov(20, 170), plane(0, 1.5);
    std::size_t seen = 0;
    for (int trial = 0; trial < 40; ++trial) {
        const Furnished room(furniture(random, 3 + trial % 9));
        const Pose3 pose = poseAt({x(random), y(random), z(random)}, turn(random), turn(random),
                                  trial % 3 == 0 ? turn(random) : 0);
        const double height = trial % 4 == 0 ? 0 : trial % 4 == 1 ? 0.75 : plane(random);
        seen += room.compareAll(pose, Angle::degrees(fov(random)), Angle::degrees(fov(random)),
                                trial % 5 == 0 ? 30 : 2 + trial % 5, trial % 6 == 0, height,
                                "trial " + std::to_string(trial));
    }
    EXPECT_GT(seen, 5000U);
}

TEST(ShadowCaster, CellsOfAPlaneThroughTheSensorAreThoseInTheRegion) {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> x(-5.9, 5.9), y(-3.9, 3.9), z(0.05, 1.2),
        turn(-180, 180), fov(20, 170);
    std::size_t seen = 0;
    for (int trial = 0; trial < 12; ++trial) {
        const Furnished room(furniture(random, 3 + trial % 9));
        const Pose3 pose =
            poseAt({x(random), y(random), z(random)}, turn(random), turn(random) / 4, turn(random));
        seen += room.compareAll(pose, Angle::degrees(fov(random)), Angle::degrees(fov(random)),
                                2 + trial, trial % 2 == 0, pose.position.z,
                                "trial " + std::to_string(trial));
    }
    EXPECT_GT(seen, 5000U);
}

TEST(ShadowCaster, CellsAreThoseInTheRegionWhereAllIsAligned) {
    std::mt19937_64 random(7);
    const auto pick = [&](int low, int high, double step) {
        return step * std::uniform_int_distribution<int>(low, high)(random);
    };
    std::size_t seen = 0;
    for (int trial = 0; trial < 60; ++trial) {
        std::string lines;
        for (int i = 0; i < 6; ++i)
            lines += "cube at=" + std::to_string(pick(-10, 10, 0.5)) + "," +
                     std::to_string(pick(-6, 6, 0.5)) + " size=" + std::to_string(pick(1, 3, 0.5)) +
                     "," + std::to_string(pick(1, 3, 0.5)) + "," +
                     std::to_string(pick(1, 4, 0.25)) + '\n';
        const Furnished room(lines);
        const Pose3 pose = poseAt({pick(-12, 12, 0.5), pick(-8, 8, 0.5), pick(0, 10, 0.25)},
                                  pick(-8, 8, 45), pick(-4, 4, 45), pick(-2, 2, 90));
        seen += room.compareAll(pose, Angle::degrees(pick(2, 11, 15)),
                                Angle::degrees(pick(2, 11, 15)), pick(1, 12, 1), trial % 3 == 0,
                                pick(0, 4, 0.25), "trial " + std::to_string(trial));
    }
    EXPECT_GT(seen, 5000U);
}

TEST(ShadowCaster, TurningTheSceneChangesNothing) {
    for (const double turn : {0.0, 17.0, 90.0, 211.5}) {
        const Pose2 turned{{0, 0}, Angle::degrees(turn)};
        const auto record = [&](const char* kind, Point2 at, double heading, const char* more) {
            const Point2 p = turned * at;
            return std::string("\n") + kind + " at=" + std::to_string(p.x) + "," +
                   std::to_string(p.y) + " heading=" + std::to_string(heading + turn) + more;
        };
        const ShadowCaster caster = casterOf(
            kEmpty + record("table", {2, 1}, 10, "") + record("desk", {-2, 1}, 70, " kind=closed") +
            record("cube", {1, -2}, 30, " size=1,0.5,0.8") + record("chair", {-1.5, -1}, 0, ""));
        const auto area = [&](double tilt, double roll) {
            const Point2 p = turned * Point2{0.3, 0.2};
            return areaOf(
                caster
                    .regionSeen(rangerAt(poseAt({p.x, p.y, 3}, 40 + turn, tilt, roll), 80, 60, 7),
                                0.1)
                    .value());
        };
        static double first[2] = {area(-60, 0), area(-80, 30)};
        EXPECT_NEAR(area(-60, 0), first[0], 2e-5) << turn;
        EXPECT_NEAR(area(-80, 30), first[1], 2e-5) << turn;
    }
}

}  // namespace shadow_caster_test
}  // namespace ispace
