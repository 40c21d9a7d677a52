// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/zone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "env/element_schemas.h"
#include "record/text.h"

namespace ispace {
namespace door_zones_test {

const Schemas& schemas() {
    static const Schemas kSchemas(environmentSchemas());
    return kSchemas;
}

/// A thin wall with a door of 1 m, and a wall of 0.2 m with another.
Environment room() {
    const Document document = readRecordText(
        "#env 1\nispace size=8,6\nwall id=w from=-2,-3 to=-2,3\nwall id=t from=2,-3 to=2,3 "
        "thickness=0.2\ndoor id=front wall=w from=-2,0 to=-2,1\n"
        "door id=back wall=t from=2,-0.45 to=2,0.45\nzone id=front-zone at=0,0 size=1,1\n",
        "room.env", schemas());
    return {document.records, assignIds(document.records)};
}

std::string refusal(const std::string& text) {
    try {
        static_cast<void>(readZones(text, room()));
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(DoorZones, OneForEachDoor) {
    const double pi = std::numbers::pi;
    const std::vector<NamedZone> zones = readZones("door:*,0.8", room());
    ASSERT_EQ(zones.size(), 2U);
    EXPECT_EQ(zones[0].name, "door:front,0.8");
    EXPECT_NEAR(signedArea(zones[0].outline), 1.6 + 0.64 * pi, 0.01);
    EXPECT_NEAR(zones[0].inside.x, -2, 1e-9);
    EXPECT_NEAR(zones[0].inside.y, 0.5, 1e-9);
    // Around a doorway of 0.9 m x 0.2 m.
    EXPECT_EQ(zones[1].name, "door:back,0.8");
    EXPECT_NEAR(signedArea(zones[1].outline), 0.18 + 0.8 * 2.2 + 0.64 * pi, 0.01);
    const Box2 box = bounds(zones[1].outline);
    EXPECT_NEAR(box.high.x, 2.9, 1e-9);
    EXPECT_NEAR(box.low.y, -1.25, 1e-9);
    EXPECT_EQ(readZones("door:f*,80cm", room()).size(), 1U);
    EXPECT_EQ(readZones("front-zone", room()).front().name, "front-zone");
    EXPECT_EQ(readZones("rect:0,0,1,1", room()).size(), 1U);
}

TEST(DoorZones, ReachOneAndAHalfMetresUnlessTheyTellOtherwise) {
    const std::vector<NamedZone> zones = readZones("door:*", room());
    ASSERT_EQ(zones.size(), 2U);
    EXPECT_EQ(zones[0].name, "door:front,1.5");
    EXPECT_EQ(zones[0].outline, readZones("door:front,1.5", room())[0].outline);
    EXPECT_EQ(zones[1].name, "door:back,1.5");
}

TEST(DoorZones, RefusesWhatIsNone) {
    EXPECT_EQ(
        refusal("door:frond,1"),
        "the room has no door `frond`, did you mean `front`?; its doors: front (1.00 m), back "
        "(0.90 m)");
    EXPECT_EQ(refusal("door:"), "`door:` is no zone: wanted door:GLOB[,M], such as door:*,0.8");
    for (const char* text : {"door:*,", "door:*,0", "door:*,-1", "door:*,nan", "door:*,x"})
        EXPECT_NE(refusal(text).find("is no zone: "), std::string::npos) << text << refusal(text);
    const Document empty = readRecordText("#env 1\nispace size=8,6\n", "room.env", schemas());
    const Environment bare(empty.records, assignIds(empty.records));
    EXPECT_THROW(static_cast<void>(readZones("door:*,1", bare)), UsageError);
}

TEST(DoorZones, AsRecords) {
    const std::vector<std::string> texts{"door:*,0.8", "rect:0,0,1,2", "front-zone"};
    const std::vector<Record> records = zoneRecords(texts, room(), schemas());
    ASSERT_EQ(records.size(), 3U) << "that of the room is there";
    EXPECT_EQ(records[0].writtenId(), "front-zone-2");
    EXPECT_EQ(records[1].writtenId(), "back-zone");
    EXPECT_EQ(records[2].writtenId(), "");
    EXPECT_EQ(records[2].list("path").size(), 4U);
}

}  // namespace door_zones_test
}  // namespace ispace
