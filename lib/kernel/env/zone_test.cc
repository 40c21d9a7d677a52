// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/zone.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "env/element_schemas.h"
#include "record/text.h"

namespace ispace {
namespace zone_test {

Environment room() {
    static const Schemas schemas(environmentSchemas());
    const Document document = readRecordText(
        "#env 1\nispace size=8,6\nzone id=entrance path=0,0;0,1;1,1\nzone id=desk at=1,1 size=2,1\n"
        "zone at=-1,-1 size=1,1\n",
        "room.env", schemas);
    return {document.records, assignIds(document.records)};
}

std::string refusal(const std::string& text) {
    try {
        static_cast<void>(readZone(text, room()));
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(ReadZone, FindsRecords) {
    const NamedZone zone = readZone("entrance", room());
    EXPECT_EQ(zone.name, "entrance");
    EXPECT_NEAR(signedArea(zone.outline), 0.5, 1e-12) << "counter-clockwise";
    EXPECT_NEAR(zone.inside.x, 1.0 / 3, 1e-12);
    EXPECT_NEAR(zone.inside.y, 2.0 / 3, 1e-12);
    EXPECT_FALSE(zone.is_center_outside);
    EXPECT_EQ(bounds(readZone("desk", room()).outline), (Box2{{0, 0.5}, {2, 1.5}}));
    EXPECT_EQ(readZone("zone1", room()).inside, (Point2{-1, -1})) << "ids that are not written";
}

TEST(ReadZone, TakesRectanglesAndPolygons) {
    const NamedZone zone = readZone("rect:3,-1,1,50cm", room());
    EXPECT_EQ(zone.name, "rect:3,-1,1,50cm");
    EXPECT_EQ(zone.outline, (Polygon{{1, -1}, {3, -1}, {3, 0.5}, {1, 0.5}}));
    EXPECT_EQ(zone.inside, (Point2{2, -0.25}));
    const NamedZone polygon = readZone("poly:0,0;0,2;2,2;2,0", room());
    EXPECT_GT(signedArea(polygon.outline), 0);
    EXPECT_NEAR(distance(polygon.inside, Point2{1, 1}), 0, 1e-12);
    // Given around to its first corner again.
    EXPECT_NEAR(signedArea(readZone("poly:0,0;2,0;2,2;0,0", room()).outline), 2, 1e-12);
}

TEST(ReadZone, WarnsOfACentreThatLiesOutside) {
    // A U, whose centre of gravity lies between its arms.
    const NamedZone zone = readZone("poly:0,0;6,0;6,5;5,5;5,1;1,1;1,5;0,5", room());
    EXPECT_TRUE(zone.is_center_outside);
    EXPECT_EQ(locate(zone.outline, zone.inside), Side::Inside);
    // An L of which it lies on the boundary: 3 x 1 and 1 x 2 have it at (1, 1).
    const NamedZone corner = readZone("poly:0,0;3,0;3,1;1,1;1,3;0,3", room());
    EXPECT_EQ(locate(corner.outline, corner.inside), Side::Inside);
    EXPECT_FALSE(readZone("poly:0,0;6,0;6,5;0,5", room()).is_center_outside);
}

TEST(ReadZones, TakesGlobsOfIds) {
    const auto names = [](const char* text) {
        std::string list;
        for (const NamedZone& zone : readZones(text, room())) list += zone.name + ' ';
        return list;
    };
    EXPECT_EQ(names("*"), "entrance desk zone1 ");
    EXPECT_EQ(names("?e*"), "desk ");
    EXPECT_EQ(names("desk"), "desk ");
    EXPECT_EQ(names("*/?e*"), "desk ") << "a room alone is all rooms";
    EXPECT_THROW(static_cast<void>(readZones("b*", room())), UsageError);
    static const Schemas schemas(environmentSchemas());
    const std::string all = "*";
    EXPECT_TRUE(zoneRecords({&all, 1}, room(), schemas).empty()) << "they are records";
}

TEST(ReadZone, KeepsTheDigitsOfSmallPolygonsFarAway) {
    const NamedZone zone = readZone("poly:900000,900000;900000.01,900000;900000,900000.01", room());
    EXPECT_FALSE(zone.is_center_outside);
    EXPECT_NEAR(zone.inside.x - 900000, 0.01 / 3, 1e-9);
}

TEST(ReadZone, RefusesWhatIsNone) {
    EXPECT_EQ(refusal("entrence"),
              "the room has no zone `entrence`, did you mean `entrance`?; its zones: entrance, "
              "desk, zone1; "
              "write the id of a zone, rect:X,Y,X,Y, poly:X,Y;X,Y;X,Y or door:GLOB[,M]");
    EXPECT_NE(refusal("Desk").find("no zone `Desk`, did you mean `desk`?; its"), std::string::npos);
    EXPECT_NE(refusal("ground/door:*")
                  .find("no zone `ground/door:*`: of one storey alone it is "
                        "`door:*`; its"),
              std::string::npos);
    EXPECT_NE(refusal("ground/desk").find(": of one storey alone it is `desk`; its"),
              std::string::npos);
    EXPECT_EQ(refusal("ground/thing").find("alone"), std::string::npos);
    EXPECT_NE(refusal(""), "");
    EXPECT_NE(refusal("room1"), "") << "not a zone";
    EXPECT_EQ(refusal("poly:0,0;1,1"), "zone `poly:0,0;1,1` has 2 corners, wanted at least 3");
    EXPECT_EQ(refusal("poly:0,0;1,1;2,2"), "zone `poly:0,0;1,1;2,2` has no area");
    EXPECT_EQ(refusal("rect:0,0,0,3"), "zone `rect:0,0,0,3` has no area");
    EXPECT_EQ(refusal("poly:0,0;2,2;2,0;0,2"),
              "zone `poly:0,0;2,2;2,0;0,2` crosses itself near (1.00, 1.00)");
    for (const char* text : {"rect:", "rect:1,2,3", "rect:1,2,3,4,5", "rect:a,0,1,1",
                             "rect:nan,0,1,1", "rect:0,0,1e7,1", "poly:", "poly:1,2,3;4,5,6;7,8,9",
                             "poly:0,0;1,0;1,1;", "poly:0,0;1,0;1deg,1"})
        EXPECT_NE(refusal(text).find("is no zone: "), std::string::npos) << text << refusal(text);
}

}  // namespace zone_test
}  // namespace ispace
