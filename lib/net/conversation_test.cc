// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/conversation.h"

#include <gtest/gtest.h>

#include <list>
#include <random>

#include "base/utf8.h"
#include "net/scan_text.h"
#include "net/test_world.h"

namespace ispace {
namespace {

constexpr std::chrono::nanoseconds kLong = std::chrono::hours(1);

/// A hall and who is in it.
struct Talk {
    explicit Talk(Clock clock = {Clock::Kind::Step, 1}, std::optional<SimTime> until = {},
                  const std::string& script = "")
        : room(clock, until, script), hall(room.simulation) {
        room.simulation.onStep([this] {
            for (Conversation& client : clients) client.stepped();
        });
    }
    Conversation& client(std::string_view role = "") {
        Conversation& added = clients.emplace_back(hall);
        if (!role.empty()) {
            EXPECT_TRUE(ask(added, role).starts_with("OK "));
        }
        return added;
    }
    static std::string ask(Conversation& client, std::string_view request) {
        client.request(request);
        return client.take();
    }
    /// Takes the steps that are allowed.
    void run() {
        room.simulation.run(WallTime{}, kLong);
        for (Conversation& client : clients)
            if (client.waiting()) client.stepped();
    }
    void step(std::int64_t count) {
        room.simulation.allow(count);
        run();
    }
    std::string scan(std::size_t laser, bool stream, bool binary) {
        return scanText(room.world.reading(laser), stream, binary);
    }

    testing::TestWorld room;
    Hall hall;
    std::list<Conversation> clients;
};

std::string streamed(Conversation& client) {
    const auto scan = client.takeScan();
    return scan ? *scan : "";
}

TEST(Conversation, Greets) { EXPECT_EQ(Conversation::greeting(), "ISPACE 1\n"); }

TEST(Conversation, TakesOneRole) {
    Talk talk;
    EXPECT_EQ(talk.ask(talk.client(), "ROBOT r1"), "OK ROBOT r1 model=pioneer-2dx radius=0.25\n");
    EXPECT_EQ(talk.ask(talk.client(), "ROBOT r2"), "OK ROBOT r2 model=- radius=0.3\n");
    EXPECT_EQ(talk.ask(talk.client(), "LASER l1"),
              "OK LASER l1 angle_min=-2 angle_max=2 step=2 n=3 range_min=0.1 range_max=7.002 "
              "rate=10\n");
    EXPECT_EQ(talk.ask(talk.client(), "WORLD"), "OK WORLD t=0.000 dt=0.1 clock=step\n");
    Conversation& robot = talk.clients.front();
    for (const char* request : {"ROBOT r1", "LASER l1", "WORLD", "ROBOT", "LASER x y"})
        EXPECT_EQ(talk.ask(robot, request).substr(0, 8), "ERR 405 ");
    EXPECT_EQ(talk.ask(robot, "LASER l1"),
              "ERR 405 this connection has the role ROBOT r1: open another one for LASER\n");
    EXPECT_EQ(talk.ask(talk.clients.back(), "ROBOT r2"),
              "ERR 405 this connection has the role WORLD: open another one for ROBOT\n");
}

TEST(Conversation, WorldNamesItsClock) {
    Talk real({Clock::Kind::Real, 20}), fast({Clock::Kind::Fast, 1});
    EXPECT_EQ(real.ask(real.client(), "WORLD"), "OK WORLD t=0.000 dt=0.1 clock=real rate=20\n");
    EXPECT_EQ(fast.ask(fast.client(), "WORLD"), "OK WORLD t=0.000 dt=0.1 clock=fast\n");
}

TEST(Conversation, UnknownThings) {
    Talk talk;
    Conversation& client = talk.client();
    EXPECT_EQ(talk.ask(client, "ROBOT r9"), "ERR 404 no robot `r9`, did you mean `r1`?\n");
    EXPECT_EQ(talk.ask(client, "ROBOT rover"), "ERR 404 no robot `rover`; there is r1, r2\n");
    EXPECT_EQ(talk.ask(client, "LASER panel"), "ERR 404 no laser `panel`; there is l1, l2\n");
    EXPECT_EQ(talk.ask(client, "ROBOT l1"), "ERR 404 no robot `l1`, did you mean `r1`?\n");
    EXPECT_EQ(talk.ask(client, "ROBOT r1"), "OK ROBOT r1 model=pioneer-2dx radius=0.25\n");
}

TEST(Conversation, RobotHasOneHolder) {
    Talk talk;
    Conversation& first = talk.client("ROBOT r1");
    Conversation& second = talk.client();
    EXPECT_EQ(talk.ask(second, "ROBOT r1"), "ERR 409 robot r1 is held by another client\n");
    EXPECT_EQ(talk.ask(first, "QUIT"), "OK QUIT\n");
    EXPECT_TRUE(first.closing());
    EXPECT_EQ(talk.ask(second, "ROBOT r1").substr(0, 3), "OK ");
    talk.clients.pop_back();
    Conversation& third = talk.client("ROBOT r1");
    EXPECT_FALSE(third.closing());
}

TEST(Conversation, LaserHasManyReaders) {
    Talk talk;
    Conversation& first = talk.client("LASER l1");
    Conversation& second = talk.client("LASER l1");
    EXPECT_EQ(talk.ask(first, "SCAN"), talk.ask(second, "SCAN"));
}

TEST(Conversation, Errors405SayWhatToDo) {
    Talk talk;
    Conversation& nobody = talk.client();
    for (const char* request : {"FORWARD 1", "SCAN", "LIST", "STATUS x", "STEP -1"})
        EXPECT_EQ(talk.ask(nobody, request),
                  "ERR 405 take a role first: ROBOT id, LASER id or WORLD\n");
    Conversation& robot = talk.client("ROBOT r1");
    EXPECT_EQ(talk.ask(robot, "LIST"),
              "ERR 405 LIST is for the role WORLD, this connection has the role ROBOT r1: open "
              "another one\n");
    Conversation& laser = talk.client("LASER l2");
    EXPECT_EQ(talk.ask(laser, "FORWARD 1"),
              "ERR 405 FORWARD is for the role ROBOT, this connection has the role LASER l2: open "
              "another one\n");
    Conversation& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "SCAN"),
              "ERR 405 SCAN is for the role ROBOT or LASER, this connection has the role WORLD: "
              "open another one\n");
}

