// SPDX-License-Identifier: GPL-3.0-or-later
// What all roles share, and the role WORLD.
#include "server/session.h"

#include <gtest/gtest.h>

#include <list>
#include <random>

#include "base/message.h"
#include "support/test_talk.h"

namespace ispace {
namespace session_test {

using testing::streamed;
using testing::Talk;

TEST(Session, Greets) { EXPECT_EQ(Session::greeting(), "ISPACE 1\n"); }

TEST(Session, TakesOneRole) {
    Talk talk;
    const std::string speeds =
        " speed=0.5 rotspeed=100 max_speed=1.6 max_rotspeed=300 max_sidespeed=0 accel=";
    EXPECT_EQ(talk.ask(talk.client(), "ROBOT r1"),
              "OK ROBOT r1 model=pioneer-2dx radius=0.25" + speeds + "0.3 rotaccel=100\n");
    EXPECT_EQ(talk.ask(talk.client(), "ROBOT r2"),
              "OK ROBOT r2 model=- radius=0.3" + speeds + "1 rotaccel=100\n");
    EXPECT_EQ(talk.ask(talk.client(), "LASER l1"),
              "OK LASER l1 angle_min=-2 angle_max=2 step=2 n=3 range_min=0.1 range_max=7.002 "
              "rate=10\n");
    EXPECT_EQ(talk.ask(talk.client(), "WORLD"), "OK WORLD t=0.000 dt=0.1 clock=step\n");
    Session& robot = talk.clients.front();
    for (const char* request : {"ROBOT r1", "LASER l1", "WORLD", "ROBOT", "LASER x y"})
        EXPECT_EQ(talk.ask(robot, request).substr(0, 8), "ERR 405 ");
    EXPECT_EQ(talk.ask(robot, "LASER l1"),
              "ERR 405 this connection has the role ROBOT r1: open another one for LASER\n");
    EXPECT_EQ(talk.ask(talk.clients.back(), "ROBOT r2"),
              "ERR 405 this connection has the role WORLD: open another one for ROBOT\n");
}

TEST(Session, WorldNamesItsClock) {
    Talk real({Clock::Kind::Real, 20}), fast({Clock::Kind::Fast, 1});
    EXPECT_EQ(real.ask(real.client(), "WORLD"), "OK WORLD t=0.000 dt=0.1 clock=real rate=20\n");
    EXPECT_EQ(fast.ask(fast.client(), "WORLD"), "OK WORLD t=0.000 dt=0.1 clock=fast\n");
}

TEST(Session, UnknownThings) {
    Talk talk;
    Session& client = talk.client();
    EXPECT_EQ(talk.ask(client, "ROBOT r9"), "ERR 404 no robot `r9`, did you mean `r1`?\n");
    EXPECT_EQ(talk.ask(client, "ROBOT rover"), "ERR 404 no robot `rover`; there is r1, r2\n");
    EXPECT_EQ(talk.ask(client, "LASER panel"), "ERR 404 no laser `panel`; there is l1, l2\n");
    EXPECT_EQ(talk.ask(client, "ROBOT l1"), "ERR 404 no robot `l1`, did you mean `r1`?\n");
    EXPECT_TRUE(talk.ask(client, "ROBOT r1").starts_with("OK ROBOT r1 model=pioneer-2dx radius"));
}

TEST(Session, DoesNotSearchThousandsOfNames) {
    std::string robots;
    for (int i = 0; i < 300; ++i)
        robots +=
            "robot radius=0.01 at=" + std::to_string(i % 20) + ',' + std::to_string(i / 20) + "\n";
    const Scene scene = testing::scene("ispace at=10,8 size=30,30\n", robots);
    World world(scene, std::chrono::milliseconds(100));
    Simulation simulation(world, {}, {Clock::Kind::Step, 1}, {});
    ServerState state(simulation);
    Session client(state);
    client.request("ROBOT robot1x");
    EXPECT_EQ(client.take(), "ERR 404 no robot `robot1x`; LIST of the role WORLD names all\n");
}

TEST(Session, RobotHasOneHolder) {
    Talk talk;
    Session& first = talk.client("ROBOT r1");
    Session& second = talk.client();
    EXPECT_EQ(talk.ask(second, "ROBOT r1"), "ERR 409 robot r1 is held by another client\n");
    EXPECT_EQ(talk.ask(first, "QUIT"), "OK QUIT\n");
    EXPECT_TRUE(first.closing());
    EXPECT_EQ(talk.ask(second, "ROBOT r1").substr(0, 3), "OK ");
    talk.clients.pop_back();
    Session& third = talk.client("ROBOT r1");
    EXPECT_FALSE(third.closing());
}

TEST(Session, LaserHasManyReaders) {
    Talk talk;
    Session& first = talk.client("LASER l1");
    Session& second = talk.client("LASER l1");
    EXPECT_EQ(talk.ask(first, "SCAN"), talk.ask(second, "SCAN"));
}

TEST(Session, Errors405SayWhatToDo) {
    Talk talk;
    Session& nobody = talk.client();
    for (const char* request : {"FORWARD 1", "SCAN", "LIST", "STATUS x", "STEP -1"})
        EXPECT_EQ(talk.ask(nobody, request),
                  "ERR 405 take a role first: ROBOT id, PERSON id, LASER id, SENSOR id or WORLD\n");
    Session& robot = talk.client("ROBOT r1");
    EXPECT_EQ(talk.ask(robot, "LIST"),
              "ERR 405 LIST is for the role WORLD, this connection has the role ROBOT r1: open "
              "another one\n");
    Session& laser = talk.client("LASER l2");
    EXPECT_EQ(talk.ask(laser, "FORWARD 1"),
              "ERR 405 FORWARD is for the role ROBOT or PERSON, this connection has the role LASER "
              "l2: open "
              "another one\n");
    Session& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "SCAN"),
              "ERR 405 SCAN is for the role ROBOT or LASER or SENSOR, this connection has the role "
              "WORLD: "
              "open another one\n");
}

