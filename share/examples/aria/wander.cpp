// SPDX-License-Identifier: GPL-3.0-or-later
// Wanders about for some seconds (30, or the first argument): ahead where the sonars find room,
// aside where they do not, back where the robot is stuck. Written for ARIA and a Pioneer; with
// simrun, the include path alone changes:
//
//   g++ -std=c++11 -pthread -I lib/client -I lib/client/aria share/examples/aria/wander.cpp
//   (installed: g++ -std=c++11 -pthread -I /usr/include/ispace_aria wander.cpp)
//   simrun share/scenes/ispace.env share/scenes/ispace.3dm --listen 127.0.0.1:7001 &
//   ISPACE_SIMRUN=127.0.0.1:7001 ./a.out
#include "Aria.h"

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    const int seconds = argc > 1 ? std::atoi(argv[1]) : 30;

    Aria::init();
    // Ctrl-C ends the program at once, as without ARIA.
    ArSignalHandler::unhandle(ArSignalHandler::SigINT);

    ArRobot robot;
    ArSonarDevice sonar;
    ArSerialConnection connection;
    int error = connection.open();
    if (error != 0) {
        std::printf("cannot open the port: %s\n", connection.getOpenMessage(error));
        Aria::shutdown();
        return 1;
    }
    robot.setDeviceConnection(&connection);
    if (!robot.blockingConnect()) {
        std::printf("no robot answers\n");
        Aria::shutdown();
        return 1;
    }
    robot.addRangeDevice(&sonar);
    robot.comInt(ArCommands::ENABLE, 1);
    robot.comInt(ArCommands::SONAR, 1);
    robot.comInt(ArCommands::SOUNDTOG, 0);
    robot.runAsync(true);

    double way = 0;
    int stalls = 0;
    ArTime begun;
    ArTime backward;
    bool stuck = false;
    robot.lock();
    ArPose last = robot.getPose();
    robot.unlock();
    while (begun.secSince() < seconds && robot.isConnected()) {
        robot.lock();
        way += last.findDistanceTo(robot.getPose());
        last = robot.getPose();
        const bool stalled = robot.isLeftMotorStalled() || robot.isRightMotorStalled();
        const double left = sonar.currentReadingPolar(0, 70);
        const double right = sonar.currentReadingPolar(-70, 0);
        const double ahead = left < right ? left : right;
        if (stalled && !stuck) {
            ++stalls;
            stuck = true;
            backward.setToNow();
        }
        if (stuck) {
            robot.setVel(-150);
            robot.setRotVel(20);
            stuck = backward.mSecSince() < 3000;
        } else {
            robot.setVel(ahead > 1000 ? 300 : ahead > 500 ? 120 : 0);
            robot.setRotVel(ahead > 1200 ? 0 : left > right ? 35 : -35);
        }
        robot.unlock();
        ArUtil::sleep(50);
    }

    robot.lock();
    const ArPose at = robot.getPose();
    std::printf("%s: %.0f mm in %d s, stalled %d times, now at %.0f %.0f %.1f, %.0f mm/s\n",
                robot.getRobotSubType(), way, seconds, stalls, at.getX(), at.getY(), at.getTh(),
                robot.getVel());
    robot.unlock();
    robot.stopRunning();
    robot.disconnect();
    Aria::shutdown();
    return 0;
}
