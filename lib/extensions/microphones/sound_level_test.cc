// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/microphones/sound_level.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>

#include "extensions/microphones/microphones_test.h"
#include "scene/sensor/sensor_keys.h"
#include "sense/formats/reading_fields.h"
#include "sim/run_limits.h"
#include "support/test_readings.h"

namespace ispace::microphones {
namespace sound_level_test {

/// Returns the level that a microphone at 0,0,1 reports.
double levelIn(const std::string& room, const std::string& keys = "floor=0",
               const TakerOptions& options = {}, int frame = 0) {
    const Scene scene =
        testing::scene("ispace size=12,12,2.5\n" + room, "microphone at=0,0,1 " + keys + '\n');
    return std::get<AddedReading>(testing::readings(scene, options, frame).front())
        .as<SoundLevel>()
        .level;
}

std::string speaker(double x, double volume = 70) {
    return "speaker on=yes height=1 at=" + std::to_string(x) +
           ",0 volume=" + std::to_string(volume) + '\n';
}

TEST(SoundLevel, FallsWithTheDistance) {
    EXPECT_NEAR(levelIn(speaker(1)), 70, 1e-5);
    EXPECT_NEAR(levelIn(speaker(2)), 70 - 6.0206, 1e-4);
    EXPECT_NEAR(levelIn(speaker(-4)), 70 - 12.0412, 1e-4);
    EXPECT_NEAR(levelIn(speaker(0.01)), 90, 1e-4) << "no nearer than 0.1 m";
    EXPECT_NEAR(levelIn(speaker(0)), 90, 1e-4);
    EXPECT_EQ(levelIn("speaker at=1,0\n"), 0) << "it is off";
}

TEST(SoundLevel, AddsEnergies) {
    EXPECT_NEAR(levelIn(speaker(1) + speaker(-1)), 73.0103, 1e-4);
    EXPECT_NEAR(levelIn(speaker(1, 40), "floor=40"), 43.0103, 1e-4) << "and its own noise";
    EXPECT_EQ(levelIn(speaker(1), "floor=0 max=60"), 60);
}

TEST(SoundLevel, WallsMakeItQuieter) {
    const double free = 70 - 12.0412;
    const std::string thin = "wall from=2,-6 to=2,6\n",
                      thick = "wall from=2,-6 to=2,6 thickness=0.3\n";
    EXPECT_NEAR(levelIn(speaker(4) + thin), free - 30, 1e-2);
    EXPECT_NEAR(levelIn(speaker(4) + thick), free - 30, 1e-2) << "one wall, of two faces";
    EXPECT_NEAR(levelIn(speaker(4) + thin, "floor=0 loss=7"), free - 7, 1e-3);
    EXPECT_NEAR(levelIn(speaker(4) + thick + "wall from=3,-6 to=3,6\n", "floor=0 loss=7"),
                free - 14, 1e-3);
    EXPECT_NEAR(levelIn(speaker(4) + "wall from=5,-6 to=5,6\n"), free, 1e-4)
        << "behind the speaker";
    // Through an open door.
    EXPECT_NEAR(levelIn(speaker(4) + thin + "door at=2,0 open=yes\n"), free, 1e-4);
    EXPECT_NEAR(levelIn(speaker(4) + thin + "door at=2,0\n", "floor=0 loss=7"), free - 7, 1e-3);
}

TEST(SoundLevel, SpreadsWithNoise) {
    double sum = 0, squares = 0;
    constexpr int kFrames = 400;
    for (int frame = 0; frame < kFrames; ++frame) {
        const double error = levelIn(speaker(1), "floor=0 sigma=2", {.noise_seed = 3}, frame) - 70;
        sum += error;
        squares += error * error;
    }
    EXPECT_NEAR(sum / kFrames, 0, 5 * 0.1);
    EXPECT_NEAR(std::sqrt(squares / kFrames), 2, 5 * 0.07);
    EXPECT_EQ(levelIn(speaker(1), "floor=0 sigma=2"), levelIn(speaker(1)));
}

TEST(SoundLevel, HasATopic) {
    const auto topics = readingKind(modelOf(Microphone())).topics;
    ASSERT_EQ(topics.size(), 1U);
    EXPECT_EQ(topics[0].name, "level");
    EXPECT_EQ(topics[0].type, RosType::Float64);
}

TEST(Microphone, ItsRaysAreThoseOfSpeakersThatSound) {
    const Scene scene = testing::scene("ispace size=8,6\nspeaker at=0,1 on=yes\nspeaker at=1,0\n",
                                       "microphone at=1,1\n");
    EXPECT_EQ(loadOf(scene, std::chrono::milliseconds(5), nullptr).beams, 1 + 8);
}

TEST(Microphone, ReadsItsKeys) {
    const auto read = [](const std::string& keys) {
        const Record record = testing::sensorRecord("microphone " + keys);
        return parametersOf<Microphone>(record, testing::deviceFor(record));
    };
    EXPECT_EQ(read(""), Microphone());
    EXPECT_FALSE(Microphone().isNoisy());
    const Microphone microphone = read("floor=20 max=110 loss=40 sigma=1 rate=2");
    EXPECT_EQ(microphone.floor, 20);
    EXPECT_EQ(microphone.max, 110);
    EXPECT_EQ(microphone.loss, 40);
    EXPECT_EQ(microphone.sigma, 1);
    EXPECT_EQ(microphone.rate, 2);
    EXPECT_EQ(read("model=inmp441").floor, 33);
    EXPECT_NE(testing::findings([&] { return read("floor=50 max=40"); }).find("louder"),
              std::string::npos);
}

}  // namespace sound_level_test
}  // namespace ispace::microphones
