// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "extensions/locks/lock.h"
#include "extensions/locks/lock_role.h"
#include "extensions/locks/locks_test.h"
#include "record/edit.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/room_state.h"
#include "server/session.h"
#include "sim/activity.h"
#include "sim/simulation.h"

namespace ispace::locks {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A hall and an office, with a door between them, and a way round by a lobby if `lobby` is open.
std::string flat(const std::string& door, const std::string& lobby = "") {
    return "#env 1\nfence id=f path=0,0;10,0;10,6;0,6 closed=yes\nwall id=w from=5,0 to=5,6\n"
           "wall id=v from=0,4 to=10,4\ndoor id=d wall=w offset=2 " +
           door + "\ndoor id=a wall=v offset=2 " + lobby + "\ndoor id=b wall=v offset=8 " + lobby +
           "\ndoor id=c wall=w offset=5 " + lobby +
           "\ninside at=1,1\ninside at=9,1\ninside at=1,5\ninside at=9,5\n"
           "zone id=hall at=2.5,2 size=5,4\nzone id=office at=7.5,2 size=5,4\n";
}

Scene sceneOf(const std::string& room, const std::string& people) {
    testing::addLocksOnce();
    const Document placed = readRecordText("#3dm 1\n" + people, "room.3dm", sceneSchemas());
    return makeScene(readRecordText(room, "room.env", sceneSchemas()), &placed, shippedDevices());
}

const std::string kPeople = "human id=ann at=1,2 tag=42\nhuman id=bob at=2,1 tag=7\n";

const Record& recordOf(const Scene& scene, std::string_view id) {
    for (std::size_t i = 0; i < scene.ids.size(); ++i)
        if (scene.ids[i] == id) return scene.records[i];
    throw std::logic_error("no such record");
}

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

/// A run in which changes are made as the server does.
class LockedFlat {
  public:
    LockedFlat(const std::string& room, const std::string& script, const std::string& people,
               SimTime step = milliseconds(100))
        : scene_(sceneOf(room, people)),
          world_(scene_, step),
          simulation_(world_, {}, {Clock::Kind::Step, 1}, {}) {
        simulation_.events().want({EventKind::Activity, EventKind::Unreached, EventKind::Mark});
        simulation_.follow(readDayPlan(script, "s.txt", world_));
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            while (simulation_.isChangeDue()) {
                try {
                    act(simulation_.takeScriptedChange());
                } catch (const FormatError&) {
                    changes.back() += " is refused";
                }
            }
            simulation_.allow(1);
            simulation_.run(std::chrono::steady_clock::now(), seconds(10));
        }
    }
    void act(const std::string& change) {
        changes.push_back(change);
        world_.change(makeScene(editedRecords(world_.scene(), parseEdits(change),
                                              [](const std::string&) { return std::nullopt; }),
                                world_.scene(), shippedDevices()));
    }
    [[nodiscard]] bool isChangeDue() const { return simulation_.isChangeDue(); }
    [[nodiscard]] Point2 at(std::string_view person) const {
        return world_.status(*world_.moverNamed(person)).pose.position;
    }
    [[nodiscard]] std::string stateOf(const std::string& id) const {
        std::string text;
        for (const RoomState& state : roomStates(world_.scene()))
            if (state.id == id) text += state.key + '=' + state.value + ' ';
        return text;
    }
    /// Returns the events of a kind: "bob office: d is locked".
    [[nodiscard]] std::vector<std::string> events(EventKind kind) const {
        std::vector<std::string> found;
        const EventLog& log = simulation_.events();
        for (std::int64_t i = log.first(); i < log.next(); ++i)
            if (log.at(i).kind == kind)
                found.push_back(log.at(i).id + ' ' + log.at(i).other + ": " + log.at(i).text);
        return found;
    }

    std::vector<std::string> changes;

  private:
    Scene scene_;
    World world_;
    Simulation simulation_;
};

using Rows = std::vector<std::string>;

TEST(LockedDoors, OpenBeforeThoseWithATagAndLockBehindThem) {
    for (const SimTime step :
         {SimTime(milliseconds(5)), SimTime(milliseconds(100)), SimTime(milliseconds(500))}) {
        LockedFlat home(flat("locked=yes access=42"), "at 00:00 ann goes office\n", kPeople, step);
        home.run(static_cast<int>(seconds(15) / step));
        EXPECT_EQ(home.changes, (Rows{"ACT d locked=no open=yes", "ACT d open=no locked=yes"}));
        EXPECT_GT(home.at("ann").x, 5.25);
        EXPECT_EQ(home.events(EventKind::Unreached), Rows{});
        EXPECT_EQ(home.stateOf("d"), "open=0 locked=1 forced=0 ");
    }
}

