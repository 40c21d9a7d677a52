// SPDX-License-Identifier: GPL-3.0-or-later
#include "wire/p2os_session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "wire/test_host.h"

namespace ispace {

namespace {

using testing::TestHost;

/// A client that puts packets together by hand.
class Pioneer {
  public:
    explicit Pioneer(TestHost& host)
        : host_(&host), session_(host, "r1", [this] { return wall_; }) {}

    P2osSession& session() { return session_; }
    /// Wall time goes on.
    void wait(std::chrono::milliseconds time) { wall_ += time; }
    void send(const std::string& bytes) {
        session_.receive(bytes);
        collect();
    }
    void command(int id) { send(p2osBytes(static_cast<std::uint8_t>(id))); }
    void command(int id, int value) {
        P2osWriter out;
        out.u8(value < 0 ? 0x1b : 0x3b).u16(std::abs(value));
        send(out.packet(static_cast<std::uint8_t>(id)));
    }
    Pioneer& connect() {
        for (const int id : {0, 1, 2}) command(id);
        EXPECT_EQ(packets.size(), 3U);
        command(1, 1);
        packets.clear();
        return *this;
    }
    Pioneer& drive() {
        connect();
        command(4, 1);
        return *this;
    }
    void run(double seconds) {
        host_->run(session_, seconds);
        collect();
    }
    /// The newest packet with this id.
    std::string last(std::uint8_t id) const {
        for (auto packet = packets.rbegin(); packet != packets.rend(); ++packet)
            if (packet->id == id) return packet->data;
        ADD_FAILURE() << "no packet " << int{id};
        return std::string(200, '\0');
    }
    [[nodiscard]] int field(std::size_t at, std::size_t bytes) const {
        return p2osInteger(last(0x32), at, bytes);
    }
    [[nodiscard]] int x() const { return field(0, 2); }
    [[nodiscard]] int y() const { return field(2, 2); }
    [[nodiscard]] int heading() const { return field(4, 2); }
    [[nodiscard]] int left() const { return field(6, 2); }
    [[nodiscard]] int right() const { return field(8, 2); }
    [[nodiscard]] int stall() const { return field(11, 2) & 0xFFFF; }
    [[nodiscard]] int flags() const { return field(15, 2); }
    [[nodiscard]] int sonars() const { return field(18, 1); }
    [[nodiscard]] int sonar(std::size_t k) const { return field(20 + 3 * k, 2); }
    [[nodiscard]] int rotspeed() const { return field(last(0x32).size() - 8, 2); }

    std::vector<P2osPacket> packets;

  private:
    void collect() {
        parser_.append(session_.take());
        while (auto packet = parser_.take()) packets.push_back(std::move(*packet));
    }