TEST(Conversation, UnknownRequests) {
    Talk talk;
    Conversation& client = talk.client();
    EXPECT_EQ(talk.ask(client, "FORWRAD 1"),
              "ERR 400 unknown request `FORWRAD`, did you mean `FORWARD`? HELP lists what there "
              "is\n");
    EXPECT_EQ(talk.ask(client, "robot r1"),
              "ERR 400 unknown request `robot`, did you mean `ROBOT`? HELP lists what there is\n");
    EXPECT_EQ(talk.ask(client, "ISPACE 1"),
              "ERR 400 unknown request `ISPACE`; HELP lists what there is\n");
    // Of later versions.
    for (const char* request :
         {"RESET", "SET r1.at=1,1", "ADD cube", "DELETE r1", "EVENTS", "SENSOR c1", "TOKEN x"})
        EXPECT_EQ(talk.ask(client, request).substr(0, 24), "ERR 400 unknown request ") << request;
}

TEST(Conversation, ArgumentsAreCounted) {
    Talk talk;
    Conversation& client = talk.client();
    EXPECT_EQ(talk.ask(client, "ROBOT"), "ERR 400 ROBOT wants an argument: ROBOT id\n");
    EXPECT_EQ(talk.ask(client, "ROBOT r1 r2"), "ERR 400 unexpected `r2` behind ROBOT id\n");
    EXPECT_EQ(talk.ask(client, "WORLD w1"), "ERR 400 unexpected `w1` behind WORLD\n");
    EXPECT_EQ(talk.ask(client, "HELP me"), "ERR 400 unexpected `me` behind HELP\n");
    EXPECT_EQ(talk.ask(client, "QUIT now"), "ERR 400 unexpected `now` behind QUIT\n");
    EXPECT_FALSE(client.closing());
    EXPECT_EQ(talk.ask(client, " \tWORLD  \t"), "OK WORLD t=0.000 dt=0.1 clock=step\n");
    EXPECT_EQ(talk.ask(client, "STEP 1 2"), "ERR 400 unexpected `2` behind STEP [n]\n");
}

