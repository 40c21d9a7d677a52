// SPDX-License-Identifier: GPL-3.0-or-later
// Places from distances.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "sense/locate.h"

namespace ispace {
namespace locate_test {

using Points = std::vector<Point3>;

constexpr Vec3 kDown{0, 0, -1};

double distance(Point3 a, Point3 b) { return length(b - a); }

std::vector<double> distancesTo(const Points& receivers, Point3 place) {
    std::vector<double> distances;
    distances.reserve(receivers.size());
    for (const Point3 receiver : receivers) distances.push_back(distance(receiver, place));
    return distances;
}

/// The place by receivers that all have one cone, of half a space unless told otherwise.
std::optional<PositionFix> locate(const Points& receivers, const std::vector<double>& distances,
                                  Vec3 axis, double fov = 180, double error = 0) {
    std::vector<Hearing> heard;
    const double size = length(axis);
    for (std::size_t i = 0; i < receivers.size(); ++i)
        heard.push_back({receivers[i], size > 0 ? (1 / size) * axis : axis, Angle::degrees(fov),
                         distances[i], error});
    return ispace::locate(heard);
}

/// A square grid at a ceiling.
Points ceiling(int columns, int rows, double pitch, double height) {
    Points receivers;
    receivers.reserve(static_cast<std::size_t>(columns * rows));
    for (int i = 0; i < columns; ++i) {
        for (int j = 0; j < rows; ++j) receivers.push_back({i * pitch, j * pitch, height});
    }
    return receivers;
}

class Random {
  public:
    explicit Random(unsigned seed) : random_(seed) {}
    double in(double low, double high) {
        return std::uniform_real_distribution<>(low, high)(random_);
    }
    double normal() { return normal_(random_); }
    int count(int low, int high) { return std::uniform_int_distribution<>(low, high)(random_); }
    Point3 place(Point3 low, Point3 high) {
        return {in(low.x, high.x), in(low.y, high.y), in(low.z, high.z)};
    }

