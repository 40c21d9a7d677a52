// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/moving_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "trace/body_scan.h"

namespace ispace {
namespace moving_bodies_test {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kNoReturn = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kNoOwner = MovingBodies::kNoOwner;

Angle degrees(double value) { return Angle::degrees(value); }

MovingBody box(double x, double y, double heading, double length, double width, double bottom = 0,
               double top = 0.3) {
    MovingBody body;
    body.pose = {{x, y}, degrees(heading)};
    body.half_length = length / 2;
    body.half_width = width / 2;
    body.bottom = bottom;
    body.top = top;
    return body;
}

MovingBody cylinder(double x, double y, double radius, double bottom = 0, double top = 0.3) {
    MovingBody body;
    body.pose = {{x, y}, {}};
    body.radius = radius;
    body.bottom = bottom;
    body.top = top;
    return body;
}

MovingBody ball(double x, double y, double radius, double height) {
    MovingBody body = cylinder(x, y, radius, height - radius, height + radius);
    body.is_ball = true;
    return body;
}

/// Signed: how far outside of the body a point is along the axis where it is furthest out.
double outside(const MovingBody& body, Point3 p) {
    const double vertical = std::max(p.z - body.top, body.bottom - p.z);
    const Vec2 way = p.onFloor() - body.pose.position;
    const double up = p.z - (body.bottom + body.top) / 2;
    if (body.is_ball) return length(Vec3{way.x, way.y, up}) - body.radius;
    const Vec2 offset = way - body.lean * up * unitVector(body.pose.heading);
    if (body.radius > 0) return std::max(vertical, length(offset) - body.radius);
    const Vec2 ahead = unitVector(body.pose.heading);
    return std::max({vertical, std::abs(dot(offset, ahead)) - body.half_length,
                     std::abs(cross(ahead, offset)) - body.half_width});
}

TEST(MovingBody, BoxIsMetAtItsFaces) {
    const MovingBody body = box(3, 0, 0, 1, 0.5);
    EXPECT_EQ(body.meet({0, 0, 0.1}, {1, 0, 0}), 2.5);
    EXPECT_EQ(body.meet({6, 0, 0.1}, {-1, 0, 0}), 2.5);
    EXPECT_EQ(body.meet({3, 2, 0.1}, {0, -1, 0}), 1.75);
    EXPECT_EQ(body.meet({3, 0, 2}, {0, 0, -1}), 1.7);
    EXPECT_EQ(body.meet({0, 0, 0.1}, {-1, 0, 0}), kInfinity);
    EXPECT_EQ(body.meet({0, 1, 0.1}, {1, 0, 0}), kInfinity);
    // Turned by a quarter it is met at its other face.
    EXPECT_EQ(box(3, 0, 90, 1, 0.5).meet({0, 0, 0.1}, {1, 0, 0}), 2.75);
    EXPECT_NEAR(box(3, 0, 45, 1, 1).meet({0, 0, 0.1}, {1, 0, 0}), 3 - std::sqrt(0.5), 1e-12);
    EXPECT_DOUBLE_EQ(box(0, 0, 0, 3, 4).reach(), 2.5);
}

TEST(MovingBody, CylinderHasLids) {
    const MovingBody body = cylinder(3, 0, 0.5);
    EXPECT_EQ(body.meet({0, 0, 0.1}, {1, 0, 0}), 2.5);
    EXPECT_EQ(body.meet({3, 0, 2}, {0, 0, -1}), 1.7);
    EXPECT_EQ(body.meet({3.5, 0, 2}, {0, 0, -1}), 1.7);  // on its rim
    EXPECT_EQ(body.meet({3.6, 0, 2}, {0, 0, -1}), kInfinity);
    const double slope = std::sqrt(0.5);
    EXPECT_NEAR(body.meet({2, 0, 1.3}, {slope, 0, -slope}), std::sqrt(2.0),
                1e-12);                                                // the upper lid
    EXPECT_EQ(body.meet({0, 0, 1.3}, {slope, 0, -slope}), kInfinity);  // the floor before it
    EXPECT_EQ(body.reach(), 0.5);
}

TEST(MovingBody, ClosedEndsCount) {
    for (const MovingBody& body : {box(3, 0, 0, 1, 0.5, 0.1), cylinder(3, 0, 0.5, 0.1)}) {
        for (const double z : {0.1, 0.3}) EXPECT_EQ(body.meet({0, 0, z}, {1, 0, 0}), 2.5) << z;
        for (const double z : {0.0999, 0.3001})
            EXPECT_EQ(body.meet({0, 0, z}, {1, 0, 0}), kInfinity) << z;
    }
    // Along a face, through an edge, and touching the round.
    EXPECT_EQ(box(3, 0, 0, 1, 0.5).meet({0, 0.25, 0.1}, {1, 0, 0}), 2.5);
    EXPECT_EQ(cylinder(3, 0, 0.5).meet({0, 0.5, 0.1}, {1, 0, 0}), 3);
    EXPECT_EQ(cylinder(3, 0, 0.5).meet({0, 0.500001, 0.1}, {1, 0, 0}), kInfinity);
}

TEST(MovingBody, FromInsideAndFromItsSurface) {
    for (const MovingBody& body : {box(3, 0, 0, 1, 0.5), cylinder(3, 0, 0.5)}) {
        EXPECT_EQ(body.meet({3, 0, 0.1}, {1, 0, 0}), 0.5);
        EXPECT_EQ(body.meet({3.25, 0, 0.1}, {-1, 0, 0}), 0.75);
        EXPECT_DOUBLE_EQ(body.meet({3, 0, 0.1}, {0, 0, 1}), 0.2);
        EXPECT_EQ(body.meet({2.5, 0, 0.1}, {1, 0, 0}), 0);
        EXPECT_EQ(body.meet({2.5, 0, 0.1}, {-1, 0, 0}), 0);
    }
}

TEST(MovingBody, IsMetWhereItsSurfaceIs) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> place(-2, 2), part(0.05, 1), turn(-180, 180);
    std::normal_distribution<double> any;
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
        const double bottom = part(random) - 0.5;
        MovingBody body = i % 2 == 0 ? box(place(random), place(random), turn(random), part(random),
                                           part(random), bottom, bottom + part(random))
                                     : cylinder(place(random), place(random), part(random), bottom,
                                                bottom + part(random));
        if (i % 8 == 1) body = ball(place(random), place(random), part(random), bottom);
        if (i % 8 == 3) {
            body.lean = 2 * part(random) - 1;
            body.pose.heading = degrees(turn(random));
        }
        const Point3 origin{place(random), place(random), place(random)};
        // Half of them towards the body, and of all a third level.
        Vec3 direction{any(random), any(random), any(random)};
        if (i % 4 < 2) {
            const Point2 middle = body.pose.position;
            direction = 0.3 * direction;
            direction.x += middle.x - origin.x;
            direction.y += middle.y - origin.y;
            direction.z += (body.bottom + body.top) / 2 - origin.z;
        }
        if (i % 3 == 0) direction.z = 0;
        direction = 1 / length(direction) * direction;
        const double meeting = body.meet(origin, direction);
        const bool inside = outside(body, origin) < 0;
        if (meeting < kInfinity) {
            ++met;
            const Point3 place = origin + meeting * direction;
            EXPECT_NEAR(outside(body, place), 0, 1e-9);
            // The normal points out, and the slope is how the ray meets it.
            const Vec3 normal = body.normalAt(place);
            EXPECT_GT(outside(body, place + 1e-6 * normal), 0.5e-6);
            const BodyFrame from(body, cosSin(body.pose.heading), origin);
            EXPECT_NEAR(from.meet(direction).slope, std::abs(dot(normal, direction)), 1e-6);
        }
        const double end = std::min(meeting, 8.0);
        for (int k = 1; k < 50; ++k) {
            const double way = end * k / 50;
            const double out = outside(body, origin + way * direction);
            EXPECT_TRUE(inside ? out < 1e-9 : out > -1e-9) << way << " of " << meeting;
        }
    }
    EXPECT_GT(met, 1000);
}