TEST(Conversation, BlankLinesAreNoRequests) {
    Talk talk;
    Conversation& client = talk.client();
    for (const char* line : {"", " ", "\t", " \t "}) EXPECT_EQ(talk.ask(client, line), "");
}

TEST(Conversation, Help) {
    Talk talk;
    EXPECT_EQ(talk.ask(talk.client(), "HELP"),
              "OK HELP ROBOT id | LASER id | WORLD | HELP | QUIT\n");
    EXPECT_EQ(talk.ask(talk.client("ROBOT r1"), "HELP"),
              "OK HELP FORWARD m | BACKWARD m | LEFT deg | RIGHT deg | SPEED m/s | ROTSPEED deg/s "
              "| STOP | STATUS | SCAN id | HELP | QUIT\n");
    EXPECT_EQ(talk.ask(talk.client("LASER l1"), "HELP"),
              "OK HELP SCAN | STREAM [every=k] | STOP | BINARY on|off | HELP | QUIT\n");
    EXPECT_EQ(talk.ask(talk.client("WORLD"), "HELP"),
              "OK HELP LIST | TIME | POSES | PAUSE | RESUME | STEP [n] | SHUTDOWN | HELP | QUIT\n");
}

TEST(Conversation, TooLongCloses) {
    Talk talk;
    Conversation& robot = talk.client("ROBOT r1");
    robot.tooLong(4096);
    EXPECT_EQ(robot.take(), "ERR 413 a request has at most 4096 bytes before its end of line\n");
    EXPECT_TRUE(robot.closing());
    talk.client("ROBOT r1");  // it is free
}

