// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/left_out.h"

#include <gtest/gtest.h>

#include "layout/test_layout.h"

namespace ispace {
namespace {

constexpr std::string_view kKinds[] = {"camera", "mat"};

TEST(LeftOut, NamesAFewOfEachKind) {
    const Scene scene = testing::scene("ispace size=8,6\n",
                                       "camera id=a\nlaser id=l at=0,0\ncamera id=b at=1,1\n"
                                       "camera id=c\nmat id=m\ncamera id=d\ncamera id=e\n");
    EXPECT_EQ(
        leftOut(scene, kKinds, "measured"),
        (std::vector<std::string>{"`camera` is not measured yet, left out: a, b, c and 2 more",
                                  "`mat` is not measured yet, left out: m"}));
    const auto is_placed = [&](std::size_t i) { return scene.records[i].has("at"); };
    EXPECT_EQ(leftOut(scene, kKinds, "read", is_placed),
              std::vector<std::string>{"`camera` is not read yet, left out: b"});
}

TEST(LeftOut, SaysNothingOfNothing) {
    const Scene scene = testing::scene("ispace size=8,6\n", "laser at=0,0\n");
    EXPECT_TRUE(leftOut(scene, kKinds, "measured").empty());
}

}  // namespace
}  // namespace ispace