TEST(LockedDoors, StayShutToOthers) {
    LockedFlat home(flat("locked=yes access=42"), "at 00:00 bob goes office\n", kPeople);
    home.run(100);
    EXPECT_EQ(home.changes, Rows{});
    EXPECT_EQ(home.at("bob"), (Point2{2, 1}));
    EXPECT_EQ(home.events(EventKind::Unreached), Rows{"bob office: d is locked"});
}

TEST(LockedDoors, AreGoneRound) {
    LockedFlat home(flat("locked=yes access=42", "open=yes"), "at 00:00 bob goes office\n",
                    kPeople);
    home.run(250);
    EXPECT_EQ(home.changes, Rows{});
    EXPECT_GT(home.at("bob").x, 5.25);
    EXPECT_LT(home.at("bob").y, 4);
    EXPECT_EQ(home.events(EventKind::Unreached), Rows{});
}

/// Two behind each other, and one that has no tag and waits until they come back.
TEST(LockedDoors, StayOpenWhileOthersWithATagPass) {
    LockedFlat home(flat("locked=yes access=42,43"),
                    "at 00:00 ann goes office\nat 00:00:01 cyd goes office\n",
                    kPeople + "human id=cyd at=3,3 tag=43\n");
    home.run(200);
    EXPECT_GT(home.at("ann").x, 5.25);
    EXPECT_GT(home.at("cyd").x, 5.25);
    EXPECT_EQ(home.changes.front(), "ACT d locked=no open=yes");
    EXPECT_EQ(home.changes.back(), "ACT d open=no locked=yes");
    EXPECT_EQ(home.stateOf("d"), "open=0 locked=1 forced=0 ");
}

/// The door does not shut on a person in its doorway.
TEST(LockedDoors, WaitForTheirDoorway) {
    LockedFlat home(flat("locked=yes access=42"), "at 00:00 ann goes office; goes hall\n", kPeople);
    for (int i = 0; i < 300; ++i) {
        home.run(1);
        if (home.stateOf("d").starts_with("open=0")) {
            EXPECT_GE(std::abs(home.at("ann").x - 5), 0.2) << i;
        }
    }
    EXPECT_LT(home.at("ann").x, 4.75);
    EXPECT_EQ(home.changes.size() % 2, 0U);
    EXPECT_EQ(home.stateOf("d"), "open=0 locked=1 forced=0 ");
}

TEST(LockedDoors, AreForced) {
    LockedFlat home(flat("locked=yes access=42"),
                    "at 00:00:01 bob opens d; forces d; goes office\nat 00:00:14 ann locks d\n",
                    kPeople);
    home.run(150);
    EXPECT_EQ(home.changes, Rows{"ACT d forced=yes locked=no open=yes"});
    EXPECT_GT(home.at("bob").x, 5.25);
    EXPECT_EQ(home.stateOf("d"), "open=1 locked=0 forced=1 ");
    EXPECT_EQ(home.events(EventKind::Mark),
              (Rows{" bob: script: bob opens d: it is locked, and its lock does not know the "
                    "person's tag",
                    " ann: script: ann locks d: its lock is broken"}));
    EXPECT_THROW(home.act("SET d.locked=yes"), FormatError) << "open, and broken";
    home.act("ACT d open=no");
    EXPECT_THROW(home.act("SET d.locked=yes"), FormatError) << "broken";
    home.act("ACT d forced=no locked=yes");
    EXPECT_EQ(home.stateOf("d"), "open=0 locked=1 forced=0 ");
    EXPECT_THROW(home.act("SET d.open=yes"), FormatError) << "locked";
}

