// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/room_state.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "support/test_layout.h"

namespace ispace {
namespace room_state_test {

const char* const kRoom =
    "ispace size=6,6\ndoor id=d1 at=0,3\nlamp id=l1 at=1,1 on=yes level=40%\nswitch id=b1\nspeaker "
    "id=a1\nprojector id=q1 pan=30 tilt=-10\n";

TEST(RoomState, HasARowForEachStateKey) {
    const Scene room = testing::scene(kRoom, "robot id=r1\n");
    const std::vector<RoomState> expected = {
        {"d1", "open", "0"},         {"l1", "on", "1"},   {"l1", "level", "0.4"},
        {"l1", "color", "1,1,0.97"}, {"b1", "on", "0"},   {"a1", "on", "0"},
        {"a1", "volume", "70"},      {"q1", "on", "0"},   {"q1", "level", "1"},
        {"q1", "color", "1,1,1"},    {"q1", "pan", "30"}, {"q1", "tilt", "-10"}};
    EXPECT_EQ(roomStates(room), expected);
    EXPECT_TRUE(isActuator("lamp"));
    EXPECT_FALSE(isActuator("robot"));
}

/// The keys of the table are keys of the schemas.
TEST(RoomState, NamesKeysOfRecords) {
    for (const StateKey& state : stateKeys()) {
        const Schema* const schema = sceneSchemas().find(state.keyword);
        ASSERT_NE(schema, nullptr) << state.keyword;
        EXPECT_NE(schema->find(state.key), nullptr) << state.keyword << ' ' << state.key;
    }
}

TEST(RoomState, EditsAreChecked) {
    const Scene room = testing::scene(kRoom, "robot id=r1\n");
    EXPECT_EQ(stateEdit(room, "l1", "on=0"), "l1.on=no");
    EXPECT_EQ(stateEdit(room, "b1", "on=1"), "b1.on=yes");
    EXPECT_EQ(stateEdit(room, "l1", "on=off"), "l1.on=off");
    EXPECT_EQ(stateEdit(room, "l1", "level=1"), "l1.level=1");
    EXPECT_EQ(stateEdit(room, "q1", "pan=-20"), "q1.pan=-20");
    const auto refusal = [&](const char* id, const char* assignment) {
        try {
            stateEdit(room, id, assignment);
        } catch (const UsageError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(refusal("l2", "on=1"), "no record has the id `l2`, did you mean `l1`?");
    EXPECT_EQ(refusal("r1", "at=1,1"), "r1 is a robot, which has no state");
    EXPECT_EQ(refusal("d1", "size=1"), "wanted a state of d1 as open=value, found `size=1`");
    EXPECT_EQ(refusal("l1", "on"), "wanted a state of l1 as on=value, found `on`");
    EXPECT_EQ(refusal("l1", "levle=1"),
              "wanted a state of l1 as on=value, found `levle=1`, did you mean `level`?");
}

TEST(RoomState, SeveralStatesAreOneChange) {
    const Scene room = testing::scene(kRoom, "robot id=r1\n");
    const auto change = [&](std::vector<std::string_view> states) {
        return stateChange(room, "l1", states);
    };
    EXPECT_EQ(change({"on=0"}), "SET l1.on=no");
    EXPECT_EQ(change({"on=1", "level=0.5"}), "ACT l1 on=yes level=0.5");
    EXPECT_THROW(change({"on=1", "on=0"}), UsageError);
    EXPECT_THROW(change({"on=1", "levle=1"}), UsageError);
    const std::vector<Edit> edits = parseEdits(change({"on=0", "level=0.5"}));
    ASSERT_EQ(edits.size(), 2U);
    EXPECT_EQ(edits[1].key, "level");
    EXPECT_EQ(edits[1].value, "0.5");
}

}  // namespace room_state_test
}  // namespace ispace
