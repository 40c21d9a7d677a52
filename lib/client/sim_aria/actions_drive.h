// SPDX-License-Identifier: GPL-3.0-or-later
// Goals are in the frame of the robot's pose, which moveTo() shifts and drift of odometry bends; a
// distance counts by the wheels. An action that has arrived has no wish more: the robot keeps the
// stop that it asked for last, unless another one drives.
#ifndef SIM_ARIA_ACTIONS_DRIVE_H
#define SIM_ARIA_ACTIONS_DRIVE_H

#include <algorithm>
#include <cmath>

#include <sim_aria/action.h>
#include <sim_aria/robot.h>

/// Drives at one speed, mm/s.
class ArActionConstantVelocity : public ArAction {
  public:
    explicit ArActionConstantVelocity(const char* name = "Constant Velocity", double velocity = 400)
        : ArAction(name, "Drives at a constant speed."), myVelocity(velocity) {
        setNextArgument(ArArg("velocity", &myVelocity, "Speed, mm/s"));
    }
    ArActionDesired* fire(ArActionDesired) override {
        myDesired.reset();
        myDesired.setVel(myVelocity);
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    double myVelocity;
    ArActionDesired myDesired;
};

/// Stands still.
class ArActionStop : public ArAction {
  public:
    explicit ArActionStop(const char* name = "stop") : ArAction(name, "Stands still.") {}
    ArActionDesired* fire(ArActionDesired) override {
        myDesired.reset();
        myDesired.setVel(0);
        myDesired.setRotVel(0);
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    ArActionDesired myDesired;
};

/// Turns while actions of higher priority let the robot go at less than `speedFull` mm/s: not at
/// that speed, by the full amount (degrees) below `speedStart`.
class ArActionTurn : public ArAction {
  public:
    explicit ArActionTurn(const char* name = "turn", double speedStart = 200,
                          double speedFull = 100, double turnAmount = 15)
        : ArAction(name, "Turns where the robot is slowed down."),
          mySpeedStart(speedStart),
          mySpeedFull(speedFull),
          myTurnAmount(turnAmount) {
        setNextArgument(ArArg("speed start turn", &mySpeedStart, "Speed below which to turn"));
        setNextArgument(ArArg("speed full turn", &mySpeedFull, "Speed for the full turn"));
        setNextArgument(ArArg("amount to turn", &myTurnAmount, "Degrees"));
    }
    ArActionDesired* fire(ArActionDesired current) override {
        myDesired.reset();
        const bool limited = current.getMaxVelStrength() >= ArActionDesired::MIN_STRENGTH;
        if (!limited) return nullptr;
        const double speed = current.getMaxVel(), low = std::min(mySpeedStart, mySpeedFull);
        const double high = std::max(mySpeedStart, mySpeedFull);
        if (speed > high) {
            mySide = 0;
            return nullptr;
        }
        // Away from the nearer side, as long as the turn lasts.
        if (mySide == 0) {
            double angle = 0;
            getRobot()->checkRangeDevicesCurrentPolar(-70, 70, &angle);
            mySide = angle > 0 ? -1 : 1;
        }
        const double share = high > low ? std::min(1.0, (high - speed) / (high - low)) : 1;
        myDesired.setDeltaHeading(mySide * share * myTurnAmount);
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    double mySpeedStart, mySpeedFull, myTurnAmount;
    int mySide = 0;
    ArActionDesired myDesired;
};

/// Drives to a point and turns on the way, at `speed` mm/s; turns by at most `turnAmount` degrees
/// at a time, at speeds of at most `speedToTurnAt`.
class ArActionGoto : public ArAction {
  public:
    explicit ArActionGoto(const char* name = "goto", ArPose goal = ArPose(0, 0, 0),
                          double closeDist = 100, double speed = 400, double speedToTurnAt = 150,
                          double turnAmount = 7)
        : ArAction(name, "Drives to a point."),
          myCloseDist(closeDist),
          mySpeed(speed),
          mySpeedToTurnAt(speedToTurnAt),
          myTurnAmount(turnAmount) {
        setNextArgument(ArArg("close dist", &myCloseDist, "Distance at which it has arrived, mm"));
        setNextArgument(ArArg("speed", &mySpeed, "mm/s"));
        setNextArgument(ArArg("speed to turn at", &mySpeedToTurnAt, "mm/s"));
        setNextArgument(ArArg("amount to turn", &myTurnAmount, "Degrees"));
        setGoal(goal);
    }
    void setGoal(ArPose goal) {
        myGoal = goal;
        myState = Going;
    }
    ArPose getGoal() const { return myGoal; }
    void cancelGoal() { myState = Without; }
    bool haveAchievedGoal() const { return myState == Arrived; }
    void setCloseDist(double dist) { myCloseDist = dist; }
    double getCloseDist() const { return myCloseDist; }
    void setSpeed(double speed) { mySpeed = speed; }
    double getSpeed() const { return mySpeed; }

