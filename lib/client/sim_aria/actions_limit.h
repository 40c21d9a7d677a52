// SPDX-License-Identifier: GPL-3.0-or-later
// Limits hold whatever their priority, since the lowest one counts (ArActionDesired). They look at
// current readings in a strip before or behind the robot's centre, by its pose in this cycle: at
// 100 ms a robot of 750 mm/s moves up to 75 mm before a limit takes effect.
#ifndef SIM_ARIA_ACTIONS_LIMIT_H
#define SIM_ARIA_ACTIONS_LIMIT_H

#include <algorithm>
#include <cmath>

#include <sim_aria/action.h>
#include <sim_aria/robot.h>

/// Slows down before obstacles ahead: not beyond `slowDistance` from the robot's rim, down to a
/// stand at `stopDistance` (mm). Looks at a strip of the robot's width times `widthRatio`.
class ArActionLimiterForwards : public ArAction {
  public:
    /// \param slowSpeed speed at the slow distance, mm/s
    explicit ArActionLimiterForwards(const char* name = "speed limiter", double stopDistance = 250,
                                     double slowDistance = 1000, double slowSpeed = 200,
                                     double widthRatio = 1)
        : ArAction(name, "Slows down before obstacles ahead.") {
        setParameters(stopDistance, slowDistance, slowSpeed, widthRatio);
        setNextArgument(ArArg("stop distance", &myStop, "mm"));
        setNextArgument(ArArg("slow distance", &mySlow, "mm"));
        setNextArgument(ArArg("slow speed", &mySpeed, "mm/s"));
        setNextArgument(ArArg("width ratio", &myRatio, "Share of the robot's width"));
    }
    void setParameters(double stopDistance = 250, double slowDistance = 1000,
                       double slowSpeed = 200, double widthRatio = 1) {
        myStop = stopDistance;
        mySlow = slowDistance;
        mySpeed = slowSpeed;
        myRatio = widthRatio;
    }
    ArActionDesired* fire(ArActionDesired) override {
        const double front = getRobot()->getRobotLength() / 2;
        const double aside = myRatio * getRobot()->getRobotWidth() / 2;
        const double far = std::max(myStop, mySlow) + front;
        ArPose hit;
        const double nearest = getRobot()->checkRangeDevicesCurrentBox(0, -aside, far, aside, &hit);
        if (nearest > far + aside) return nullptr;
        const ArPose local = getRobot()->getToGlobalTransform().doInvTransform(hit);
        const double left = local.getX() - front;
        myDesired.reset();
        if (left <= myStop) {
            myDesired.setMaxVel(0);
        } else if (left < mySlow && mySlow > myStop) {
            myDesired.setMaxVel(mySpeed * (left - myStop) / (mySlow - myStop));
        } else {
            return nullptr;
        }
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    double myStop = 0, mySlow = 0, mySpeed = 0, myRatio = 1;
    ArActionDesired myDesired;
};

/// The same backward; distances and speed are negative.
class ArActionLimiterBackwards : public ArAction {
  public:
    explicit ArActionLimiterBackwards(const char* name = "speed limiter backward",
                                      double stopDistance = -250, double slowDistance = -600,
                                      double maxBackwardsSpeed = -250, double widthRatio = 1.5)
        : ArAction(name, "Slows down before obstacles behind."),
          myStop(stopDistance),
          mySlow(slowDistance),
          mySpeed(maxBackwardsSpeed),
          myRatio(widthRatio) {
        setNextArgument(ArArg("stop distance", &myStop, "mm"));
        setNextArgument(ArArg("slow distance", &mySlow, "mm"));
        setNextArgument(ArArg("maximum backwards speed", &mySpeed, "mm/s"));
        setNextArgument(ArArg("width ratio", &myRatio, "Share of the robot's width"));
    }
    ArActionDesired* fire(ArActionDesired) override {
        const double rear = getRobot()->getRobotLength() / 2;
        const double aside = myRatio * getRobot()->getRobotWidth() / 2;
        const double stop = std::fabs(myStop), slow = std::fabs(mySlow);
        const double most = std::fabs(mySpeed), far = std::max(stop, slow) + rear;
        ArPose hit;
        const double nearest =
            getRobot()->checkRangeDevicesCurrentBox(-far, -aside, 0, aside, &hit);
        myDesired.reset();
        myDesired.setMaxNegVel(-most);
        if (nearest > far + aside) return &myDesired;
        const ArPose local = getRobot()->getToGlobalTransform().doInvTransform(hit);
        const double left = -local.getX() - rear;
        if (left <= stop)
            myDesired.setMaxNegVel(0);
        else if (left < slow)
            myDesired.setMaxNegVel(-most * (left - stop) / (slow - stop));
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    double myStop, mySlow, mySpeed, myRatio;
    ArActionDesired myDesired;
};

/// Stops before tables, by infrared sensors that a Pioneer of simrun does not have.
class ArActionLimiterTableSensor : public ArAction {
  public:
    explicit ArActionLimiterTableSensor(const char* name = "TableSensorLimiter")
        : ArAction(name, "Stops before tables.") {}
    ArActionDesired* fire(ArActionDesired) override {
        if (!getRobot()->isLeftTableSensingIRTriggered() &&
            !getRobot()->isRightTableSensingIRTriggered())
            return nullptr;
        myDesired.reset();
        myDesired.setMaxVel(0);
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    ArActionDesired myDesired;
};

#endif  // SIM_ARIA_ACTIONS_LIMIT_H
