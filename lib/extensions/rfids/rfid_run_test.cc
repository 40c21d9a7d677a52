// SPDX-License-Identifier: GPL-3.0-or-later
// RFID readers of a running world.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "extensions/rfids/rfid_tags.h"
#include "extensions/rfids/rfids_test.h"
#include "sim/run_limits.h"
#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace::rfids {
namespace rfid_run_test {

using std::chrono::milliseconds;

TEST(RfidRun, ListsATagWhileItPasses) {
    const Scene room = testing::scene("ispace size=12,12\n",
                                      "rfid at=0,-2,1 heading=90 fov=60,90 range=3\n"
                                      "human at=-4,0 path=4,0 tag=anna\n");
    World world(room, milliseconds(50));
    std::vector<std::vector<std::string>> lists = {{}};
    double first = 0, end = 0;
    while (world.time() < std::chrono::seconds(12)) {
        world.step();
        if (world.latestReadings().empty()) continue;
        const auto& reading = std::get<AddedReading>(world.reading(0).value);
        const auto& tags = reading.as<RfidTags>().tags;
        if (tags == lists.back()) continue;
        lists.push_back(tags);
        (tags.empty() ? end : first) = reading.time;
    }
    ASSERT_EQ(lists, (std::vector<std::vector<std::string>>{{}, {"anna"}, {}}));
    // The field is 2 * 2 tan 30 = 2.3 m wide there, and the person walks 1.2 m a second.
    EXPECT_NEAR(end - first, 2.31 / 1.2, 0.4);
}

TEST(RfidRun, ItsRaysAreThoseOfTags) {
    const Scene room =
        testing::scene("ispace size=8,6\n", "rfid at=1,1\nrobot at=2,2 tag=t1\nhuman at=0,0\n");
    EXPECT_EQ(loadOf(room, milliseconds(5), nullptr).beams, 1 + 1);
}

}  // namespace rfid_run_test
}  // namespace ispace::rfids
