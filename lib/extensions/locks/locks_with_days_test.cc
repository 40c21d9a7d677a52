// SPDX-License-Identifier: GPL-3.0-or-later
// People on their days at locked doors.
#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "extensions/days/activity.h"
#include "extensions/locks/lock_rooms_test.h"
#include "record/edit.h"
#include "scene/room_state.h"
#include "server/session.h"
#include "sim/simulation.h"

namespace ispace::locks {
namespace locks_with_days_test {

using days::readDayPlan;
using days::readDays;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// A run in which changes are made as the server does.
class LockedFlat {
  public:
    LockedFlat(const std::string& room, const std::string& script, const std::string& people,
               SimTime step = milliseconds(100))
        : scene_(sceneOf(room, people)),
          world_(scene_, step),
          simulation_(world_, {}, {Clock::Kind::Step, 1}, {}) {
        simulation_.events().want({EventKind::Activity, EventKind::Unreached, EventKind::Mark});
        simulation_.follow(readDays(script, "s.txt", world_));
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

/// A row of three rooms with a door between each two, and people of all tags that go about.
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

/// Of two that hold a door open the later one counts: ann passes it in less than 5 s.
TEST_F(LockRole, KeepsADoorOpenThatAPersonOpened) {
    simulation_.follow(readDays("at 00:00 ann goes office\n", "s.txt", world_));
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
    simulation_.follow(readDays("at 00:00 ann goes office; goes hall\n", "s.txt", world_));
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

}  // namespace locks_with_days_test
}  // namespace ispace::locks
