// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/web/web_frames.h"

#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <string>

#include "support/test_layout.h"
#include "support/test_world.h"

namespace ispace::web {
namespace web_frames_test {

using std::chrono::milliseconds;
using testing::TestWorld;

bool has(const std::string& text, const std::string& piece) {
    return text.find(piece) != std::string::npos;
}

/// A world that a browser looks at, a second apart.
struct Watched : TestWorld {
    explicit Watched(const std::string& more = "")
        : TestWorld({Clock::Kind::Step, 1}, {}, "", more),
          frames(simulation, simulation, {.title = "room.env"}) {}

    void step(int count = 1) {
        simulation.allow(count);
        simulation.run(WallTime{}, std::chrono::hours(1));
    }
    std::string next() {
        frames.look(now += std::chrono::hours(1));
        const std::int64_t known = std::exchange(last, frames.number());
        return *frames.frame(known);
    }

    WebFrames frames;
    WallTime now{};
    std::int64_t last = 0;
};

TEST(WebFrames, TellWhereEverythingIs) {
    Watched world("human id=h1 at=-1,1.5 heading=90\n");
    const std::string frame = world.next();
    EXPECT_TRUE(
        frame.starts_with("{\"schema\":\"ispace-web-frame/1\",\"frame\":1,\"scene\":0,"
                          "\"t\":0.000,\"steps\":0,\"clock\":\"step\",\"rate\":1,"
                          "\"days\":false,\"paused\":true,\"replay\":false,\"over\":false,"
                          "\"movers\":[[0,0,0,0,0,0,0],"
                          "[2000,1500,9000,0,0,0,0],[-1000,1500,9000,0,0,0,0]],"))
        << frame;
    EXPECT_TRUE(has(frame,
                    "{\"id\":\"l1\",\"pose\":[-3000,-2000,0,0,0],\"first\":-2,\"step\":2,"
                    "\"max\":7.002,\"r\":[-1,7000,-1]}"))
        << frame;
}

TEST(WebFrames, HaveTheTracksThatAreToldNow) {
    Watched world;
    EXPECT_FALSE(has(world.next(), "tracks"));
    world.simulation.tracks().report({.track = "7", .place = {1.25, -0.5}});
    world.simulation.tracks().report({.source = "hub", .track = "a", .place = {0, 1}});
    EXPECT_TRUE(has(world.next(), ",\"tracks\":[[\"7\",1250,-500],[\"hub/a\",0,1000]],"));
    world.step(11);
    EXPECT_FALSE(has(world.next(), "tracks"));
}

TEST(WebFrames, TellTheClockOfTheLeadingSimulation) {
    Watched world;
    Simulation led(world.world, {}, {Clock::Kind::Fast, 1}, {});
    WebFrames frames(led, world.simulation, {.title = "upper"});
    frames.look(WallTime{} + std::chrono::hours(1));
    EXPECT_TRUE(
        has(*frames.frame(0), "\"clock\":\"step\",\"rate\":1,\"days\":false,\"paused\":true"));
}

TEST(WebFrames, HaveMatsAndGates) {
    Watched world("mat id=m1 at=0,0 size=1,1\ngate id=g1 at=1,0\n");
    EXPECT_TRUE(has(world.next(), "{\"id\":\"m1\",\"on\":1},{\"id\":\"g1\",\"in\":0,\"out\":0}"));
}

TEST(WebFrames, HaveWaysUntilTheyEnd) {
    Watched world;
    EXPECT_TRUE(has(world.next(), "\"ways\":[],"));
    Command command = {Verb::Goto, 0, {.path = {{1, 0}}}};
    ASSERT_EQ(world.world.findPath(0, command), "");
    world.world.command(0, command);
    const std::string way = "\"ways\":[{\"id\":\"r1\",\"way\":[1000,0]}],";
    EXPECT_TRUE(has(world.next(), way)) << "before the next step";
    world.step();
    const std::string next = world.next();
    EXPECT_TRUE(has(next, "\"ways\":[],")) << next;
    EXPECT_TRUE(has(*world.frames.frame(0), way)) << "for a client that is new";
    world.world.command(0, {Verb::Stop, 0});
    const std::string ended = world.next();
    EXPECT_TRUE(has(ended, "\"ways\":[{\"id\":\"r1\",\"way\":[]}],")) << ended;
    EXPECT_TRUE(has(*world.frames.frame(0), "\"ways\":[],"));
}

TEST(WebFrames, HaveTheWaysOfTripsThatComeLater) {
    TestWorld world({Clock::Kind::Step, 1});
    std::vector<PlannedPath> planned = {{"r9", {{1, 2}, {3, 4}}}};
    WebFrames frames(world.simulation, world.simulation,
                     {.title = "upper", .planned = [&] { return planned; }});
    frames.look(WallTime{} + std::chrono::hours(1));
    EXPECT_TRUE(has(*frames.frame(0),
                    "\"ways\":[{\"id\":\"r9\",\"way\":[],\"later\":[[1000,2000,3000,4000]]}],"));
    planned.clear();
    frames.look(WallTime{} + std::chrono::hours(2));
    EXPECT_TRUE(has(*frames.frame(1), "\"ways\":[{\"id\":\"r9\",\"way\":[]}],"));
}

TEST(WebFrames, AreMadeWhenThereIsSomethingNew) {
    Watched world;
    world.next();
    world.frames.look(world.now += std::chrono::hours(1));
    EXPECT_EQ(world.frames.number(), 1);
    world.step();
    world.frames.look(world.now += std::chrono::hours(1));
    EXPECT_EQ(world.frames.number(), 2);
    world.step();
    world.frames.look(world.now + milliseconds(5));
    EXPECT_EQ(world.frames.number(), 2) << "too soon";
    EXPECT_GE(world.frames.nextLook(), world.now + milliseconds(33));
}

TEST(WebFrames, HaveReadingsThatAreNew) {
    Watched world;  // l1 is read in each step, l2 in each fourth
    world.next();
    world.step();
    world.next();
    world.step();
    const std::string second = world.next();
    EXPECT_TRUE(has(second, "\"all\":false,\"readings\":[{\"id\":\"l1\",")) << second;
    EXPECT_FALSE(has(second, "\"id\":\"l2\"")) << second;
    world.step();
    world.frames.look(world.now += std::chrono::hours(1));
    const std::string whole = *world.frames.frame(0);
    EXPECT_TRUE(has(whole, "\"all\":true") && has(whole, "\"id\":\"l2\"")) << whole;
    EXPECT_EQ(world.frames.frame(0), world.frames.frame(1)) << "made once for all";
}

TEST(WebFrames, OfManyBeamsComeInTurn) {
    std::string more;
    for (int i = 0; i < 20; ++i)
        more += "laser id=x" + std::to_string(i) + " at=0,2 fov=180 step=0.02 range=2\n";
    Watched world(more);  // 9001 beams each
    world.next();
    std::set<std::string> seen;
    for (int frame = 0; frame < 3; ++frame) {
        world.step();
        const std::string text = world.next();
        int here = 0;
        for (int i = 0; i < 20; ++i)
            if (has(text, "\"id\":\"x" + std::to_string(i) + "\"")) {
                ++here;
                seen.insert(std::to_string(i));
            }
        EXPECT_LE(here, 7);
    }
    EXPECT_GE(seen.size(), 20U);
}

TEST(WebFrames, FollowTheWorldIntoAnotherScene) {
    Watched world;
    EXPECT_TRUE(has(*world.frames.scene(), "\"scene\":0,\"title\":\"room.env\""));
    world.next();
    world.step();
    world.frames.look(world.now += std::chrono::hours(1));
    world.world.change(testing::scene("ispace size=8,6\n", "robot id=new at=1,1\n"));
    EXPECT_TRUE(has(*world.frames.frame(1), "\"readings\":[]")) << "of the scene before";
    EXPECT_EQ(world.frames.sceneVersion(), 1);
    const std::string scene = *world.frames.scene();
    EXPECT_TRUE(has(scene, "\"scene\":1,") && has(scene, "\"id\":\"new\"")) << scene;
    const std::string frame = world.next();
    EXPECT_TRUE(has(frame, "\"scene\":1,") && has(frame, "\"movers\":[[1000,1000,0,0,0,0,0]]"))
        << frame;
}

}  // namespace web_frames_test
}  // namespace ispace::web