    TestHost* host_;
    std::chrono::steady_clock::time_point wall_{};
    P2osSession session_;
    P2osParser parser_;
};

constexpr const char* kRobot = "robot id=r1 model=pioneer-3dx at=-2,0\n";

TEST(P2osSession, Introduces) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.run(0.5);
    robot.command(11, 300);  // before its time
    EXPECT_TRUE(robot.packets.empty());
    for (const int id : {0, 1, 0, 1, 2}) {
        robot.command(id);
        EXPECT_EQ(robot.packets.back().id, id);
    }
    EXPECT_EQ(robot.packets.size(), 5U);
    EXPECT_EQ(robot.packets.back().data, std::string("r1\0Pioneer\0p3dx-sh\0", 19));
    robot.run(0.5);
    EXPECT_EQ(robot.packets.size(), 5U) << "status before OPEN";
    robot.command(1);  // OPEN without an argument
    robot.run(1);
    EXPECT_EQ(robot.packets.size(), 5U + 1 + 10);
    EXPECT_EQ(robot.packets.back().id, 0x32);
    EXPECT_EQ(robot.last(0x32).size() + 3, 86U);
    EXPECT_FALSE(robot.session().closing());
    robot.command(2);
    EXPECT_TRUE(robot.session().closing());
}

TEST(P2osSession, HoldsTheRobotAlone) {
    TestHost host(kRobot);
    {
        Pioneer robot(host);
        EXPECT_TRUE(host.isHeld());
        Pioneer other(host);
        EXPECT_TRUE(other.session().closing());
        EXPECT_TRUE(host.isHeld());
        robot.drive().command(11, 300);
        robot.run(2);
        EXPECT_GT(host.world().status(0).speed, 0.2);
    }
    EXPECT_FALSE(host.isHeld());
    for (int i = 0; i < 200; ++i) host.world().step();
    EXPECT_EQ(host.world().status(0).speed, 0);
}

TEST(P2osSession, TellsWhatItIs) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.connect().command(18, 1);
    const std::string config = robot.last(0x20);
    EXPECT_TRUE(config.starts_with(std::string("Pioneer\0p3dx-sh\0SIM\0", 20)));
    EXPECT_EQ(p2osInteger(config, 21, 2), 300);   // top rotspeed
    EXPECT_EQ(p2osInteger(config, 23, 2), 1200);  // top speed
    // name, cycle, bauds, gripper, sonars, battery, counter, watchdog, stall, joystick
    const std::size_t behind_name = 31 + 3;
    EXPECT_EQ(config[behind_name], 100);
    EXPECT_EQ(p2osInteger(config, behind_name + 12, 2), 2000);
    const std::size_t limits = behind_name + 3 + 2 + 2 + 1 + 2 + 2 + 2 + 1 + 2 + 2 + 2 + 2;
    EXPECT_EQ(p2osInteger(config, limits, 2), 100);
    EXPECT_EQ(p2osInteger(config, limits + 2, 2), 750);
    EXPECT_EQ(p2osInteger(config, limits + 4, 2), 100);
    EXPECT_EQ(p2osInteger(config, limits + 14, 2), 300);
    EXPECT_EQ(config[limits + 24], 5);  // bumpers in front
    EXPECT_EQ(config[limits + 25], 5);
}

TEST(P2osSession, IgnoresMotionWithoutMotors) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.connect().command(11, 300);
    robot.run(1);
    EXPECT_EQ(robot.x(), 0);
    EXPECT_EQ(robot.flags(), 0x1E);
    robot.command(4, 1);
    robot.run(0.5);
    EXPECT_EQ(robot.x(), 0) << "a command from before";
    EXPECT_EQ(robot.flags(), 0x1F);
}

TEST(P2osSession, KeepsSpeeds) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(11, 300);
    robot.run(3);
    EXPECT_EQ(robot.left(), 300);
    EXPECT_EQ(robot.right(), 300);
    EXPECT_EQ(robot.x(), 750);  // 1 s of 300 mm/s^2, then 2 s of 300 mm/s
    EXPECT_EQ(robot.y(), 0);
    EXPECT_NEAR(host.world().status(0).pose.position.x, -2 + 0.75, 1e-9);
    robot.command(21, 50);  // does not cancel the speed
    robot.run(1);
    EXPECT_EQ(robot.rotspeed(), 500);
    EXPECT_EQ(robot.right() - robot.left(), 2 * 156);  // 50 deg/s over 0.0056
    EXPECT_EQ(robot.right() + robot.left(), 600);
    robot.command(29);
    robot.run(2);
    EXPECT_EQ(robot.left(), 0);
    EXPECT_EQ(robot.rotspeed(), 0);
}

TEST(P2osSession, GoesBackAndTurnsTheOtherWay) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(11, -300);
    robot.run(3);
    EXPECT_EQ(robot.x(), -750);
    robot.command(11, 0);
    robot.command(9, -50);
    robot.run(1);
    EXPECT_EQ(robot.rotspeed(), -500);
}