TEST(Session, UnknownRequests) {
    Talk talk;
    Session& client = talk.client();
    talk.ask(client, "HELP");
    EXPECT_EQ(talk.ask(client, "FORWRAD 1"),
              "ERR 400 unknown request `FORWRAD`, did you mean `FORWARD`? HELP lists what there "
              "is\n");
    EXPECT_EQ(talk.ask(client, "robot r1"),
              "ERR 400 unknown request `robot`, did you mean `ROBOT`? HELP lists what there is\n");
    EXPECT_EQ(talk.ask(client, "ISPACE 1"),
              "ERR 400 unknown request `ISPACE`; HELP lists what there is\n");
}

TEST(Session, ArgumentsAreCounted) {
    Talk talk;
    Session& client = talk.client();
    EXPECT_EQ(talk.ask(client, "ROBOT"), "ERR 400 ROBOT wants an argument: ROBOT id\n");
    EXPECT_EQ(talk.ask(client, "ROBOT r1 r2"), "ERR 400 unexpected `r2` behind ROBOT id\n");
    EXPECT_EQ(talk.ask(client, "WORLD w1"), "ERR 400 unexpected `w1` behind WORLD\n");
    EXPECT_EQ(talk.ask(client, "HELP me"), "ERR 400 unexpected `me` behind HELP\n");
    EXPECT_EQ(talk.ask(client, "QUIT now"), "ERR 400 unexpected `now` behind QUIT\n");
    EXPECT_FALSE(client.closing());
    EXPECT_EQ(talk.ask(client, " \tWORLD  \t"), "OK WORLD t=0.000 dt=0.1 clock=step\n");
    EXPECT_EQ(talk.ask(client, "STEP 1 2"), "ERR 400 unexpected `2` behind STEP [n]\n");
}

TEST(Session, BlankLinesAreNoRequests) {
    Talk talk;
    Session& client = talk.client();
    for (const char* line : {"", " ", "\t", " \t "}) EXPECT_EQ(talk.ask(client, line), "");
}

