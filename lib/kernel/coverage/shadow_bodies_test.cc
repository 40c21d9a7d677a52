// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/shadow_bodies.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "support/test_scenes.h"

namespace ispace {
namespace shadow_bodies_test {

constexpr Box2 kBox{{-20, -20}, {20, 20}};

std::vector<const ShadowBody*> pointersTo(const std::vector<ShadowBody>& bodies) {
    std::vector<const ShadowBody*> pointers;
    for (const ShadowBody& body : bodies) pointers.push_back(&body);
    return pointers;
}

/// Area that any layer covers.
double shaded(const std::vector<ShadowBody>& bodies, Point3 sensor, double height,
              const Box2& box = kBox) {
    const Shadows shadows(pointersTo(bodies), sensor, height, box);
    std::vector<Layer> layers;
    for (const ShadowBody& body : bodies)
        for (Layer& layer : shadows.of(body)) layers.push_back(std::move(layer));
    return Overlay(layers).area([](const LayerLabel& label) { return label.count > 0; });
}

std::vector<ShadowBody> bodiesOf(const std::string& lines) {
    const ShadowBodies all(sceneOf("ispace size=40,40,0.01\n" + lines).environment);
    std::vector<ShadowBody> bodies;
    for (const ShadowBody* const body : all.near({{{-50, -50}, {50, 50}}, -9, 9}, Surfaces::Opaque))
        bodies.push_back(*body);
    // Without the walls.
    std::erase_if(bodies, [](const ShadowBody& body) {
        return body.plan.width() >= 40 || body.plan.depth() >= 40;
    });
    return bodies;
}

std::vector<ShadowBody> loose(std::vector<ShadowBody> bodies) {
    for (ShadowBody& body : bodies) body.kind = ShadowBody::Kind::Loose;
    return bodies;
}

TEST(Shadows, HowTrianglesAreGroupedChangesNothing) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> place(-3, 3), z(0, 3);
    const std::vector<ShadowBody> bodies = bodiesOf(
        "cube at=1,0 size=1,0.5,1 heading=20\ndesk at=-1,1 heading=70 kind=closed\n"
        "chair at=0,-1.5\nscreen at=-2,-1 heading=30\n");
    ASSERT_GT(bodies.size(), 10U);
    for (int trial = 0; trial < 20; ++trial) {
        const Point3 sensor{place(random), place(random), z(random)};
        const double height = z(random);
        EXPECT_NEAR(shaded(bodies, sensor, height), shaded(loose(bodies), sensor, height), 1e-5)
            << trial;
    }
}

TEST(Shadows, CylindersThrowThoseOfTheirCurves) {
    std::mt19937_64 random(12);
    std::uniform_real_distribution<double> place(-3, 3), size(0.05, 1), tall(0.1, 1.2);
    for (int trial = 0; trial < 100; ++trial) {
        const double radius = size(random), height = tall(random), z = 1.5 + tall(random);
        const Point2 middle{place(random), place(random)}, foot{place(random), place(random)};
        if (distance(middle, foot) < radius + 0.01) continue;
        std::vector<ShadowBody> bodies;
        const Ellipse curve(middle, 2 * radius, 2 * radius, Angle::degrees(7 * trial));
        addPrism(roundPrism(curve, 0, height, Material::Box), bodies);
        // The hull of the foot and of the top's shadow, a disc that is `grown` times as large and
        // as far: between the near side of the one, two tangents and the far side of the other.
        const double grown = z / (z - height), d = distance(middle, foot);
        const double kite = radius * std::sqrt(d * d - radius * radius);
        const double near = std::acos(radius / d) * radius * radius;
        const double far = std::numbers::pi * radius * radius - near;
        EXPECT_NEAR(shaded(bodies, {foot.x, foot.y, z}, 0, {{-40, -40}, {40, 40}}),
                    grown * grown * (kite + far) - (kite - near), 1e-6 * grown * grown)
            << trial;
    }
    // From above: the top alone.
    std::vector<ShadowBody> bodies;
    addPrism(roundPrism(Ellipse({1, 2}, 0.6, 0.4, {}), 0, 1, Material::Box), bodies);
    EXPECT_NEAR(shaded(bodies, {1.1, 2, 2}, 0), 4 * 0.06 * std::numbers::pi, 1e-6);
}

TEST(Shadows, BoxIsSeenInFrontAndFromInside) {
    const std::vector<ShadowBody> bodies = bodiesOf("cube at=0,0 size=2,2,2\n");
    ASSERT_EQ(bodies.size(), 1U);
    EXPECT_EQ(bodies[0].kind, ShadowBody::Kind::Convex);
    EXPECT_NEAR(shaded(bodies, {0, 0, 4}, 0), 16, 1e-6);
    EXPECT_NEAR(shaded(bodies, {0, 0, 4}, 1), 16 * 9 / 16.0, 1e-6);
    EXPECT_NEAR(shaded(bodies, {0, 0, 4}, 1.99995), 0, 1e-6);  // in contact
    // From inside a body only the floor under it is seen.
    EXPECT_NEAR(shaded(bodies, {0, 0, 1}, 0), 1600 - 4, 1e-5);
    EXPECT_NEAR(shaded(bodies, {0, 0, 1}, -1), 1600, 1e-5);
    // On its top, where the top does not count, and on its side.
    EXPECT_NEAR(shaded(bodies, {0, 0, 2}, 0), 1600 - 4, 1e-5);
    EXPECT_NEAR(shaded(bodies, {0.3, 0, 2.00005}, 0), 1600 - 4, 1e-2);
    EXPECT_NEAR(shaded(bodies, {1, 0, 1.5}, 0), 800 - 4, 1e-2);
}

TEST(Shadows, LieOnTheLeftOfTheirEdges) {
    for (const std::vector<ShadowBody>& bodies :
         {bodiesOf("cube at=3,0 size=2,2,2\n"), loose(bodiesOf("screen at=3,0 size=1,2\n"))})
        for (const double z : {-1.0, 4.0}) {
            const Shadows shadows(pointersTo(bodies), {0, 0, z}, 3 - z, kBox);
            for (const ShadowBody& body : bodies)
                for (const Layer& layer : shadows.of(body))
                    for (const Curve& curve : layer.curves) EXPECT_GT(signedArea(curve), 0);
        }
}

TEST(Shadows, BodiesBehindWallsAddNone) {
    std::mt19937_64 random(13);
    std::uniform_real_distribution<double> place(-6, 6), turn(0, 360), z(-1, 3);
    std::size_t bodies_with = 0, bodies_alone = 0;
    for (int trial = 0; trial < 30; ++trial) {
        std::string lines;
        const auto add = [&](const char* record) {
            lines.append(record).append(" at=").append(std::to_string(place(random))).append(",");
            lines.append(std::to_string(place(random)));
            lines.append(" heading=").append(std::to_string(turn(random))).append("\n");
        };
        for (int i = 0; i < 6; ++i) {
            add("wall size=5 height=2.5");
            add(i % 2 == 0 ? "pillar size=0.5,0.3" : "wall size=3 height=2.5 thickness=0.2");
            add("chair");
            add("cylinder size=0.6,0.4,1");
        }
        const std::vector<ShadowBody> bodies = bodiesOf(lines);
        const Point3 sensor{place(random), place(random), z(random)};
        const double height = trial % 3 == 0 ? z(random) : 0;
        const Shadows shadows(pointersTo(bodies), sensor, height, kBox);
        std::vector<Layer> some, all;
        for (const ShadowBody& body : bodies) {
            const Shadows alone(std::array{&body}, sensor, height, kBox);
            for (const Layer& layer : shadows.of(body)) some.push_back(layer);
            for (const Layer& layer : alone.of(body)) all.push_back(layer);
        }
        const auto area = [](const std::vector<Layer>& layers) {
            return Overlay(layers).area([](const LayerLabel& label) { return label.count > 0; });
        };
        EXPECT_NEAR(area(some), area(all), 1e-7) << trial;
        bodies_with += some.size();
        bodies_alone += all.size();
    }
    EXPECT_LT(5 * bodies_with, 4 * bodies_alone);
}

TEST(Shadows, PrismsThatAreNotConvexAreTakenApart) {
    const Prism prism{{{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, 0, 1};
    std::vector<ShadowBody> bodies;
    addPrism(prism, bodies);
    EXPECT_EQ(bodies.size(), 10U);
    std::vector<ShadowBody> parts;
    addPrism({{{0, 0}, {3, 0}, {3, 1}, {0, 1}}, 0, 1}, parts);
    addPrism({{{0, 1}, {1, 1}, {1, 3}, {0, 3}}, 0, 1}, parts);
    addPrism({{{2, 1}, {3, 1}, {3, 3}, {2, 3}}, 0, 1}, parts);
    EXPECT_EQ(parts.size(), 3U);
    for (const Point3 sensor : {Point3{5, 6, 2}, Point3{1.5, 2, 3}, Point3{-4, 1, 1.5}})
        EXPECT_NEAR(shaded(bodies, sensor, 0.2), shaded(parts, sensor, 0.2), 1e-6);
}

TEST(Shadows, AreCutOffAtTheBox) {
    const std::vector<ShadowBody> bodies = bodiesOf("cube at=0,0 size=2,2,2\n");
    EXPECT_NEAR(shaded(bodies, {0, 0, 4}, 0, {{-1, -1}, {5, 1.5}}), 3 * 2.5, 1e-6);
    // It reaches beyond the height of the sensor, and its shadow beyond all bounds.
    EXPECT_NEAR(shaded(bodies, {-2, 0, 1}, 0, {{0, -4}, {4, 4}}), 4 * 3 + 2 * 2 - 1, 1e-6);
}

TEST(CutsOf, LevelPlaneMeetsWhatReachesIt) {
    const std::vector<ShadowBody> bodies = bodiesOf("cube at=0,0 size=2,2,2\n");
    const auto lengthOf = [&](double height) {
        Frame3 plane;
        plane.origin = {0.5, 0, height};
        double sum = 0;
        for (const Segment2& cut : cutsOf(pointersTo(bodies), plane, 9))
            sum += distance(cut.a, cut.b);
        return sum;
    };
    EXPECT_NEAR(lengthOf(1), 8, 1e-12);
    EXPECT_NEAR(lengthOf(2), 8, 1e-12);  // closed: its upper rim is met, not the plane's inside
    EXPECT_NEAR(lengthOf(0), 8, 1e-12);
    EXPECT_EQ(lengthOf(2.001), 0);
    Frame3 far;
    far.origin = {20, 0, 1};
    EXPECT_TRUE(cutsOf(pointersTo(bodies), far, 9).empty());
}

}  // namespace shadow_bodies_test
}  // namespace ispace