TEST(FloorGrid, FindsWhatMayExtendIntoABoxOnce) {
    std::mt19937_64 random(2);
    for (const double scale : {0.0, 1e-6, 1.0, 1e6, 1e15}) {
        std::uniform_real_distribution<double> offset(-scale, scale);
        std::vector<Point2> places;
        for (int i = 0; i < 300; ++i) places.push_back({offset(random), 0.01 * offset(random)});
        const double reach = 0.02 * scale;
        FloorGrid grid;
        grid.rebuild(places, reach);
        for (int i = 0; i < 200; ++i) {
            Box2 box;
            // Some about a thing at exactly its reach, some far outside.
            box.add({3 * offset(random), offset(random)});
            if (i % 2 == 0) box.add({offset(random), offset(random)});
            if (i % 5 == 0) box = {places[0] + Vec2{reach, 0}, places[0] + Vec2{reach, 0}};
            std::vector<int> visits(places.size());
            grid.forEachNear(box, [&](std::size_t index) { ++visits[index]; });
            for (std::size_t k = 0; k < places.size(); ++k) {
                const Point2 p = places[k];
                const bool near = p.x >= box.low.x - reach && p.x <= box.high.x + reach &&
                                  p.y >= box.low.y - reach && p.y <= box.high.y + reach;
                EXPECT_LE(visits[k], 1);
                EXPECT_TRUE(!near || visits[k] == 1) << scale << ' ' << k;
            }
        }
    }
}