TEST(Session, Help) {
    Talk talk;
    EXPECT_EQ(talk.ask(talk.client(), "HELP"),
              "OK HELP ROBOT id | PERSON id | LASER id | SENSOR id | WORLD | HELP | QUIT\n");
    EXPECT_EQ(talk.ask(talk.client("ROBOT r1"), "HELP"),
              "OK HELP FORWARD m | BACKWARD m | LEFT deg | RIGHT deg | SPEED m/s | ROTSPEED deg/s "
              "| SIDESPEED m/s | PATH x,y;... [speed=v] [pause=s] [loop=yes] | GOTO "
              "[storey/]x,y[,heading] [speed=v] | STOP | STATUS | "
              "ODOMETRY | "
              "SCAN id | SONAR | BUMPER | HELP | QUIT\n");
    EXPECT_EQ(talk.ask(talk.client("LASER l1"), "HELP"),
              "OK HELP SCAN | STREAM [every=k] | STOP | BINARY on|off | HELP | QUIT\n");
    EXPECT_EQ(talk.ask(talk.client("WORLD"), "HELP"),
              "OK HELP LIST | TIME | POSES | PAUSE | RESUME | STEP [n] | STATE [id] | RECORDS "
              "[room] | EVENTS [kinds|off] | MARK text | "
              "TRACK id [storey/]x,y [t=s] [kind=person|robot] | SHUTDOWN | HELP | QUIT\n");
}

TEST(Session, TooLongCloses) {
    Talk talk;
    Session& robot = talk.client("ROBOT r1");
    robot.tooLong(4096);
    EXPECT_EQ(robot.take(), "ERR 413 a request has at most 4096 bytes before its end of line\n");
    EXPECT_TRUE(robot.closing());
    talk.client("ROBOT r1");  // it is free
}

TEST(Session, WorldTellsWhatThereIs) {
    Talk talk;
    Session& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "LIST"), "OK LIST robots=r1,r2 lasers=l1,l2 people= sensors=l1,l2\n");
    EXPECT_EQ(talk.ask(world, "TIME"), "OK TIME t=0.000 steps=0\n");
    talk.step(3);
    EXPECT_EQ(talk.ask(world, "TIME"), "OK TIME t=0.300 steps=3\n");
    EXPECT_EQ(talk.ask(world, "POSES"),
              "OK POSES t=0.300 n=2 poses=r1,0.000,0.000,0.000;r2,2.000,1.500,90.000\n");
}

TEST(Session, EmptyWorld) {
    const Scene scene = testing::scene("ispace size=8,6\n", "");
    World world(scene, std::chrono::milliseconds(5));
    Simulation simulation(world, {}, {Clock::Kind::Fast, 1}, {});
    ServerState state(simulation);
    Session client(state);
    EXPECT_EQ(Talk::ask(client, "ROBOT r1"), "ERR 404 no robot `r1`: there is none\n");
    Talk::ask(client, "WORLD");
    EXPECT_EQ(Talk::ask(client, "LIST"), "OK LIST robots= lasers= people= sensors=\n");
    EXPECT_EQ(Talk::ask(client, "POSES"), "OK POSES t=0.000 n=0 poses=\n");
}

TEST(Session, HeadingsStayAboveMinus180) {
    const Scene scene = testing::scene(
        "ispace size=8,6\n", "robot id=r1 at=0,0 heading=-179.9999\nrobot id=r2 at=-0.0001,2\n");
    World world(scene, std::chrono::milliseconds(5));
    Simulation simulation(world, {}, {Clock::Kind::Fast, 1}, {});
    ServerState state(simulation);
    Session client(state);
    Talk::ask(client, "WORLD");
    EXPECT_EQ(Talk::ask(client, "POSES"),
              "OK POSES t=0.000 n=2 poses=r1,0.000,0.000,180.000;r2,0.000,2.000,0.000\n");
}

TEST(Session, StepIsAnsweredWhenDone) {
    Talk talk;
    Session& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "STEP 10"), "");
    EXPECT_TRUE(world.waiting());
    talk.run();
    EXPECT_FALSE(world.waiting());
    EXPECT_EQ(world.take(), "OK STEP n=10 t=1.000\n");
    EXPECT_EQ(talk.ask(world, "STEP"), "");
    talk.run();
    EXPECT_EQ(world.take(), "OK STEP n=1 t=1.100\n");
}