  private:
    std::mt19937 random_;
    std::normal_distribution<> normal_;
};

TEST(Locate, ThesisFourReceiversAreTheLeast) {
    Points receivers = ceiling(2, 2, 1, 2.5);
    const Point3 tag{0.3, 0.6, 0.8};
    const auto fix = locate(receivers, distancesTo(receivers, tag), kDown);
    ASSERT_TRUE(fix);
    EXPECT_LT(distance(fix->position, tag), 1e-9);
    EXPECT_LT(fix->residual, 1e-12);
    receivers.pop_back();
    EXPECT_FALSE(locate(receivers, distancesTo(receivers, tag), kDown));
    EXPECT_FALSE(locate({}, {}, kDown));
}

TEST(Locate, ThreeDistancesFixAPlaceBetweenHeights) {
    const Points receivers = {{0, 0, 2.4}, {5, 0, 2.4}, {0, 4, 2.4}};
    Random random(11);
    for (int i = 0; i < 50; ++i) {
        const Point3 tag = random.place({0.2, 0.2, 0.1}, {4.8, 3.8, 1.9});
        std::vector<Hearing> heard;
        for (const Point3 receiver : receivers)
            heard.push_back({receiver, {1, 0, 0}, Angle::degrees(360), distance(receiver, tag)});
        // The mirror image lies above the room.
        const auto fix = ispace::locate(heard, {3, 0, 2.5});
        ASSERT_TRUE(fix);
        EXPECT_LT(distance(fix->position, tag), 1e-6);
        EXPECT_LT(fix->pdop, 1e3);
        // In a higher room nothing tells the two apart: the axes point along the plane.
        EXPECT_FALSE(ispace::locate(heard, {3, 0, 9}));
        EXPECT_FALSE(ispace::locate(heard));
        EXPECT_FALSE(ispace::locate(std::span(heard).first(2), {2, 0, 2.5}));
        for (Hearing& one : heard) one.axis = kDown;
        const auto below = ispace::locate(heard, {3, 0, 9});
        ASSERT_TRUE(below);
        EXPECT_LT(distance(below->position, tag), 1e-6);
        EXPECT_EQ(below->pdop, HUGE_VAL) << "of two candidates";
        // No place in the room fits.
        EXPECT_FALSE(ispace::locate(heard, {3, 6, 9}));
    }
}

TEST(Locate, ReceiversInALineFixNothing) {
    const Point3 tag{1, 2, 0.5};
    for (const Vec3 along : {Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{1, -2, 0.3}}) {
        Points receivers;
        for (const double at : {0.0, 0.7, 1.0, 2.5, 4.0})
            receivers.push_back(Point3{-3, 8, 2.5} + at * along);
        EXPECT_FALSE(locate(receivers, distancesTo(receivers, tag), kDown));
    }
    const Points same(5, Point3{1, 1, 2.5});
    EXPECT_FALSE(locate(same, distancesTo(same, tag), kDown));
}

TEST(Locate, ACeilingGridAnywhereInTheRoom) {
    Random random(1);
    for (int round = 0; round < 500; ++round) {
        const Points receivers =
            ceiling(random.count(2, 6), random.count(2, 6), random.in(0.2, 2), random.in(2, 4));
        const Point3 tag =
            random.place({-4, -4, 0}, {12, 12, receivers[0].z - random.in(1e-3, 0.5)});
        const auto fix = locate(receivers, distancesTo(receivers, tag), kDown);
        ASSERT_TRUE(fix);
        ASSERT_LT(distance(fix->position, tag), 1e-3) << round;
        ASSERT_LT(fix->residual, 1e-7);
        ASSERT_NEAR(fix->pdop, std::hypot(fix->hdop, fix->vdop), 1e-6 * fix->pdop);
    }
}

TEST(Locate, APlaneOfAnyTiltGivesTheSideItLooksTo) {
    Random random(2);
    for (int round = 0; round < 500; ++round) {
        const Vec3 u{random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)};
        const Vec3 v{random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)};
        const Vec3 normal = cross(u, v);
        if (length(normal) < 0.1) continue;
        const Point3 middle = random.place({-50, -50, 0}, {50, 50, 10});
        Points receivers;
        const int count = random.count(4, 12);
        for (int i = 0; i < count; ++i)
            receivers.push_back(middle + random.in(-3, 3) * u + random.in(-3, 3) * v);
        const double height = random.in(0.05, 5);
        const Point3 tag = middle + random.in(-6, 6) * u + random.in(-6, 6) * v + height * normal;
        const auto distances = distancesTo(receivers, tag);
        const auto fix = locate(receivers, distances, normal);
        ASSERT_TRUE(fix);
        ASSERT_LT(distance(fix->position, tag), 1e-3) << round;
        // Mirrored to the other side, which is as good.
        const auto mirrored = locate(receivers, distances, -1 * normal);
        ASSERT_TRUE(mirrored);
        ASSERT_LT(distance(mirrored->position, tag + (-2 * height) * normal), 1e-3) << round;
        ASSERT_LT(mirrored->residual, 1e-7);
    }
}

TEST(Locate, ReceiversAnywhereTellTheSideThemselves) {
    Random random(3);
    for (int round = 0; round < 500; ++round) {
        const Point3 origin = random.place({-1e5, -1e5, 0}, {1e5, 1e5, 10});
        const int count = random.count(4, 20);
        const double thickness = std::pow(10, random.in(-2, 0.5));
        Points receivers;
        for (int i = 0; i < count; ++i) {
            const Point3 place = random.place({-4, -4, 0}, {4, 4, thickness});
            receivers.push_back(origin + (place - Point3()));
        }
        const Point3 tag = origin + (random.place({-20, -20, -10}, {20, 20, 10}) - Point3());
        for (const Vec3 towards : {kDown, Vec3{0, 0, 1}}) {
            const auto fix = locate(receivers, distancesTo(receivers, tag), towards, 360);
            ASSERT_TRUE(fix);
            ASSERT_LT(distance(fix->position, tag), 1e-3) << round;
        }
    }
}

