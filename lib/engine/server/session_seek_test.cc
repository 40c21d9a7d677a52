// SPDX-License-Identifier: GPL-3.0-or-later
// A replay is taken to another time while something is still being made of the world as it is.
#include <gtest/gtest.h>

#include <time.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "base/file.h"
#include "sim/replay.h"
#include "support/test_folder.h"
#include "support/test_source.h"
#include "support/test_talk.h"

namespace ispace {
namespace session_seek_test {

using testing::Talk;

ServerLimits changing() {
    ServerLimits limits;
    limits.source = std::make_shared<testing::TextSource>(
        std::map<std::string, std::string>{{"hall.env", "ispace size=20,20\n"}});
    return limits;
}

/// A replay of three steps of 0.1 s in which r1 goes along x, whose changes and pictures are made
/// aside.
class SessionSeekTest : public ::testing::Test {
  protected:
    SessionSeekTest() : talk_({Clock::Kind::Step, 1}, {}, "", changing()) {
        writeAll(folder_ / "robots.csv", moments());
        replay_ = std::make_unique<Replay>(folder_.path());
        talk_.room.simulation.replay(*replay_, true);
        talk_.state.startBackground([] {}, nullptr);
    }
    void TearDown() override { talk_.state.stopBackground(); }

    static std::string moments() {
        std::string text = "t,id,x,y,heading_deg,stall\n";
        for (const char* t : {"0", "0.1", "0.2", "0.3"})
            text.append(t).append(",r1,").append(t).append(",0,0,0\n");
        return text;
    }
    /// The answer, once it is there.
    std::string answer(Session& client) {
        std::string text = client.take();
        while (client.waiting()) {
            std::this_thread::yield();
            talk_.state.collect();
            for (Session& each : talk_.clients) each.proceed();
            text += client.take();
        }
        return text;
    }
    std::string ask(Session& client, const std::string& request) {
        client.request(request);
        return answer(client);
    }