TEST(Session, StepsOfSeveralClientsAddUp) {
    Talk talk;
    Session& first = talk.client("WORLD");
    Session& second = talk.client("WORLD");
    first.request("STEP 10");
    second.request("STEP 5");
    talk.run();
    EXPECT_EQ(first.take(), "OK STEP n=10 t=1.000\n");
    EXPECT_EQ(second.take(), "OK STEP n=5 t=1.500\n");
    EXPECT_EQ(talk.room.world.steps(), 15);
}

TEST(Session, StepEndsWithTheRun) {
    Talk talk({Clock::Kind::Step, 1}, std::chrono::milliseconds(1200));
    Session& first = talk.client("WORLD");
    Session& second = talk.client("WORLD");
    Session& third = talk.client("WORLD");
    first.request("STEP 10");
    second.request("STEP 5");
    third.request("STEP 5");
    talk.run();
    EXPECT_EQ(first.take(), "OK STEP n=10 t=1.000\n");
    EXPECT_EQ(second.take(), "OK STEP n=2 t=1.200\n");
    EXPECT_EQ(third.take(), "OK STEP n=0 t=1.200\n");
}

TEST(Session, PauseCutsAStepShort) {
    Talk talk;
    Session& first = talk.client("WORLD");
    Session& second = talk.client("WORLD");
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

TEST(Session, StepArguments) {
    Talk talk;
    Session& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "STEP x"),
              "ERR 400 the number of steps is a whole number, found `x`\n");
    EXPECT_EQ(talk.ask(world, "STEP 1.5"),
              "ERR 400 the number of steps is a whole number, found `1.5`\n");
    for (const std::string n : {"0", "-3", "1000000001"})
        EXPECT_EQ(talk.ask(world, "STEP " + n),
                  "ERR 416 the number of steps is from 1 to 1000000000, found `" + n + "`\n");
    EXPECT_FALSE(world.waiting());
}

TEST(Session, PauseAndResume) {
    Talk step;
    EXPECT_EQ(step.ask(step.client("WORLD"), "RESUME"),
              "ERR 405 the clock is `step`: use STEP n\n");
    EXPECT_EQ(step.ask(step.clients.back(), "PAUSE"), "OK PAUSE t=0.000\n");
    Talk talk({Clock::Kind::Fast, 1});
    Session& world = talk.client("WORLD");
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

TEST(Session, Shutdown) {
    Talk talk;
    Session& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "SHUTDOWN"), "OK SHUTDOWN t=0.000\n");
    EXPECT_TRUE(talk.room.simulation.finished());
    EXPECT_TRUE(world.closing());
}

std::string dialogue() {
    Talk talk;
    Session& robot = talk.client("ROBOT r1");
    Session& laser = talk.client("LASER l2");
    Session& world = talk.client("WORLD");
    std::string out;
    const auto say = [&](Session& client, std::string_view request) {
        client.request(request);
        talk.run();
        for (Session* each : {&robot, &laser, &world}) out += each->take() + streamed(*each);
    };
    say(laser, "STREAM every=2");
    say(robot, "FORWARD 1");
    for (int i = 0; i < 40; ++i) say(world, "STEP");
    say(robot, "LEFT 100");
    for (int i = 0; i < 40; ++i) say(world, "STEP 1");
    say(robot, "STATUS");
    return out;
}

TEST(Session, DialogueByStepIsTheSameEachTime) {
    const std::string first = dialogue();
    EXPECT_EQ(first, dialogue());
    EXPECT_NE(first.find("\nDONE id=1 t="), std::string::npos);
    EXPECT_NE(first.find("\nDONE id=2 t="), std::string::npos);
    EXPECT_NE(first.find(" seq=10 "), std::string::npos);
    EXPECT_EQ(first.find(" seq=9 "), std::string::npos);
}

TEST(Session, AnyBytesGetOnePrintableLine) {
    std::mt19937 random(5);
    const std::vector<std::string> starts = {
        "", "ROBOT ", "STEP ", "SCAN ", "STREAM every=", "SPEED ", "BINARY "};
    Talk talk;
    for (int i = 0; i < 20000; ++i) {
        Session client(talk.state);
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

}  // namespace session_test
}  // namespace ispace