TEST(FloorGrid, KeepsFarThingsApart) {
    std::vector<Point2> places;
    for (int i = 0; i < 1000; ++i) places.push_back({static_cast<double>(i), 0});
    FloorGrid grid;
    grid.rebuild(places, 0.3);
    int visits = 0;
    grid.forEachNear({{500, -1}, {510, 1}}, [&](std::size_t) { ++visits; });
    EXPECT_GE(visits, 11);
    EXPECT_LT(visits, 30);
}

TEST(FloorGrid, EmptyOneFindsNothing) {
    FloorGrid grid;
    const auto fail = [](std::size_t) { FAIL(); };
    grid.forEachNear({{-1, -1}, {1, 1}}, fail);
    EXPECT_TRUE(grid.empty());
    grid.rebuild({}, 0);
    EXPECT_TRUE(grid.empty());
    grid.forEachNear({{-1, -1}, {1, 1}}, fail);
    const Point2 place;
    grid.rebuild({&place, 1}, 0.5);
    EXPECT_FALSE(grid.empty());
    grid.forEachNear(Box2(), fail);
}

/// A sensor with its beams.
struct Sensor {
    Pose3 pose;
    Angle first, step = Angle::degrees(1);
    std::size_t beams = 1;
    double max_range = 10;

    [[nodiscard]] Directions directions() const {
        Directions out;
        out.resize(beams);
        for (std::size_t k = 0; k < beams; ++k)
            out.set(k, pose.beam(first + static_cast<double>(k) * step));
        if (pose.isLevel()) out.arc = {pose.heading + first, step};
        return out;
    }
    [[nodiscard]] std::vector<float> read(const MovingBodies& bodies, std::vector<float> ranges,
                                          std::uint32_t own = kNoOwner) const {
        bodies.shorten(pose.position, directions(), max_range, own, ranges);
        return ranges;
    }
    [[nodiscard]] std::vector<float> read(const MovingBodies& bodies,
                                          std::uint32_t own = kNoOwner) const {
        return read(bodies, std::vector<float>(beams, kNoReturn), own);
    }
    /// Every body and every beam.
    [[nodiscard]] std::vector<float> readSlowly(const MovingBodies& bodies,
                                                std::vector<float> ranges,
                                                std::uint32_t own) const {
        const Directions rays = directions();
        for (const MovingBody& body : bodies.bodies()) {
            if (body.owner == own) continue;
            for (std::size_t k = 0; k < beams; ++k) {
                const auto range = static_cast<float>(body.meet(pose.position, rays[k]));
                if (range <= static_cast<float>(max_range)) ranges[k] = std::min(ranges[k], range);
            }
        }
        return ranges;
    }
};