TEST(Conversation, CommandsAreAnsweredAtOnce) {
    Talk talk;
    Conversation& robot = talk.client("ROBOT r2");
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

TEST(Conversation, CommandsThatAreWrong) {
    Talk talk;
    Conversation& robot = talk.client("ROBOT r1");
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

TEST(Conversation, EndsComeWithTheSteps) {
    Talk talk;
    Conversation& r1 = talk.client("ROBOT r1");
    Conversation& r2 = talk.client("ROBOT r2");
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

TEST(Conversation, StallIsAFailure) {
    Talk talk;
    Conversation& robot = talk.client("ROBOT r2");
    EXPECT_EQ(talk.ask(robot, "FORWARD 3"), "OK FORWARD id=1 distance=3\n");
    talk.step(100);
    const std::string told = robot.take();
    EXPECT_TRUE(told.starts_with("FAIL id=1 reason=stall t=")) << told;
    const std::string status = talk.ask(robot, "STATUS");
    EXPECT_TRUE(status.ends_with(" stall=1\n")) << status;
    EXPECT_NE(status.find(" heading=90.000 speed=0.000 "), std::string::npos) << status;
}

TEST(Conversation, ScriptMayReplaceACommand) {
    Talk talk({Clock::Kind::Step, 1}, {}, "0.2 r2 FORWARD 0.25\n");
    Conversation& robot = talk.client("ROBOT r2");
    EXPECT_EQ(talk.ask(robot, "FORWARD 1"), "OK FORWARD id=1 distance=1\n");
    talk.step(30);
    // The end of the script's own command is not the client's.
    EXPECT_EQ(robot.take(), "FAIL id=1 reason=replaced t=0.200\n");
}

TEST(Conversation, LeavingStopsTheRobot) {
    for (const bool quits : {true, false}) {
        Talk talk;
        Conversation& robot = talk.client("ROBOT r2");
        talk.ask(robot, "SPEED 0.3");
        talk.step(5);
        EXPECT_DOUBLE_EQ(talk.room.world.status(1).speed, 0.3);
        if (quits) talk.ask(robot, "QUIT");
        if (!quits) talk.clients.clear();
        talk.step(5);
        EXPECT_EQ(talk.room.world.status(1).speed, 0);
    }
}

TEST(Conversation, NewHolderHearsNothingOfTheOldOnes) {
    Talk talk;
    Conversation& first = talk.client("ROBOT r1");
    talk.ask(first, "FORWARD 1");
    EXPECT_EQ(talk.ask(first, "QUIT"), "OK QUIT\n");
    Conversation& second = talk.client("ROBOT r1");
    EXPECT_EQ(talk.ask(second, "FORWARD 1"), "OK FORWARD id=2 distance=1\n");
    talk.step(1);
    EXPECT_EQ(second.take(), "");
    EXPECT_EQ(first.take(), "");
}

TEST(Conversation, Status) {
    Talk talk;
    Conversation& robot = talk.client("ROBOT r2");
    EXPECT_EQ(talk.ask(robot, "STATUS"),
              "OK STATUS t=0.000 x=2.000 y=1.500 heading=90.000 speed=0.000 rotspeed=0.000 accel=0 "
              "rotaccel=0 stall=0\n");
    talk.ask(robot, "SPEED -0.5");
    talk.step(2);
    EXPECT_EQ(talk.ask(robot, "STATUS"),
              "OK STATUS t=0.200 x=2.000 y=1.480 heading=90.000 speed=-0.200 rotspeed=0.000 "
              "accel=-1 rotaccel=0 stall=0\n");
}

TEST(Conversation, RobotReadsItsOwnLasers) {
    Talk talk;
    Conversation& robot = talk.client("ROBOT r1");
    EXPECT_EQ(talk.ask(robot, "SCAN l2"), talk.scan(1, false, false));
    EXPECT_EQ(talk.ask(robot, "SCAN l1"),
              "ERR 404 laser l1 is not on this robot: open another connection and take the role "
              "LASER l1\n");
    EXPECT_EQ(talk.ask(robot, "SCAN l7"),
              "ERR 404 no laser `l7` on this robot, did you mean `l2`?\n");
    EXPECT_EQ(talk.ask(robot, "SCAN"), "ERR 400 SCAN wants an argument: SCAN id\n");
}

TEST(Conversation, Scan) {
    Talk talk;
    Conversation& laser = talk.client("LASER l1");
    EXPECT_EQ(talk.ask(laser, "SCAN"),
              "SCAN l1 t=0.000 seq=0 angle_min=-2 angle_max=2 step=2 n=3 r=-,7.000,-\n");
    talk.step(3);
    EXPECT_EQ(laser.take(), "");
    EXPECT_EQ(laser.takeScan(), nullptr);
    EXPECT_EQ(talk.ask(laser, "SCAN"),
              "SCAN l1 t=0.300 seq=3 angle_min=-2 angle_max=2 step=2 n=3 r=-,7.000,-\n");
}

TEST(Conversation, StreamSendsEachScan) {
    Talk talk;
    Conversation& laser = talk.client("LASER l1");
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

TEST(Conversation, StreamOfASlowLaser) {
    Talk talk;
    Conversation& laser = talk.client("LASER l2");
    talk.ask(laser, "STREAM");
    std::string times;
    for (int i = 0; i < 12; ++i) {
        talk.step(1);
        if (const std::string scan = streamed(laser); !scan.empty())
            times += scan.substr(8, scan.find(" angle") - 8) + ";";
    }
    EXPECT_EQ(times, "t=0.400 seq=1;t=0.800 seq=2;t=1.200 seq=3;");
}

TEST(Conversation, NewestScanReplacesTheOneNotSent) {
    Talk talk;
    Conversation& laser = talk.client("LASER l1");
    talk.ask(laser, "STREAM every=2");
    talk.step(5);
    EXPECT_EQ(laser.take(), "");
    EXPECT_NE(streamed(laser).find(" seq=4 "), std::string::npos);
    EXPECT_EQ(streamed(laser), "");
}

TEST(Conversation, ScanNotSentGoesBeforeTheEndOfTheStream) {
    for (const std::string request : {"STOP", "BINARY on"}) {
        Talk talk;
        Conversation& laser = talk.client("LASER l1");
        talk.ask(laser, "STREAM");
        talk.step(1);
        EXPECT_EQ(talk.ask(laser, request), talk.scan(0, true, false) + "OK " + request + "\n");
        EXPECT_EQ(streamed(laser), "");
    }
}

TEST(Conversation, BinaryScans) {
    Talk talk;
    Conversation& laser = talk.client("LASER l1");
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

TEST(Conversation, ReadersShareOneText) {
    Talk talk;
    Conversation& first = talk.client("LASER l1");
    Conversation& second = talk.client("LASER l1");
    talk.ask(first, "STREAM");
    talk.ask(second, "STREAM");
    talk.step(1);
    const auto scan = first.takeScan();
    ASSERT_NE(scan, nullptr);
    EXPECT_EQ(scan, second.takeScan());
    EXPECT_EQ(scan, talk.hall.scan(0, true, false));
    EXPECT_NE(scan, talk.hall.scan(0, false, false));
    talk.step(1);
    EXPECT_NE(scan, first.takeScan());
}

TEST(Conversation, StreamArguments) {
    Talk talk;
    Conversation& laser = talk.client("LASER l1");
    EXPECT_EQ(talk.ask(laser, "STREAM 5"), "ERR 400 unexpected `5` behind STREAM [every=k]\n");
    EXPECT_EQ(talk.ask(laser, "STREAM every=x"), "ERR 400 every is a whole number, found `x`\n");
    EXPECT_EQ(talk.ask(laser, "STREAM every="), "ERR 400 every is a whole number, found ``\n");
    EXPECT_EQ(talk.ask(laser, "STREAM every=0"),
              "ERR 416 every is from 1 to 1000000000, found `0`\n");
    talk.step(1);
    EXPECT_EQ(streamed(laser), "");
}

TEST(Conversation, WorldTellsWhatThereIs) {
    Talk talk;
    Conversation& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "LIST"), "OK LIST robots=r1,r2 lasers=l1,l2\n");
    EXPECT_EQ(talk.ask(world, "TIME"), "OK TIME t=0.000 steps=0\n");
    talk.step(3);
    EXPECT_EQ(talk.ask(world, "TIME"), "OK TIME t=0.300 steps=3\n");
    EXPECT_EQ(talk.ask(world, "POSES"),
              "OK POSES t=0.300 n=2 poses=r1,0.000,0.000,0.000;r2,2.000,1.500,90.000\n");
}

TEST(Conversation, EmptyWorld) {
    const Scene scene = testing::scene("ispace size=8,6\n", "");
    World world(scene, std::chrono::milliseconds(5));
    Simulation simulation(world, {}, {Clock::Kind::Fast, 1}, {});
    Hall hall(simulation);
    Conversation client(hall);
    EXPECT_EQ(Talk::ask(client, "ROBOT r1"), "ERR 404 no robot `r1`: there is none\n");
    Talk::ask(client, "WORLD");
    EXPECT_EQ(Talk::ask(client, "LIST"), "OK LIST robots= lasers=\n");
    EXPECT_EQ(Talk::ask(client, "POSES"), "OK POSES t=0.000 n=0 poses=\n");
}

TEST(Conversation, HeadingsStayAboveMinus180) {
    const Scene scene = testing::scene(
        "ispace size=8,6\n", "robot id=r1 at=0,0 heading=-179.9999\nrobot id=r2 at=-0.0001,2\n");
    World world(scene, std::chrono::milliseconds(5));
    Simulation simulation(world, {}, {Clock::Kind::Fast, 1}, {});
    Hall hall(simulation);
    Conversation client(hall);
    Talk::ask(client, "WORLD");
    EXPECT_EQ(Talk::ask(client, "POSES"),
              "OK POSES t=0.000 n=2 poses=r1,0.000,0.000,180.000;r2,0.000,2.000,0.000\n");
}

TEST(Conversation, StepIsAnsweredWhenDone) {
    Talk talk;
    Conversation& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "STEP 10"), "");
    EXPECT_TRUE(world.waiting());
    talk.run();
    EXPECT_FALSE(world.waiting());
    EXPECT_EQ(world.take(), "OK STEP n=10 t=1.000\n");
    EXPECT_EQ(talk.ask(world, "STEP"), "");
    talk.run();
    EXPECT_EQ(world.take(), "OK STEP n=1 t=1.100\n");
}

TEST(Conversation, StepsOfSeveralClientsAddUp) {
    Talk talk;
    Conversation& first = talk.client("WORLD");
    Conversation& second = talk.client("WORLD");
    first.request("STEP 10");
    second.request("STEP 5");
    talk.run();
    EXPECT_EQ(first.take(), "OK STEP n=10 t=1.000\n");
    EXPECT_EQ(second.take(), "OK STEP n=5 t=1.500\n");
    EXPECT_EQ(talk.room.world.steps(), 15);
}

TEST(Conversation, StepEndsWithTheRun) {
    Talk talk({Clock::Kind::Step, 1}, std::chrono::milliseconds(1200));
    Conversation& first = talk.client("WORLD");
    Conversation& second = talk.client("WORLD");
    Conversation& third = talk.client("WORLD");
    first.request("STEP 10");
    second.request("STEP 5");
    third.request("STEP 5");
    talk.run();
    EXPECT_EQ(first.take(), "OK STEP n=10 t=1.000\n");
    EXPECT_EQ(second.take(), "OK STEP n=2 t=1.200\n");
    EXPECT_EQ(third.take(), "OK STEP n=0 t=1.200\n");
}

TEST(Conversation, PauseCutsAStepShort) {
    Talk talk;
    Conversation& first = talk.client("WORLD");
    Conversation& second = talk.client("WORLD");
    first.request("STEP 1000000000");
    talk.room.simulation.run(WallTime{}, std::chrono::nanoseconds(1));
    const std::int64_t taken = talk.room.world.steps();
    EXPECT_EQ(first.take(), "");
    EXPECT_EQ(talk.ask(second, "PAUSE").substr(0, 9), "OK PAUSE ");
    first.stepped();
    EXPECT_EQ(first.take(), "OK STEP n=" + std::to_string(taken) +
                                " t=" + formatMilliseconds(talk.room.world.time()) + "\n");
    talk.run();
    EXPECT_EQ(talk.room.world.steps(), taken);
}

TEST(Conversation, StepArguments) {
    Talk talk;
    Conversation& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "STEP x"),
              "ERR 400 the number of steps is a whole number, found `x`\n");
    EXPECT_EQ(talk.ask(world, "STEP 1.5"),
              "ERR 400 the number of steps is a whole number, found `1.5`\n");
    for (const std::string n : {"0", "-3", "1000000001"})
        EXPECT_EQ(talk.ask(world, "STEP " + n),
                  "ERR 416 the number of steps is from 1 to 1000000000, found `" + n + "`\n");
    EXPECT_FALSE(world.waiting());
}

