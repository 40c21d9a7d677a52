// SPDX-License-Identifier: GPL-3.0-or-later
// The roles ROBOT and LASER.
// What clients are kept from.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <string_view>

#include "server/client_role.h"
#include "server/session.h"
#include "support/test_talk.h"

namespace ispace {

namespace session_requests_test {

using testing::streamed;
using testing::Talk;

TEST(Session, CommandsAreAnsweredAtOnce) {
    Talk talk;
    Session& robot = talk.client("ROBOT r2");
    EXPECT_EQ(talk.ask(robot, "SPEED 0.30"), "OK SPEED speed=0.3\n");
    EXPECT_EQ(talk.ask(robot, "ROTSPEED -30"), "OK ROTSPEED rotspeed=-30\n");
    EXPECT_EQ(talk.ask(robot, "FORWARD 1.5"), "OK FORWARD id=1 distance=1.5\n");
    EXPECT_EQ(talk.ask(robot, "LEFT\t 90"),
              "OK LEFT id=2 angle=90\nFAIL id=1 reason=replaced t=0.000\n");
    EXPECT_EQ(talk.ask(robot, "STOP"), "OK STOP\nFAIL id=2 reason=stopped t=0.000\n");
    EXPECT_EQ(talk.ask(robot, "BACKWARD 1e-1"), "OK BACKWARD id=3 distance=0.1\n");
    EXPECT_EQ(talk.ask(robot, "RIGHT 45.5"),
              "OK RIGHT id=4 angle=45.5\nFAIL id=3 reason=replaced t=0.000\n");
    EXPECT_EQ(talk.ask(robot, "SPEED -0"), "OK SPEED speed=0\nFAIL id=4 reason=replaced t=0.000\n");
}

TEST(Session, PathsAreAsLongAsTheWayFromHere) {
    Talk talk;
    Session& robot = talk.client("ROBOT r1");
    const Point2 at = talk.room.world.status(0).pose.position;
    const auto place = [&at](double east, double north) {
        return formatDouble(at.x + east) + ',' + formatDouble(at.y + north);
    };
    EXPECT_EQ(talk.ask(robot, ("PATH " + place(0.5, 0)).c_str()), "OK PATH id=1 length=0.5\n");
    EXPECT_EQ(talk.ask(robot, ("PATH " + place(0.5, 0) + ';' + place(0.5, 0.25)).c_str()),
              "OK PATH id=2 length=0.75\nFAIL id=1 reason=replaced t=0.000\n");
}

TEST(Session, CommandsThatAreWrong) {
    Talk talk;
    Session& robot = talk.client("ROBOT r1");
    const auto code = [&](const char* request) { return talk.ask(robot, request).substr(0, 8); };
    for (const char* request : {"FORWARD", "FORWARD x", "FORWARD 1 2", "STOP 1", "SPEED nan"})
        EXPECT_EQ(code(request), "ERR 400 ") << request;
    for (const char* request : {"FORWARD -1", "LEFT 1e9", "SPEED 100", "ROTSPEED -1000"})
        EXPECT_EQ(code(request), "ERR 416 ") << request;
    // They leave what runs alone.
    EXPECT_EQ(talk.ask(robot, "FORWARD 1"), "OK FORWARD id=1 distance=1\n");
    EXPECT_EQ(talk.ask(robot, "SPEED 100"),
              "ERR 416 " + talk.room.world.refusal(0, {Verb::Speed, 100}) + "\n");
    EXPECT_EQ(talk.ask(robot, "STOP"), "OK STOP\nFAIL id=1 reason=stopped t=0.000\n");
}

TEST(Session, EndsComeWithTheSteps) {
    Talk talk;
    Session& r1 = talk.client("ROBOT r1");
    Session& r2 = talk.client("ROBOT r2");
    // 1 m/s^2 up to 0.5 m/s and down again: 0.25 m in one second.
    EXPECT_EQ(talk.ask(r2, "FORWARD 0.25"), "OK FORWARD id=1 distance=0.25\n");
    EXPECT_EQ(talk.ask(r1, "FORWARD 1"), "OK FORWARD id=1 distance=1\n");
    talk.step(9);
    EXPECT_EQ(r2.take(), "");
    talk.step(2);
    EXPECT_EQ(r2.take(), "DONE id=1 t=1.000\n");
    EXPECT_EQ(r1.take(), "");
    talk.step(20);
    EXPECT_EQ(r2.take(), "");
    EXPECT_EQ(talk.ask(r1, "STOP").substr(0, 32), "OK STOP\nFAIL id=1 reason=stopped");
}

TEST(Session, StallIsAFailure) {
    Talk talk;
    Session& robot = talk.client("ROBOT r2");
    EXPECT_EQ(talk.ask(robot, "FORWARD 3"), "OK FORWARD id=1 distance=3\n");
    talk.step(100);
    const std::string told = robot.take();
    EXPECT_TRUE(told.starts_with("FAIL id=1 reason=stall t=")) << told;
    const std::string status = talk.ask(robot, "STATUS");
    EXPECT_TRUE(status.ends_with(" stall=1\n")) << status;
    EXPECT_NE(status.find(" heading=90.000 speed=0.000 "), std::string::npos) << status;
}

TEST(Session, ScriptMayReplaceACommand) {
    Talk talk({Clock::Kind::Step, 1}, {}, "0.2 r2 FORWARD 0.25\n");
    Session& robot = talk.client("ROBOT r2");
    EXPECT_EQ(talk.ask(robot, "FORWARD 1"), "OK FORWARD id=1 distance=1\n");
    talk.step(30);
    // The end of the script's own command is not the client's.
    EXPECT_EQ(robot.take(), "FAIL id=1 reason=replaced t=0.200\n");
}

TEST(Session, LeavingStopsTheRobot) {
    for (const bool quits : {true, false}) {
        Talk talk;
        Session& robot = talk.client("ROBOT r2");
        talk.ask(robot, "SPEED 0.3");
        talk.step(5);
        EXPECT_DOUBLE_EQ(talk.room.world.status(1).speed, 0.3);
        if (quits) talk.ask(robot, "QUIT");
        if (!quits) talk.clients.clear();
        talk.step(5);
        EXPECT_EQ(talk.room.world.status(1).speed, 0);
    }
}

TEST(Session, NewHolderHearsNothingOfTheOldOnes) {
    Talk talk;
    Session& first = talk.client("ROBOT r1");
    talk.ask(first, "FORWARD 1");
    EXPECT_EQ(talk.ask(first, "QUIT"), "OK QUIT\n");
    Session& second = talk.client("ROBOT r1");
    EXPECT_EQ(talk.ask(second, "FORWARD 1"), "OK FORWARD id=2 distance=1\n");
    talk.step(1);
    EXPECT_EQ(second.take(), "");
    EXPECT_EQ(first.take(), "");
}

TEST(Session, Status) {
    Talk talk;
    Session& robot = talk.client("ROBOT r2");
    EXPECT_EQ(talk.ask(robot, "STATUS"),
              "OK STATUS t=0.000 x=2.000 y=1.500 heading=90.000 speed=0.000 rotspeed=0.000 accel=0 "
              "rotaccel=0 stall=0\n");
    talk.ask(robot, "SPEED -0.5");
    talk.step(2);
    EXPECT_EQ(talk.ask(robot, "STATUS"),
              "OK STATUS t=0.200 x=2.000 y=1.480 heading=90.000 speed=-0.200 rotspeed=0.000 "
              "accel=-1 rotaccel=0 stall=0\n");
}

TEST(Session, RobotReadsItsOwnLasers) {
    Talk talk;
    Session& robot = talk.client("ROBOT r1");
    EXPECT_EQ(talk.ask(robot, "SCAN l2"), talk.scan(1, false, false));
    EXPECT_EQ(talk.ask(robot, "SCAN l1"),
              "ERR 404 laser l1 is not on this robot: open another connection and take the role "
              "LASER l1\n");
    EXPECT_EQ(talk.ask(robot, "SCAN l7"),
              "ERR 404 no sensor `l7` on this robot, did you mean `l2`?\n");
    EXPECT_EQ(talk.ask(robot, "SCAN"), "ERR 400 SCAN wants an argument: SCAN id\n");
}

TEST(Session, Scan) {
    Talk talk;
    Session& laser = talk.client("LASER l1");
    EXPECT_EQ(talk.ask(laser, "SCAN"),
              "SCAN l1 t=0.000 seq=0 angle_min=-2 angle_max=2 step=2 n=3 r=-,7.000,-\n");
    talk.step(3);
    EXPECT_EQ(laser.take(), "");
    EXPECT_EQ(laser.takeScan(), nullptr);
    EXPECT_EQ(talk.ask(laser, "SCAN"),
              "SCAN l1 t=0.300 seq=3 angle_min=-2 angle_max=2 step=2 n=3 r=-,7.000,-\n");
}

TEST(Session, StreamSendsEachScan) {
    Talk talk;
    Session& laser = talk.client("LASER l1");
    EXPECT_EQ(talk.ask(laser, "STREAM"), "OK STREAM every=1\n");
    EXPECT_EQ(streamed(laser), "");
    for (int i = 1; i <= 5; ++i) {
        talk.step(1);
        EXPECT_EQ(streamed(laser), talk.scan(0, true, false));
        laser.stepped();
        EXPECT_EQ(streamed(laser), "");  // nothing new
    }
    EXPECT_EQ(talk.ask(laser, "STREAM every=3"), "OK STREAM every=3\n");
    std::string seqs;
    for (int i = 6; i <= 12; ++i) {
        talk.step(1);
        if (!streamed(laser).empty()) seqs += std::to_string(i) + ' ';
    }
    EXPECT_EQ(seqs, "6 9 12 ");
    EXPECT_EQ(talk.ask(laser, "STOP"), "OK STOP\n");
    talk.step(3);
    EXPECT_EQ(streamed(laser), "");
}

TEST(Session, StreamOfASlowLaser) {
    Talk talk;
    Session& laser = talk.client("LASER l2");
    talk.ask(laser, "STREAM");
    std::string times;
    for (int i = 0; i < 12; ++i) {
        talk.step(1);
        if (const std::string scan = streamed(laser); !scan.empty())
            times += scan.substr(8, scan.find(" angle") - 8) + ";";
    }
    EXPECT_EQ(times, "t=0.400 seq=1;t=0.800 seq=2;t=1.200 seq=3;");
}

TEST(Session, NewestScanReplacesTheOneNotSent) {
    Talk talk;
    Session& laser = talk.client("LASER l1");
    talk.ask(laser, "STREAM every=2");
    talk.step(5);
    EXPECT_EQ(laser.take(), "");
    EXPECT_NE(streamed(laser).find(" seq=4 "), std::string::npos);
    EXPECT_EQ(streamed(laser), "");
}

TEST(Session, ScanNotSentGoesBeforeTheEndOfTheStream) {
    for (const std::string request : {"STOP", "BINARY on"}) {
        Talk talk;
        Session& laser = talk.client("LASER l1");
        talk.ask(laser, "STREAM");
        talk.step(1);
        EXPECT_EQ(talk.ask(laser, request), talk.scan(0, true, false) + "OK " + request + "\n");
        EXPECT_EQ(streamed(laser), "");
    }
}

TEST(Session, BinaryScans) {
    Talk talk;
    Session& laser = talk.client("LASER l1");
    EXPECT_EQ(talk.ask(laser, "BINARY on"), "OK BINARY on\n");
    EXPECT_EQ(talk.ask(laser, "SCAN"), talk.scan(0, false, true));
    talk.ask(laser, "STREAM");
    talk.step(1);
    EXPECT_EQ(streamed(laser), talk.scan(0, true, true));
    EXPECT_EQ(talk.ask(laser, "BINARY off"), "OK BINARY off\n");
    EXPECT_EQ(talk.ask(laser, "SCAN"), talk.scan(0, false, false));
    EXPECT_EQ(talk.ask(laser, "BINARY"), "ERR 400 BINARY wants an argument: BINARY on|off\n");
    EXPECT_EQ(talk.ask(laser, "BINARY yes"), "ERR 400 BINARY is on or off, found `yes`\n");
}

TEST(Session, ReadersShareOneText) {
    Talk talk;
    Session& first = talk.client("LASER l1");
    Session& second = talk.client("LASER l1");
    talk.ask(first, "STREAM");
    talk.ask(second, "STREAM");
    talk.step(1);
    const auto scan = first.takeScan();
    ASSERT_NE(scan, nullptr);
    EXPECT_EQ(scan, second.takeScan());
    EXPECT_EQ(scan, talk.state.scan(0, {.stream = true}));
    EXPECT_NE(scan, talk.state.scan(0, {}));
    talk.step(1);
    EXPECT_NE(scan, first.takeScan());
}

TEST(Session, StreamArguments) {
    Talk talk;
    Session& laser = talk.client("LASER l1");
    EXPECT_EQ(talk.ask(laser, "STREAM 5"), "ERR 400 unexpected `5` behind STREAM [every=k]\n");
    EXPECT_EQ(talk.ask(laser, "STREAM every=x"), "ERR 400 every is a whole number, found `x`\n");
    EXPECT_EQ(talk.ask(laser, "STREAM every="), "ERR 400 every is a whole number, found ``\n");
    EXPECT_EQ(talk.ask(laser, "STREAM every=0"),
              "ERR 416 every is from 1 to 1000000000, found `0`\n");
    talk.step(1);
    EXPECT_EQ(streamed(laser), "");
}

}  // namespace session_requests_test

namespace session_requests_test {

using testing::Talk;

TEST(Session, FirstLineThatIsNoRequestEnds) {
    Talk talk;
    for (const char* line : {"USER a", "GET / HTTP/1.1", "robot r1", "\xff\xfe", "{"}) {
        Session& client = talk.client();
        EXPECT_EQ(talk.ask(client, ""), "");
        EXPECT_EQ(talk.ask(client, line).substr(0, 8), "ERR 400 ");
        EXPECT_TRUE(client.closing()) << line;
    }
    EXPECT_EQ(talk.ask(talk.client(), "USER a"),
              "ERR 400 unknown request `USER`; HELP lists what there is; a first line that is no "
              "request ends the connection\n");
    // A request that cannot be met is one.
    for (const char* line : {"FORWARD 1", "ROBOT", "ROBOT r9", "WORLD w1", "HELP", "SHUTDOWN"}) {
        Session& client = talk.client();
        talk.ask(client, line);
        EXPECT_FALSE(client.closing()) << line;
        EXPECT_EQ(talk.ask(client, "USER a").substr(0, 8), "ERR 400 ");
        EXPECT_FALSE(client.closing());
    }
}

ServerLimits fewPauses() {
    ServerLimits limits;
    // None come back while a test runs.
    limits.pauses = {1e-6, 4};
    limits.all_pauses = {1e-6, 6};
    limits.spare_pauses = {1e-6, 1};
    return limits;
}

TEST(Session, PausesAreRationed) {
    Talk talk({Clock::Kind::Fast, 1}, {}, "", fewPauses());
    Session& first = talk.client("WORLD");
    Session& second = talk.client("WORLD");
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(talk.ask(first, "PAUSE"), "OK PAUSE t=0.000\n");
        EXPECT_EQ(talk.ask(first, "RESUME"), "OK RESUME t=0.000\n");
    }
    for (const char* request : {"PAUSE", "RESUME"})
        EXPECT_EQ(talk.ask(first, request),
                  std::string("ERR 429 ") + request +
                      " comes too often: a client has 1e-06 a second, all together 1e-06\n");
    EXPECT_FALSE(talk.room.simulation.paused());
    // Not what others have, which ends with the sum of all; and a pause can be ended.
    EXPECT_EQ(talk.ask(second, "PAUSE"), "OK PAUSE t=0.000\n");
    EXPECT_EQ(talk.ask(second, "PAUSE"), "OK PAUSE t=0.000\n");
    EXPECT_EQ(talk.ask(second, "PAUSE").substr(0, 8), "ERR 429 ");
    EXPECT_EQ(talk.ask(first, "RESUME"), "OK RESUME t=0.000\n");
    EXPECT_FALSE(talk.room.simulation.paused());
    // A connection of its own does not help.
    EXPECT_EQ(talk.ask(talk.client("WORLD"), "PAUSE").substr(0, 8), "ERR 429 ");
    EXPECT_EQ(talk.ask(first, "STATUS").substr(0, 8), "ERR 405 ");
    EXPECT_EQ(talk.ask(first, "TIME").substr(0, 8), "OK TIME ");
}

TEST(Session, WhoSeldomPausesMayWhereOthersFlood) {
    ServerLimits limits = fewPauses();
    limits.spare_pauses = {1e9, 1};
    Talk talk({Clock::Kind::Fast, 1}, {}, "", limits);
    Session& seldom = talk.client("WORLD");
    for (int i = 0; i < 3; ++i) {
        Session& flooding = talk.client("WORLD");
        for (int k = 0; k < 10; ++k) talk.ask(flooding, "PAUSE");
    }
    EXPECT_EQ(talk.ask(seldom, "PAUSE"), "OK PAUSE t=0.000\n");
}

TEST(Session, BehavedPausesAreNotNoticed) {
    Talk talk({Clock::Kind::Fast, 1});
    Session& world = talk.client("WORLD");
    for (int i = 0; i < 50; ++i) {
        ASSERT_EQ(talk.ask(world, "PAUSE").substr(0, 8), "OK PAUSE");
        ASSERT_EQ(talk.ask(world, "RESUME").substr(0, 9), "OK RESUME");
    }
}

TEST(Session, TheRateOfARealClockMayBeChanged) {
    Talk talk({Clock::Kind::Real, 20});
    Session& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "RATE 0.5"), "OK RATE t=0.000 rate=0.5\n");
    EXPECT_EQ(talk.room.simulation.clock().rate, 0.5);
    EXPECT_NE(talk.ask(world, "HELP").find(" | RATE x | "), std::string::npos);
    for (const char* wrong : {"0", "-1", "nan", "inf", "2e6", "1e-9", "fast"})
        EXPECT_EQ(talk.ask(world, std::string("RATE ") + wrong),
                  std::string("ERR 416 `") + wrong +
                      "` is no number of simulated seconds in a second, from 0.000001 to "
                      "1000000\n");
    EXPECT_EQ(talk.room.simulation.clock().rate, 0.5);
    Talk fast({Clock::Kind::Fast, 1});
    EXPECT_EQ(fast.ask(fast.client("WORLD"), "RATE 2"),
              "ERR 405 only the clock `real` has a rate\n");
}

