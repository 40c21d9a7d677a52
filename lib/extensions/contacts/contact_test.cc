// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/contacts/contact.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "extensions/contacts/contacts_test.h"
#include "sense/formats/reading_fields.h"
#include "sim/state_watch.h"
#include "sim/world.h"
#include "support/test_readings.h"

namespace ispace::contacts {
namespace contact_test {

/// Returns what a contact of the door or window `d1` reports.
bool isOpen(const std::string& door) {
    const Scene scene = testing::scene("ispace size=6,6\nwall id=w from=0,-3 to=0,3\n" + door,
                                       "contact id=k1 at=0,3,2 door=d1\n");
    return std::get<AddedReading>(testing::readings(scene).front()).as<ContactState>().open;
}

TEST(Contact, KnowsItsDoorOrWindow) {
    EXPECT_FALSE(isOpen("door id=d1 at=0,3\n"));
    EXPECT_TRUE(isOpen("door id=d1 at=0,3 open=yes\n"));
    EXPECT_FALSE(isOpen("window id=d1 wall=w at=0,0 size=2\n"));
    EXPECT_TRUE(isOpen("window id=d1 wall=w at=0,0 size=2 open=yes\n"));
}

TEST(Contact, NamesADoorOrAWindow) {
    EXPECT_THROW(isOpen("door id=d2 at=0,3\n"), FormatError);
    EXPECT_NE(testing::findings([] {
                  return isOpen("cube id=d1 at=1,1\n");
              }).find("no door or window has the id `d1`"),
              std::string::npos);
}

TEST(Contact, ReportsADoorThatOpensInARun) {
    const auto room = [](const std::string& door) {
        return testing::scene("ispace size=6,6\ndoor id=d1 at=0,3 " + door + '\n',
                              "contact id=k1 at=0,3,2 door=d1\n");
    };
    const Scene shut = room("");
    World world(shut, std::chrono::milliseconds(100));
    EXPECT_EQ(statesOf(world), (std::vector<RoomState>{{"d1", "open", "0"}, {"k1", "open", "0"}}));
    StateWatch watch(world);
    world.change(room("open=yes"));
    world.step();
    EXPECT_EQ(watch.changed(), (std::vector<RoomState>{{"d1", "open", "1"}, {"k1", "open", "1"}}));
}

TEST(Contact, HasATopic) {
    const auto topics = readingKind(modelOf(Contact())).topics;
    ASSERT_EQ(topics.size(), 1U);
    EXPECT_EQ(topics[0].name, "open");
    EXPECT_EQ(topics[0].type, RosType::Bool);
}

}  // namespace contact_test
}  // namespace ispace::contacts
