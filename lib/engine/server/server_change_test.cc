// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of the world take long: others are served meanwhile, and a run by steps does not change
// for it.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "support/test_client.h"
#include "support/test_source.h"

namespace ispace {
namespace server_change_test {

using testing::Client;
using testing::comes;
using testing::Running;
using testing::step;

/// Scenes that are loaded only when the test lets them.
class SlowSource : public testing::TextSource {
  public:
    SlowSource()
        : TextSource(std::map<std::string, std::string>{
              {"hall.env", "ispace size=20,20\n"},
              {"hall.3dm", "robot id=r1 at=9,9\nrobot id=r3 at=-9,9\n"},
              {"bad.3dm", "robot id=r1 at=10,0\n"}}) {}
    [[nodiscard]] Scene load(const std::string& environment,
                             const std::string& layout) const override {
        std::unique_lock lock(mutex_);
        has_begun_ = true;
        changed_.notify_all();
        changed_.wait(lock, [this] { return is_open_; });
        return TextSource::load(environment, layout);
    }
    void awaitBegin() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return has_begun_; });
    }
    void open() {
        {
            const std::lock_guard lock(mutex_);
            is_open_ = true;
        }
        changed_.notify_all();
    }

  private:
    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    mutable bool has_begun_ = false;
    bool is_open_ = false;
};

/// A server whose world can be changed, as soon as the source is open.
struct Slow {
    explicit Slow(Clock::Kind clock, const std::string& more = "")
        : running({clock, 1}, limitsOf(source), more) {}
    ~Slow() { source->open(); }
    Slow(const Slow&) = delete;
    Slow& operator=(const Slow&) = delete;

    static ServerLimits limitsOf(std::shared_ptr<SlowSource> source) {
        ServerLimits limits;
        limits.source = std::move(source);
        return limits;
    }
    std::shared_ptr<SlowSource> source = std::make_shared<SlowSource>();
    Running running;
};

TEST(ServerChange, OthersAreServedAndTheWorldGoesOn) {
    Slow slow(Clock::Kind::Real);
    Client loader(slow.running.port()), robot(slow.running.port()), world(slow.running.port());
    loader.take("WORLD");
    robot.take("ROBOT r1");
    world.take("WORLD");
    ASSERT_TRUE(loader.send("LOAD hall.env hall.3dm\nLIST\n"));
    slow.source->awaitBegin();
    EXPECT_EQ(robot.ask("STATUS").substr(0, 9), "OK STATUS");
    const std::string time = world.ask("TIME");
    EXPECT_TRUE(testing::soon([&] { return world.ask("TIME") != time; })) << "steps are taken";
    EXPECT_EQ(world.ask("LIST").substr(0, 20), "OK LIST robots=r1,r2");
    EXPECT_TRUE(loader.quiet());
    slow.source->open();
    EXPECT_EQ(loader.line().substr(0, 10), "OK LOAD t=");
    EXPECT_EQ(loader.line().substr(0, 20), "OK LIST robots=r1,r3");
}

TEST(ServerChange, StepsWaitForThoseBeforeThem) {
    for (const Clock::Kind clock : {Clock::Kind::Step, Clock::Kind::Real}) {
        Slow slow(clock);
        Client loader(slow.running.port()), world(slow.running.port());
        loader.take("WORLD");
        world.take("WORLD");
        world.ask("PAUSE");
        const std::string before = world.ask("TIME");
        ASSERT_TRUE(loader.send("LOAD hall.env hall.3dm\n"));
        slow.source->awaitBegin();
        ASSERT_TRUE(world.send("STEP 3\n"));
        Client other(slow.running.port());
        other.take("WORLD");
        for (int i = 0; i < 20; ++i) EXPECT_EQ(other.ask("TIME"), before);
        EXPECT_TRUE(world.quiet());
        slow.source->open();
        const std::string time = before.substr(8, before.find(' ', 8) - 8);
        EXPECT_EQ(loader.line(), "OK LOAD " + time);
        EXPECT_EQ(world.line().substr(0, 11), "OK STEP n=3");
    }
}

TEST(ServerChange, TwoAtOnceAreMadeOneAfterAnother) {
    Slow slow(Clock::Kind::Real);
    Client first(slow.running.port()), second(slow.running.port());
    for (Client* client : {&first, &second}) client->take("WORLD");
    ASSERT_TRUE(first.send("LOAD hall.env hall.3dm\n"));
    slow.source->awaitBegin();
    EXPECT_EQ(second.ask("LIST").substr(0, 20), "OK LIST robots=r1,r2");
    // Of the room that is still to come.
    ASSERT_TRUE(second.send("ADD robot id=r9 at=-9,-9\nLIST\n"));
    slow.source->open();
    EXPECT_EQ(first.line().substr(0, 7), "OK LOAD");
    EXPECT_EQ(second.line().substr(0, 12), "OK ADD id=r9");
    EXPECT_EQ(second.line().substr(0, 23), "OK LIST robots=r1,r3,r9");
}