TEST(Conversation, PauseAndResume) {
    Talk step;
    EXPECT_EQ(step.ask(step.client("WORLD"), "RESUME"),
              "ERR 405 the clock is `step`: use STEP n\n");
    EXPECT_EQ(step.ask(step.clients.back(), "PAUSE"), "OK PAUSE t=0.000\n");
    Talk talk({Clock::Kind::Fast, 1});
    Conversation& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "STEP 1"), "ERR 405 the world is running: PAUSE comes before STEP\n");
    EXPECT_EQ(talk.ask(world, "RESUME"), "OK RESUME t=0.000\n");
    EXPECT_EQ(talk.ask(world, "PAUSE"), "OK PAUSE t=0.000\n");
    EXPECT_TRUE(talk.room.simulation.paused());
    EXPECT_EQ(talk.ask(world, "STEP 2"), "");
    talk.run();
    EXPECT_EQ(world.take(), "OK STEP n=2 t=0.200\n");
    EXPECT_EQ(talk.ask(world, "RESUME"), "OK RESUME t=0.200\n");
    EXPECT_FALSE(talk.room.simulation.paused());
}

TEST(Conversation, Shutdown) {
    Talk talk;
    Conversation& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "SHUTDOWN"), "OK SHUTDOWN t=0.000\n");
    EXPECT_TRUE(talk.room.simulation.finished());
    EXPECT_TRUE(world.closing());
}

