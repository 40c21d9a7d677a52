// SPDX-License-Identifier: GPL-3.0-or-later
// Obstacles are what the robot's range devices see: a robot without any reads 5000 mm all around,
// and drives on. A side that was chosen is kept until the way is free, so that corners do not hold
// the robot.
#ifndef SIM_ARIA_ACTIONS_AVOID_H
#define SIM_ARIA_ACTIONS_AVOID_H

#include <algorithm>
#include <cmath>

#include <sim_aria/action.h>
#include <sim_aria/robot.h>

/// Turns away from obstacles ahead, by all range devices of the robot. Distances are from its rim,
/// mm.
class ArActionAvoidFront : public ArAction {
  public:
    /// \param avoidVelocity speed while it turns, mm/s \param turnAmount degrees
    explicit ArActionAvoidFront(const char* name = "avoid front obstacles",
                                double obstacleDistance = 450, double avoidVelocity = 200,
                                double turnAmount = 15, bool /*useTableIRIfAvail*/ = true)
        : ArAction(name, "Turns away from obstacles ahead."),
          myDistance(obstacleDistance),
          myVelocity(avoidVelocity),
          myTurnAmount(turnAmount) {
        setNextArgument(ArArg("avoidance distance", &myDistance, "mm"));
        setNextArgument(ArArg("avoidance velocity", &myVelocity, "mm/s"));
        setNextArgument(ArArg("turn amount", &myTurnAmount, "Degrees"));
    }
    ArActionDesired* fire(ArActionDesired) override {
        const double radius = getRobot()->getRobotRadius();
        const double left = getRobot()->checkRangeDevicesCurrentPolar(0, kAside) - radius;
        const double right = getRobot()->checkRangeDevicesCurrentPolar(-kAside, 0) - radius;
        if (std::min(left, right) > myDistance) {
            mySide = 0;
            return nullptr;
        }
        // One side until the way is free, or corners would hold the robot.
        if (mySide == 0) mySide = left < right ? -1 : 1;
        myDesired.reset();
        myDesired.setVel(myVelocity);
        myDesired.setDeltaHeading(mySide * myTurnAmount);
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    static constexpr double kAside = 70;  // degrees to either side that count as ahead

    double myDistance, myVelocity, myTurnAmount;
    int mySide = 0;
    ArActionDesired myDesired;
};

/// Turns away from obstacles to the side.
class ArActionAvoidSide : public ArAction {
  public:
    explicit ArActionAvoidSide(const char* name = "Avoid side", double obstacleDistance = 300,
                               double turnAmount = 5)
        : ArAction(name, "Turns away from obstacles to the side."),
          myDistance(obstacleDistance),
          myTurnAmount(turnAmount) {
        setNextArgument(ArArg("obstacle distance", &myDistance, "mm"));
        setNextArgument(ArArg("turn amount", &myTurnAmount, "Degrees"));
    }
    ArActionDesired* fire(ArActionDesired) override {
        const double radius = getRobot()->getRobotRadius();
        const bool left = getRobot()->checkRangeDevicesCurrentPolar(60, 120) - radius < myDistance;
        const bool right =
            getRobot()->checkRangeDevicesCurrentPolar(-120, -60) - radius < myDistance;
        // Between two walls it keeps its heading.
        if (left == right) return nullptr;
        myDesired.reset();
        myDesired.setDeltaHeading(left ? -myTurnAmount : myTurnAmount);
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    double myDistance, myTurnAmount;
    ArActionDesired myDesired;
};

/// Backs off from a pressed bumper, then turns to the other side; times in ms.
class ArActionBumpers : public ArAction {
  public:
    explicit ArActionBumpers(const char* name = "bumpers", double backOffSpeed = 100,
                             int backOffTime = 3000, int turnTime = 3000,
                             bool /*setMaximums*/ = false)
        : ArAction(name, "Backs off from pressed bumpers."),
          mySpeed(backOffSpeed),
          myBackOffTime(backOffTime),
          myTurnTime(turnTime) {
        setNextArgument(ArArg("back off speed", &mySpeed, "mm/s"));
        setNextArgument(ArArg("back off time", &myBackOffTime, "ms"));
        setNextArgument(ArArg("turn time", &myTurnTime, "ms"));
    }
    ArActionDesired* fire(ArActionDesired) override {
        const int stall = getRobot()->getStallValue(), front = stall >> 8 & kBumpers;
        const int rear = stall & kBumpers;
        if (!myFiring) start(front, rear);
        if (!myFiring) return nullptr;
        const long since = myStarted.mSecSince();
        if (since > myBackOffTime + myTurnTime) {
            myFiring = false;
            return nullptr;
        }
        myDesired.reset();
        const bool backs = since <= myBackOffTime;
        myDesired.setVel(backs ? myDirection * mySpeed : 0);
        // The front bumpers count clockwise from the left.
        myDesired.setDeltaHeading(backs ? 0 : mySide * kTurn);
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    static constexpr int kBumpers = 0xfe;
    static constexpr double kTurn = 30;  // degrees

    void start(int front, int rear) {
        if ((front == 0) == (rear == 0)) return;
        const bool ahead = front != 0;
        const int bits = (ahead ? front : rear) >> 1;
        const unsigned int count =
            ahead ? getRobot()->getNumFrontBumpers() : getRobot()->getNumRearBumpers();
        // Sum of positions of the pressed bumpers about the middle.
        int first_half = 0;
        for (unsigned int i = 0; i < count; ++i)
            if ((bits >> i & 1) != 0)
                first_half += 2 * i + 1 < count ? 1 : 2 * i + 1 > count ? -1 : 0;
        myDirection = ahead ? -1 : 1;
        mySide = first_half > 0 ? -1 : 1;
        myStarted.setToNow();
        myFiring = true;
    }

    double mySpeed;
    int myBackOffTime, myTurnTime;
    bool myFiring = false;
    int myDirection = -1, mySide = 1;
    ArTime myStarted;
    ArActionDesired myDesired;
};

/// Frees a robot whose motors stall: moves away from the nearer obstacle, then turns.
class ArActionStallRecover : public ArAction {
  public:
    /// \param obstacleDistance mm that must be free to move there \param cyclesToMove cycles of
    /// motion and of rotation \param speed mm/s \param degreesToTurn degrees in each step
    explicit ArActionStallRecover(const char* name = "stall recover", double obstacleDistance = 225,
                                  int cyclesToMove = 50, double speed = 150,
                                  double degreesToTurn = 45)
        : ArAction(name, "Frees the robot after a stall."),
          myDistance(obstacleDistance),
          myCycles(cyclesToMove),
          mySpeed(speed),
          myDegrees(degreesToTurn) {
        setNextArgument(ArArg("obstacle distance", &myDistance, "mm"));
        setNextArgument(ArArg("cycles to move", &myCycles, "Cycles"));
        setNextArgument(ArArg("speed", &mySpeed, "mm/s"));
        setNextArgument(ArArg("degrees to turn", &myDegrees, "Degrees"));
    }
    ArActionDesired* fire(ArActionDesired) override {
        const bool stalled = getRobot()->isLeftMotorStalled() || getRobot()->isRightMotorStalled();
        if (myLeft == 0 && stalled) begin();
        if (myLeft == 0) return nullptr;
        --myLeft;
        myDesired.reset();
        const bool moves = myLeft >= myCycles;
        // Stalled again on this way: the other one.
        if (moves && stalled && myLeft < 2 * myCycles - kPatience) {
            myDirection = -myDirection;
            myLeft = std::min(myLeft, myCycles + myCycles / 2);
        }
        if (moves) {
            const bool ahead = myDirection > 0;
            const double middle = ahead ? 0 : 180;
            const double room =
                getRobot()->checkRangeDevicesCurrentPolar(middle - kSector, middle + kSector) -
                getRobot()->getRobotRadius();
            if (room < myDistance / 2) myLeft = std::min(myLeft, myCycles);
            myDesired.setVel(myDirection * mySpeed);
            myDesired.setDeltaHeading(0);
        } else {
            if (myLeft == myCycles - 1)
                myHeading = ArMath::addAngle(getRobot()->getTh(), mySide * myDegrees);
            myDesired.setVel(0);
            myDesired.setHeading(myHeading);
            if (std::fabs(ArMath::subAngle(myHeading, getRobot()->getTh())) < kDone) myLeft = 0;
        }
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    static constexpr int kPatience = 10;   // cycles before a stall counts again
    static constexpr double kSector = 45;  // degrees to either side of a way
    static constexpr double kDone = 3;     // degrees

    void begin() {
        const double ahead = getRobot()->checkRangeDevicesCurrentPolar(-kSector, kSector);
        const double behind =
            getRobot()->checkRangeDevicesCurrentPolar(180 - kSector, 180 + kSector);
        const double left = getRobot()->checkRangeDevicesCurrentPolar(0, 100);
        const double right = getRobot()->checkRangeDevicesCurrentPolar(-100, 0);
        const int bumpers = getRobot()->getStallValue() & 0xfe;
        myDirection = bumpers != 0 || behind < ahead ? 1 : -1;
        mySide = left < right ? -1 : 1;
        myLeft = 2 * myCycles;
    }

    double myDistance;
    int myCycles;
    double mySpeed, myDegrees;
    int myLeft = 0;  // cycles
    int myDirection = -1, mySide = 1;
    double myHeading = 0;
    ArActionDesired myDesired;
};

#endif  // SIM_ARIA_ACTIONS_AVOID_H
