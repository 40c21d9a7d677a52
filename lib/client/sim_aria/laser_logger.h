// SPDX-License-Identifier: GPL-3.0-or-later
// Format: LaserOdometryLog, version 3, of ARIA: poses in mm and degrees in the frame of the robot's
// pose, points in the robot's frame. Each scan is flushed: a program that is killed loses at most
// the last one.
#ifndef SIM_ARIA_LASER_LOGGER_H
#define SIM_ARIA_LASER_LOGGER_H

#include <cmath>
#include <cstdio>
#include <string>

#include <sim_aria/functor_kinds.h>
#include <sim_aria/keys.h>
#include <sim_aria/laser.h>
#include <sim_aria/robot.h>

/// Writes scans and the robot's poses to a file for mapping, after each `distDiff` mm and `degDiff`
/// degrees; `g` adds a goal.
class ArLaserLogger {
  public:
    ArLaserLogger(ArRobot* robot, ArLaser* laser, double distDiff, double degDiff,
                  const char* fileName, bool addGoals = false)
        : myRobot(robot),
          myLaser(laser),
          myDistance(distDiff),
          myDegrees(degDiff),
          myFile(std::fopen(fileName, "w")),
          myTask(this, &ArLaserLogger::scan),
          myGoal(this, &ArLaserLogger::addGoal) {
        if (!myFile) {
            ArLog::logErrorFromOS(ArLog::Terse, "Cannot write %s", fileName);
            return;
        }
        const ArPose at = laser->getSensorPosition();
        std::fprintf(myFile, "LaserOdometryLog\nversion: 3\nsick1pose: %.0f %.0f %.2f\n", at.getX(),
                     at.getY(), at.getTh());
        std::fprintf(myFile, "sick1conf: %.0f %.0f %zu\n", laser->getStartDegrees(),
                     laser->getEndDegrees(), laser->getRawReadings()->size());
        laser->addReadingCB(&myTask);
        ArKeyHandler* const keys = Aria::getKeyHandler();
        if (addGoals && keys) {
            keys->addKeyHandler('g', &myGoal);
            keys->addKeyHandler('G', &myGoal);
        }
    }
    virtual ~ArLaserLogger() {
        myLaser->remReadingCB(&myTask);
        if (ArKeyHandler* const keys = Aria::getKeyHandler()) keys->remKeyHandler(&myGoal);
        if (myFile) std::fclose(myFile);
    }
    ArLaserLogger(const ArLaserLogger&) = delete;
    ArLaserLogger& operator=(const ArLaserLogger&) = delete;

    bool wasFileOpened() const { return myFile != nullptr; }
    bool takeReading() {
        myWanted = true;
        return myFile != nullptr;
    }
    void addGoal() {
        if (!myFile) return;
        const ArPose at = myRobot->getPose();
        std::fprintf(myFile, "cairn: Goal \"\" ICON_GOAL \"g%d\" %.0f %.0f %.2f\n", ++myGoals,
                     at.getX(), at.getY(), at.getTh());
    }

  private:
    void scan() {
        const std::list<ArSensorReading*>& readings = *myLaser->getRawReadings();
        if (readings.empty()) return;
        const ArPose at = readings.front()->getPoseTaken();
        const bool moved = at.findDistanceTo(myLast) > myDistance ||
                           std::fabs(ArMath::subAngle(at.getTh(), myLast.getTh())) > myDegrees;
        if (myScans > 0 && !moved && !myWanted) return;
        myWanted = false;
        myLast = at;
        std::fprintf(myFile, "scan1Id: %d\ntime: %.3f\nvelocities: %.2f %.2f 0\n", ++myScans,
                     sim_aria::Clock::get().now() / 1000, myRobot->getRotVel(), myRobot->getVel());
        std::fprintf(myFile, "robot: %.0f %.0f %.2f\nscan1:", at.getX(), at.getY(), at.getTh());
        for (const ArSensorReading* reading : readings)
            std::fprintf(myFile, " %d %d", ArMath::roundInt(reading->getLocalX()),
                         ArMath::roundInt(reading->getLocalY()));
        std::fprintf(myFile, "\n");
        std::fflush(myFile);
    }

    ArRobot* myRobot;
    ArLaser* myLaser;
    double myDistance, myDegrees;
    std::FILE* myFile;
    ArFunctorC<ArLaserLogger> myTask, myGoal;
    ArPose myLast;
    bool myWanted = false;
    int myScans = 0, myGoals = 0;
};

#endif  // SIM_ARIA_LASER_LOGGER_H
