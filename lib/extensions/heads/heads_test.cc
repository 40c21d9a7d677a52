// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "extensions/heads/head.h"
#include "extensions/heads/head_role.h"
#include "extensions/heads/heads_test.h"
#include "geom/rotation.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/room_state.h"
#include "scene/scene.h"
#include "server/server_state.h"
#include "server/session.h"
#include "sim/simulation.h"

namespace ispace::heads {
namespace heads_test {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Rows = std::vector<std::string>;

Scene sceneOf(const std::string& records) {
    testing::addHeadsOnce();
    return makeScene(
        readRecordText("#env 1\nispace size=8,6\n" + records, "room.env", sceneSchemas()), nullptr,
        shippedDevices());
}

std::string refusal(const std::string& records) {
    try {
        sceneOf(records);
    } catch (const FormatError& error) {
        return error.diagnostics().front().text();
    }
    return "";
}

const std::string kRobot = "robot id=r at=1,-1 heading=30\n";

TEST(Head, HasItsRanges) {
    EXPECT_EQ(refusal("head id=h pan=20 pan_range=-90,90 at=0,0,1\n"), "");
    EXPECT_NE(refusal("head id=h pan=100 pan_range=-90,90\n").find("beyond the pan_range"),
              std::string::npos);
    EXPECT_NE(refusal("head id=h tilt=-45 tilt_range=-30,60\n").find("beyond the tilt_range"),
              std::string::npos);
    EXPECT_NE(refusal("head id=h pan_range=10,-10\n").find("least angle before"),
              std::string::npos);
}

TEST(Head, StandsOnARobotOrAnObject) {
    EXPECT_EQ(refusal(kRobot + "head id=h on=r\ncamera id=c on=h at=0,0,0\n"), "");
    EXPECT_EQ(refusal("table id=t at=1,1\nhead id=h on=t\ncamera id=c on=h at=0,0,0\n"), "");
    EXPECT_NE(refusal("human id=ann\nhead id=h on=ann\n").find("stands on a robot or an object"),
              std::string::npos);
    EXPECT_NE(refusal("head id=g\nhead id=h on=g\n").find("stands on a robot or an object"),
              std::string::npos);
    EXPECT_NE(refusal("head id=h on=h\n").find("stands on a robot or an object"),
              std::string::npos);
    EXPECT_NE(refusal(kRobot + "head id=h on=q\n").find("nothing has the id `q`"),
              std::string::npos);
}

/// The axis of a sensor by the angles' definitions: turned by tilt about the left axis, then by all
/// headings about the vertical one.
TEST(Head, TurnsTheSensorsOnIt) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int i = 0; i < 200; ++i) {
        const double pan = 150 * any(random), tilt = 80 * any(random), heading = 100 * any(random);
        const double x = any(random), y = any(random), z = any(random), turn = 100 * any(random);
        const auto text = [](double value) { return std::to_string(value); };
        const Scene scene =
            sceneOf(kRobot + "head id=h on=r at=0.2,0.1,0.5 heading=" + text(heading) + " pan=" +
                    text(pan) + " tilt=" + text(tilt) + "\ncamera id=c on=h at=" + text(x) + ',' +
                    text(y) + ',' + text(z) + " heading=" + text(turn) + '\n');
        ASSERT_EQ(scene.sensors.size(), 1U);
        const Sensor& camera = scene.sensors.front();
        const auto radians = [](double degrees) { return degrees * std::numbers::pi / 180; };
        const auto raised = [&](Vec3 v) {
            const double c = std::cos(radians(tilt)), s = std::sin(radians(tilt));
            return Vec3{c * v.x - s * v.z, v.y, s * v.x + c * v.z};
        };
        const auto turned = [&](Vec3 v, double degrees) {
            const double c = std::cos(radians(degrees)), s = std::sin(radians(degrees));
            return Vec3{c * v.x - s * v.y, s * v.x + c * v.y, v.z};
        };
        const Vec3 from_head = turned(raised({x, y, z}), heading + pan);
        const Vec3 from_robot =
            turned({0.2 + from_head.x, 0.1 + from_head.y, 0.5 + from_head.z}, 30);
        EXPECT_NEAR(camera.pose.position.x, 1 + from_robot.x, 2e-6);
        EXPECT_NEAR(camera.pose.position.y, -1 + from_robot.y, 2e-6);
        EXPECT_NEAR(camera.pose.position.z, from_robot.z, 2e-6);
        const Vec3 axis = turned(raised(turned({1, 0, 0}, turn)), heading + pan + 30);
        const Vec3 found = Frame3(camera.pose).forward;
        EXPECT_NEAR(length(Vec3{axis.x - found.x, axis.y - found.y, axis.z - found.z}), 0, 1e-6);
        ASSERT_TRUE(camera.mount);
        EXPECT_EQ(camera.mount->robot, 0U);
    }
    const Scene level = sceneOf(kRobot + "head id=h on=r pan=33.3\nlaser id=l on=h at=0,0,0\n");
    EXPECT_TRUE(level.sensors.front().pose.isLevel()) << "a laser scans a level plane exactly";
    EXPECT_NEAR(level.sensors.front().pose.heading.degrees(), 63.3, 1e-9);
}

