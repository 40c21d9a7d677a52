// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "extensions/bumpers/bumper.h"
#include "extensions/bumpers/bumpers_test.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "server/server_state.h"
#include "server/session.h"
#include "sim/simulation.h"

namespace ispace::bumpers {
namespace bumpers_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

Scene sceneOf(const std::string& records) {
    testing::addBumpersOnce();
    return makeScene(
        readRecordText("#env 1\nispace id=room size=20,10\n" + records, "room.env", sceneSchemas()),
        nullptr, shippedDevices());
}

/// The force of a spring that a mass compresses, by small steps of Newton's law.
TEST(ContactForce, IsThatOfASpring) {
    for (const double speed : {0.2, 1.0, 1.7})
        for (const double stiffness : {2e3, 2e4})
            for (const double mass : {4.0, 25.0}) {
                double x = 0, v = speed, most = 0;
                constexpr double kStep = 1e-6;
                while (v > 0) {
                    v -= stiffness * x / mass * kStep;
                    x += v * kStep;
                    most = std::max(most, stiffness * x);
                }
                EXPECT_NEAR(contactForce(speed, stiffness, mass), most, 1e-3 * most);
            }
    EXPECT_EQ(contactForce(-1, 1e4, 10), 0);
    EXPECT_EQ(reducedMass(20, 20), 10);
}

TEST(ContactOf, IsOnALineOrAFootprint) {
    const Scene scene = sceneOf("cube id=c at=3,0 size=2,2,1\n");
    const Body& cube = scene.environment.elements().back().body;
    const auto near = contactOf(cube, {{0, 0.5}, {1, 0}, 0.3, 0.22});
    ASSERT_TRUE(near);
    EXPECT_NEAR(near->x, 2, 1e-12);
    EXPECT_NEAR(near->y, 0.5, 1e-12);
    EXPECT_FALSE(contactOf(Body{}, {{0, 0}, {1, 0}, 0.3, 0.22}));
}

TEST(ContactOf, IsAheadAndAtTheHeightOfTheRobot) {
    // Along a wall a millimetre away, towards another.
    const Scene hall = sceneOf("fence id=f path=-3,0.301;3,0.301;3,-3\n");
    const Body& walls = hall.environment.elements().back().body;
    const auto end = contactOf(walls, {{2.698, 0}, {0.6, 0}, 0.3, 0.22});
    ASSERT_TRUE(end);
    EXPECT_NEAR(end->x, 3, 1e-9);
    EXPECT_NEAR(end->y, 0, 1e-9);
    // Under the board of a table, towards a leg.
    const Scene office = sceneOf("table id=t at=0,0 size=3,2,0.7\n");
    const Body& table = office.environment.elements().back().body;
    for (const Prism& prism : table.prisms) {
        if (prism.bottom > 0.22) continue;
        const auto leg =
            contactOf(table, {{0, 0}, 0.1 * (prism.footprint[0] - Point2{}), 0.3, 0.22});
        ASSERT_TRUE(leg);
        EXPECT_LT(std::abs(cross(prism.footprint[0] - Point2{}, *leg - Point2{})), 0.3);
        EXPECT_GT(dot(prism.footprint[0] - Point2{}, *leg - Point2{}), 0);
    }
    EXPECT_GT(table.prisms.size(), 1U);
}

TEST(BumperChecks, FindNoRobot) {
    const Scene scene = sceneOf("human id=ann at=1,1\nbumper id=b of=ann\n");
    const auto finding = checkBumper(scene, scene.records.size() - 1);
    ASSERT_TRUE(finding);
    EXPECT_EQ(finding->message.substr(0, 42), "bumper b is of `ann`, which is no robot");
    const Scene right = sceneOf("robot id=r\nbumper id=b of=r\n");
    EXPECT_FALSE(checkBumper(right, right.records.size() - 1));
}

class BumperRole : public ::testing::Test {
  protected:
    BumperRole()
        : scene_(sceneOf("robot id=r at=-5,0 mass=25 accel=100 max_speed=3\n"
                         "robot id=askew at=-5,-3 heading=45 mass=25 accel=100 max_speed=3\n"
                         "robot id=other at=0,3 heading=180 mass=15 accel=100 max_speed=3\n"
                         "robot id=pusher at=-5,3 mass=25 accel=100 max_speed=3\n"
                         "human id=ann at=5,3.5 heading=90\n"
                         "wall id=w from=-1,-1 to=-1,1\nwall id=v from=-9,-1.5 to=-3,-1.5\n"
                         "bumper id=b of=r stiffness=10000\nbumper id=c of=askew stiffness=10000\n"
                         "bumper id=d of=pusher stiffness=10000\n")),
          world_(scene_, milliseconds(5)),
          simulation_(world_, {}, {Clock::Kind::Step, 1}, {}),
          state_(simulation_),
          room_{"", &simulation_},
          service_(makeBumpers({&room_, 1}, 1)) {
        state_.addRoleService(*service_);
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            simulation_.allow(1);
            simulation_.run(std::chrono::steady_clock::now(), seconds(10));
            service_->stepped();
        }
    }
    void go(const char* robot, double speed) {
        world_.command(*world_.moverNamed(robot), {.verb = Verb::Speed, .value = speed});
    }
    static std::string ask(Session& session, const std::string& line) {
        session.request(line);
        return session.take();
    }
    double force(Session& session, const std::string& id) {
        const std::string read = ask(session, "READ " + id);
        return std::stod(read.substr(read.find("force=") + 6));
    }