/// One forced while it is open, or in the moment in which it is to shut.
TEST(LockedDoors, ShutOnceTheyWereForced) {
    for (const bool is_late : {false, true}) {
        LockedFlat home(flat("locked=yes access=42"), "at 00:00 ann goes office\n", kPeople);
        const auto is_open = [&] { return home.stateOf("d").starts_with("open=1"); };
        for (int i = 0; i < 100 && !(is_open() && (!is_late || home.isChangeDue())); ++i)
            home.run(1);
        home.act("SET d.forced=yes");
        home.run(100);
        EXPECT_EQ(home.stateOf("d"), "open=0 locked=0 forced=1 ");
        Rows changes{"ACT d locked=no open=yes", "SET d.forced=yes"};
        if (is_late) changes.emplace_back("ACT d open=no locked=yes is refused");
        changes.emplace_back("SET d.open=no");
        EXPECT_EQ(home.changes, changes);
    }
}

/// A row of three rooms with a door between each two, and people of all tags who go about.
TEST(LockedDoors, KeepTheirWordInRandomFlats) {
    constexpr int kFlats = 60, kTrips = 3;
    std::mt19937 random(7);
    const auto pick = [&random](int count) {
        return std::uniform_int_distribution<int>(0, count - 1)(random);
    };
    int passed = 0, given_up = 0, locked = 0;
    for (int flat = 0; flat < kFlats; ++flat) {
        std::ostringstream room, people, script;
        room << "#env 1\nfence id=f path=0,0;12,0;12,4;0,4 closed=yes\n";
        for (int i = 0; i < 3; ++i) {
            room << "inside at=" << 4 * i + 2 << ",1\nzone id=z" << i << " at=" << 4 * i + 2
                 << ",2 size=4,4\n";
            if (i == 0) continue;
            room << "wall id=w" << i << " from=" << 4 * i << ",0 to=" << 4 * i
                 << ",4 thickness=" << (pick(2) == 0 ? "0" : "0.2");
            room << "\ndoor id=d" << i << " wall=w" << i << " offset=" << 1 + pick(3)
                 << " locked=yes access=" << (pick(2) == 0 ? "1" : "1,2") << '\n';
        }
        for (int i = 0; i < 3; ++i) {
            people << "human id=p" << i << " at=" << 4 * i + 1 + pick(2);
            people << ',' << 1 + pick(2) << " tag=" << i + 1 << '\n';
            script << "at 00:00:0" << pick(9) << " p" << i << ' ';
            for (int trip = 0; trip < kTrips; ++trip) script << "goes z" << pick(3) << "; ";
            script << '\n';
        }
        const int step = std::array{20, 100, 250}[static_cast<std::size_t>(pick(3))];
        LockedFlat home(room.str(), script.str(), people.str(), milliseconds(step));
        std::array<double, 3> before{};
        std::array<bool, 3> was_open{};
        for (int i = 0; i < 240'000 / step; ++i) {
            for (std::size_t p = 0; p < before.size(); ++p)
                before[p] = home.at("p" + std::to_string(p)).x;
            home.run(1);
            for (const std::size_t door : {1U, 2U}) {
                const bool is_open =
                    home.stateOf("d" + std::to_string(door)).starts_with("open=1 locked=0 ");
                for (std::size_t p = 0; p < before.size(); ++p) {
                    const double now = home.at("p" + std::to_string(p)).x;
                    const double wall = 4.0 * static_cast<double>(door);
                    if ((before[p] < wall) == (now < wall)) continue;
                    EXPECT_TRUE(is_open || was_open[door]) << flat << " p" << p;
                    ++passed;
                }
                was_open[door] = is_open;
            }
        }
        for (const std::size_t door : {1U, 2U}) {
            bool is_free = true;  // a person that has given up may stand in a doorway
            for (std::size_t p = 0; p < before.size(); ++p) {
                const double off =
                    home.at("p" + std::to_string(p)).x - 4.0 * static_cast<double>(door);
                is_free = is_free && std::abs(off) > 0.45;
            }
            const std::string state = home.stateOf("d" + std::to_string(door));
            if (is_free) {
                EXPECT_EQ(state, "open=0 locked=1 forced=0 ") << flat << " d" << door;
            }
            locked += state == "open=0 locked=1 forced=0 " ? 1 : 0;
        }
        for (const std::string& reason : home.events(EventKind::Unreached))
            given_up += reason.ends_with(" is locked") ? 1 : 0;
    }
    EXPECT_GT(passed, 100);
    EXPECT_GT(given_up, 50);
    EXPECT_GT(locked, 2 * kFlats * 9 / 10);
}

