// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/rfids/rfid_tags.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "extensions/rfids/rfids_test.h"
#include "scene/sensor/sensor_keys.h"
#include "sense/formats/reading_fields.h"
#include "support/test_readings.h"

namespace ispace::rfids {
namespace rfid_tags_test {

using Texts = std::vector<std::string>;

/// Returns the tags that the first sensor of a scene reads.
Texts tagsIn(const std::string& room, const std::string& layout, const TakerOptions& options = {},
             int frame = 0) {
    const Scene scene = testing::scene("ispace size=12,12\n" + room, layout);
    return std::get<AddedReading>(testing::readings(scene, options, frame).front())
        .as<RfidTags>()
        .tags;
}

constexpr const char* kCrate = "cube at=2.5,0 size=0.4,0.4,0.8 tag=crate\n";

TEST(RfidTags, AreThoseOfPeopleRobotsAndThings) {
    EXPECT_EQ(tagsIn(kCrate,
                     "rfid at=0,0,1\n"
                     "robot model=pioneer-2dx at=2,-0.8 tag=r7\n"
                     "human at=2,0.8 tag=anna\n"
                     "human at=2.5,1.4\n"),
              (Texts{"anna", "crate", "r7"}));
    EXPECT_EQ(tagsIn("", "rfid at=0,0,1\nhuman at=1,0.5 tag=b\nhuman at=1,-0.5 tag=b\n"),
              Texts{"b"});
}

TEST(RfidTags, AreInRangeAndFieldOfView) {
    EXPECT_EQ(tagsIn(kCrate, "rfid at=0,0,1 range=2.4\n"), Texts());
    EXPECT_EQ(tagsIn(kCrate, "rfid at=0,0,1 range=2.6,4\n"), Texts());
    EXPECT_EQ(tagsIn(kCrate, "rfid at=0,0,1 heading=34\n"), Texts{"crate"});
    EXPECT_EQ(tagsIn(kCrate, "rfid at=0,0,1 heading=36\n"), Texts());
    EXPECT_EQ(tagsIn(kCrate, "rfid at=0,0,1 heading=36 fov=80,70\n"), Texts{"crate"});
    EXPECT_EQ(tagsIn("", "rfid at=0,0,1\nhuman at=4,0 tag=anna\n"), Texts());
    EXPECT_EQ(tagsIn("", "rfid at=0,0,1 range=5\nhuman at=4,0 tag=anna\n"), Texts{"anna"});
}

TEST(RfidTags, WallsAndMoversHideThem) {
    EXPECT_EQ(tagsIn("wall from=1,-3 to=1,3\n" + std::string(kCrate),
                     "rfid at=0,0,1\nhuman at=2,0.8 tag=anna\n"),
              Texts());
    EXPECT_EQ(tagsIn(kCrate, "rfid at=0,0,1\nhuman at=1.5,0\n"), Texts());
    EXPECT_EQ(tagsIn(kCrate, "rfid at=0,0,1\nhuman at=1.5,1\n"), Texts{"crate"});
    EXPECT_EQ(tagsIn("", "rfid at=0,0,1\nhuman at=1.5,0\nhuman at=2.6,0 tag=anna\n"), Texts());
    // The carrier of the reader does not.
    EXPECT_EQ(tagsIn(kCrate, "rfid at=0,0,1 on=h1\nhuman id=h1 tag=own\n"), Texts{"crate"});
}

TEST(RfidTags, AreReadInAShareOfTheRounds) {
    const std::string reader = "rfid at=0,0,1 read=30%\nhuman at=2,0.8 tag=anna\n";
    constexpr int kRounds = 400;
    int crates = 0, both = 0;
    for (int frame = 0; frame < kRounds; ++frame) {
        const Texts tags = tagsIn(kCrate, reader, {.noise_seed = 5}, frame);
        crates += !tags.empty() && tags.back() == "crate" ? 1 : 0;
        both += tags.size() == 2 ? 1 : 0;
        if (frame < 10) {
            EXPECT_EQ(tags, tagsIn(kCrate, reader, {.noise_seed = 5}, frame));
        }
    }
    EXPECT_NEAR(crates, 0.3 * kRounds, 5 * 9.2);
    EXPECT_NEAR(both, 0.09 * kRounds, 5 * 5.7) << "tags are lost each for itself";
    EXPECT_EQ(tagsIn(kCrate, reader).size(), 2U) << "without noise";
}

TEST(RfidTags, GlassStopsRadio) {
    const auto through = [](const std::string& window) {
        return tagsIn(
            "wall id=w from=0,-4 to=0,4\ncube at=2,0 size=0.3,0.3,1.2 tag=vase\n"
            "window wall=w at=0,0 size=2 " +
                window + '\n',
            "rfid at=-0.5,0,1.2\n");
    };
    EXPECT_EQ(through(""), Texts());
    EXPECT_EQ(through("open=yes"), Texts{"vase"});
}

TEST(RfidTags, HaveATopic) {
    const auto topics = readingKind(modelOf(Rfid())).topics;
    ASSERT_EQ(topics.size(), 1U);
    EXPECT_EQ(topics[0].name, "tags");
    EXPECT_EQ(topics[0].type, RosType::String);
}

TEST(Rfid, ReadsItsKeys) {
    const auto read = [](const std::string& keys) {
        const Record record = testing::sensorRecord("rfid " + keys);
        return parametersOf<Rfid>(record, testing::deviceFor(record));
    };
    EXPECT_EQ(read(""), Rfid());
    const Rfid rfid = read("range=0.2,6 fov=60,40 rate=20 read=90%");
    EXPECT_EQ(rfid.min_range, 0.2);
    EXPECT_EQ(rfid.max_range, 6);
    EXPECT_EQ(rfid.fov_y, Angle::degrees(40));
    EXPECT_EQ(rfid.rate, 20);
    EXPECT_EQ(rfid.read, 0.9);
    EXPECT_TRUE(rfid.isNoisy());
    EXPECT_EQ(read("model=mfrc522").max_range, 0.05);
    EXPECT_NE(testing::findings([&] { return read("range=3,2"); }).find("above the greatest"),
              std::string::npos);
}

}  // namespace rfid_tags_test
}  // namespace ispace::rfids