    ArActionDesired* fire(ArActionDesired) override {
        if (myState != Going) return nullptr;
        myDesired.reset();
        const ArPose at = getRobot()->getPose();
        if (at.findDistanceTo(myGoal) < myCloseDist) {
            myState = Arrived;
            myDesired.setVel(0);
            myDesired.setDeltaHeading(0);
            return &myDesired;
        }
        const double turn = ArMath::subAngle(at.findAngleTo(myGoal), at.getTh());
        const double size = std::fabs(turn);
        // A goal behind: turn first.
        myDesired.setVel(size > kBehind        ? 0
                         : size > myTurnAmount ? std::min(mySpeedToTurnAt, mySpeed)
                                               : mySpeed);
        myDesired.setDeltaHeading(std::max(-myTurnAmount, std::min(myTurnAmount, turn)));
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    enum State { Without, Going, Arrived };
    static constexpr double kBehind = 60;  // degrees

    ArPose myGoal;
    State myState = Without;
    double myCloseDist, mySpeed, mySpeedToTurnAt, myTurnAmount;
    ArActionDesired myDesired;
};

/// Turns to a goal, drives straight to it and brakes in time; the preferred of the two.
class ArActionGotoStraight : public ArAction {
  public:
    explicit ArActionGotoStraight(const char* name = "goto", double speed = 400)
        : ArAction(name, "Drives straight to a point."), mySpeed(speed) {
        setNextArgument(ArArg("speed", &mySpeed, "mm/s"));
    }
    bool haveAchievedGoal() const { return myState == Arrived; }
    bool haveGoal() const { return myState == Going; }
    void cancelGoal() { myState = Without; }
    /// \param backToGoal drive backward \param justDistance stop after the distance, whatever the
    /// position
    void setGoal(ArPose goal, bool backToGoal = false, bool justDistance = true) {
        myGoal = goal;
        myBack = backToGoal;
        myByDistance = justDistance;
        myFromSet = false;
        myState = Going;
    }
    /// \param dist mm, in the direction `deltaHeading` of the robot
    void setGoalRel(double dist, double deltaHeading, bool backToGoal = false,
                    bool justDistance = true) {
        const ArPose at = getRobot() ? getRobot()->getPose() : ArPose();
        const double th = at.getTh() + deltaHeading;
        setGoal(ArPose(at.getX() + dist * ArMath::cos(th), at.getY() + dist * ArMath::sin(th)),
                backToGoal, justDistance);
    }
    ArPose getGoal() const { return myGoal; }
    void setSpeed(double speed) { mySpeed = speed; }
    double getSpeed() const { return mySpeed; }
    void setCloseDist(double dist) { myCloseDist = dist; }
    double getCloseDist() const { return myCloseDist; }