TEST(Locate, InThePlaneOfTheReceivers) {
    Random random(4);
    const Points receivers = ceiling(4, 4, 0.8, 2.5);
    for (int round = 0; round < 200; ++round) {
        const Point3 tag = random.place({-3, -3, 2.5}, {6, 6, 2.5});
        const auto fix = locate(receivers, distancesTo(receivers, tag), kDown);
        ASSERT_TRUE(fix);
        ASSERT_LT(distance(fix->position, tag), 1e-3);
        EXPECT_GT(fix->vdop, 1e3);
        EXPECT_TRUE(std::isfinite(fix->hdop));
        EXPECT_LT(fix->hdop, 20);
    }
    // At a receiver, near one, and right below one.
    for (const double below : {0.0, 1e-9, 1e-6, 1e-3, 0.02, 1.0}) {
        const Point3 tag{0.8, 1.6, 2.5 - below};
        const auto fix = locate(receivers, distancesTo(receivers, tag), kDown);
        ASSERT_TRUE(fix);
        EXPECT_LT(distance(fix->position, tag), 1e-3) << below;
    }
}

TEST(Locate, FarOutsideOfTheReceivers) {
    const Points receivers = ceiling(3, 3, 1, 2.5);
    for (const double away : {10.0, 30.0, 100.0}) {
        const Point3 tag{away, -away / 2, 0.3};
        const auto fix = locate(receivers, distancesTo(receivers, tag), kDown);
        ASSERT_TRUE(fix);
        EXPECT_LT(distance(fix->position, tag), 1e-3) << away;
    }
}

TEST(Locate, DilutionInClosedForm) {
    // Three right angles: one unit of each axis, one axis twice.
    const Points receivers{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 2}};
    const auto fix = locate(receivers, distancesTo(receivers, {0, 0, 0}), kDown);
    ASSERT_TRUE(fix);
    EXPECT_LT(distance(fix->position, {0, 0, 0}), 1e-9);
    EXPECT_NEAR(fix->hdop, std::sqrt(2.0), 1e-9);
    EXPECT_NEAR(fix->vdop, std::sqrt(0.5), 1e-9);
    EXPECT_NEAR(fix->pdop, std::sqrt(2.5), 1e-9);
}

