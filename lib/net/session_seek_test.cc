// SPDX-License-Identifier: GPL-3.0-or-later
// A replay is taken to another time while something is still being made of the world as it is.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>

#include "base/file.h"
#include "base/test_folder.h"
#include "net/test_talk.h"
#include "sim/replay.h"
#include "sim/test_source.h"

namespace ispace {
namespace {

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
        talk_.state.makeAside([] {}, nullptr);
    }
    void TearDown() override { talk_.state.endAside(); }

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

}  // namespace
}  // namespace ispace
