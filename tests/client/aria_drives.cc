// SPDX-License-Identifier: GPL-3.0-or-later
// aria_drives PROGRAM: a program for ARIA, and the true pose at which the robot r1 ends. It is
// built twice: over simrun's own protocol, and over the packets of a Pioneer (OVER_P2OS), with the
// folder p2os before the headers.
#include <Aria.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include <ispace_client/world.h>

namespace {

/// A command that the firmware carries out; the header does so without one.
void obey(ArRobot& robot, unsigned char command, short value) {
    robot.lock();
#ifdef OVER_P2OS
    robot.link()->com(command, value);
#else
    robot.comInt(command, value);
#endif
    robot.unlock();
}

/// Direct motion, as in the example simpleMotionCommands.
void speeds(ArRobot& robot) {
    const double orders[][3] = {
        {250, 0, 5000}, {0, 0, 1000},  {0, 10, 5000},      {0, -10, 10000}, {150, 0, 5000},
        {0, 0, 1000},   {900, 0, 700}, {-300, 25.4, 2500}, {0, 250, 2000},  {-150.5, -30, 3100}};
    for (const auto& order : orders) {
        robot.lock();
        robot.setVel(order[0]);
        robot.setRotVel(order[1]);
        robot.unlock();
        ArUtil::sleep(static_cast<unsigned int>(order[2]));
    }
    robot.stop();
    ArUtil::sleep(3000);
}

void wheels(ArRobot& robot) {
    robot.setVel2(200, 300);
    ArUtil::sleep(4000);
    robot.setVel2(-100, 100);
    ArUtil::sleep(2000);
    robot.setRotVel(0);
    robot.setVel(-120);
    ArUtil::sleep(1000);
    robot.stop();
    ArUtil::sleep(2000);
}

/// Cycles in a loop of the program, as in singleThreadLoopExample.
void loop(ArRobot& robot) {
    robot.stopRunning(false);
    robot.setVel(300);
    robot.setRotVel(10);
    for (int i = 0; i < 400; ++i) {
        robot.loopOnce();
        ArUtil::sleep(20);
    }
}

/// Moved in the room while it drives: odometry and speeds go on.
void placed(ArRobot& robot) {
    ArSimUtil simulator(&robot);
    robot.setVel(200);
    robot.setRotVel(20);
    ArUtil::sleep(2000);
    robot.stop();
    ArUtil::sleep(2000);
    const ArPose before = robot.getPose();
    if (!simulator.setSimTruePose(ArPose(500, -400, 135))) std::printf("refused ");
    ArLog::init(ArLog::None, ArLog::Terse);
    if (simulator.setSimTruePose(ArPose(1990, 0, 0))) std::printf("in the wall ");
    robot.setVel(150);
    robot.setRotVel(0);
    ArUtil::sleep(3000);
    const ArPose after = robot.getPose();
    const double way = before.findDistanceTo(after);
    const bool ahead = std::fabs(ArMath::subAngle(before.findAngleTo(after), before.getTh())) < 1;
    if (!ahead || way < 350 || way > 450) std::printf("its odometry jumped ");
}

/// Distances and headings of the firmware.
void distances(ArRobot& robot) {
    obey(robot, ArCommands::MOVE, 900);
    ArUtil::sleep(6000);
    obey(robot, ArCommands::HEAD, 90);
    ArUtil::sleep(4000);
    obey(robot, ArCommands::MOVE, -700);
    ArUtil::sleep(6000);
    obey(robot, ArCommands::DHEAD, -135);
    ArUtil::sleep(4000);
    obey(robot, ArCommands::MOVE, 500);
    ArUtil::sleep(6000);
}

/// Goals of an action below limits, as in gotoActionExample.
void goals(ArRobot& robot) {
    ArActionLimiterForwards near("near", 300, 600, 250), far("far", 300, 1100, 400);
    ArActionGotoStraight go("go");
    ArActionStop stop("stop");
    robot.addAction(&near, 95);
    robot.addAction(&far, 90);
    robot.addAction(&go, 50);
    robot.addAction(&stop, 40);
    for (const ArPose& goal :
         {ArPose(1500, 0), ArPose(1500, 1000), ArPose(0, 1000), ArPose(0, 0)}) {
        go.setGoal(goal);
        for (int i = 0; i < 200 && !go.haveAchievedGoal(); ++i) ArUtil::sleep(100);
    }
    go.cancelGoal();
    ArUtil::sleep(3000);
}

/// As in the example wander.
void wander(ArRobot& robot) {
    ArActionStallRecover recover;
    ArActionBumpers bumpers;
    ArActionAvoidFront near("Avoid Front Near", 225, 0), far;
    ArActionConstantVelocity drive("Constant Velocity", 400);
    robot.addAction(&recover, 100);
    robot.addAction(&bumpers, 75);
    robot.addAction(&near, 50);
    robot.addAction(&far, 49);
    robot.addAction(&drive, 25);
    ArUtil::sleep(60000);
}

/// Speeds of a person at keys, as in actionGroupExample.
void input(ArRobot& robot) {
    ArActionGroupInput group(&robot);
    group.activateExclusive();
    group.setVel(300);
    ArUtil::sleep(3000);
    group.setRotVel(20);
    ArUtil::sleep(3000);
    group.setVel(-100);
    group.deltaHeadingFromCurrent(50);
    ArUtil::sleep(3000);
}

}  // namespace

int main(int argc, char** argv) {
    const std::map<std::string, void (*)(ArRobot&)> programs = {
        {"speeds", speeds}, {"wheels", wheels}, {"loop", loop},   {"distances", distances},
        {"goals", goals},   {"wander", wander}, {"input", input}, {"placed", placed}};
    const auto program = programs.find(argc == 2 ? argv[1] : "");
    if (program == programs.end()) return 2;
    Aria::init(Aria::SIGHANDLE_NONE);
    ArSimpleConnector connector(nullptr, nullptr);
    ArRobot robot;
    ArSonarDevice sonar;
    if (!connector.connectRobot(&robot)) return 1;
    robot.addRangeDevice(&sonar);
    robot.enableMotors();
    robot.runAsync(true);
    program->second(robot);
    ispace::client::World world(std::getenv("ISPACE_SIMRUN"));
    const ispace::client::Pose pose = world.poses().at("r1");
    std::printf("%.17g %.17g %.17g %ld\n", pose.x, pose.y, pose.heading, world.steps());
    Aria::exit(0);
}