TEST(Head, OnATableIsAboveItsTop) {
    const Scene scene = sceneOf(
        "table id=t at=1,1 height=0.7\nhead id=h on=t at=0,0,0.2\ncamera id=c on=h at=0,0,0\n");
    EXPECT_NEAR(scene.sensors.front().pose.position.z, 0.9, 1e-12);
    const Scene alone = sceneOf("head id=h at=1,2,1.5 tilt=90\ncamera id=c on=h at=0.1,0,0\n");
    EXPECT_NEAR(alone.sensors.front().pose.position.z, 1.6, 1e-12);
    EXPECT_NEAR(alone.sensors.front().pose.position.x, 1, 1e-12);
}

TEST(Head, HasStatesAndAFinding) {
    const Scene scene = sceneOf("head id=h pan=20\n");
    EXPECT_EQ(roomStates(scene), (std::vector<RoomState>{{"h", "pan", "20"}, {"h", "tilt", "0"}}));
    const auto finding = checkHead(scene, scene.records.size() - 1);
    ASSERT_TRUE(finding);
    EXPECT_EQ(finding->message, "no sensor is on head h");
    const Scene used = sceneOf("head id=h\ncamera id=c on=h\n");
    EXPECT_FALSE(checkHead(used, used.records.size() - 2));
}

/// A run with the service, in which changes are made as the server does.
class HeadRole : public ::testing::Test {
  protected:
    HeadRole()
        : scene_(sceneOf("robot id=r at=0,0\n"
                         "head id=h on=r at=0,0,1 pan_range=-90,90 tilt_range=-30,30 speed=20\n"
                         "head id=fast at=1,1,1\nlaser id=l on=h at=0,0,0\n"
                         "camera id=c on=fast at=0,0,0\n")),
          world_(scene_, milliseconds(10)),
          simulation_(world_, {}, {Clock::Kind::Step, 1}, {}),
          state_(simulation_),
          room_{"", &simulation_},
          service_(makeHeads({&room_, 1}, 1)) {
        state_.addRoleService(*service_);
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            while (simulation_.isChangeDue()) {
                changes_.push_back(simulation_.takeScriptedChange());
                world_.change(
                    makeScene(editedRecords(world_.scene(), parseEdits(changes_.back()),
                                            [](const std::string&) { return std::nullopt; }),
                              world_.scene(), shippedDevices()));
            }
            simulation_.allow(1);
            simulation_.run(std::chrono::steady_clock::now(), seconds(10));
            service_->stepped();
        }
    }
    static std::string ask(Session& session, const std::string& line) {
        session.request(line);
        return session.take();
    }

    Scene scene_;
    World world_;
    Simulation simulation_;
    ServerState state_;
    RunRoom room_;
    std::unique_ptr<RoleService> service_;
    Rows changes_;
};

