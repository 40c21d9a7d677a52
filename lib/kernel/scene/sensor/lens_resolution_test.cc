// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/lens_resolution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "support/test_sensors.h"

namespace ispace {

namespace lens_resolution_test {

class RandomLenses {
  public:
    Camera next() {
        for (;;) {
            Camera camera;
            camera.columns = static_cast<int>(uniform(200, 2000));
            camera.rows = static_cast<int>(uniform(200, 2000));
            camera.center();
            camera.lens = kLenses[count_++ % kLenses.size()];
            camera.fx = uniform(0.3, 1.5) * camera.columns;
            camera.fy = camera.fx * uniform(0.8, 1.25);
            camera.cx += uniform(-0.4, 0.4) * camera.columns;
            camera.cy += uniform(-0.4, 0.4) * camera.rows;
            if (camera.lens == Lens::Mirror)
                camera.mirror = uniform(0, 1);
            else
                for (std::size_t i = 0; i < 5; ++i) camera.distortion[i] = coefficient(camera, i);
            camera.widest = camera.turningAngle();
            if (camera.widest.degrees() > 5) return camera;
        }
    }
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }

  private:
    /// Tangential distortion is below the others, as in lenses.
    double coefficient(const Camera& camera, std::size_t i) {
        const bool is_fisheye = camera.lens == Lens::Fisheye;
        if (i == 4 && is_fisheye) return 0;
        if (is_fisheye) return uniform(-0.1, 0.1) / std::pow(4.0, static_cast<double>(i));
        return i == 2 || i == 3 ? uniform(-0.08, 0.08) : uniform(-0.3, 0.3);
    }

    static constexpr std::array<Lens, 5> kLenses = {Lens::Pinhole, Lens::Fisheye, Lens::Pinhole,
                                                    Lens::Mirror, Lens::Pinhole};
    std::mt19937_64 random_{11};
    std::size_t count_ = 0;
};

std::string nameOf(const Camera& camera) {
    std::string name =
        std::to_string(static_cast<int>(camera.lens)) + " fx=" + std::to_string(camera.fx) +
        " cx=" + std::to_string(camera.cx) + " cy=" + std::to_string(camera.cy) +
        " pixels=" + std::to_string(camera.columns) + "," + std::to_string(camera.rows);
    for (const double d : camera.distortion) name += " " + std::to_string(d);
    return name;
}

TEST(LensResolution, BoundsAreAboveAllDirections) {
    RandomLenses lenses;
    for (int lens = 0; lens < 40; ++lens) {
        const Camera camera = lenses.next();
        const LensResolution resolution(camera);
        const double widest = camera.widestInPicture().radians();
        double most = 0, farthest = 0;
        const int rings = camera.isLopsided() ? 200 : 20'000;
        for (int ring = 0; ring <= rings; ++ring)
            for (int k = 0; k < (camera.isLopsided() ? 360 : 1); ++k) {
                const double angle = widest * ring / rings;
                const double bearing = 2 * std::numbers::pi * k / 360;
                const Vec3 way{std::cos(angle), std::sin(angle) * std::cos(bearing),
                               std::sin(angle) * std::sin(bearing)};
                const double pixels = resolution.at(way);
                most = std::max(most, pixels);
                farthest = std::max(farthest, pixels * (camera.lens == Lens::Pinhole ? way.x : 1));
            }
        const double above = camera.isLopsided() ? 1.15 : 1.02;
        EXPECT_GE(resolution.most(), most) << nameOf(camera);
        EXPECT_LE(resolution.most(), above * most) << nameOf(camera);
        EXPECT_GE(resolution.farthest(1), farthest) << nameOf(camera);
        EXPECT_LE(resolution.farthest(1), above * farthest) << nameOf(camera);
    }
}

TEST(LensResolution, BoundsOfLopsidedLensesOf89DegreesAreNear) {
    for (const double tangential : {1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
        Camera camera;
        camera.columns = camera.rows = 2000;
        camera.center();
        camera.lens = Lens::Pinhole;
        camera.fx = camera.fy = 18;
        camera.distortion = {0, 0, tangential, -tangential / 2, 0};
        camera.widest = camera.turningAngle();
        const LensResolution resolution(camera);
        const double widest = camera.widestInPicture().radians();
        double most = 0, farthest = 0;
        for (int ring = 0; ring <= 1000; ++ring)
            for (int k = 0; k < 720; ++k) {
                const double angle = widest * ring / 1000;
                const double bearing = 2 * std::numbers::pi * k / 720;
                const Vec3 way{std::cos(angle), std::sin(angle) * std::cos(bearing),
                               std::sin(angle) * std::sin(bearing)};
                most = std::max(most, resolution.at(way));
                farthest = std::max(farthest, resolution.at(way) * way.x);
            }
        EXPECT_GE(resolution.most(), most) << tangential;
        EXPECT_LE(resolution.most(), 1.1 * most) << tangential;
        EXPECT_GE(resolution.farthest(1), farthest) << tangential;
        EXPECT_LE(resolution.farthest(1), 1.5 * farthest) << tangential;
    }
}

TEST(LensResolution, BoundsHoldAroundPoints) {
    RandomLenses lenses;
    for (int lens = 0; lens < 40; ++lens) {
        const Camera camera = lenses.next();
        const LensResolution resolution(camera);
        for (int i = 0; i < 100; ++i) {
            const auto coordinate = [&lenses](double most) { return lenses.uniform(-most, most); };
            const Vec3 center{coordinate(3), coordinate(3), coordinate(3)};
            const double radius = lenses.uniform(0, 1) * (i % 2 == 0 ? 0.05 : 1);
            const Interval bounds = resolution.around(center, radius);
            for (int k = 0; k < 100; ++k) {
                Vec3 way{coordinate(1), coordinate(1), coordinate(1)};
                way = (radius * (k % 2 == 0 ? 1 : lenses.uniform(0, 1)) / length(way)) * way;
                const double pixels = resolution.at(Point3{} + center + way - Point3{});
                EXPECT_GE(pixels, bounds.low * (1 - 1e-9) - 1e-9) << nameOf(camera);
                EXPECT_LE(pixels, bounds.high * (1 + 1e-9) + 1e-9) << nameOf(camera);
            }
        }
        // Near an axis that is not the end of the lens the bounds are as tight as the ball.
        const Vec3 way{1, 0.01, 0.02};
        const Interval narrow = resolution.around(way, 1e-7);
        EXPECT_NEAR(narrow.low, resolution.at(way), 1e-4 * resolution.at(way)) << nameOf(camera);
        EXPECT_NEAR(narrow.high, resolution.at(way), 1e-4 * resolution.at(way)) << nameOf(camera);
    }
}

}  // namespace lens_resolution_test
}  // namespace ispace