    ArActionDesired* fire(ArActionDesired) override {
        if (myState != Going) return nullptr;
        myDesired.reset();
        const ArPose at = getRobot()->getPose();
        if (!myFromSet) myFrom = at;
        myFromSet = true;
        const double left = myByDistance ? myFrom.findDistanceTo(myGoal) - myFrom.findDistanceTo(at)
                                         : at.findDistanceTo(myGoal);
        const double rest = std::max(at.findDistanceTo(myGoal) < myCloseDist ? 0.0 : left, 0.0);
        if (rest < myCloseDist && std::fabs(getRobot()->getVel()) < kSlow) myState = Arrived;
        if (rest < myCloseDist) {
            myDesired.setVel(0);
            myDesired.setDeltaHeading(0);
            return &myDesired;
        }
        const double bearing = at.findAngleTo(myGoal) + (myBack ? 180 : 0);
        const double turn = ArMath::subAngle(bearing, at.getTh());
        myDesired.setDeltaHeading(turn);
        // Half of the deceleration, since poses arrive one cycle late.
        const double brake = std::sqrt(getRobot()->getTransDecel() * rest);
        const double speed = std::fabs(turn) > kAside ? 0 : std::min(mySpeed, brake);
        myDesired.setVel(myBack ? -speed : speed);
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    enum State { Without, Going, Arrived };
    static constexpr double kAside = 15;  // degrees beyond which it turns on the spot
    static constexpr double kSlow = 50;   // mm/s

    ArPose myGoal, myFrom;
    State myState = Without;
    bool myBack = false, myByDistance = true, myFromSet = false;
    double mySpeed, myCloseDist = 100;
    ArActionDesired myDesired;
};

/// Drives a distance along the present heading, mm.
class ArActionDriveDistance : public ArAction {
  public:
    explicit ArActionDriveDistance(const char* name = "driveDistance", double speed = 400,
                                   double deceleration = 200)
        : ArAction(name, "Drives a distance."), mySpeed(speed), myDeceleration(deceleration) {
        setNextArgument(ArArg("speed", &mySpeed, "mm/s"));
        setNextArgument(ArArg("deceleration", &myDeceleration, "mm/s2"));
    }
    bool haveAchievedDistance() const { return myState == Arrived; }
    void cancelDistance() { myState = Without; }
    void setDistance(double distance, bool /*useEncoders*/ = true) {
        myDistance = distance;
        myFromSet = false;
        myState = Going;
    }
    void setSpeed(double speed) { mySpeed = speed; }
    double getSpeed() const { return mySpeed; }

    ArActionDesired* fire(ArActionDesired) override {
        if (myState != Going) return nullptr;
        const ArPose at = getRobot()->getEncoderPose();
        if (!myFromSet) myFrom = at;
        myFromSet = true;
        const double left = std::fabs(myDistance) - myFrom.findDistanceTo(at);
        myDesired.reset();
        const double speed =
            std::min(mySpeed, std::sqrt(std::max(0.0, myDeceleration * (left - kClose))));
        if (left < 2 * kClose && std::fabs(getRobot()->getVel()) < kClose) myState = Arrived;
        myDesired.setVel(myDistance < 0 ? -speed : speed);
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    enum State { Without, Going, Arrived };
    static constexpr double kClose = 10;  // mm, mm/s

    State myState = Without;
    double mySpeed, myDeceleration, myDistance = 0;
    bool myFromSet = false;
    ArPose myFrom;
    ArActionDesired myDesired;
};

/// Limits speeds (mm/s, degrees/s); the simulated robot keeps its accelerations.
class ArActionMovementParameters : public ArAction {
  public:
    explicit ArActionMovementParameters(const char* name = "MovementParameters",
                                        bool /*overrideFaster*/ = true,
                                        bool /*addLatIfAvailable*/ = true)
        : ArAction(name, "Limits speeds.") {}
    void setParameters(double maxVel = 0, double maxNegVel = 0, double /*transAccel*/ = 0,
                       double /*transDecel*/ = 0, double rotVelMax = 0) {
        myMaxVel = maxVel;
        myMaxNegVel = maxNegVel;
        myRotVelMax = rotVelMax;
    }
    ArActionDesired* fire(ArActionDesired) override {
        myDesired.reset();
        if (std::fabs(myMaxVel) >= 1) myDesired.setMaxVel(myMaxVel);
        if (std::fabs(myMaxNegVel) >= 1) myDesired.setMaxNegVel(-std::fabs(myMaxNegVel));
        if (std::fabs(myRotVelMax) >= 1) myDesired.setMaxRotVel(myRotVelMax);
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    double myMaxVel = 0, myMaxNegVel = 0, myRotVelMax = 0;
    ArActionDesired myDesired;
};

#endif  // SIM_ARIA_ACTIONS_DRIVE_H