TEST(Locate, ResidualInClosedForm) {
    // In the middle of four at once too far or too near, only a wrong length stays.
    const Points receivers{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    const auto fix = locate(receivers, std::vector<double>(6, 1.25), kDown, 360);
    ASSERT_TRUE(fix);
    EXPECT_LT(distance(fix->position, {0, 0, 0}), 1e-8);
    EXPECT_NEAR(fix->residual, 0.25, 1e-12);
}

/// Errors of many fixes of one tag whose distances have noise of `sigma`.
struct Errors {
    double across = 0, up = 0;  // root mean squares
    double residual = 0;        // mean square
    double bias = 0;            // length of the mean error
    PositionFix exact;
};
Errors errorsOf(const Points& receivers, Point3 tag, double sigma, int rounds, unsigned seed) {
    const auto located = [&receivers, sigma](const std::vector<double>& distances) {
        const bool is_ceiling = receivers[0].z == receivers[1].z;
        return locate(receivers, distances, kDown, is_ceiling ? 180 : 360, sigma).value();
    };
    Random random(seed);
    const auto exact = distancesTo(receivers, tag);
    Errors errors;
    errors.exact = located(exact);
    Vec3 sum;
    for (int round = 0; round < rounds; ++round) {
        auto noisy = exact;
        for (double& d : noisy) d += sigma * random.normal();
        const PositionFix fix = located(noisy);
        const Vec3 error = fix.position - tag;
        errors.across += (error.x * error.x + error.y * error.y) / rounds;
        errors.up += error.z * error.z / rounds;
        errors.residual += fix.residual * fix.residual / rounds;
        sum = {sum.x + error.x, sum.y + error.y, sum.z + error.z};
    }
    errors.across = std::sqrt(errors.across);
    errors.up = std::sqrt(errors.up);
    errors.bias = length(sum) / rounds;
    return errors;
}

TEST(Locate, ErrorsAreSigmaTimesDilution) {
    constexpr double kSigma = 0.005;
    constexpr int kRounds = 5000;
    // Five standard deviations of a root mean square; across has up to twice the freedom.
    const double slack = 5 / std::sqrt(2.0 * kRounds);
    const std::vector<Points> layouts{
        ceiling(2, 2, 1.5, 2.5),
        ceiling(4, 3, 1, 3),
        {{0, 0, 2.5}, {3, 0, 2}, {3, 3, 2.4}, {0, 3, 1}, {1.5, 1.5, 2.5}, {-1, 1, 0.2}}};
    for (const Points& receivers : layouts) {
        for (const Point3 tag : {Point3{1, 1, 0.4}, Point3{-0.5, 2, 1}, Point3{2.5, 0.2, 0}}) {
            const Errors errors = errorsOf(receivers, tag, kSigma, kRounds, 5);
            EXPECT_NEAR(errors.across / (kSigma * errors.exact.hdop), 1, slack);
            EXPECT_NEAR(errors.up / (kSigma * errors.exact.vdop), 1, slack);
            EXPECT_LT(errors.bias, kSigma * errors.exact.pdop * 5 / std::sqrt(double{kRounds}));
            // Three of n freedoms go into the place.
            const auto n = static_cast<double>(receivers.size());
            EXPECT_NEAR(errors.residual / (kSigma * kSigma * (n - 3) / n), 1,
                        5 * std::sqrt(2.0 / (kRounds * (n - 3))));
        }
    }
}

TEST(Locate, ACrookedCeilingIsAPlaneAsFarAsNoiseTells) {
    // Millimetres of unevenness say nothing about the side where distances err by centimetres.
    Random random(6);
    Points receivers = ceiling(4, 4, 1, 2.5);
    for (Point3& receiver : receivers) receiver.z += random.in(-0.001, 0.001);
    const Point3 tag{1.2, 1.9, 0.5};
    int above = 0;
    for (int round = 0; round < 1000; ++round) {
        auto distances = distancesTo(receivers, tag);
        for (double& d : distances) d += 0.01 * random.normal();
        const PositionFix fix = locate(receivers, distances, kDown, 360, 0.01).value();
        if (fix.position.z > 2.5) ++above;
        // It may as well be above: that a centimetre means so much is told.
        const PositionFix sure = locate(receivers, distances, kDown, 180, 0.01).value();
        EXPECT_EQ(sure.position, fix.position);
        EXPECT_LT(sure.pdop, 2);
        EXPECT_GT(fix.pdop, 100);
        EXPECT_GT(fix.vdop, 100);
        EXPECT_NEAR(fix.pdop, std::hypot(fix.hdop, fix.vdop), 1e-9 * fix.pdop);
    }
    EXPECT_EQ(above, 0);
}

TEST(Locate, NoiseBeyondThePlaneStaysFinite) {
    // Distances that meet nowhere, as of a tag among the receivers.
    Random random(7);
    const Points receivers = ceiling(3, 3, 1, 2.5);
    for (int round = 0; round < 500; ++round) {
        const Point3 tag = random.place({-1, -1, 2.3}, {3, 3, 2.5});
        auto distances = distancesTo(receivers, tag);
        for (double& d : distances) d = std::max(0.0, d + 0.05 * random.normal());
        const PositionFix fix = locate(receivers, distances, kDown, 180, 0.05).value();
        ASSERT_LT(distance(fix.position, tag), 1);
        ASSERT_LE(fix.position.z, 2.5 + 1e-6);
        ASSERT_LT(fix.residual, 0.1);
        // It is the best place around.
        const auto cost = [&](Point3 place) {
            double sum = 0;
            for (std::size_t i = 0; i < receivers.size(); ++i) {
                const double error = distance(receivers[i], place) - distances[i];
                sum += error * error;
            }
            return std::sqrt(sum / static_cast<double>(receivers.size()));
        };
        ASSERT_NEAR(cost(fix.position), fix.residual, 1e-9);
        for (int i = 0; i < 20; ++i) {
            const Point3 near = fix.position + Vec3{random.in(-0.01, 0.01), random.in(-0.01, 0.01),
                                                    random.in(-0.01, 0.01)};
            ASSERT_GE(cost(near), fix.residual - 1e-9);
        }
    }
}

TEST(Locate, NoPlaceIsBehindReceiversThatAreNearlyInOnePlane) {
    // One receiver hangs lower by a little, as they do; distances err by a centimetre.
    constexpr double kSigma = 0.01, kFov = 120;
    Random random(8);
    for (const double lower : {0.0, 0.001, 0.01, 0.05}) {
        Points receivers = ceiling(2, 2, 2, 2.5);
        receivers[3].z -= lower;
        int heard = 0, found = 0;
        for (int round = 0; round < 5000; ++round) {
            const Point3 tag = random.place({-1, -1, 0}, {3, 3, 2.3});
            const auto hears = [&](Point3 receiver) {
                return receiver.z - tag.z >=
                       distance(receiver, tag) * std::cos(Angle::degrees(60).radians());
            };
            if (!std::all_of(receivers.begin(), receivers.end(), hears)) continue;
            ++heard;
            auto distances = distancesTo(receivers, tag);
            for (double& d : distances) d += kSigma * random.normal();
            const auto fix = locate(receivers, distances, kDown, kFov, kSigma);
            if (!fix) continue;
            ++found;
            EXPECT_LT(fix->position.z, 2.5) << lower << ' ' << round;
            EXPECT_LT(distance(fix->position, tag), 8 * kSigma * fix->pdop)
                << lower << ' ' << round;
        }
        EXPECT_GT(heard, 1000);
        EXPECT_EQ(found, heard) << lower;
    }
}

TEST(Locate, ConesDecideBetweenMirrorImages) {
    // All look to the lower image.
    std::vector<Hearing> heard;
    const Point3 tag{1, 1, 0.5};
    for (const Point3 place :
         {Point3{0, 0, 1}, Point3{2, 0, 1}, Point3{2, 2, 1}, Point3{0, 2, 1}}) {
        const Vec3 inwards = tag - place;
        heard.push_back(
            {place, (1 / length(inwards)) * inwards, Angle::degrees(20), distance(place, tag), 0});
    }
    EXPECT_LT(distance(ispace::locate(heard).value().position, tag), 1e-6);
    // All of space is heard: the axes still say which, and the dilution that they say no more.
    for (Hearing& one : heard) one.fov = Angle::degrees(360);
    const PositionFix fix = ispace::locate(heard).value();
    EXPECT_LT(distance(fix.position, tag), 1e-6);
    EXPECT_TRUE(std::isinf(fix.pdop));
    EXPECT_TRUE(std::isinf(fix.vdop));
    EXPECT_TRUE(std::isfinite(fix.hdop));
    // Neither image is heard.
    for (Hearing& one : heard) {
        one.axis = {0, 0, 1};
        one.fov = Angle::degrees(20);
    }
    EXPECT_FALSE(ispace::locate(heard));
}

TEST(Locate, AxesAlongTheReceiversPlaneTellNoSide) {
    const std::vector<Point3> receivers = {{0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}};
    const Point3 tag{0.5, 0.7, 0.4};
    std::vector<double> distances;
    for (const Point3& receiver : receivers) distances.push_back(length(tag - receiver));
    EXPECT_FALSE(locate(receivers, distances, {1, 0, 0}, 360));
    EXPECT_FALSE(locate(receivers, distances, {}, 360));
    EXPECT_NEAR(locate(receivers, distances, {0, 0, -1})->position.z, 0.4, 1e-9);
    EXPECT_NEAR(locate(receivers, distances, {0, 0, 1})->position.z, 1.6, 1e-9);
}

}  // namespace locate_test
}  // namespace ispace