TEST(LockedDoors, TellPlansWhatDoesNotGo) {
    const Scene scene = sceneOf(flat(""), kPeople);
    const World world(scene, milliseconds(100));
    const auto failure = [&](const std::string& line) -> std::string {
        try {
            readDayPlan(line, "s.txt", world);
        } catch (const FormatError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(failure("at 00:00 ann forces d\n"), "");
    EXPECT_EQ(failure("at 00:00 ann forces hall\n"),
              "s.txt:1:14: error: no thing that one forces has the id `hall`");
    EXPECT_EQ(failure("at 00:00 ann locks\n"),
              "s.txt:1:14: error: `locks` is no action, wanted one like locks d");
    EXPECT_EQ(failure("at 00:00 ann closes\n"),
              "s.txt:1:14: error: `closes` is no action, wanted one like closes door1");
    EXPECT_EQ(failure("at 00:00 ann lokcs d\n"),
              "s.txt:1:14: error: `lokcs` is no action, did you mean `locks`?");
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

/// A run with the service, in which changes are made as the server does.
class LockRole : public ::testing::Test {
  protected:
    LockRole()
        : scene_(sceneOf(
              flat("locked=yes access=42,43 strength=20 drive=l") + "lamp id=l at=1,1\n",
              kPeople + "robot id=r at=3,2 mass=40\nrobot id=askew at=3,0.5 heading=45 mass=40\n")),
          world_(scene_, milliseconds(100)),
          simulation_(world_, {}, {Clock::Kind::Step, 1}, {}),
          state_(simulation_),
          room_{"", &simulation_},
          service_(makeLocks({&room_, 1}, 1)) {
        state_.addRoleService(*service_);
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            while (simulation_.isChangeDue()) {
                changes_.push_back(simulation_.takeScriptedChange());
                try {
                    change(changes_.back());
                } catch (const FormatError&) {
                    changes_.back() += " is refused";
                }
            }
            simulation_.allow(1);
            simulation_.run(std::chrono::steady_clock::now(), seconds(10));
            service_->stepped();
        }
    }
    void change(const std::string& request) {
        world_.change(makeScene(editedRecords(world_.scene(), parseEdits(request),
                                              [](const std::string&) { return std::nullopt; }),
                                world_.scene(), shippedDevices()));
    }
    static std::string ask(Session& session, const std::string& line) {
        session.request(line);
        return session.take();
    }

    Scene scene_;
    World world_;
    Simulation simulation_;
    ServerState state_;
    RunRoom room_;
    std::unique_ptr<RoleService> service_;
    Rows changes_;
};

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

/// Of two that hold a door open the later one counts: ann passes it in less than 5 s.
TEST_F(LockRole, KeepsADoorOpenThatAPersonOpened) {
    simulation_.follow(readDayPlan("at 00:00 ann goes office\n", "s.txt", world_));
    Session session(state_);
    ask(session, "LOCK d");
    const auto is_open = [&] { return ask(session, "READ d").find("open=1") != std::string::npos; };
    for (int i = 0; i < 100 && !is_open(); ++i) run(1);
    run(5);
    const SimTime tried = world_.time();
    ask(session, "TRY d 42");
    while (is_open()) {
        run(1);
        ASSERT_LT(world_.time() - tried, seconds(20));
    }
    EXPECT_GE(world_.time() - tried, seconds(5));
    EXPECT_LT(world_.time() - tried, milliseconds(5500));
    EXPECT_EQ(changes_,
              (Rows{"ACT d locked=no open=yes", "SET l.on=yes", "ACT d open=no locked=yes"}));
}

/// A tag in the moment in which ann opens the door; after 5 s she is on her way back.
TEST_F(LockRole, KeepsADoorOpenForPeople) {
    simulation_.follow(readDayPlan("at 00:00 ann goes office; goes hall\n", "s.txt", world_));
    Session session(state_);
    ask(session, "LOCK d");
    while (!simulation_.isChangeDue()) {
        run(1);
        ASSERT_LT(world_.time(), seconds(20));
    }
    EXPECT_EQ(ask(session, "TRY d 42").substr(0, 10), "OK TRY id=");
    run(52);
    EXPECT_GT(world_.status(*world_.moverNamed("ann")).pose.position.x, 5.4);
    EXPECT_NE(ask(session, "READ d").find("open=1"), std::string::npos);
    run(60);
    EXPECT_NE(ask(session, "READ d").find("open=0 locked=1"), std::string::npos);
    EXPECT_LT(world_.status(*world_.moverNamed("ann")).pose.position.x, 4.6);
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

}  // namespace
}  // namespace ispace::locks