TEST(P2osSession, GoesADistanceAndTurnsToAHeading) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(8, 1500);
    robot.run(6);
    EXPECT_EQ(robot.x(), 1500);
    EXPECT_EQ(robot.left(), 0);
    robot.command(12, 90);
    robot.run(4);
    EXPECT_EQ(robot.heading(), 1024);
    robot.command(13, -135);
    robot.run(4);
    EXPECT_EQ(robot.heading(), -512);
    robot.command(12, -180);  // the shorter way
    robot.run(1);
    EXPECT_LT(robot.rotspeed(), 0);
    robot.run(3);
    EXPECT_EQ(robot.heading(), 2048);
    EXPECT_NEAR(host.world().status(0).pose.position.x, -0.5, 1e-9);
}

TEST(P2osSession, TurnsWhileItGoes) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(8, 1000);
    robot.command(12, 45);
    robot.run(6);
    EXPECT_EQ(robot.heading(), 512);
    EXPECT_EQ(robot.left(), 0);
    EXPECT_GT(robot.y(), 300);
    EXPECT_LT(std::hypot(robot.x(), robot.y()), 1000);
}

TEST(P2osSession, KeepsItsLimits) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(6, 200);  // SETV
    robot.command(5, 100);          // SETA, up
    robot.command(5, -400);         // down
    robot.command(11, 900);
    robot.run(1);
    EXPECT_EQ(robot.left(), 100);
    robot.run(2);
    EXPECT_EQ(robot.left(), 200);
    robot.command(11, 0);
    robot.run(0.3);
    EXPECT_EQ(robot.left(), 80);
    robot.run(0.3);
    EXPECT_EQ(robot.left(), 0);
    robot.command(10, 20);  // SETRV
    robot.command(23, 200);
    robot.command(21, 90);
    robot.run(1);
    EXPECT_EQ(robot.rotspeed(), 200);
    robot.command(6, 30'000);  // no more than the robot can
    robot.command(11, 30'000);
    robot.run(0.1);
    EXPECT_DOUBLE_EQ(host.world().status(0).accel, 0.1);
}

TEST(P2osSession, DrivesByWheels) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(32, 10 << 8 | 20);  // left 200, right 400
    robot.run(3);
    EXPECT_EQ(robot.left(), 200);
    EXPECT_EQ(robot.right(), 400);
    const int backward = static_cast<std::uint16_t>(static_cast<std::uint8_t>(-10) << 8U | 10);
    robot.command(32, -(0x10000 - backward));  // left -200, right 200
    robot.run(3);
    EXPECT_EQ(robot.left(), -200);
    EXPECT_EQ(robot.right(), 200);
}

TEST(P2osSession, StopsHard) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(11, 500);
    robot.run(3);
    robot.command(55);
    robot.command(11, 500);  // ignored until it stands
    robot.run(0.1);
    EXPECT_EQ(robot.left(), 300);
    EXPECT_EQ(robot.flags() & 0x20, 0x20);
    robot.run(0.4);
    EXPECT_EQ(robot.left(), 0);
    EXPECT_EQ(robot.flags() & 0x20, 0);
    robot.command(11, 500);
    robot.run(0.5);
    EXPECT_EQ(robot.left(), 150);
    robot.command(4, 0);
    robot.run(0.5);
    EXPECT_EQ(robot.left(), 0);
    EXPECT_EQ(robot.flags() & 1, 0);
}

TEST(P2osSession, StallsAtAWall) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(12, 180);
    robot.run(4);
    EXPECT_EQ(robot.stall(), 0);
    robot.command(11, 300);
    robot.run(9);
    // The wall is 2 m away, the radius 0.25; three of the bumpers in front feel it at most.
    EXPECT_EQ(robot.stall() & 0x0101, 0x0101);
    EXPECT_NE(robot.stall() & 0x3E00, 0);
    EXPECT_EQ(robot.stall() & 0x00FE, 0);
    EXPECT_NEAR(robot.x(), -1750, 5);
    for (int i = 0; i < 25; ++i) {
        robot.run(0.1);
        EXPECT_EQ(robot.stall() & 0x0101, 0x0101) << "while it pushes";
    }
    robot.command(21, 30);  // it can turn
    robot.run(0.3);
    EXPECT_GT(robot.rotspeed(), 0);
    robot.command(11, -200);
    robot.run(1);
    EXPECT_EQ(robot.stall(), 0);
    EXPECT_EQ(robot.left() + robot.right(), -400);
}