std::string dialogue() {
    Talk talk;
    Conversation& robot = talk.client("ROBOT r1");
    Conversation& laser = talk.client("LASER l2");
    Conversation& world = talk.client("WORLD");
    std::string out;
    const auto say = [&](Conversation& client, std::string_view request) {
        client.request(request);
        talk.run();
        for (Conversation* each : {&robot, &laser, &world}) out += each->take() + streamed(*each);
    };
    say(laser, "STREAM every=2");
    say(robot, "FORWARD 1");
    for (int i = 0; i < 40; ++i) say(world, "STEP");
    say(robot, "LEFT 100");
    for (int i = 0; i < 40; ++i) say(world, "STEP 1");
    say(robot, "STATUS");
    return out;
}

TEST(Conversation, DialogueByStepIsTheSameEachTime) {
    const std::string first = dialogue();
    EXPECT_EQ(first, dialogue());
    EXPECT_NE(first.find("\nDONE id=1 t="), std::string::npos);
    EXPECT_NE(first.find("\nDONE id=2 t="), std::string::npos);
    EXPECT_NE(first.find(" seq=10 "), std::string::npos);
    EXPECT_EQ(first.find(" seq=9 "), std::string::npos);
}

TEST(Conversation, AnyBytesGetOnePrintableLine) {
    std::mt19937 random(5);
    const std::vector<std::string> starts = {
        "", "ROBOT ", "STEP ", "SCAN ", "STREAM every=", "SPEED ", "BINARY "};
    Talk talk;
    for (int i = 0; i < 20000; ++i) {
        Conversation client(talk.hall);
        if (i % 4 > 0) client.request(i % 4 == 1 ? "ROBOT r1" : i % 4 == 2 ? "LASER l1" : "WORLD");
        client.take();
        std::string line = starts[random() % starts.size()];
        for (std::size_t n = 1 + random() % 80; n > 0; --n) {
            const char c = static_cast<char>(random() % 256);
            line += c == '\n' ? 'x' : c;
        }
        client.request(line);
        std::string reply = client.take();
        if (reply.empty() && line.find_first_not_of(" \t") == std::string::npos) continue;
        if (client.waiting()) continue;
        ASSERT_TRUE(reply.ends_with('\n'));
        reply.pop_back();
        ASSERT_EQ(reply, printable(reply));
        ASSERT_TRUE(reply.starts_with("ERR 4") || reply.starts_with("OK ")) << reply;
    }
    const std::string nul("FORWARD\0 1", 10);
    EXPECT_EQ(talk.ask(talk.client("ROBOT r1"), nul),
              "ERR 400 unknown request `FORWARD?`, did you mean `FORWARD`? HELP lists what there "
              "is\n");
}

}  // namespace
}  // namespace ispace