TEST_F(HeadRole, TurnsAtItsSpeed) {
    Session session(state_);
    EXPECT_EQ(ask(session, "HEAD *"), "OK HEAD * t=0.000 heads=fast,h\n");
    EXPECT_EQ(ask(session, "TURN h 40 -10"), "OK TURN id=h t=0.000 for=2.000\n");
    run(100);
    // At half of the time, within a change's interval.
    const double pan = world_.scene().records[2].number("pan");
    EXPECT_NEAR(pan, 20, 1.2);
    EXPECT_NEAR(world_.scene().records[2].number("tilt"), -pan / 4, 1e-2);
    EXPECT_EQ(ask(session, "READ h").substr(0, 16), "OK READ id=h t=1");
    EXPECT_NE(ask(session, "READ h").find("moving=1"), std::string::npos);
    run(110);
    EXPECT_EQ(ask(session, "READ h"), "OK READ id=h t=2.100 pan=40 tilt=-10 moving=0\n");
    EXPECT_LE(changes_.size(), 43U);
    EXPECT_GE(changes_.size(), 38U);
    EXPECT_NEAR(world_.sensors()[0].pose.heading.degrees(), 40, 1e-9);
}

TEST_F(HeadRole, TellsWhenItHasTurned) {
    Session session(state_);
    ask(session, "HEAD h");
    ask(session, "TURN h 10 0");
    std::string lines;
    for (int i = 0; i < 80; ++i) {
        run(1);
        session.stepped();
        lines += session.take();
    }
    EXPECT_NE(lines.find("EVENT turned t=0."), std::string::npos) << lines;
    EXPECT_NE(lines.find(" id=h pan=10 tilt=0\n"), std::string::npos) << lines;
    EXPECT_EQ(lines.find("EVENT", 6), std::string::npos) << "once";
}

TEST_F(HeadRole, TurnsAtOnceWithoutASpeed) {
    Session session(state_);
    ask(session, "HEAD *");
    EXPECT_EQ(ask(session, "TURN fast 170 45"), "OK TURN id=fast t=0.000 for=0.000\n");
    run(3);
    EXPECT_EQ(ask(session, "READ fast"), "OK READ id=fast t=0.030 pan=170 tilt=45 moving=0\n");
    EXPECT_EQ(changes_, Rows{"ACT fast pan=170 tilt=45"});
}

TEST_F(HeadRole, StopsAndRefuses) {
    Session session(state_);
    ask(session, "HEAD *");
    EXPECT_EQ(ask(session, "TURN h 91 0"), "ERR 416 pan goes from -90 to 90, not to 91\n");
    EXPECT_EQ(ask(session, "TURN h 0 -31"), "ERR 416 tilt goes from -30 to 30, not to -31\n");
    EXPECT_EQ(ask(session, "TURN h left 0"), "ERR 400 TURN takes two angles in degrees\n");
    EXPECT_EQ(ask(session, "READ x").substr(0, 8), "ERR 404 ");
    ask(session, "TURN h 40 0");
    run(50);
    // At any moment HALT tells where it stops, also if a change is still due.
    for (const int steps : {1, 2, 3, 4, 5, 6, 7}) {
        run(steps);
        const std::string stopped = ask(session, "HALT h");
        const std::size_t made = changes_.size();
        run(100);
        EXPECT_LE(changes_.size(), made + 1);
        const auto angles = [](const std::string& answer) {
            return answer.substr(answer.find(" pan="));
        };
        EXPECT_EQ(angles(ask(session, "READ h")), angles(stopped)) << steps;
        ask(session, "TURN h 40 0");
        run(20);
        ask(session, "TURN h -40 0");
    }
    // A later turn takes over.
    ask(session, "TURN h 90 0");
    run(20);
    ask(session, "TURN h -10 0");
    run(400);
    EXPECT_NE(ask(session, "READ h").find("pan=-10 tilt=0 moving=0"), std::string::npos);
}

TEST(HeadService, IsForHeads) {
    const Scene scene = sceneOf("robot id=r\n");
    World world(scene, milliseconds(5));
    Simulation simulation(world, {}, {Clock::Kind::Step, 1}, {});
    const RunRoom room{"", &simulation};
    EXPECT_EQ(makeHeads({&room, 1}, 1), nullptr);
}

}  // namespace heads_test
}  // namespace ispace::heads
