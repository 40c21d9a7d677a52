// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/edit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "record/text.h"
#include "support/test_random_records.h"
#include "support/test_schemas.h"

namespace ispace {
namespace placing_test {

Record make(std::string_view line) { return readRecord(line, "a.env", placedSchemas()); }

std::string placed(std::string_view line, const Pose2& pose, double dz = 0) {
    Record record = make(line);
    placeIn(record, pose, dz);
    return formatRecord(record);
}

std::string moved(std::string_view line, const Pose2& pose, double dz = 0) {
    Record record = make(line);
    moveInFrame(record, pose, dz);
    return formatRecord(record);
}

Pose2 pose(double x, double y, double degrees = 0) { return {{x, y}, Angle::degrees(degrees)}; }

TEST(DecimalSum, IsWhatAPersonAdds) {
    EXPECT_EQ(decimalSum(0.1, 0.2), 0.3);
    EXPECT_EQ(decimalSum(1.1, 2.2, -3.3), 0);
    EXPECT_EQ(decimalSum(1.2, 0.5), 1.7);
    EXPECT_EQ(decimalSum(1e6, 0.1, 0.2), 1000000.3);
    EXPECT_FALSE(std::signbit(decimalSum(-0.0, -0.0)));
    EXPECT_FALSE(std::signbit(decimalSum(-1e-15, 0))) << "less than a rounding error";
}

TEST(DecimalSum, LeavesWhatIsNoDecimal) {
    const double third = 1.0 / 3;
    EXPECT_EQ(decimalSum(third, 1), third + 1);
    EXPECT_EQ(decimalSum(1e-11, 0), 1e-11) << "finer than nine decimals, but no rounding error";
    EXPECT_EQ(decimalSum(1e300, 1), 1e300) << "too large to have decimals";
}

TEST(DecimalSum, OfRandomDecimalsIsTheirs) {
    std::mt19937_64 random(5);
    for (int round = 0; round < 1000; ++round) {
        const auto a = static_cast<std::int64_t>(random() % 2000000) - 1000000,
                   b = static_cast<std::int64_t>(random() % 2000000) - 1000000;
        const auto number = [](std::int64_t thousandths) {
            return static_cast<double>(thousandths) / 1000;
        };
        EXPECT_EQ(decimalSum(number(a), number(b)), number(a + b)) << a << ' ' << b;
    }
}

TEST(TurnedHeading, StaysWithinATurn) {
    EXPECT_EQ(turnedHeading(30, Angle::degrees(0.1)), 30.1);
    EXPECT_EQ(turnedHeading(0.1, Angle::degrees(190)), -169.9);
    EXPECT_EQ(turnedHeading(-90, Angle::degrees(-90)), 180);
    EXPECT_EQ(turnedHeading(350.2, Angle::degrees(9.8)), 0);
    EXPECT_EQ(turnedHeading(0, Angle::degrees(720.3)), 0.3);
}

TEST(PlaceIn, MovesWhatIsWritten) {
    EXPECT_EQ(placed("desk at=1,2 heading=30", pose(10, 20, 90)), "desk at=8,21 heading=120");
    EXPECT_EQ(placed("desk at=1,2,0.5", pose(10, 20)), "desk at=11,22,0.5");
    EXPECT_EQ(placed("fence path=0,0;2,0;2,1", pose(1, 1, 90)), "fence path=1,1;1,3;0,3");
    EXPECT_EQ(placed("wall from=0,0 to=2,0", pose(1, 1, 90)), "wall from=1,1 to=1,3")
        << "neither centre nor heading appear";
    EXPECT_EQ(placed("wall size=2", pose(1, 1, 90)), "wall at=1,1 heading=90 size=2");
}

TEST(PlaceIn, WritesAPlaceThatIsLeftOut) {
    EXPECT_EQ(placed("desk", pose(1, 2)), "desk at=1,2");
    EXPECT_EQ(placed("desk", pose(0, 0, 30)), "desk heading=30");
    EXPECT_EQ(placed("desk at=-1,-2 heading=-30", pose(1, 2, 0)), "desk heading=-30");
    EXPECT_EQ(placed("desk at=1,0 heading=-90", pose(0, -1, 90)), "desk") << "as the default again";
}

TEST(PlaceIn, LeavesWhatHasNoPlaceOfItsOwn) {
    EXPECT_EQ(placed("laser heading=10", pose(1, 2, 30)), "laser heading=10") << "to be placed";
    EXPECT_EQ(placed("laser on=r1 at=0.1,0 heading=10", pose(1, 2, 30)),
              "laser at=0.1,0 heading=10 on=r1");
    EXPECT_EQ(placed("door wall=w1 offset=2", pose(1, 2, 30)), "door wall=w1 offset=2");
    EXPECT_EQ(placed("door at=0,0", pose(1, 2, 30)), "door at=1,2") << "its heading is not known";
    EXPECT_EQ(placed("door at=0,0 heading=0", pose(1, 2, 30)), "door at=1,2 heading=30");
}

TEST(PlaceIn, TakesCoursesAlong) {
    EXPECT_EQ(placed("robot path=1,0;2,0", pose(1, 1, 90)), "robot at=1,1 heading=90 path=1,2;1,3");
}

TEST(PlaceIn, Lifts) {
    EXPECT_EQ(placed("desk", pose(0, 0), 0.5), "desk at=0,0,0.5");
    EXPECT_EQ(placed("desk at=1,1,0.2", pose(0, 0), 0.1), "desk at=1,1,0.3");
    EXPECT_EQ(placed("laser at=1,1", pose(0, 0), 0.7), "laser at=1,1,0.85");
    EXPECT_EQ(placed("laser at=1,1", pose(2, 0), 0), "laser at=3,1");
    EXPECT_EQ(placed("fence path=0,0;1,0", pose(2, 0), 1), "fence path=2,0;3,0");
    EXPECT_TRUE(canRise(make("desk")));
    EXPECT_TRUE(canRise(make("laser"))) << "it does not move";
    EXPECT_FALSE(canRise(make("fence path=0,0;1,0")));
    EXPECT_FALSE(canRise(make("robot")));
}

TEST(PlaceIn, KeepsNumbersShort) {
    EXPECT_EQ(placed("desk at=1.2,0.1", pose(0.5, 0.2)), "desk at=1.7,0.3");
    EXPECT_EQ(placed("desk heading=350", pose(1, 0, 20)), "desk at=1,0 heading=10");
    EXPECT_EQ(placed("desk heading=170", pose(1, 0, 20)), "desk at=1,0 heading=-170");
    EXPECT_EQ(placed("desk heading=90", pose(1, 0, 90)), "desk at=1,0 heading=180");
    EXPECT_EQ(placed("desk heading=0.1", pose(1, 0, 0.2)), "desk at=1,0 heading=0.3");
    EXPECT_EQ(placed("desk heading=350", pose(1, 0, 0)), "desk at=1,0 heading=350");
    EXPECT_EQ(placed("desk heading=350", pose(1, 0, 360)), "desk at=1,0 heading=350");
    EXPECT_EQ(placed("desk at=0.123456789012,0", pose(0, 1)), "desk at=0.123456789012,1")
        << "a coordinate that nothing is added to stays";
    EXPECT_EQ(placed("desk at=1,0", pose(0, 0, 30)), "desk at=0.8660254037844387,0.5 heading=30")
        << "the sine of 30 degrees is not quite a half";
}

TEST(PlaceIn, QuarterTurnsAreExact) {
    for (const double turn : {-270.0, -90.0, 90.0, 180.0, 450.0}) {
        Record desk = make("desk at=0.1234567890123,0.9876543210987");
        placeIn(desk, pose(0, 0, turn));
        placeIn(desk, pose(0, 0, -turn));
        EXPECT_EQ(formatRecord(desk), "desk at=0.1234567890123,0.9876543210987");
    }
}

TEST(PlaceIn, ThereAndBackChangesNothing) {
    std::mt19937_64 random(11);
    const auto decimal = [&random](int steps, double step) {
        return (static_cast<double>(random() % static_cast<unsigned>(2 * steps)) - steps) * step;
    };
    for (int i = 0; i < 5000; ++i) {
        Record desk(*placedSchemas().find("desk"));
        const double x = std::round(decimal(100000, 1)) / 1000, y = decimal(100, 0.5);
        const double turn = decimal(72, 5), heading = decimal(35, 5);
        desk.set("at", Tuple{x, y});
        desk.set("heading", heading);
        const Record before = desk;
        const Pose2 there = pose(decimal(40, 0.25), std::round(decimal(4000, 1)) / 100, turn);
        const Vec2 offset = there.position - Point2{};
        placeIn(desk, there);
        const Tuple at = desk.tuple("at");
        const Point2 want = there * Point2{x, y};
        EXPECT_NEAR(at[0], want.x, 1e-12);
        EXPECT_NEAR(at[1], want.y, 1e-12);
        placeIn(desk, {Point2{} - offset, {}});
        placeIn(desk, pose(0, 0, -turn));
        EXPECT_EQ(desk, before) << formatRecord(before) << " became " << formatRecord(desk);
    }
}

TEST(PlaceIn, NumbersBeyondBoundsAreRefused) {
    EXPECT_EQ(findingsOf([] { (void)placed("desk at=9e5,0", pose(2e5, 0)); }),
              std::vector<std::string>{"a.env:1:9: error: `at`: 1100000 is above 1000000"});
}

TEST(PlaceIn, RandomRecordsKeepTheirKeys) {
    RandomDocuments random(placedSchemas(), 12);
    for (std::size_t i = 0; i < 5000; ++i) {
        Record record = random.record(i);
        const Record before = record;
        placeIn(record, {});
        EXPECT_EQ(record, before);
        try {
            placeIn(record, pose(1, 2, 30), 1);
        } catch (const FormatError&) {
            continue;
        }
        for (const KeySpec& key : record.schema().keys) {
            const bool may_move = key.role == Role::Place || key.role == Role::MotionPlan ||
                                  key.role == Role::Heading;
            if (may_move) continue;
            EXPECT_EQ(record.has(key.name), before.has(key.name));
            if (!record.has(key.name)) continue;
            EXPECT_EQ(*record.find(key.name), *before.find(key.name));
        }
    }
}

TEST(MoveInFrame, MovesCarriedRecordsToo) {
    EXPECT_EQ(moved("laser on=r1 at=0.1,0", pose(1, 2)), "laser at=1.1,2 on=r1");
    EXPECT_EQ(moved("laser on=r1", pose(1, 2)), "laser at=1,2 on=r1");
    EXPECT_EQ(moved("laser on=r1", pose(1, 2), 0.1), "laser at=1,2,0.25 on=r1");
    EXPECT_EQ(moved("laser", pose(1, 2)), "laser");
}

TEST(PlaceOf, IsWhereTheRecordStands) {
    const auto of = [](std::string_view line) { return placeOf(make(line)); };
    EXPECT_EQ(of("desk at=1,2,3"), (Point2{1, 2}));
    EXPECT_EQ(of("desk"), (Point2{0, 0}));
    EXPECT_EQ(of("wall from=1,2 to=3,4"), (Point2{1, 2}));
    EXPECT_EQ(of("wall from=1,2 to=3,4 at=5,6"), (Point2{5, 6}));
    EXPECT_EQ(of("fence path=1,2;3,4"), (Point2{1, 2}));
    EXPECT_EQ(of("laser on=r1"), (Point2{0, 0}));
    EXPECT_EQ(of("laser"), std::nullopt);
    EXPECT_EQ(of("door wall=w offset=1"), std::nullopt);
}

TEST(TurnAbout, KeepsItsCentre) {
    const Pose2 motion = turnAbout({3, 4}, Angle::degrees(90), {0.5, 0});
    EXPECT_EQ(motion * Point2({3, 4}), (Point2{3.5, 4}));
    EXPECT_EQ(motion * Point2({4, 4}), (Point2{3.5, 5}));
    EXPECT_EQ(turnAbout({0.1, 0.2}, {}, {0.3, 0.7}), (Pose2{{0.3, 0.7}, {}}));
}

}  // namespace placing_test
}  // namespace ispace
