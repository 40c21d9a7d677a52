// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/wire/zps_session.h"

#include <gtest/gtest.h>

#include "extensions/wire/tests/test_host.h"

namespace ispace::wire {

namespace zps_session_test {

using testing::TestHost;

constexpr const char* kSystem =
    "ultrasound id=u1 at=-2,-2,2.4 tilt=-90 fov=160\nultrasound id=u2 at=2,-2,2.4 tilt=-90 "
    "fov=160\n"
    "ultrasound id=u3 at=2,2,2.4 tilt=-90 fov=160\nultrasound id=u4 at=-2,2,2.4 tilt=-90 fov=160\n"
    "robot id=r1 at=0,0 accel=10 speed=0.5\ntag id=t1 on=r1 at=0,0,0.5 tilt=90\n"
    "tag id=t2 at=3.9,2.9,0.1 tilt=-90 fov=10 rate=5\n";
constexpr const char* kHead = "# zps-3d 1: t,tag,x,y,z,receivers,residual (s, m)\n";

TEST(ZpsSession, TellsWhereATagIs) {
    TestHost host(kSystem);
    ZpsSession session(host, "t1");
    EXPECT_EQ(session.take(), kHead);
    host.run(session, 0.2);
    EXPECT_EQ(session.take(),
              "0.100,t1,0.000,0.000,0.500,4,0.000\n0.200,t1,0.000,0.000,0.500,4,0.000\n");
    host.world().command(0, {Verb::Forward, 1});
    host.run(session, 4);
    const std::string lines = session.take();
    EXPECT_TRUE(lines.ends_with("\n4.200,t1,1.000,0.000,0.500,4,0.000\n")) << lines;
    session.receive("anything\n");
    EXPECT_EQ(session.take(), "");
}

TEST(ZpsSession, TellsOfAllTagsAndOfThoseThatNobodyHears) {
    TestHost host(kSystem);
    ZpsSession session(host, "u2");
    session.take();
    host.run(session, 0.2);
    EXPECT_EQ(session.take(),
              "0.100,t1,0.000,0.000,0.500,4,0.000\n0.200,t1,0.000,0.000,0.500,4,0.000\n"
              "0.200,t2,,,,0,\n");
}

TEST(ZpsSession, LeavesOutWhatNobodyReads) {
    TestHost host(kSystem);
    ZpsSession session(host, "t1");
    session.take();
    for (int i = 0; i < 50; ++i) {
        host.world().step();
        session.stepped(100'000);
    }
    EXPECT_EQ(session.take(), "");
    host.run(session, 0.1);
    EXPECT_EQ(session.take(), "0.600,t1,0.000,0.000,0.500,4,0.000\n");
}

TEST(ZpsSession, NeedsNothingSaid) {
    TestHost host(kSystem);
    ZpsSession session(host, "t1");
    EXPECT_TRUE(session.isEngaged());
    session.take();
    session.ended();
    host.run(session, 0.1);
    EXPECT_EQ(session.take(), "0.100,t1,0.000,0.000,0.500,4,0.000\n");
    EXPECT_FALSE(session.closing());
}

TEST(ZpsSession, FollowsChanges) {
    TestHost host(kSystem);
    ZpsSession session(host, "t1");
    session.take();
    const std::vector<std::string> moved = {"r1.at=1,1"};
    EXPECT_EQ(host.change(moved), WireHost::Change::Done);
    host.run(session, 0.1);
    EXPECT_EQ(session.take(), "0.100,t1,1.000,1.000,0.500,4,0.000\n");
    Scene scene = testing::scene("ispace size=8,6\n", "");
    host.world().change(std::move(scene));
    session.stepped(0);
    EXPECT_TRUE(session.closing());
}

}  // namespace zps_session_test

}  // namespace ispace::wire
