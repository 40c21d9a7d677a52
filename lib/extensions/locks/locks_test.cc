// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "extensions/locks/lock.h"
#include "extensions/locks/lock_role.h"
#include "extensions/locks/lock_rooms_test.h"
#include "record/edit.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/room_state.h"
#include "server/session.h"
#include "sim/simulation.h"

namespace ispace::locks {
namespace locks_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

std::string refusal(const std::string& door) {
    try {
        sceneOf(flat(door), kPeople);
    } catch (const FormatError& error) {
        return error.diagnostics().front().text();
    }
    return "";
}

TEST(Lock, ReadsTags) {
    EXPECT_EQ(parseAccess("42"), std::vector<std::string>{"42"});
    EXPECT_EQ(parseAccess("42,ann:card"), (std::vector<std::string>{"42", "ann:card"}));
    for (const char* bad : {"", ",", "42,", ",42", "42,,43", "4 2", "42,42"})
        EXPECT_THROW(parseAccess(bad), FormatError) << bad;
}

TEST(Lock, RejectsContradictions) {
    EXPECT_EQ(refusal("locked=yes access=42"), "");
    EXPECT_EQ(refusal("open=yes forced=yes"), "");
    EXPECT_NE(refusal("locked=yes open=yes").find("an open door cannot be locked"),
              std::string::npos);
    EXPECT_NE(refusal("locked=yes forced=yes").find("is broken: set forced=no"), std::string::npos);
    EXPECT_NE(refusal("access=42,42").find("the tag `42` is given twice"), std::string::npos);
}

/// A door without a lock has no more states than before.
TEST(Lock, TellsItsStates) {
    const auto states = [](const std::string& door) {
        std::string text;
        for (const RoomState& state : roomStates(sceneOf(flat(door), kPeople)))
            if (state.id == "d") text += state.key + '=' + state.value + ' ';
        return text;
    };
    EXPECT_EQ(states(""), "open=0 ");
    EXPECT_EQ(states("strength=5"), "open=0 ");
    EXPECT_EQ(states("locked=no"), "open=0 locked=0 forced=0 ");
    EXPECT_EQ(states("access=42"), "open=0 locked=0 forced=0 ");
    EXPECT_EQ(states("locked=yes"), "open=0 locked=1 forced=0 ");
    EXPECT_EQ(states("forced=yes"), "open=0 locked=0 forced=1 ");
}

TEST(Lock, OpensToItsTags) {
    struct Case {
        const char *door, *person, *verb, *changes, *refusal;
    };
    const Case cases[] = {
        {"", "bob", "opens", "open=yes", ""},
        {"locked=yes access=42", "ann", "opens", "locked=no open=yes", ""},
        {"locked=yes access=42", "bob", "opens", "",
         "it is locked, and its lock does not know the person's tag"},
        {"locked=yes", "ann", "opens", "",
         "it is locked, and its lock does not know the person's tag"},
        {"locked=yes access=42", "eve", "opens", "", "it is locked, and the person has no tag"},
        {"access=42", "ann", "locks", "locked=yes", ""},
        {"access=42", "bob", "locks", "", "its lock does not know the person's tag"},
        {"access=42 open=yes", "ann", "locks", "", "it is open"},
        {"access=42 forced=yes", "ann", "locks", "", "its lock is broken"},
        {"access=42 locked=yes", "ann", "locks", "", ""},
        {"access=42 locked=yes", "ann", "unlocks", "locked=no", ""},
        {"access=42 locked=yes", "bob", "unlocks", "", "its lock does not know the person's tag"},
        {"access=42", "bob", "unlocks", "", ""},
        {"access=42 locked=yes", "bob", "forces", "forced=yes locked=no open=yes", ""},
        {"access=42", "bob", "forces", "", "it is not locked"},
        {"locked=no", "bob", "forces", "", "it is not locked"},
        {"", "ann", "locks", "", "it has no lock"},
        {"strength=5", "eve", "locks", "", "it has no lock"},
        {"", "ann", "unlocks", "", "it has no lock"},
        {"", "bob", "forces", "", "it has no lock"},
        {"open=yes", "bob", "closes", "open=yes", ""}};
    for (const Case& one : cases) {
        const Scene scene = sceneOf(flat(one.door), kPeople + "human id=eve at=3,1\n");
        const ActResult result =
            actOnLock(recordOf(scene, "d"), one.verb, recordOf(scene, one.person), "open=yes");
        EXPECT_EQ(result.changes, one.changes) << one.door << ' ' << one.verb;
        EXPECT_EQ(result.refusal, one.refusal) << one.door << ' ' << one.verb;
    }
}

TEST(Lock, LetsPass) {
    const auto pass = [](const std::string& door, const char* person) {
        const Scene scene = sceneOf(flat(door), kPeople);
        const UseChanges changes = passOfLock(recordOf(scene, "d"), recordOf(scene, person));
        return changes.begin + "; " + changes.end;
    };
    EXPECT_EQ(pass("", "ann"), "; ");
    EXPECT_EQ(pass("locked=yes", "ann"), "; ");
    EXPECT_EQ(pass("access=42", "bob"), "open=yes; open=no");
    EXPECT_EQ(pass("access=42 locked=yes", "bob"), "; ");
    EXPECT_EQ(pass("access=41,42 locked=yes", "ann"), "locked=no open=yes; open=no locked=yes");
}

std::string findingOf(RecordCheck check, const Scene& scene, std::string_view id) {
    for (std::size_t i = 0; i < scene.ids.size(); ++i)
        if (scene.ids[i] == id) {
            const auto finding = check(scene, i);
            return finding ? finding->text() : "";
        }
    throw std::logic_error("no such record");
}

TEST(LockChecks, FindTagsThatNoRecordHas) {
    const auto found = [](const std::string& door) {
        return findingOf(checkAccess, sceneOf(flat(door), kPeople), "d");
    };
    EXPECT_EQ(found(""), "");
    EXPECT_EQ(found("access=42,7"), "");
    EXPECT_EQ(found("access=42,ann"),
              "door d opens to the tag `ann`, which no record has; give it to a person by tag=");
    EXPECT_EQ(found("access=24").substr(0, 44), "door d opens to the tag `24`, which no recor");
}

TEST(LockChecks, FindPeopleWhoCannotLeave) {
    const std::string doors = "locked=yes access=42";
    const auto found = [](const Scene& scene, const char* person) {
        return findingOf(checkExit, scene, person);
    };
    const Scene closed = sceneOf(flat(doors, doors), kPeople);
    EXPECT_EQ(
        found(closed, "bob"),
        "no door lets human bob out of the room: d, a are locked; name its tag in `access` of a "
        "door, or set locked=no");
    EXPECT_EQ(found(closed, "ann"), "");
    EXPECT_EQ(found(sceneOf(flat(doors, ""), kPeople), "bob"), "") << "round by the lobby";
    // A door to the outside that is not locked.
    EXPECT_EQ(found(sceneOf(flat(doors, doors) + "door id=out wall=f offset=1\n", kPeople), "bob"),
              "");
}

TEST(LockChecks, FindDrives) {
    const auto found = [](const std::string& drive) {
        return findingOf(checkDrive,
                         sceneOf(flat("drive=" + drive) + "lamp id=l at=1,1\n", kPeople), "d");
    };
    EXPECT_EQ(found("l"), "");
    EXPECT_EQ(found("g"),
              "the drive of door d is `g`, which is no appliance; name one of kind=gate");
}

TEST_F(LockRole, OpensToTagsForAWhile) {
    Session session(state_);
    EXPECT_EQ(ask(session, "LOCK *"), "OK LOCK * t=0.000 doors=d\n");
    EXPECT_EQ(ask(session, "TRY a 42"),
              "ERR 404 no door with `access`, `drive` or `strength` is `a`\n");
    EXPECT_EQ(ask(session, "TRY d 7"), "OK TRY id=d t=0.000 opens=0\n");
    EXPECT_EQ(ask(session, "READ d"), "OK READ id=d t=0.000 open=0 locked=1 forced=0\n");
    EXPECT_EQ(ask(session, "TRY d 43"), "OK TRY id=d t=0.000 opens=1\n");
    run(2);
    EXPECT_EQ(ask(session, "READ d"), "OK READ id=d t=0.200 open=1 locked=0 forced=0\n");
    run(20);
    EXPECT_EQ(ask(session, "TRY d 42"), "OK TRY id=d t=2.200 opens=1\n");
    run(49);
    EXPECT_EQ(ask(session, "READ d"), "OK READ id=d t=7.100 open=1 locked=0 forced=0\n");
    run(3);
    EXPECT_EQ(ask(session, "READ d"), "OK READ id=d t=7.400 open=0 locked=1 forced=0\n");
    EXPECT_EQ(changes_, (Rows{"ACT d locked=no open=yes", "SET l.on=yes",
                              "ACT d open=no locked=yes", "SET l.on=yes"}));
}

TEST_F(LockRole, AsksForOneChangeInAStep) {
    Session session(state_);
    ask(session, "LOCK d");
    for (int i = 0; i < 50; ++i)
        EXPECT_EQ(ask(session, i % 2 == 0 ? "TRY d 42" : "TRY d 43"),
                  "OK TRY id=d t=0.000 opens=1\n");
    run(1);
    EXPECT_EQ(changes_, Rows{"ACT d locked=no open=yes"});
}

/// Requests know the changes since the step before.
TEST_F(LockRole, AnswersFromTheDoorAsItIs) {
    Session session(state_);
    ask(session, "LOCK d");
    change("SET d.access=99");
    EXPECT_EQ(ask(session, "TRY d 42"), "OK TRY id=d t=0.000 opens=0\n");
    change("ACT d locked=no access=42");
    EXPECT_EQ(ask(session, "READ d"), "OK READ id=d t=0.000 open=0 locked=0 forced=0\n");
    run(1);
    EXPECT_EQ(changes_, Rows{});
    change("SET d.locked=yes");
    EXPECT_EQ(ask(session, "TRY d 42"), "OK TRY id=d t=0.100 opens=1\n");
    run(1);
    EXPECT_EQ(ask(session, "READ d"), "OK READ id=d t=0.200 open=1 locked=0 forced=0\n");
    change("SET d.open=no");
    EXPECT_EQ(ask(session, "READ d"), "OK READ id=d t=0.200 open=0 locked=0 forced=0\n");
    run(2);
    EXPECT_EQ(changes_, (Rows{"ACT d locked=no open=yes", "SET l.on=yes", "SET l.on=yes"}));
}

TEST_F(LockRole, ShutsADoorThatWasForced) {
    Session session(state_);
    ask(session, "LOCK d");
    ask(session, "TRY d 42");
    run(3);
    change("SET d.forced=yes");
    run(60);
    EXPECT_EQ(ask(session, "READ d"), "OK READ id=d t=6.300 open=0 locked=0 forced=1\n");
    change("ACT d forced=no locked=yes");
    ask(session, "TRY d 42");
    run(3);
    while (!simulation_.isChangeDue()) run(1);
    change("SET d.forced=yes");
    run(3);
    EXPECT_EQ(ask(session, "READ d").substr(22), "open=0 locked=0 forced=1\n");
    EXPECT_EQ(changes_,
              (Rows{"ACT d locked=no open=yes", "SET l.on=yes", "ACT d open=no", "SET l.on=yes",
                    "ACT d locked=no open=yes", "SET l.on=yes",
                    "ACT d open=no locked=yes is refused", "ACT d open=no", "SET l.on=yes"}));
}

/// 40 kg at 0.9 m/s are 16.2 J; at 1.1 m/s 24.2 J, of which 12.1 J across the door at 45 degrees.
TEST_F(LockRole, RobotsForceIt) {
    const auto stalls = [this](const char* robot, double speed) {
        const std::size_t mover = *world_.moverNamed(robot);
        world_.command(mover, {.verb = Verb::Speed, .value = speed});
        run(60);
        const bool is_stalled = world_.isStalled(mover);
        world_.command(mover, {.verb = Verb::Backward, .value = 2});
        run(80);
        return is_stalled;
    };
    EXPECT_TRUE(stalls("r", 0.9));
    EXPECT_TRUE(stalls("askew", 1.1));
    EXPECT_EQ(changes_, Rows{});
    EXPECT_TRUE(stalls("r", 1.1));
    ASSERT_FALSE(changes_.empty());
    EXPECT_EQ(changes_.front(), "ACT d forced=yes locked=no open=yes");
}

TEST(LockService, IsForDoorsWithLocks) {
    const Scene scene = sceneOf(flat("locked=yes"), kPeople);
    World world(scene, milliseconds(5));
    Simulation simulation(world, {}, {Clock::Kind::Step, 1}, {});
    const RunRoom room{"", &simulation};
    EXPECT_EQ(makeLocks({&room, 1}, 1), nullptr);
}

}  // namespace locks_test
}  // namespace ispace::locks
