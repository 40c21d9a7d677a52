// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/luxes/illuminance.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <string>

#include "base/number.h"
#include "extensions/luxes/luxes_test.h"
#include "scene/sensor/sensor_keys.h"
#include "sense/formats/reading_fields.h"
#include "sim/run_limits.h"
#include "support/test_readings.h"
#include "trace/render/lights.h"

namespace ispace::luxes {
namespace illuminance_test {

/// Returns the illuminance at the first sensor of a room that is 2.5 m high.
double luxIn(const std::string& room, const std::string& layout, const TakerOptions& options = {},
             int frame = 0) {
    const Scene scene = testing::scene("ispace size=8,6,2.5 ceiling=yes\n" + room, layout);
    return std::get<AddedReading>(testing::readings(scene, options, frame).front())
        .as<Illuminance>()
        .lux;
}

constexpr const char* kLamp = "lamp at=0,0 on=yes lumens=3000\n";

/// Integrates the light of a lamp of 3000 lm above a spot that faces up.
double expectedBelow(double distance) {
    constexpr int kParts = 400;
    const double half = static_cast<double>(Lamps::kHalf);
    double sum = 0;
    for (int i = 0; i < kParts; ++i)
        for (int j = 0; j < kParts; ++j) {
            const double x = half * (2 * (i + 0.5) / kParts - 1);
            const double y = half * (2 * (j + 0.5) / kParts - 1);
            const double square = x * x + y * y + distance * distance;
            sum += distance * distance / (square * square);
        }
    return 3000 / std::numbers::pi * sum / (kParts * kParts);
}

TEST(Illuminance, IsThatOfALambertianPanel) {
    EXPECT_NEAR(luxIn(kLamp, "lux at=0,0,0.5 tilt=90\n") / expectedBelow(1.98), 1, 1e-5);
    EXPECT_NEAR(luxIn(kLamp, "lux at=0,0,1.5 tilt=90\n") / expectedBelow(0.98), 1, 1e-5);
    const double whole = luxIn(kLamp, "lux at=1,0,0.5 tilt=90\n");
    EXPECT_NEAR(luxIn("lamp at=0,0 on=yes lumens=3000 level=25%\n", "lux at=1,0,0.5 tilt=90\n"),
                0.25 * whole, 1e-9);
    EXPECT_NEAR(
        luxIn(kLamp + std::string("lamp at=2,0 on=yes lumens=3000\n"), "lux at=1,0,0.5 tilt=90\n"),
        2 * whole, 1e-3);
    EXPECT_EQ(luxIn("lamp at=0,0 lumens=3000\n", "lux at=0,0,0.5 tilt=90\n"), 0) << "off";
}

/// Integrates the light of a lamp of 3000 lm over the origin at a spot, by a fine grid.
double integrated(Point3 spot, Vec3 facing, Angle heading = {}) {
    constexpr int kParts = 1600;
    const double half = static_cast<double>(Lamps::kHalf), height = 2.48;
    double sum = 0;
    for (int i = 0; i < kParts; ++i)
        for (int j = 0; j < kParts; ++j) {
            const double along = half * (2 * (i + 0.5) / kParts - 1);
            const double across = half * (2 * (j + 0.5) / kParts - 1);
            const Vec2 at =
                along * unitVector(heading) + across * perpendicular(unitVector(heading));
            const Vec3 way = Point3{at.x, at.y, height} - spot;
            const double square = dot(way, way);
            sum += std::max(0.0, dot(way, facing)) * way.z / (square * square);
        }
    return 3000 / std::numbers::pi * sum / (kParts * kParts);
}

TEST(Illuminance, IsExactNearAPanel) {
    const auto expect_near = [](const std::string& keys, Point3 spot, Vec3 facing) {
        const double expected = integrated(spot, facing);
        EXPECT_NEAR(luxIn(kLamp, "lux " + keys + '\n') / expected, 1, 2e-4) << keys;
    };
    expect_near("at=0,0,2.38 tilt=90", {0, 0, 2.38}, {0, 0, 1});
    expect_near("at=0.1,0.2,2.43 tilt=90", {0.1, 0.2, 2.43}, {0, 0, 1});
    expect_near("at=0.35,0.35,2.4 tilt=90", {0.35, 0.35, 2.4}, {0, 0, 1});
    // The plane of the spot cuts the panel.
    expect_near("at=0.1,0,2.3", {0.1, 0, 2.3}, {1, 0, 0});
    expect_near("at=0.34,0.1,2.3", {0.34, 0.1, 2.3}, {1, 0, 0});
    expect_near("at=-1,0.3,1 heading=20 tilt=35", {-1, 0.3, 1},
                {std::cos(0.6108652381980153) * std::cos(0.3490658503988659),
                 std::cos(0.6108652381980153) * std::sin(0.3490658503988659),
                 std::sin(0.6108652381980153)});
}

TEST(Illuminance, PanelsTurnWithTheirLamps) {
    const auto near = [](double degrees) {
        return luxIn("lamp at=0,0 on=yes lumens=3000 heading=" + formatDouble(degrees) + '\n',
                     "lux at=0.4,0,2.43 tilt=90\n");
    };
    for (const double degrees : {0.0, 20.0, 45.0, -70.0})
        EXPECT_NEAR(near(degrees) / integrated({0.4, 0, 2.43}, {0, 0, 1}, Angle::degrees(degrees)),
                    1, 2e-4)
            << degrees;
    // A corner reaches over the spot.
    EXPECT_GT(near(45), 3 * near(0));
    EXPECT_NEAR(near(20), near(-70), 1e-9 * near(20))
        << "a square is the same after a quarter turn";
}

TEST(Illuminance, DependsOnTheFacing) {
    EXPECT_EQ(luxIn(kLamp, "lux at=0,0,0.5 tilt=-90\n"), 0);
    EXPECT_EQ(luxIn(kLamp, "lux at=-2,0,1 heading=180\n"), 0);
    EXPECT_GT(luxIn(kLamp, "lux at=-2,0,1\n"), 10);
    EXPECT_EQ(luxIn(kLamp, "lux at=0,0,2.49 tilt=90\n"), 0) << "above the lamps";
}

TEST(Illuminance, FurnitureWallsAndPeopleCastShadows) {
    EXPECT_EQ(luxIn(kLamp + std::string("table at=0,0\n"), "lux at=0,0.1,0.3 tilt=90\n"), 0);
    EXPECT_EQ(luxIn(kLamp + std::string("wall from=-1,-3 to=-1,3\n"), "lux at=-2,0,1\n"), 0);
    EXPECT_EQ(luxIn(kLamp, "lux at=-2,0,1\nhuman at=-1.5,0\n"), 0);
    EXPECT_EQ(luxIn(kLamp, "lux at=-2,0,1\nhuman at=-1.5,1\n"), luxIn(kLamp, "lux at=-2,0,1\n"));
}

TEST(Illuminance, HasTheLightOfProjectors) {
    // At 3 m a picture of 2 * 3 * tan(30 deg) by 2 * 3 * tan(15 deg), seen head-on.
    const double area = 36 * std::tan(std::numbers::pi / 6) * std::tan(std::numbers::pi / 12);
    const std::string beam = "projector at=-3,0 height=1 on=yes fov=60,30 lumens=2000";
    EXPECT_NEAR(luxIn(beam + '\n', "lux at=0,0,1 heading=180\n"), 2000 / area, 1e-6);
    EXPECT_NEAR(luxIn(beam + " level=20%\n", "lux at=0,1.5,1 heading=180\n"), 400 / area, 1e-6);
    EXPECT_EQ(luxIn(beam + " pan=31\n", "lux at=0,0,1 heading=180\n"), 0);
    EXPECT_EQ(luxIn(beam + '\n', "lux at=0,0,1\n"), 0) << "it faces away";
    EXPECT_EQ(luxIn(beam + "\nwall from=-1,-3 to=-1,3\n", "lux at=0,0,1 heading=180\n"), 0);
    EXPECT_EQ(luxIn(beam + '\n', "lux at=0,0,1 heading=180\nhuman at=-1,0\n"), 0);
    EXPECT_NEAR(luxIn(kLamp + beam + '\n', "lux at=-1,0,1 heading=180\n"),
                luxIn(kLamp, "lux at=-1,0,1 heading=180\n") + 2000 / area * 9 / 4, 1e-6);
}

TEST(Illuminance, HasAConstantFactorAndSteps) {
    const auto measured = [](int seed, int frame, const std::string& keys) {
        return luxIn(kLamp, "lux at=0,0,0.5 tilt=90 " + keys + '\n',
                     {.noise_seed = static_cast<std::uint64_t>(seed)}, frame);
    };
    EXPECT_EQ(measured(1, 0, "error=20%"), measured(1, 7, "error=20%"));
    const double exact = luxIn(kLamp, "lux at=0,0,0.5 tilt=90\n");
    double squares = 0;
    constexpr int kSeeds = 100;
    for (int seed = 0; seed < kSeeds; ++seed)
        squares += std::pow(measured(seed, 0, "error=20%") / exact - 1, 2);
    EXPECT_NEAR(std::sqrt(squares / kSeeds), 0.2, 5 * 0.0142);
    EXPECT_EQ(measured(1, 0, "resolution=50"), 50 * std::round(exact / 50));
    EXPECT_EQ(measured(1, 0, "max=100"), 100);
}

TEST(Illuminance, ABlindOfAWindowStopsLight) {
    const auto through = [](const std::string& window) {
        return luxIn(
            "wall id=w from=0,-4 to=0,4\nlamp at=1.2,0 on=yes\nwindow wall=w at=0,0 size=2 " +
                window + '\n',
            "lux at=-0.5,0,1\n");
    };
    const double lux = through("");
    EXPECT_GT(lux, 1);
    EXPECT_EQ(through("open=yes"), lux) << "clear glass is no shadow";
    EXPECT_EQ(through("blind=yes"), 0);
    EXPECT_EQ(through("blind=yes open=yes"), 0);
}

TEST(Illuminance, HasATopic) {
    const auto topics = readingKind(modelOf(Lux())).topics;
    ASSERT_EQ(topics.size(), 1U);
    EXPECT_EQ(topics[0].name, "illuminance");
    EXPECT_EQ(topics[0].type, RosType::Illuminance);
}

TEST(Lux, ItsRaysAreThoseOfLampsThatAreOn) {
    const Scene scene = testing::scene(
        "ispace size=8,6\n"
        "lamp at=0,0 on=yes\nlamp at=1,0 on=yes\nlamp at=2,0 on=no\n",
        "lux at=1,1\n");
    EXPECT_EQ(loadOf(scene, std::chrono::milliseconds(5), nullptr).beams, 16 * 3);
}

TEST(Lux, ReadsItsKeys) {
    const auto read = [](const std::string& keys) {
        const Record record = testing::sensorRecord("lux " + keys);
        return parametersOf<Lux>(record, testing::deviceFor(record));
    };
    EXPECT_EQ(read(""), Lux());
    const Lux lux = read("max=500 resolution=0.5 error=10% rate=4");
    EXPECT_EQ(lux.max, 500);
    EXPECT_EQ(lux.resolution, 0.5);
    EXPECT_EQ(lux.error, 0.1);
    EXPECT_EQ(lux.rate, 4);
    EXPECT_EQ(read("model=bh1750fvi").resolution, 1);
}

}  // namespace illuminance_test
}  // namespace ispace::luxes