TEST(Session, RecordsAreWrittenWithTheirIds) {
    Talk talk;
    Session& world = talk.client("WORLD");
    const std::string text = talk.ask(world, "RECORDS");
    const std::string head = text.substr(0, text.find('\n'));
    EXPECT_TRUE(head.starts_with("OK RECORDS t=0.000 room=")) << head;
    const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    EXPECT_EQ(lines, 1 + talk.room.world.scene().records.size());
    EXPECT_TRUE(head.ends_with(" bytes=" + std::to_string(text.size() - head.size() - 1))) << head;
    for (const std::string& id : talk.room.world.scene().ids)
        EXPECT_TRUE(id.empty() || text.find(" id=" + id) != std::string::npos) << id << text;
    EXPECT_EQ(talk.ask(world, "RECORDS upper"),
              "ERR 400 this run is of one room: RECORDS has no argument\n");
    ServerLimits limits;
    limits.pending = 64;
    Talk narrow({Clock::Kind::Step, 1}, {}, "", limits);
    EXPECT_TRUE(narrow.ask(narrow.client("WORLD"), "RECORDS").starts_with("ERR 409 the records"));
}

/// A role whose requests need more memory than there is.
class LargeRole final : public ClientRole {
  public:
    [[nodiscard]] std::span<const RoleRequest> requests() const override {
        static constexpr RoleRequest kRows[] = {{"ALL", "", 0, 0}};
        return kRows;
    }
    RoleAnswer request(std::span<const std::string_view> /*words*/) override {
        throw std::bad_alloc();
    }
    [[nodiscard]] bool waits() const override { return false; }
    std::string stepped(bool /*has_room*/) override { return ""; }
    [[nodiscard]] std::span<const std::string> sensors() const override { return {}; }
    [[nodiscard]] double clock(SimTime time) const override { return seconds(time); }
};

