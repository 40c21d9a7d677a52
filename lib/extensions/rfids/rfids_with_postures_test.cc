// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "extensions/postures/postures_test.h"
#include "extensions/rfids/rfid_tags.h"
#include "extensions/rfids/rfids_test.h"
#include "support/test_readings.h"

namespace ispace::rfids {
namespace rfids_with_postures_test {

// Before the schemas are asked for.
const bool kPosturesAdded = [] {
    testing::addPosturesOnce();
    return true;
}();

/// The tag of a thing in the hand is where the thing is.
TEST(RfidTags, OfThingsAreInTheHand) {
    ASSERT_TRUE(kPosturesAdded);
    const auto is_read = [](const std::string& reader) {
        const Scene scene = testing::scene(
            "ispace size=10,8\ncylinder id=cup at=3,3 size=0.1,0.1 height=0.2 tag=cup "
            "carried=ann\n",
            "human id=ann at=0,0 heading=90\n" + reader + '\n');
        return !std::get<AddedReading>(testing::readings(scene).front())
                    .as<RfidTags>()
                    .tags.empty();
    };
    EXPECT_TRUE(is_read("rfid at=0.3,2,1.2 heading=-90"));
    EXPECT_FALSE(is_read("rfid at=0.3,2,1.2 heading=-90 range=0.5")) << "too far";
    EXPECT_FALSE(is_read("rfid at=-0.2,-2,1 heading=90 fov=4,4"))
        << "the person alone is in the field";
}

}  // namespace rfids_with_postures_test
}  // namespace ispace::rfids
