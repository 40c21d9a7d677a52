// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/thermometers/temperature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "extensions/thermometers/thermometers_test.h"
#include "sense/formats/reading_fields.h"
#include "support/test_readings.h"

namespace ispace::thermometers {
namespace temperature_test {

constexpr const char* kCold = "weather celsius=0\n";
// 4 x 5 m: 30 W/K and 3.3 MJ/K.
constexpr const char* kZone = "zone id=z at=0,0 size=4,5\n";

/// Returns the reading of the first sensor of a room of 8 x 6 m at a time.
Temperature temperatureIn(const std::string& room, double time = 0,
                          const std::string& layout = "thermometer zone=z at=0,0,1.5\n",
                          const TakerOptions& options = {}) {
    const Scene scene = testing::scene("ispace size=8,6\n" + room, layout);
    const Sensors sensors = sensorsOf(scene, {});
    RayScenes worlds(scene.environment);
    const MovingBodies bodies(bodiesOf(scene));
    ReadingSampler taker(sensors, worlds, bodies, options);
    const ReadingJob job{0, 0, time, sensors.read[0].pose, {}};
    taker.prepare(job);
    return std::get<AddedReading>(taker.take(job)).as<Temperature>();
}

TEST(Temperature, CoolsExponentially) {
    const std::string room = std::string(kCold) + kZone;
    const double constant = 165e3 / 1.5;
    EXPECT_EQ(temperatureIn(room).celsius, 20);
    for (const double time : {600.0, 3600.0, 1e5})
        EXPECT_NEAR(temperatureIn(room, time).celsius, 20 * std::exp(-time / constant), 1e-12);
    EXPECT_NEAR(temperatureIn(room, 1e8).celsius, 0, 1e-9);
    EXPECT_EQ(temperatureIn(kZone).steady, 10) << "without weather";
}

TEST(Temperature, OfAHeatedZoneRisesToPowerOverLoss) {
    const std::string room = std::string(kCold) + kZone + "heater id=h at=1,1 on=yes watts=900\n";
    EXPECT_NEAR(temperatureIn(room, 1e8).celsius, 30, 1e-9);
    EXPECT_NEAR(temperatureIn(room + "heater at=3,0 on=yes\n").steady, 30, 1e-12) << "outside";
    EXPECT_NEAR(temperatureIn(room + "heater at=0,0\n").steady, 30, 1e-12) << "off";
    EXPECT_NEAR(temperatureIn(room + "heater at=0,0 on=yes watts=900 level=50%\n").steady, 45,
                1e-12);
    EXPECT_NEAR(temperatureIn(room + "lamp at=0,0 on=yes lumens=3000\n").steady, 31, 1e-12);
    EXPECT_NEAR(temperatureIn(std::string(kCold) + "heater at=0,0 on=yes watts=900\nzone id=z "
                                                   "at=0,0 size=4,5 loss=3 storage=80 celsius=25\n",
                              1000)
                    .celsius,
                15 + 10 * std::exp(-1000 * 3 / 80e3), 1e-12);
}

TEST(Temperature, RisesWithPeopleInTheZone) {
    const std::string room = std::string(kCold) + kZone;
    const std::string inside = "thermometer zone=z at=0,0,1.5\nhuman at=1,1\nhuman at=-1,-1\n";
    EXPECT_NEAR(temperatureIn(room, 0, inside).steady, 150 / 30.0, 1e-12);
    EXPECT_NEAR(temperatureIn(room, 0, inside + "human at=3,0\nrobot at=0,0\n").steady, 150 / 30.0,
                1e-12);
}

TEST(Temperature, FollowsWindowsAndTheSun) {
    // The window is on the outline of a zone of the whole room: 48 m2, 72 W/K.
    const std::string room = "weather celsius=0 sun=500\nzone id=z at=0,0 size=8,6\n";
    const std::string window = "window id=w at=4,0 size=2 height=1.5";
    EXPECT_NEAR(temperatureIn(room + window + '\n').steady, 0.6 * 500 * 3 / 72, 1e-12);
    EXPECT_EQ(temperatureIn(room + window + " blind=yes\n").steady, 0);
    EXPECT_EQ(temperatureIn(room + window + " glass=opaque\n").steady, 0);
    EXPECT_NEAR(temperatureIn(room + window + " open=yes\n").constant, 165e3 * 48 / (72 + 270),
                1e-6);
    EXPECT_NEAR(temperatureIn(room + "window from=4,-1 to=4,1 height=1.5\n").steady,
                0.6 * 500 * 3 / 72, 1e-12);
    EXPECT_EQ(
        temperatureIn("weather celsius=0 sun=500\n" + std::string(kZone) + window + '\n').steady, 0)
        << "of another zone";
}

TEST(Temperature, OfAWindowIsOfTheZoneBehindIt) {
    const std::string room =
        "weather celsius=0 sun=500\nzone id=west at=-2,0 size=4,6\nzone id=east at=2,0 size=4,6\n";
    const auto steady = [&](const char* zone, const char* window) {
        return temperatureIn(room + window, 0,
                             std::string("thermometer at=0,0 zone=") + zone + '\n')
            .steady;
    };
    const char* const corner = "window at=0.2,3 size=1 height=1\n";
    EXPECT_NEAR(steady("east", corner), 300 / 36.0, 1e-12);
    EXPECT_EQ(steady("west", corner), 0);
    const char* const between = "fence id=f path=0,-2;0,2\nwindow wall=f size=1,0.1,1 offset=3\n";
    EXPECT_EQ(steady("east", between), 0);
    EXPECT_EQ(steady("west", between), 0);
}

TEST(Temperature, OfAWellInsulatedZoneRisesByItsPower) {
    const double rise = temperatureIn(std::string(kCold) +
                                          "zone id=z at=0,0 size=4,5 loss=0.001 storage=1e4\n"
                                          "heater at=0,0 on=yes watts=1000\n",
                                      1)
                            .celsius -
                        20;
    EXPECT_NEAR(rise, (1000 - 0.02 * 20) / (1e7 * 20), 1e-14);
    EXPECT_THROW(temperatureIn("zone id=z at=0,0 size=4,5 loss=1e-9\n"), FormatError);
}

TEST(Temperature, RequiresZonesWithAnExtent) {
    try {
        temperatureIn("zone id=z at=0,0\n");
        FAIL() << "no extent";
    } catch (const FormatError& error) {
        EXPECT_NE(std::string(error.what()).find("room.env:3:1"), std::string::npos)
            << error.what();
    }
}

TEST(Temperature, FindsWindowsAlongTheirWalls) {
    // 1 m before the end of the second wall of the fence: at 4,2.
    const std::string room =
        "weather celsius=0 sun=500\nzone id=z at=3,2 size=2,1\nfence id=f path=-4,-3;4,-3;4,3\n";
    const auto steady = [&](const char* offset) {
        return temperatureIn(room + "window wall=f size=1,0.1,1 offset=" + offset + '\n').steady;
    };
    EXPECT_NEAR(steady("13"), 0.6 * 500 / 3, 1e-12);
    EXPECT_EQ(steady("11"), 0);
}

TEST(Temperature, ContinuesFromTheReadingBefore) {
    const std::string cold = std::string(kCold) + kZone;
    const std::string warm = cold + "heater at=0,0 on=yes watts=900\n";
    const double constant = 165e3 / 1.5;
    const Temperature first = temperatureIn(cold, 5000);
    Temperature next = temperatureIn(warm, 8000);
    goOn(first, 3000, next);
    EXPECT_NEAR(next.celsius, 30 + (first.celsius - 30) * std::exp(-3000 / constant), 1e-12);
    // In small steps it is the same.
    Temperature last = first;
    for (int k = 1; k <= 30; ++k) {
        Temperature step = temperatureIn(warm, 5000 + 100 * k);
        goOn(last, 100, step);
        last = step;
    }
    EXPECT_NEAR(last.celsius, next.celsius, 1e-9);
    // Earlier readings are no past.
    Temperature back = temperatureIn(cold, 1000);
    goOn(next, 1000 - 8000, back);
    EXPECT_NEAR(back.celsius, 20 * std::exp(-1000 / constant), 1e-12);
}

TEST(Temperature, HasNoiseInReadingsAlone) {
    TakerOptions noisy;
    noisy.noise_seed = 3;
    const std::string room = std::string(kCold) + kZone;
    const std::string layout =
        "thermometer zone=z at=0,0,1.5 error=0.5 resolution=0.25 limits=-10,19\n";
    const Temperature one = temperatureIn(room, 20000, layout, noisy);
    EXPECT_NEAR(one.truth, temperatureIn(room, 20000).celsius, 1e-12);
    EXPECT_NE(one.celsius, one.truth);
    EXPECT_EQ(one.celsius, 0.25 * std::round(one.celsius / 0.25));
    EXPECT_EQ(temperatureIn(room, 20000, layout).celsius, one.truth) << "without noise";
    EXPECT_EQ(temperatureIn("zone id=z at=0,0 size=4,5 celsius=60\n", 0, layout, noisy).celsius,
              19);
    Temperature next = temperatureIn(room, 30000, layout, noisy);
    goOn(one, 10000, next);
    EXPECT_NEAR(next.truth, temperatureIn(room, 30000).celsius, 1e-9)
        << "errors do not add up in the zone";
}

TEST(Temperature, IsOfTheZoneInWhichItStands) {
    const std::string room =
        "zone id=west at=-2,0 size=4,6 celsius=18\nzone id=east at=2,0 size=4,6 celsius=23\n";
    EXPECT_EQ(temperatureIn(room, 0, "thermometer at=3,0\n").celsius, 23);
    EXPECT_EQ(temperatureIn(room, 0, "thermometer at=-3,0\n").celsius, 18);
    EXPECT_EQ(temperatureIn(room, 0, "thermometer at=-3,0 zone=east\n").celsius, 23);
    EXPECT_THROW(temperatureIn(room, 0, "thermometer at=-3,0 zone=eats\n"), FormatError);
    EXPECT_THROW(temperatureIn(kZone, 0, "thermometer at=3,0\n"), FormatError);
    EXPECT_THROW(temperatureIn(kZone, 0, "thermometer at=0,0 limits=5,5\n"), FormatError);
}

TEST(Temperature, HasATopic) {
    const auto topics = readingKind(modelOf(Thermometer())).topics;
    ASSERT_EQ(topics.size(), 1U);
    EXPECT_EQ(topics[0].name, "temperature");
    EXPECT_EQ(topics[0].type, RosType::Temperature);
}

}  // namespace temperature_test
}  // namespace ispace::thermometers
