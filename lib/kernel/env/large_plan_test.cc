// SPDX-License-Identifier: GPL-3.0-or-later
// Plans of so many records that walls and all else are made at once.
#include <gtest/gtest.h>

#include <string>

#include "base/parallel.h"
#include "env/environment.h"
#include "support/test_floor_plans.h"
#include "support/test_scene.h"

namespace ispace {
namespace large_plan_test {

using testing::buildingPlan;
using testing::environment;
using testing::findings;

/// Walls, doors and a desk after each third of them.
std::string plan(int walls) {
    std::string out;
    int line = 0;
    for (const char c : buildingPlan(walls, {.thickness = 0.1, .open_doors = true})) {
        out += c;
        if (c == '\n' && ++line % 3 == 0)
            out += "desk at=" + std::to_string(line % 40) + ",1 size=0.4,0.3\n";
    }
    return out;
}

TEST(LargePlan, HasTheShapesOfItsRecords) {
    const Environment env = environment(plan(2 * kManyRecords));
    ASSERT_GT(env.elements().size(), kManyRecords);
    std::size_t desks = 0, walls = 0;
    for (const Element& element : env.elements()) {
        const std::string& keyword = element.record.keyword();
        if (keyword == "desk") {
            const Body alone = bodyOf(element.record);
            ASSERT_EQ(element.body.prisms.size(), alone.prisms.size());
            for (std::size_t i = 0; i < alone.prisms.size(); ++i)
                ASSERT_EQ(element.body.prisms[i].footprint, alone.prisms[i].footprint);
            ++desks;
        } else if (keyword == "wall") {
            ASSERT_FALSE(element.body.prisms.empty()) << element.id;
            ++walls;
        }
    }
    EXPECT_GT(desks, 500U);
    EXPECT_GE(walls, 2 * kManyRecords);
}

TEST(LargePlan, EnclosesWhatItsWallsEncloseAlone) {
    const Environment large = environment(buildingPlan(2 * kManyRecords));
    // Furniture in it does not change the region.
    const Environment furnished = environment(buildingPlan(2 * kManyRecords) + "desk at=1,1\n");
    EXPECT_EQ(large.indoor(), furnished.indoor());
    EXPECT_EQ(large.wallLines(), furnished.wallLines());
    const double corridor = 2, room = 4;
    EXPECT_DOUBLE_EQ(large.indoor().area(), corridor * large.limits().width());
    EXPECT_GT(large.limits().width(), 10 * room);
}

TEST(LargePlan, FindingsComeInTheOrderOfAFewRecords) {
    const std::string bad =
        "desk id=flat at=1e15,1\n"
        "wall id=point from=1,1 to=1,1\n"
        "zone id=bow outline=0,0;4,4;4,0;0,4\n"
        "door id=lost at=-50,-50\n";
    const std::string few = findings("ispace size=8,6\n" + bad);
    std::string room = "ispace size=8,6\n" + bad, many = room;
    for (std::size_t i = 0; i < kManyRecords; ++i) many += "inside at=1,1\n";
    EXPECT_EQ(findings(many), findings(room + "inside at=1,1\n"));
    EXPECT_NE(few, "");
}

TEST(LargePlan, AGapIsFoundAsInASmallOne) {
    const std::string open = "fence path=0,0;6,0;6,4;0,4;0,0.2\n";
    std::string many = open;
    for (std::size_t i = 0; i < kManyRecords; ++i) many += "desk at=1,1 size=0.4,0.3\n";
    EXPECT_NE(findings(open), "");
    EXPECT_EQ(findings(many), findings(open));
}

}  // namespace large_plan_test
}  // namespace ispace