    testing::TestFolder folder_;
    std::unique_ptr<Replay> replay_;  // outlives the room that it is played in
    Talk talk_;
};

TEST_F(SessionSeekTest, ComesAfterAChangeUnderWay) {
    Session& changer = talk_.client("WORLD");
    Session& seeker = talk_.client("WORLD");
    Session& other = talk_.client("WORLD");
    ASSERT_EQ(ask(seeker, "SEEK 0.2"), "OK SEEK t=0.200\n");
    changer.request("ADD robot id=r9 at=-2,2");
    seeker.request("SEEK 0.3");
    ASSERT_TRUE(changer.waiting());
    EXPECT_TRUE(seeker.waiting()) << "the change is of the world at 0.2";
    EXPECT_EQ(talk_.ask(other, "TIME"), "OK TIME t=0.200 steps=2\n");
    EXPECT_EQ(answer(seeker), "OK SEEK t=0.300\n");
    EXPECT_EQ(answer(changer), "OK ADD id=r9 t=0.200\n");
    EXPECT_EQ(talk_.ask(other, "LIST").substr(0, 24), "OK LIST robots=r1,r2,r9 ");
    EXPECT_EQ(talk_.ask(other, "POSES").substr(0, 48),
              "OK POSES t=0.300 n=3 poses=r1,0.300,0.000,0.000;");
}

TEST_F(SessionSeekTest, GoingBackUndoesTheChangeUnderWay) {
    Session& changer = talk_.client("WORLD");
    Session& seeker = talk_.client("WORLD");
    ASSERT_EQ(ask(seeker, "SEEK 0.2"), "OK SEEK t=0.200\n");
    changer.request("LOAD hall.env");
    seeker.request("SEEK 0.1");
    EXPECT_EQ(answer(seeker), "OK SEEK t=0.100\n");
    EXPECT_EQ(answer(changer), "OK LOAD t=0.200\n");
    EXPECT_EQ(talk_.ask(seeker, "LIST").substr(0, 21), "OK LIST robots=r1,r2 ");
    EXPECT_EQ(talk_.ask(seeker, "POSES").substr(0, 48),
              "OK POSES t=0.100 n=2 poses=r1,0.100,0.000,0.000;");
    EXPECT_EQ(ask(seeker, "RESET"), "OK RESET t=0.100\n");
    EXPECT_EQ(talk_.ask(seeker, "LIST").substr(0, 21), "OK LIST robots=r1,r2 ") << "loaded no more";
}

TEST_F(SessionSeekTest, WhoGoesMeanwhileSeeksNothing) {
    Session& other = talk_.client("WORLD");
    Session& changer = talk_.client("WORLD");
    changer.request("ADD robot id=r9 at=-2,2");
    talk_.client("WORLD").request("SEEK 0.3");
    talk_.clients.pop_back();
    EXPECT_EQ(answer(changer), "OK ADD id=r9 t=0.000\n");
    EXPECT_EQ(talk_.ask(other, "TIME"), "OK TIME t=0.000 steps=0\n");
}

TEST_F(SessionSeekTest, IsRefusedWhenTheRunEnds) {
    Session& changer = talk_.client("WORLD");
    Session& seeker = talk_.client("WORLD");
    changer.request("ADD robot id=r9 at=-2,2");
    seeker.request("SEEK 0.3");
    seeker.finish();
    EXPECT_EQ(seeker.take(), "ERR 405 the run has ended\n");
    EXPECT_FALSE(seeker.waiting());
}

/// Calls it. \returns processor time of this thread
template <typename Call>
std::chrono::nanoseconds workOf(const Call& call) {
    const auto now = [] {
        timespec time{};
        ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
    };
    const auto begin = now();
    call();
    return now() - begin;
}

TEST(SessionSeek, LeavesTheThreadThatServesToOthers) {
    // A large room, to which the run adds a robot after 0.1 s.
    std::string room = "ispace size=150,150\n";
    for (int x = -70; x <= 70; ++x)
        for (int y = 2; y <= 70; ++y)
            room += "cube at=" + std::to_string(x) + ',' + std::to_string(y) + " size=0.1\n";
    const Scene scene = testing::scene(room, "robot id=r1 at=0,0\n");
    const testing::TestFolder folder;
    std::string moments = "t,id,x,y,heading_deg,stall\n";
    for (const char* t : {"0", "0.1", "0.2", "0.3"})
        moments.append(t).append(",r1,").append(t).append(",0,0,0\n");
    writeAll(folder / "robots.csv", moments);
    writeAll(folder / "events.csv",
             "t,kind,id,other,x,y,value,text\n0.1,change,,,,,,\"ADD robot id=r9 at=0,-2\"\n");
    const auto changes = [&] { return RunChanges(folder.path(), scene, {}, {}); };
    constexpr auto kStep = std::chrono::milliseconds(100);

    World alone(scene, kStep);
    Replay record(folder.path());
    record.makeChanges(changes());
    const auto whole = workOf([&] {
        record.seek(alone, 3 * kStep);
        record.seek(alone, SimTime(0));
    });

    World world(scene, kStep);
    Simulation simulation(world, {}, {Clock::Kind::Step, 1}, {});
    Replay replay(folder.path());
    replay.makeChanges(changes());
    simulation.replay(replay, true);
    ServerState state(simulation);
    state.startBackground([] {}, nullptr);
    Session seeker(state), other(state);
    seeker.request("WORLD");
    other.request("WORLD");
    seeker.take();
    other.take();
    std::chrono::nanoseconds most{};
    const auto seek = [&](const std::string& time) {
        most = std::max(most, workOf([&] { seeker.request("SEEK " + time); }));
        EXPECT_TRUE(seeker.waiting());
        while (seeker.waiting()) {
            other.request("TIME");
            EXPECT_TRUE(other.take().starts_with("OK TIME t="));
            most = std::max(most, workOf([&] { state.collect(); }));
            most = std::max(most, workOf([&] { seeker.proceed(); }));
            std::this_thread::yield();
        }
        return seeker.take();
    };
    EXPECT_EQ(seek("0.3"), "OK SEEK t=0.300\n");
    EXPECT_TRUE(world.moverNamed("r9"));
    EXPECT_EQ(seek("0"), "OK SEEK t=0.000\n");
    EXPECT_FALSE(world.moverNamed("r9"));
    EXPECT_LT(most, whole / 4) << "of " << whole.count() << " ns";
    // A step makes the change aside as well.
    simulation.allow(3);
    while (simulation.owed() > 0) {
        most = std::max(most, workOf([&] {
                            if (simulation.isDue({})) state.prepareStep();
                            if (!state.holdsWorld()) simulation.run({}, {});
                        }));
        most = std::max(most, workOf([&] { state.collect(); }));
    }
    EXPECT_TRUE(world.moverNamed("r9"));
    EXPECT_LT(most, whole / 4) << "of " << whole.count() << " ns";
    state.stopBackground();
}

}  // namespace session_seek_test
}  // namespace ispace
