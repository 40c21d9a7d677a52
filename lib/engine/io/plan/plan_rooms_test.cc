// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan/plan_rooms.h"

#include <gtest/gtest.h>

#include <random>

#include "base/budget.h"
#include "io/importers.h"
#include "support/test_import.h"
#include "support/test_work.h"

namespace ispace {
namespace plan_rooms_test {

using Lines = std::vector<Segment2>;

void addRectangle(Lines& lines, double x0, double y0, double x1, double y1) {
    for (const Segment2& line : Lines{{{x0, y0}, {x1, y0}},
                                      {{x1, y0}, {x1, y1}},
                                      {{x1, y1}, {x0, y1}},
                                      {{x0, y1}, {x0, y0}}})
        lines.push_back(line);
}

struct Chosen {
    PlanRooms rooms;
    std::string notes, warnings;
    [[nodiscard]] double area() const {
        double sum = 0;
        for (const PlanRegion& region : rooms.regions) sum += region.area();
        return sum;
    }
};

Chosen choose(const PlanWalls& plan, const ImportOptions& options = {}) {
    ImportRecords out(sceneSchemas(), "plan", options);
    Chosen chosen{chooseRooms(plan, options, ampleWork(), out), "", ""};
    const Document document = out.take();
    chosen.notes = notesOf(document);
    chosen.warnings = warningsOf(document);
    return chosen;
}

/// Three closed rooms of 12, 20 and 6 m2 apart from each other.
PlanWalls threeRooms() {
    PlanWalls plan;
    addRectangle(plan.lines, 0, 0, 4, 3);
    addRectangle(plan.lines, 10, 0, 15, 4);
    addRectangle(plan.lines, 20, 0, 23, 2);
    return plan;
}

/// The rooms that importers hand over.
FoundRooms found(const PlanWalls& plan, ImportOptions options = {}) {
    FoundRooms rooms;
    options.found = &rooms;
    choose(plan, options);
    return rooms;
}

TEST(PlanRooms, AllAreHandedOver) {
    PlanWalls plan = threeRooms();
    addRectangle(plan.lines, 0, 6, 0.2, 9);  // the two lines of a wall
    // A porch of 4 m x 2 m with a gap, and a door between it and the first room.
    for (const Segment2& line : Lines{{{0, 0}, {0, -2}}, {{0, -2}, {3.85, -2}}, {{4, -2}, {4, 0}}})
        plan.lines.push_back(line);
    plan.doors = {{{1, 0}, {2, 0}}};
    const FoundRooms rooms = found(plan);
    ASSERT_EQ(rooms.rooms.size(), 3U);
    EXPECT_TRUE(rooms.any_plan);
    double last = 1e9;
    for (const FoundRoom& room : rooms.rooms) {
        EXPECT_LE(room.area, last);
        last = room.area;
        EXPECT_EQ(room.is_kept, room.area == 20);
        ImportOptions options;
        options.inside = {room.inside};
        EXPECT_DOUBLE_EQ(choose(plan, options).area(), room.area) << "as its point chooses it";
    }
    EXPECT_TRUE(rooms.closed_gaps.empty());
}

TEST(PlanRooms, ClosedGapsAreHandedOver) {
    PlanWalls plan;
    plan.lines = {{{0, 0}, {4, 0}}, {{4, 0}, {4, 3}}, {{4, 3}, {0, 3}}, {{0, 3}, {0, 0.1}}};
    const FoundRooms rooms = found(plan);
    ASSERT_EQ(rooms.closed_gaps.size(), 1U);
    EXPECT_NEAR(distance(rooms.closed_gaps[0].a, rooms.closed_gaps[0].b), 0.1, 1e-9);
    ASSERT_EQ(rooms.rooms.size(), 1U);
    EXPECT_TRUE(rooms.rooms[0].touches_border);
    EXPECT_EQ(rooms.rooms[0].inside, (Point2{2, 1.5}));
}

TEST(PlanRooms, OneOfSeveralIsSaid) {
    const Chosen largest = choose(threeRooms());
    EXPECT_DOUBLE_EQ(largest.area(), 20);
    EXPECT_EQ(largest.warnings,
              "plan: warning: kept 20.0 m2 on 5.0 x 4.0 m of a drawing of 23.0 x 4.0 m; other "
              "rooms have 18.0 m2, the largest of them 12.0 m2 about (2.0, 1.5): --inside X,Y "
              "chooses rooms, --rooms all keeps all\n");
}

TEST(PlanRooms, PointsChoose) {
    ImportOptions options;
    options.inside = {{1, 1}};
    EXPECT_DOUBLE_EQ(choose(threeRooms(), options).area(), 12);
    options.inside = {{1, 1}, {21, 1}, {2, 2}};
    const Chosen two = choose(threeRooms(), options);
    EXPECT_DOUBLE_EQ(two.area(), 18);
    EXPECT_EQ(two.warnings, "");
    EXPECT_TRUE(two.rooms.writes_inside);
    options.inside.clear();
    options.known_inside = {{21, 1}};
    const Chosen known = choose(threeRooms(), options);
    EXPECT_DOUBLE_EQ(known.area(), 6);
    EXPECT_FALSE(known.rooms.writes_inside);
}

TEST(PlanRooms, AllButThingsAndHollows) {
    PlanWalls plan = threeRooms();
    addRectangle(plan.lines, 11, 1, 12.5, 2);        // a table in the second room
    addRectangle(plan.lines, -0.2, -0.2, 4.2, 3.2);  // the outer face of the first one's walls
    ImportOptions options;
    options.rooms = RoomChoice::All;
    const Chosen all = choose(plan, options);
    EXPECT_EQ(all.rooms.regions.size(), 3U);
    EXPECT_DOUBLE_EQ(all.area(), 12 + 20 - 1.5 + 6);
    EXPECT_EQ(all.warnings, "");
}

/// A hall of double walls, 0.2 m thick, with an open doorway of 0.9 m and one inner wall.
PlanWalls openHall() {
    PlanWalls plan;
    plan.lines = {{{0, 0}, {3, 0}},       {{3, 0}, {3, 0.2}},     {{3, 0.2}, {0.2, 0.2}},
                  {{0.2, 0.2}, {0.2, 5}}, {{0.2, 5}, {8, 5}},     {{8, 5}, {8, 0.2}},
                  {{8, 0.2}, {3.9, 0.2}}, {{3.9, 0.2}, {3.9, 0}}, {{3.9, 0}, {8.2, 0}},
                  {{8.2, 0}, {8.2, 5.2}}, {{8.2, 5.2}, {0, 5.2}}, {{0, 5.2}, {0, 0}},
                  {{5, 5}, {5, 3}}};
    return plan;
}

TEST(PlanRooms, OpenFrontDoorsAreClosed) {
    const Chosen hall = choose(openHall());
    // The room and the floor in the doorway.
    EXPECT_NEAR(hall.area(), 7.8 * 4.8 + 0.9 * 0.2, 1e-9);
    EXPECT_EQ(hall.warnings,
              "plan: warning: the walls do not close: closed 1 gap of up to 0.9 m (0.900 m at "
              "(3.45, 0.0)); --close-gaps M sets the widest\n");
    ImportOptions options;
    options.close_gaps = 0.5;
    EXPECT_TRUE(choose(openHall(), options).rooms.regions.empty());
    options.close_gaps = 0;
    EXPECT_NE(choose(openHall(), options).notes.find("nothing is enclosed"), std::string::npos);
    // An added line closes it as well.
    options.known_walls = {{{2, 0.1}, {5, 0.1}}};
    EXPECT_NEAR(choose(openHall(), options).area(), 7.8 * 4.8 + 0.9 * 0.1, 1e-9);
}

TEST(PlanRooms, GapsTooSmallToShowAreClosedSilently) {
    PlanWalls plan;
    addRectangle(plan.lines, 0, 0, 6, 4);
    plan.lines.back().a.y -= 4e-5;
    const Chosen room = choose(plan);
    EXPECT_NEAR(room.area(), 24, 1e-9);
    EXPECT_EQ(room.rooms.closing.size(), 1U);
    EXPECT_EQ(room.warnings, "");
}

TEST(PlanRooms, AClosetIsKeptButTheFlatIsNamed) {
    PlanWalls plan = openHall();
    addRectangle(plan.lines, 0.2, 3.5, 1.7, 5);
    const Chosen closet = choose(plan);
    EXPECT_NEAR(closet.area(), 2.25, 1e-9);
    EXPECT_EQ(closet.warnings,
              "plan: warning: only 2.2 m2 are enclosed, the walls are open; with --close-gaps 0.9 "
              "it would be 35.4 m2\n");
}

/// A rectangle whose lines miss each other by up to `reach` at each end.
PlanWalls roughRoom(double reach, std::mt19937_64& random) {
    std::uniform_real_distribution<double> off(-reach, reach);
    PlanWalls plan;
    addRectangle(plan.lines, 0, 0, 8, 5);
    for (Segment2& line : plan.lines)
        for (Point2* p : {&line.a, &line.b}) {
            p->x += off(random);
            p->y += off(random);
        }
    return plan;
}

TEST(PlanRooms, RoughLinesGiveTheRoom) {
    std::mt19937_64 random(5);
    for (int round = 0; round < 50; ++round) {
        const double reach = round % 2 == 0 ? 0.01 : 0.03;
        const Chosen room = choose(roughRoom(reach, random));
        ASSERT_EQ(room.rooms.regions.size(), 1U) << round;
        EXPECT_NEAR(room.area(), 40, 13 * 2 * reach) << round;
    }
}

TEST(PlanRooms, HomeIsTheRoom) {
    PlanWalls plan = threeRooms();
    plan.home = Point2{21, 1};
    const Chosen room = choose(plan);
    EXPECT_DOUBLE_EQ(room.area(), 6);
    EXPECT_EQ(room.rooms.regions[0].inside, (Point2{21, 1}));
    // Without an enclosing room the largest is taken, as by default.
    plan.home = Point2{-9, 50};
    EXPECT_DOUBLE_EQ(choose(plan).area(), 20);
}

TEST(PlanRooms, WallsOfALargeBuildingMayMeet) {
    constexpr std::size_t kBytesALine = 60;
    constexpr double kMeetings = 2.2;  // of each wall
    for (const std::size_t lines : {1'000U, 100'000U, 1'000'000U}) {
        Budget budget(kBytesALine * lines);
        const double crossings = kMeetings * static_cast<double>(lines);
        EXPECT_TRUE(payForCrossings(crossings, lines, RoomChoice::Largest, budget)) << lines;
        EXPECT_FALSE(payForCrossings(20 * crossings, lines, RoomChoice::Largest, budget) &&
                     lines == 1'000'000U);
    }
}

}  // namespace plan_rooms_test
}  // namespace ispace
