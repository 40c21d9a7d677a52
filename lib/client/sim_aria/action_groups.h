// SPDX-License-Identifier: GPL-3.0-or-later
// Groups with the members and priorities of ARIA. A group owns the actions that it makes; destroy
// it before its robot.
#ifndef SIM_ARIA_ACTION_GROUPS_H
#define SIM_ARIA_ACTION_GROUPS_H

#include <memory>

#include <sim_aria/actions_avoid.h>
#include <sim_aria/actions_drive.h>
#include <sim_aria/actions_limit.h>
#include <sim_aria/actions_teleop.h>

namespace sim_aria {

/// Adds an action that the group owns.
template <class Action, class... Arguments>
Action* addTo(ArActionGroup* group, int priority, Arguments... arguments) {
    Action* const action = new Action(arguments...);
    group->addAction(action, priority);
    group->addActionToDelete(action);
    return action;
}

/// Limits of a guarded drive.
inline void addLimiters(ArActionGroup* group) {
    addTo<ArActionLimiterTableSensor>(group, 100);
    addTo<ArActionLimiterForwards>(group, 95, "speed limiter near", 225.0, 450.0, 0.0, 1.1);
    addTo<ArActionLimiterForwards>(group, 90, "speed limiter far", 225.0, 1100.0, 400.0, 1.1);
    addTo<ArActionLimiterBackwards>(group, 85);
}

}  // namespace sim_aria

/// Stands still.
class ArActionGroupStop : public ArActionGroup {
  public:
    explicit ArActionGroupStop(ArRobot* robot) : ArActionGroup(robot) {
        sim_aria::addTo<ArActionStop>(this, 100);
    }
};

/// Drives as the program says, within limits.
class ArActionGroupInput : public ArActionGroup {
  public:
    explicit ArActionGroupInput(ArRobot* robot) : ArActionGroup(robot) {
        sim_aria::addLimiters(this);
        myInput = sim_aria::addTo<ArActionInput>(this, 50);
    }
    void setVel(double vel) { myInput->setVel(vel); }
    void setRotVel(double rotVel) { myInput->setRotVel(rotVel); }
    void setHeading(double heading) { myInput->setHeading(heading); }
    void deltaHeadingFromCurrent(double delta) { myInput->deltaHeadingFromCurrent(delta); }
    void clear() { myInput->clear(); }

  private:
    ArActionInput* myInput;
};

/// Drives by keys and joystick, within limits.
class ArActionGroupTeleop : public ArActionGroup {
  public:
    explicit ArActionGroupTeleop(ArRobot* robot) : ArActionGroup(robot) {
        sim_aria::addLimiters(this);
        myJoydrive = sim_aria::addTo<ArActionJoydrive>(this, 50);
        sim_aria::addTo<ArActionKeydrive>(this, 45);
    }
    void setThrottleParams(int /*lowSpeed*/, int /*highSpeed*/) {}
    bool joystickInited() const { return myJoydrive->joystickInited(); }

  private:
    ArActionJoydrive* myJoydrive;
};

/// The same without limits.
class ArActionGroupUnguardedTeleop : public ArActionGroup {
  public:
    explicit ArActionGroupUnguardedTeleop(ArRobot* robot) : ArActionGroup(robot) {
        sim_aria::addTo<ArActionJoydrive>(this, 50);
        sim_aria::addTo<ArActionKeydrive>(this, 45);
    }
    void setThrottleParams(int /*lowSpeed*/, int /*highSpeed*/) {}
};

/// Wanders and avoids obstacles.
class ArActionGroupWander : public ArActionGroup {
  public:
    explicit ArActionGroupWander(ArRobot* robot, double forwardVel = 400,
                                 double avoidFrontDist = 450, double avoidVel = 200,
                                 double avoidTurnAmt = 15)
        : ArActionGroup(robot) {
        sim_aria::addTo<ArActionStallRecover>(this, 100);
        sim_aria::addTo<ArActionBumpers>(this, 75);
        sim_aria::addTo<ArActionAvoidFront>(this, 50, "Avoid Front Near", avoidFrontDist / 2, 0.0,
                                            avoidTurnAmt);
        sim_aria::addTo<ArActionAvoidFront>(this, 45, "Avoid Front Far", avoidFrontDist, avoidVel,
                                            avoidTurnAmt);
        sim_aria::addTo<ArActionConstantVelocity>(this, 25, "Constant Velocity", forwardVel);
    }
};

/// Drives by ratios from keys, without limits.
class ArActionGroupRatioDriveUnsafe : public ArActionGroup {
  public:
    explicit ArActionGroupRatioDriveUnsafe(ArRobot* robot) : ArActionGroup(robot) { fill(); }
    ArActionRatioInput* getActionRatioInput() { return myInput; }

  protected:
    enum Guard { Guarded };
    ArActionGroupRatioDriveUnsafe(ArRobot* robot, Guard) : ArActionGroup(robot) {
        sim_aria::addLimiters(this);
        fill();
    }

  private:
    void fill() {
        myInput = sim_aria::addTo<ArActionRatioInput>(this, 50);
        myKeys.reset(new ArRatioInputKeydrive(myRobot, myInput));
        // Takes its keys when it is activated.
        myInput->deactivate();
    }

    ArActionRatioInput* myInput = nullptr;
    std::unique_ptr<ArRatioInputKeydrive> myKeys;
};

/// The same within limits.
class ArActionGroupRatioDrive : public ArActionGroupRatioDriveUnsafe {
  public:
    explicit ArActionGroupRatioDrive(ArRobot* robot)
        : ArActionGroupRatioDriveUnsafe(robot, Guarded) {}
};

#endif  // SIM_ARIA_ACTION_GROUPS_H
