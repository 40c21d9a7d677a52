// SPDX-License-Identifier: GPL-3.0-or-later
#include "drawing/plan/plan_json.h"

#include <gtest/gtest.h>

#include <string>

#include "support/test_layout.h"

namespace ispace {
namespace plan_json_test {

std::string planOf(const std::string& room, const std::string& layout = "") {
    JsonWriter json;
    writePlan(json, testing::scene(room, layout));
    return json.take();
}

bool has(const std::string& text, const std::string& piece) {
    return text.find(piece) != std::string::npos;
}

TEST(PlanJson, HasTheRoomInMetres) {
    const std::string json = planOf("ispace size=8,6\n");
    EXPECT_TRUE(json.starts_with("{\"box\":[-4,-3,4,3],\"layers\":[{\"name\":\"floor\",")) << json;
    EXPECT_TRUE(has(json, "{\"area\":[[-4,-3,4,-3,4,3,-4,3]],\"inks\":[{\"fill\":\"#fbf5e9\"}]}"))
        << json;
    EXPECT_TRUE(has(json, "{\"name\":\"walls\"")) << json;
}

TEST(PlanJson, NamesThings) {
    const std::string json =
        planOf("ispace size=8,6\ncube id=box at=1,1 size=0.5\nzone id=z at=-2,0 size=2,1\n");
    EXPECT_TRUE(has(json,
                    "{\"id\":\"box\",\"title\":\"box: cube, from 0 to 0.5 m\",\"shapes\":[{"
                    "\"area\":[["))
        << json;
    EXPECT_TRUE(has(json, "{\"id\":\"z\",\"title\":\"z: zone\"")) << json;
    EXPECT_TRUE(has(json, "\"dash\":[")) << json;
}

TEST(PlanJson, LeavesOutWhatMoves) {
    EXPECT_EQ(planOf("ispace size=8,6\n"), planOf("ispace size=8,6\n",
                                                  "robot id=r1 at=1,0\nhuman id=h1 at=-1,0\n"
                                                  "laser id=l1 at=0,1\n"));
}

TEST(PlanJson, DoesNotDependOnWhereTheRoomLies) {
    std::string far = planOf("ispace at=1000,-500 size=8,6\n");
    EXPECT_TRUE(far.starts_with("{\"box\":[996,-503,1004,-497],")) << far;
}

}  // namespace plan_json_test
}  // namespace ispace