TEST(P2osSession, TurnsOnAfterItRanIntoSomething) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(11, 700);
    robot.run(10);
    EXPECT_EQ(robot.stall() & 0x0101, 0x0101);
    robot.command(12, 90);
    robot.run(1.2);
    EXPECT_GT(robot.rotspeed(), 0);
    robot.command(29);
    robot.command(12, 90);
    robot.run(4);
    EXPECT_EQ(robot.heading(), 1024);
    EXPECT_EQ(robot.stall(), 0);
}

TEST(P2osSession, HearsWalls) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.connect().run(0.1);
    ASSERT_EQ(robot.sonars(), 16);
    const std::vector<float> ranges = host.world().sonar(0);
    for (std::size_t k = 0; k < 16; ++k) {
        EXPECT_EQ(robot.field(19 + 3 * k, 1), static_cast<int>(k));
        EXPECT_EQ(robot.sonar(k), std::isinf(ranges[k]) ? 5000 : std::lround(ranges[k] * 1000));
    }
    EXPECT_LT(robot.sonar(0), 3000);
    robot.command(28, 0);
    robot.run(0.1);
    EXPECT_EQ(robot.sonars(), 0);
    EXPECT_EQ(robot.flags(), 0);
    robot.command(28, 1);
    robot.run(0.1);
    EXPECT_EQ(robot.sonars(), 16);
}

TEST(P2osSession, ConvertsAsItsTypeDoes) {
    for (const P2osType& type : p2osTypes()) {
        TestHost host("robot id=r1 model=pioneer-3dx at=-2,0 p2os=" + std::string(type.name) +
                      "\n");
        Pioneer robot(host);
        for (const int id : {0, 1, 2}) robot.command(id);
        EXPECT_NE(robot.last(2).find(std::string(type.name) + '\0'), std::string::npos);
        robot.packets.clear();
        robot.command(1, 1);
        robot.command(4, 1);
        robot.command(8, 1000);
        robot.run(6);
        EXPECT_NEAR(robot.x() * type.distance, 1000, type.distance) << type.name;
        const std::vector<float> ranges = host.world().sonar(0);
        EXPECT_NEAR(robot.sonar(0) * type.range, 1000 * ranges[0], 1) << type.name;
        robot.command(32, 250 << 8 | 6);  // both 120 mm/s, the left one backward
        robot.run(4);
        EXPECT_EQ(robot.right(), 120) << type.name;
        EXPECT_EQ(robot.left(), -120) << type.name;
        EXPECT_NEAR(robot.rotspeed(), 10 * Angle::radians(120 * type.turn).degrees(), 1);
    }
    const Scene scene = testing::scene(
        "ispace size=8,6\n",
        "robot id=a\nrobot id=b model=pioneer-2dx at=1,1\nrobot id=c model=pioneer-3at at=2,2\n");
    EXPECT_EQ(p2osTypeOf(scene, "a").name, "p3dx-sh");
    EXPECT_EQ(p2osTypeOf(scene, "b").name, "p2dx");
    EXPECT_EQ(p2osTypeOf(scene, "c").name, "p3at-sh");
    EXPECT_EQ(p2osTypeNamed("p3dx")->distance, 0.485);
    EXPECT_EQ(p2osTypeNamed("pioneer"), nullptr);
}