/// Of which client `b` is too large already.
class LargeService final : public RoleService {
  public:
    [[nodiscard]] std::string_view verb() const override { return "LARGE"; }
    std::unique_ptr<ClientRole> take(std::string_view id, std::string& answer) override {
        answer += "OK LARGE\n";
        if (id == "b") throw std::bad_alloc();
        return std::make_unique<LargeRole>();
    }
    void stepped() override {}
    [[nodiscard]] bool holdsWorld() const override { return false; }
    [[nodiscard]] std::string waitsFor() const override { return ""; }
};

TEST(Session, ARoleWithoutMemoryIsAnsweredAndServesOn) {
    Talk talk;
    LargeService service;
    talk.state.addRoleService(service);
    Session& client = talk.client("LARGE a");
    EXPECT_EQ(talk.ask(client, "ALL"), "ERR 409 there is not enough memory for this\n");
    EXPECT_EQ(talk.ask(client, "ALL").substr(0, 8), "ERR 409 ");
    EXPECT_FALSE(client.closing());
    Session& other = talk.client();
    EXPECT_EQ(talk.ask(other, "LARGE b"), "ERR 409 there is not enough memory for this\n");
    EXPECT_EQ(talk.ask(other, "LARGE a"), "OK LARGE\n") << "no role was taken";
}

TEST(Session, ShutdownMayBeRefused) {
    ServerLimits limits;
    limits.shutdown = false;
    Talk talk({Clock::Kind::Step, 1}, {}, "", limits);
    Session& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "SHUTDOWN"),
              "ERR 403 clients may not end this run: it has --no-shutdown\n");
    EXPECT_FALSE(talk.room.simulation.finished());
    EXPECT_FALSE(world.closing());
    EXPECT_EQ(talk.ask(world, "HELP"),
              "OK HELP LIST | TIME | POSES | PAUSE | RESUME | STEP [n] | STATE [id] | RECORDS "
              "[room] | EVENTS "
              "[kinds|off] | MARK text | "
              "TRACK id [storey/]x,y [t=s] [kind=person|robot] | HELP | QUIT\n");
}

}  // namespace session_requests_test

}  // namespace ispace
