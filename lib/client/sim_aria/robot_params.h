// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of a robot: radius, bumpers, sonars, and lasers with their poses. Millimetres and
// degrees.
#ifndef SIM_ARIA_ROBOT_PARAMS_H
#define SIM_ARIA_ROBOT_PARAMS_H

#include <string>
#include <vector>

#include <sim_aria/math.h>

/// Figures of a robot that ARIA reads from its parameter files; here those of simrun.
class ArRobotParams {
  public:
    const char* getClassName() const { return "Pioneer"; }
    const char* getSubClassName() const { return mySubClass.c_str(); }
    double getRobotRadius() const { return myRadius; }
    double getRobotDiagonal() const { return myRadius; }
    double getRobotWidth() const { return 2 * myRadius; }
    double getRobotLength() const { return 2 * myRadius; }
    bool getHaveRotVel() const { return true; }
    /// The firmware drives distances by itself.
    bool hasMoveCommand() const { return true; }
    bool hasTableSensingIR() const { return false; }
    bool haveFrontBumpers() const { return myFrontBumpers > 0; }
    bool haveRearBumpers() const { return myRearBumpers > 0; }
    int numFrontBumpers() const { return myFrontBumpers; }
    int numRearBumpers() const { return myRearBumpers; }
    int getNumSonar() const { return myNumSonar; }
    /// Pose of a laser on the robot, mm and degrees; numbers begin with 1.
    int getLaserX(int number = 1) const { return ArMath::roundInt(laser(number).getX()); }
    int getLaserY(int number = 1) const { return ArMath::roundInt(laser(number).getY()); }
    int getLaserZ(int /*number*/ = 1) const { return 0; }
    double getLaserTh(int number = 1) const { return laser(number).getTh(); }
    const char* getLaserPowerOutput(int /*number*/ = 1) const { return ""; }
    const char* getLaserType(int number = 1) const {
        return number >= 1 && number <= static_cast<int>(myLasers.size()) ? "sim" : "";
    }
    bool getLaserAutoConnect(int number = 1) const { return *getLaserType(number) != 0; }

  private:
    friend class ArRobot;

    ArPose laser(int number) const {
        if (number < 1 || number > static_cast<int>(myLasers.size())) return ArPose();
        return myLasers[static_cast<std::size_t>(number) - 1];
    }

    std::string mySubClass;
    double myRadius = 250;
    int myFrontBumpers = 0, myRearBumpers = 0, myNumSonar = 0;
    std::vector<ArPose> myLasers;
};

#endif  // SIM_ARIA_ROBOT_PARAMS_H