TEST(MovingBodies, AFanSeesWhatIsInItsWay) {
    const MovingBodies bodies({box(3, 0, 0, 1, 1), cylinder(0, 2, 0.5), cylinder(-2, 0, 0.5)});
    const Sensor half{{{0, 0, 0.15}, {}, {}, {}}, degrees(-90), degrees(1), 181, 10};
    const std::vector<float> ranges = half.read(bodies);
    EXPECT_EQ(ranges[90], 2.5F);
    EXPECT_EQ(ranges[180], 1.5F);
    EXPECT_EQ(ranges[0], kNoReturn);
    EXPECT_EQ(ranges[45], kNoReturn);
    // What stands nearer stays.
    EXPECT_EQ(half.read(bodies, std::vector<float>(181, 2.0F))[90], 2.0F);
    EXPECT_EQ(half.read(bodies, std::vector<float>(181, 2.0F))[180], 1.5F);
}

TEST(MovingBodies, HeightsRangesAndOwners) {
    MovingBody mine = cylinder(3, 0, 0.5);
    mine.owner = 7;
    const MovingBodies bodies({mine});
    Sensor one{{{0, 0, 0.3}, {}, {}, {}}, {}, degrees(1), 1, 10};
    EXPECT_EQ(one.read(bodies)[0], 2.5F);
    EXPECT_EQ(one.read(bodies, 7U)[0], kNoReturn);
    EXPECT_EQ(one.read(bodies, 6U)[0], 2.5F);
    one.pose.position.z = 0.301;
    EXPECT_EQ(one.read(bodies)[0], kNoReturn);
    one.pose.position.z = 0;
    one.max_range = 2.5;
    EXPECT_EQ(one.read(bodies)[0], 2.5F);
    one.max_range = 2.499;
    EXPECT_EQ(one.read(bodies)[0], kNoReturn);
    EXPECT_EQ(Sensor().read(MovingBodies())[0], kNoReturn);
}

TEST(MovingBodies, SectorsOfAnyTurn) {
    // One thin body straight behind, between the ends of a sector or on its seam.
    const MovingBodies bodies({cylinder(-3, 0, 0.01)});
    for (const double heading : {0.0, 90.0, 180.0, -720.0, 1e6}) {
        Sensor sensor{{{0, 0, 0.1}, degrees(heading), {}, {}}, {}, degrees(0.5), 1, 10};
        const double behind = 180 - heading;
        for (const double turn : {-360.0, 0.0, 360.0}) {
            sensor.first = degrees(behind + turn);
            sensor.beams = 1;
            EXPECT_NEAR(sensor.read(bodies)[0], 2.99, 1e-6) << heading;
            sensor.first = degrees(behind + turn + 0.5);
            EXPECT_EQ(sensor.read(bodies)[0], kNoReturn) << heading;
            sensor.beams = 721;  // a full turn whose both ends look at it, less one step
            EXPECT_NEAR(sensor.read(bodies)[719], 2.99, 1e-6) << heading;
            sensor.first = degrees(behind + turn);
            const std::vector<float> round = sensor.read(bodies);
            EXPECT_NEAR(round[0], 2.99, 1e-6);
            EXPECT_NEAR(round[720], 2.99, 1e-6);
            EXPECT_EQ(std::count(round.begin(), round.end(), kNoReturn), 719);
        }
    }
}

TEST(MovingBodies, SensorInsideOrTouching) {
    const MovingBodies bodies({cylinder(0, 0, 0.5), box(3, 0, 0, 2, 2)});
    Sensor round{{{0.25, 0, 0.1}, {}, {}, {}}, degrees(-180), degrees(90), 4, 10};
    const std::vector<float> inside = round.read(bodies);
    EXPECT_EQ(inside[0], 0.75F);
    EXPECT_EQ(inside[2], 0.25F);
    // On the corner of the box, which its middle sees at less than its reach.
    round.pose.position = {2, 1, 0.1};
    const std::vector<float> corner = round.read(bodies);
    EXPECT_EQ(corner[2], 0);
}