TEST(ServerChange, AFailureLeavesAllAsItWas) {
    Slow slow(Clock::Kind::Step);
    Client loader(slow.running.port()), robot(slow.running.port());
    loader.take("WORLD");
    robot.take("ROBOT r1");
    slow.source->open();
    EXPECT_EQ(loader.ask("LOAD hall.env bad.3dm").substr(0, 7), "ERR 409");
    EXPECT_EQ(loader.ask("LOAD nothing.env").substr(0, 7), "ERR 409");
    EXPECT_EQ(loader.ask("ADD cube at=0,0 size=1").substr(0, 7), "ERR 409");
    EXPECT_EQ(loader.ask("ADD cube at=0,0 side=1").substr(0, 7), "ERR 400");
    EXPECT_EQ(loader.ask("SET r9.at=0,0").substr(0, 7), "ERR 404");
    EXPECT_EQ(loader.ask("LIST").substr(0, 20), "OK LIST robots=r1,r2");
    EXPECT_EQ(robot.ask("STATUS").substr(0, 9), "OK STATUS");
    EXPECT_EQ(loader.ask("SET r1.at=1,1"), "OK SET t=0.000");
}

TEST(ServerChange, WhoAskedIsGone) {
    Slow slow(Clock::Kind::Step);
    Client loader(slow.running.port()), world(slow.running.port());
    loader.take("WORLD");
    world.take("WORLD");
    ASSERT_TRUE(loader.send("LOAD hall.env hall.3dm\n"));
    slow.source->awaitBegin();
    loader.vanish();
    slow.source->open();
    EXPECT_TRUE(comes(world, "LIST", "OK LIST robots=r1,r3"));
    EXPECT_EQ(step(world, 2), "OK STEP n=2 t=0.200");
}

TEST(ServerChange, TheRunEndsMeanwhile) {
    Slow slow(Clock::Kind::Real);
    Client loader(slow.running.port()), world(slow.running.port());
    loader.take("WORLD");
    world.take("WORLD");
    ASSERT_TRUE(loader.send("LOAD hall.env hall.3dm\n"));
    slow.source->awaitBegin();
    EXPECT_EQ(world.ask("SHUTDOWN").substr(0, 11), "OK SHUTDOWN");
    EXPECT_EQ(loader.line(), "ERR 405 the run has ended");
    EXPECT_EQ(loader.rest(), "");
}

TEST(ServerChange, PicturesOfTheWorldBefore) {
    Slow slow(Clock::Kind::Step, "ranger id=big at=-3,0,1 pixels=1200,900 rate=10\n");
    Client viewer(slow.running.port()), world(slow.running.port());
    viewer.take("SENSOR big");
    world.take("WORLD");
    slow.source->open();
    // The sensor goes while its frame is made, and with it what made it.
    ASSERT_TRUE(viewer.send("SCAN\n"));
    EXPECT_EQ(world.ask("DELETE big"), "OK DELETE t=0.000");
    const std::string line = viewer.line();
    if (line.starts_with("SCAN big")) {
        const std::size_t key = line.find(" bytes=");
        std::string bytes(std::stoul(line.substr(key + 7)), ' ');
        ASSERT_TRUE(viewer.bytes(bytes.data(), bytes.size()));
        EXPECT_EQ(bytes.size(), 4U * 1200 * 900);
        EXPECT_EQ(viewer.line(), "EVENT gone t=0.000 id=big");
    } else {
        EXPECT_EQ(line, "EVENT gone t=0.000 id=big");
    }
}

TEST(ServerChange, WithOneThread) {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    Slow slow(Clock::Kind::Real);
    slow.source->open();
    Client world(slow.running.port());
    world.take("WORLD");
    EXPECT_EQ(world.ask("ADD robot id=r9 at=-2,2").substr(0, 12), "OK ADD id=r9");
    EXPECT_EQ(world.ask("LOAD hall.env hall.3dm").substr(0, 7), "OK LOAD");
    EXPECT_EQ(world.ask("LIST").substr(0, 20), "OK LIST robots=r1,r3");
}

}  // namespace server_change_test
}  // namespace ispace