    Scene scene_;
    World world_;
    Simulation simulation_;
    ServerState state_;
    RunRoom room_;
    std::unique_ptr<RoleService> service_;
};

TEST_F(BumperRole, FeelsAWall) {
    Session session(state_);
    EXPECT_EQ(ask(session, "BUMPER *"), "OK BUMPER * t=0.000 bumpers=b,c,d\n");
    EXPECT_EQ(ask(session, "READ b"), "OK READ id=b t=0.000 force=0 into=\n");
    go("r", 1.2);
    std::string lines;
    for (int i = 0; i < 1000; ++i) {
        run(1);
        session.stepped();
        lines += session.take();
    }
    // 1.2 m/s * sqrt(10000 N/m * 25 kg) = 600 N
    EXPECT_NE(lines.find("EVENT impact t="), std::string::npos) << lines;
    EXPECT_NE(lines.find(" id=b robot=r into=w force=600 speed=1.200\n"), std::string::npos)
        << lines;
    EXPECT_NEAR(force(session, "b"), 600, 1e-9);
    go("r", -0.5);
    run(10);
    EXPECT_EQ(force(session, "b"), 0) << "it has left";
}

TEST_F(BumperRole, FeelsNothingWhereTheRobotWasPut) {
    Session session(state_);
    ask(session, "BUMPER *");
    go("r", 1.2);
    run(1000);
    ASSERT_NEAR(force(session, "b"), 600, 1e-9);
    const std::string robot = "r";
    world_.change(scene_, {&robot, 1});
    run(200);
    ASSERT_EQ(world_.status(*world_.moverNamed("r")).pose.position, (Point2{-5, 0}));
    EXPECT_EQ(force(session, "b"), 0);
}

TEST_F(BumperRole, FeelsTheSpeedAcrossASurface) {
    Session session(state_);
    ask(session, "BUMPER *");
    go("askew", 1.0);
    run(1000);
    EXPECT_NEAR(force(session, "c"), std::sqrt(0.5) * 500, 0.06 + 1) << "45 degrees";
}

TEST_F(BumperRole, FeelsRobotsByBothMasses) {
    Session session(state_);
    ask(session, "BUMPER *");
    go("pusher", 0.8);
    go("other", 0.7);
    run(1200);
    // 1.5 m/s; 25 and 15 kg reduce to 9.375.
    EXPECT_NEAR(force(session, "d"), 1.5 * std::sqrt(1e4 * 9.375), 0.06);
}

TEST(BumperService, IsForBumpers) {
    const Scene none = sceneOf("robot id=r\n");
    World world(none, milliseconds(5));
    Simulation simulation(world, {}, {Clock::Kind::Step, 1}, {});
    const RunRoom room{"", &simulation};
    EXPECT_EQ(makeBumpers({&room, 1}, 1), nullptr);
    const Scene wrong = sceneOf("robot id=r\nbumper of=q\n");
    World other(wrong, milliseconds(5));
    Simulation run(other, {}, {Clock::Kind::Step, 1}, {});
    const RunRoom second{"", &run};
    EXPECT_THROW(makeBumpers({&second, 1}, 1), FormatError);
}

}  // namespace bumpers_test
}  // namespace ispace::bumpers