TEST(P2osSession, SetsTheOriginOfOdometry) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(8, 600);
    robot.command(12, 90);
    robot.run(5);
    robot.send(p2osBytes(7, "\x3b"));  // the type byte alone
    robot.run(0.1);
    EXPECT_EQ(robot.x(), 0);
    EXPECT_EQ(robot.y(), 0);
    EXPECT_EQ(robot.heading(), 0);
    robot.command(8, 500);
    robot.run(5);
    EXPECT_EQ(robot.x(), 500);
    P2osWriter out;
    robot.send(out.u8(0x3b).u16(1000).u16(-2000).u16(90).packet(7));
    robot.command(8, -100);
    robot.run(3);
    EXPECT_EQ(robot.x(), 1000);
    EXPECT_EQ(robot.y(), -2100);
    EXPECT_EQ(robot.heading(), 1024);
}

TEST(P2osSession, IsPutElsewhere) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(8, 600);
    robot.run(4);
    P2osWriter place;
    robot.send(place.u8(0).u32(1000).u32(-500).u32(-90).packet(224));
    EXPECT_EQ(host.world().status(0).pose.position, (Point2{1, -0.5}));
    EXPECT_DOUBLE_EQ(host.world().status(0).pose.heading.degrees(), -90);
    robot.run(0.2);
    EXPECT_EQ(robot.x(), 600) << "odometry knows nothing of it";
    robot.command(237);
    const std::string sim = robot.last(0x62);
    EXPECT_EQ(p2osInteger(sim, 12, 4), 1000);
    EXPECT_EQ(p2osInteger(sim, 16, 4), -500);
    EXPECT_EQ(p2osInteger(sim, 24, 4), -90);
    robot.command(8, 400);
    robot.run(4);
    EXPECT_EQ(robot.x(), 1000);
    EXPECT_NEAR(host.world().status(0).pose.position.y, -0.9, 1e-9);
    // Into a wall: refused. Others' changes come first.
    P2osWriter wall;
    robot.send(wall.u8(0x3b).u32(4000).u32(0).u32(0).packet(224));
    EXPECT_NEAR(host.world().status(0).pose.position.y, -0.9, 1e-9);
    host.changes_later = 3;
    robot.command(225);
    EXPECT_NEAR(host.world().status(0).pose.position.y, -0.9, 1e-9);
    robot.run(0.1);
    EXPECT_EQ(host.world().status(0).pose.position, (Point2{-2, 0}));
    EXPECT_EQ(robot.x(), 0);
    EXPECT_EQ(robot.heading(), 0);
}

TEST(P2osSession, TellsOfTheSimulation) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.connect().command(237, 2);
    EXPECT_TRUE(robot.packets.empty());
    robot.run(0.2);
    ASSERT_EQ(robot.packets.size(), 4U);
    EXPECT_EQ(robot.packets[0].id, 0x62);
    EXPECT_EQ(robot.packets[1].id, 0x32);
    robot.command(237, 0);
    robot.packets.clear();
    robot.run(0.2);
    EXPECT_EQ(robot.packets.size(), 2U);
}

TEST(P2osSession, ScansInPieces) {
    TestHost host(std::string(kRobot) + "laser id=l1 on=r1 at=0.1,0,0.3 range=0.02,3\n");
    for (const auto& [base, mode] : {std::pair(35, 1), std::pair(230, 2)}) {
        Pioneer robot(host);
        robot.connect();
        robot.command(base + 1, -90);
        robot.command(base + 2, 90);
        robot.command(base + 3, 50);
        robot.command(base, mode);
        robot.run(0.1);
        std::vector<int> ranges;
        const std::size_t head = mode == 1 ? 6 : 0, step = mode == 1 ? 2 : 5;
        for (const P2osPacket& packet : robot.packets) {
            if (packet.id == 0x32) continue;
            ASSERT_EQ(packet.id, mode == 1 ? 0x60 : 0x61);
            ASSERT_EQ(p2osInteger(packet.data, head, 2), 361);
            ASSERT_EQ(p2osInteger(packet.data, head + 2, 2), static_cast<int>(ranges.size()));
            const int here = p2osInteger(packet.data, head + 4, 1);
            ASSERT_LE(here, 32);
            for (int k = 0; k < here; ++k)
                ranges.push_back(
                    p2osInteger(packet.data, head + 5 + static_cast<std::size_t>(k) * step, 2));
        }
        ASSERT_EQ(ranges.size(), 361U);
        EXPECT_EQ(ranges[0], 3000);    // to the right: the wall is 3 m away, no return
        EXPECT_EQ(ranges[180], 3000);  // ahead: beyond its range
        // 60 degrees to the left the wall at y = 3 is farther than 3 m, at 89.5 it is not.
        EXPECT_EQ(ranges[359], 3000);
        robot.command(base, 0);
        robot.packets.clear();
        robot.run(0.2);
        EXPECT_EQ(robot.packets.size(), 2U);
    }
}