TEST(MovingBodies, AgreeWithEveryBodyAndBeam) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(0, 1), place(-6, 6), turn(-400, 400);
    std::size_t shortened = 0;
    for (int round = 0; round < 400; ++round) {
        std::vector<MovingBody> made;
        // Some are crowds in which nearly all are hidden.
        const auto count = static_cast<std::uint32_t>(unit(random) * (round % 10 == 1 ? 900 : 60));
        for (std::uint32_t i = 0; i < count; ++i) {
            const double bottom = i % 4 == 0 ? 0.2 : 0;
            made.push_back(i % 3 == 0 ? cylinder(place(random), place(random),
                                                 0.6 * unit(random) + 0.01, bottom, bottom + 0.3)
                                      : box(place(random), place(random), turn(random),
                                            unit(random), unit(random), bottom, bottom + 0.3));
            made.back().owner = i / 2;
            if (i % 6 == 3) made.back().lean = unit(random) - 0.5;
            if (i % 24 == 9) made.back() = ball(place(random), place(random), 0.3, 0.2);
        }
        const MovingBodies bodies(made);
        Sensor sensor;
        const double heights[] = {0.1, 0.2, 0.3, 0.4, 0.5, unit(random)};
        sensor.pose = {
            {place(random), place(random), heights[round % 6]}, degrees(turn(random)), {}, {}};
        if (round % 4 == 3) {
            sensor.pose.tilt = degrees(180 * unit(random) - 90);
            sensor.pose.roll = degrees(round % 8 == 3 ? 0 : turn(random));
        }
        sensor.beams = static_cast<std::size_t>(1 + unit(random) * 200);
        const double most = 360.0 / std::max<double>(1, static_cast<double>(sensor.beams) - 1);
        sensor.step = degrees(round % 5 == 0 ? 1e-7 + 1e-3 * unit(random)
                                             : std::min(most, 4 * unit(random) + 0.001));
        if (round % 7 == 0) sensor.step = degrees(std::min(360.0, most));
        sensor.first = degrees(round % 9 == 0 ? -180 : turn(random) / 2);
        sensor.max_range = 8 * unit(random) + 0.01;
        std::vector<float> before(sensor.beams, kNoReturn);
        for (float& range : before)
            if (unit(random) < 0.3) range = static_cast<float>(sensor.max_range * unit(random));
        const std::uint32_t own = round % 2 == 0 ? kNoOwner : count / 4;
        const std::vector<float> ranges = sensor.read(bodies, before, own);
        EXPECT_EQ(ranges, sensor.readSlowly(bodies, before, own)) << round;
        for (std::size_t k = 0; k < ranges.size(); ++k)
            if (ranges[k] != before[k]) ++shortened;
    }
    EXPECT_GT(shortened, 1000U);
}

TEST(MovingBody, CutsOfSlantedCylindersAndBallsAreDiscs) {
    MovingBody leg = cylinder(1, 2, 0.1, 0, 0.8);
    leg.pose.heading = degrees(90);
    leg.lean = 0.25;
    for (const double z : {0.0, 0.15, 0.4, 0.8}) {
        const MovingBody cut = leg.cutAt(z);
        EXPECT_EQ(cut.lean, 0);
        EXPECT_EQ(cut.radius, 0.1);
        EXPECT_NEAR(cut.pose.position.x, 1, 1e-12);
        EXPECT_NEAR(cut.pose.position.y, 2 + 0.25 * (z - 0.4), 1e-12);
        EXPECT_NEAR(leg.meet({1, 0, z}, {0, 1, 0}), cut.pose.position.y - 0.1, 1e-12);
    }
    EXPECT_NEAR(leg.sway(), 0.1, 1e-12);
    const MovingBody cut = ball(0, 0, 0.5, 1).cutAt(1.3);
    EXPECT_NEAR(cut.radius, 0.4, 1e-12);
    EXPECT_NEAR(ball(0, 0, 0.5, 1).meet({-2, 0, 1.3}, {1, 0, 0}), 1.6, 1e-12);
}

TEST(MovingBodies, NewPlacesAreTaken) {
    MovingBodies bodies({cylinder(3, 0, 0.5)});
    const Sensor one{{{0, 0, 0.1}, {}, {}, {}}, {}, degrees(1), 1, 10};
    EXPECT_EQ(one.read(bodies)[0], 2.5F);
    const std::vector<MovingBody> moved{cylinder(4, 0, 0.5), cylinder(4, 3, 0.5)};
    bodies.rebuild(moved);
    EXPECT_EQ(bodies.bodies().size(), 2U);
    EXPECT_EQ(one.read(bodies)[0], 3.5F);
    bodies.rebuild({});
    EXPECT_EQ(one.read(bodies)[0], kNoReturn);
}

}  // namespace moving_bodies_test
}  // namespace ispace