TEST(P2osSession, HasALaserWithoutADevice) {
    TestHost host(std::string(kRobot) + "robot id=r2 at=0,0\n");
    Pioneer robot(host);
    robot.connect().command(35, 1);
    robot.run(0.1);
    // 181 readings by default: 6 packets, ahead the other robot, its circle 1.7 m off.
    ASSERT_EQ(robot.packets.size(), 7U);
    const std::string& third = robot.packets[3].data;
    EXPECT_EQ(p2osInteger(third, 8, 2), 64);
    EXPECT_EQ(p2osInteger(third, 11 + 2 * (90 - 64), 2), 1700 - 21);
    // One with more readings than any device has is none.
    robot.command(38, 1);
    robot.command(36, -180);
    robot.packets.clear();
    robot.run(0.1);
    EXPECT_EQ(robot.packets.size(), 1U);
}

TEST(P2osSession, StandsWhileTheClientIsSilent) {
    TestHost host("robot id=r1 model=pioneer-3dx at=-2,0\n", "ispace size=40,6\n");
    Pioneer robot(host);
    robot.drive().command(11, 300);
    robot.run(5);
    EXPECT_EQ(robot.left(), 300) << "no wall time has passed: the world is fast";
    robot.wait(std::chrono::milliseconds(1999));
    robot.run(0.5);
    EXPECT_EQ(robot.left(), 300);
    robot.wait(std::chrono::milliseconds(1));
    robot.run(2);
    EXPECT_EQ(robot.left(), 0);
    robot.command(0);  // PULSE
    robot.run(2);
    EXPECT_EQ(robot.left(), 300);
}

TEST(P2osSession, GetsTheDefaultsOfTheWheelsBack) {
    TestHost host(kRobot);
    {
        Pioneer robot(host);
        robot.drive().command(5, 50);
        robot.command(11, 50);
        robot.run(2);
    }
    host.world().command(0, {Verb::Forward, 1});
    for (int i = 0; i < 1000; ++i) host.world().step();
    EXPECT_DOUBLE_EQ(host.world().status(0).speed, 0);
    host.world().command(0, {Verb::Speed, 0.5});
    for (int i = 0; i < 50; ++i) host.world().step();
    EXPECT_DOUBLE_EQ(host.world().status(0).accel, 0.3);
}

TEST(P2osSession, LeavesOutWhatNobodyReads) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.connect();
    for (int i = 0; i < 100; ++i) {
        host.world().step();
        robot.session().stepped(std::size_t{1} << 20);
    }
    EXPECT_EQ(robot.session().take(), "");
    robot.run(0.1);
    EXPECT_EQ(robot.packets.size(), 1U);
}

TEST(P2osSession, SurvivesAnything) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive();
    // Every id with no data, a type byte alone, a number, a long text.
    for (int id = 0; id < 256; ++id) {
        if (id == 2) continue;
        const auto command = static_cast<std::uint8_t>(id);
        for (const std::string& data :
             {std::string(), std::string("\x3b"), std::string("\x1b\xff\xff"),
              std::string("\x3b\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\x7f"),
              "\x2b\xc0" + std::string(192, 'x')}) {
            robot.send(p2osBytes(command, data));
            robot.run(0.01);
        }
    }
    EXPECT_FALSE(robot.session().closing());
}

}  // namespace

}  // namespace ispace
