// SPDX-License-Identifier: GPL-3.0-or-later
// Driving by program, keys and joystick. Keys are read in the robot's cycle, with its lock held;
// they come from the terminal of the program, and from no other window.
#ifndef SIM_ARIA_ACTIONS_TELEOP_H
#define SIM_ARIA_ACTIONS_TELEOP_H

#include <algorithm>
#include <cmath>
#include <list>
#include <memory>

#include <sim_aria/action.h>
#include <sim_aria/functor_kinds.h>
#include <sim_aria/keys.h>
#include <sim_aria/robot.h>

namespace sim_aria {

/// Keys of an action: taken while it is active.
class ActionKeys {
  public:
    ~ActionKeys() { release(); }
    void add(int key, ArFunctor* functor) { keys_.emplace_back(key, functor); }
    /// Binds the keys, by the program's key handler or one of the robot.
    void take(ArRobot* robot) {
        if (taken_) return;
        ArKeyHandler* handler = Aria::getKeyHandler();
        if (!handler && robot) handler = robot->getKeyHandler();
        if (!handler && robot) {
            own_.reset(new ArKeyHandler);
            handler = own_.get();
            Aria::setKeyHandler(handler);
            robot->attachKeyHandler(handler);
        }
        if (!handler) return;
        taken_ = true;
        for (const auto& key : keys_)
            if (!handler->addKeyHandler(key.first, key.second))
                ArLog::log(ArLog::Normal, "The key %d has another function", key.first);
    }
    void release() {
        ArKeyHandler* const handler = Aria::getKeyHandler();
        if (taken_ && handler)
            for (const auto& key : keys_) handler->remKeyHandler(key.second);
        taken_ = false;
    }

  private:
    std::list<std::pair<int, ArFunctor*>> keys_;
    std::unique_ptr<ArKeyHandler> own_;
    bool taken_ = false;
};

}  // namespace sim_aria

/// Drives by speeds that the program sets, mm/s and degrees/s.
class ArActionInput : public ArAction {
  public:
    explicit ArActionInput(const char* name = "Input")
        : ArAction(name, "Drives as the program says.") {}
    void setVel(double vel) { myDesired.setVel(vel); }
    void setRotVel(double rotVel) { myDesired.setRotVel(rotVel); }
    void setHeading(double heading) { myDesired.setHeading(heading); }
    void deltaHeadingFromCurrent(double delta) {
        setHeading(ArMath::addAngle(getRobot() ? getRobot()->getTh() : 0, delta));
    }
    void clear() { myDesired.reset(); }
    void activate() override {
        if (!isActive()) clear();
        ArAction::activate();
    }
    ArActionDesired* fire(ArActionDesired) override {
        myFired = myDesired;
        return &myFired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    ArActionDesired myDesired, myFired;
};

/// Drives by shares of the greatest speeds, in per cent, scaled by a throttle.
class ArActionRatioInput : public ArAction {
  public:
    explicit ArActionRatioInput(const char* name = "RatioInput")
        : ArAction(name, "Drives by shares of the greatest speeds.") {}
    /// \param transRatio, rotRatio -100 to 100 \param throttleRatio 0 to 100
    void setRatios(double transRatio, double rotRatio, double throttleRatio) {
        myTrans = transRatio;
        myRot = rotRatio;
        myThrottle = throttleRatio;
    }
    void setTransRatio(double ratio) { myTrans = ratio; }
    void setRotRatio(double ratio) { myRot = ratio; }
    void setThrottleRatio(double ratio) { myThrottle = ratio; }
    double getTransRatio() const { return myTrans; }
    double getRotRatio() const { return myRot; }
    double getThrottleRatio() const { return myThrottle; }
    /// Speeds at the full and at the lowest throttle, mm/s and degrees/s.
    void setParameters(double fullThrottleForwards, double fullThrottleBackwards,
                       double rotAtFullForwards, double /*rotAtFullBackwards*/,
                       double lowThrottleForwards, double lowThrottleBackwards,
                       double rotAtLowForwards, double /*rotAtLowBackwards*/) {
        myFull[0] = fullThrottleForwards, myFull[1] = std::fabs(fullThrottleBackwards);
        myFull[2] = rotAtFullForwards;
        myLow[0] = lowThrottleForwards, myLow[1] = std::fabs(lowThrottleBackwards);
        myLow[2] = rotAtLowForwards;
    }
    /// Functions to call before each cycle, those of higher positions first.
    void addFireCallback(int priority, ArFunctor* functor) {
        myCallbacks.add(functor, priority, functor);
    }
    void remFireCallback(ArFunctor* functor) { myCallbacks.remove(functor); }
    void addActivateCallback(ArFunctor* functor) { myActivated.add(functor, 0, functor); }
    void addDeactivateCallback(ArFunctor* functor) { myDeactivated.add(functor, 0, functor); }
    void activate() override {
        ArAction::activate();
        setRatios(0, 0, myThrottle);
        for (const auto& item : myActivated.items()) item.call->invoke();
    }
    void deactivate() override {
        ArAction::deactivate();
        for (const auto& item : myDeactivated.items()) item.call->invoke();
    }
    ArActionDesired* fire(ArActionDesired) override {
        for (const auto& item : myCallbacks.items()) item.call->invoke();
        myDesired.reset();
        const double trans = std::max(-100.0, std::min(100.0, myTrans)) / 100;
        const double rot = std::max(-100.0, std::min(100.0, myRot)) / 100;
        myDesired.setVel(trans * at(trans < 0 ? 1 : 0));
        myDesired.setRotVel(rot * at(2));
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    using Callbacks = sim_aria::Ordered<ArFunctor*>;

    double at(int i) const {
        const double t = std::max(0.0, std::min(100.0, myThrottle)) / 100;
        return myLow[i] + t * (myFull[i] - myLow[i]);
    }

    double myTrans = 0, myRot = 0, myThrottle = 100;
    double myFull[3] = {700, 250, 50}, myLow[3] = {100, 50, 10};  // forward, backward, rotation
    Callbacks myCallbacks, myActivated, myDeactivated;
    ArActionDesired myDesired;
};

/// Drives by the arrow keys: up and down change the speed by `velIncrement` mm/s, left and right
/// turn by `turnIncrement` degrees; the space bar stops.
class ArActionKeydrive : public ArAction {
  public:
    explicit ArActionKeydrive(const char* name = "keydrive", double transVelMax = 400,
                              double turnAmountMax = 24, double velIncrement = 25,
                              double turnIncrement = 8)
        : ArAction(name, "Drives by the arrow keys."),
          myVelMax(transVelMax),
          myTurnMax(turnAmountMax),
          myVelIncrement(velIncrement),
          myTurnIncrement(turnIncrement),
          myUp(this, &ArActionKeydrive::up),
          myDown(this, &ArActionKeydrive::down),
          myLeft(this, &ArActionKeydrive::left),
          myRight(this, &ArActionKeydrive::right),
          mySpace(this, &ArActionKeydrive::space) {
        myKeys.add(ArKeyHandler::UP, &myUp);
        myKeys.add(ArKeyHandler::DOWN, &myDown);
        myKeys.add(ArKeyHandler::LEFT, &myLeft);
        myKeys.add(ArKeyHandler::RIGHT, &myRight);
        myKeys.add(ArKeyHandler::SPACE, &mySpace);
        setNextArgument(ArArg("trans vel max", &myVelMax, "mm/s"));
        setNextArgument(ArArg("turn amount max", &myTurnMax, "Degrees"));
        setNextArgument(ArArg("vel increment", &myVelIncrement, "mm/s"));
        setNextArgument(ArArg("turn increment", &myTurnIncrement, "Degrees"));
    }
    void setRobot(ArRobot* robot) override {
        ArAction::setRobot(robot);
        if (robot && isActive()) myKeys.take(robot);
    }
    void activate() override {
        ArAction::activate();
        myKeys.take(getRobot());
    }
    void deactivate() override {
        ArAction::deactivate();
        myKeys.release();
        space();
    }
    void takeKeys() { myKeys.take(getRobot()); }
    void giveUpKeys() { myKeys.release(); }
    void setSpeeds(double transVelMax, double turnAmountMax) {
        myVelMax = transVelMax;
        myTurnMax = turnAmountMax;
    }
    void setIncrements(double velIncrement, double turnIncrement) {
        myVelIncrement = velIncrement;
        myTurnIncrement = turnIncrement;
    }
    void up() { myVel = std::min(myVelMax, myVel + myVelIncrement); }
    void down() { myVel = std::max(-myVelMax, myVel - myVelIncrement); }
    void left() { myTurn = std::min(myTurnMax, myTurn + myTurnIncrement); }
    void right() { myTurn = std::max(-myTurnMax, myTurn - myTurnIncrement); }
    void space() {
        myVel = myTurn = 0;
        myTurns = false;
    }

    ArActionDesired* fire(ArActionDesired) override {
        myDesired.reset();
        myDesired.setVel(myVel);
        if (myTurn != 0) myHeading = ArMath::addAngle(getRobot()->getTh(), myTurn);
        myTurns = myTurns || myTurn != 0;
        myTurn = 0;
        if (myTurns)
            myDesired.setHeading(myHeading);
        else
            myDesired.setDeltaHeading(0);
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    double myVelMax, myTurnMax, myVelIncrement, myTurnIncrement;
    double myVel = 0, myTurn = 0, myHeading = 0;
    bool myTurns = false;  // to myHeading
    ArFunctorC<ArActionKeydrive> myUp, myDown, myLeft, myRight, mySpace;
    sim_aria::ActionKeys myKeys;
    ArActionDesired myDesired;
};

/// Drives by a joystick, if there is one, see ArJoyHandler.
class ArActionJoydrive : public ArAction {
  public:
    explicit ArActionJoydrive(const char* name = "joydrive", double /*transVelMax*/ = 400,
                              double /*turnAmountMax*/ = 15, bool stopIfNoButtonPressed = false,
                              bool /*useOSCalForJoystick*/ = true)
        : ArAction(name, "Drives by a joystick."), myStops(stopIfNoButtonPressed) {}
    bool joystickInited() const { return myHandler.haveJoystick(); }
    void setStopIfNoButtonPressed(bool stop) { myStops = stop; }
    bool getStopIfNoButtonPressed() const { return myStops; }
    void setUseOSCal(bool use) { myHandler.setUseOSCal(use); }
    void setSpeeds(int x, int y) { myHandler.setSpeeds(x, y); }
    ArJoyHandler* getJoyHandler() { return &myHandler; }
    ArActionDesired* fire(ArActionDesired) override {
        if (!myStops) return nullptr;
        myDesired.reset();
        myDesired.setVel(0);
        myDesired.setDeltaHeading(0);
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    bool myStops;
    ArJoyHandler myHandler;
    ArActionDesired myDesired;
};
using ArActionRobotJoydrive = ArActionJoydrive;

/// Lets the arrow keys set the ratios of an ArActionRatioInput; z and x change the throttle.
class ArRatioInputKeydrive {
  public:
    ArRatioInputKeydrive(ArRobot* robot, ArActionRatioInput* input, int /*priority*/ = 25,
                         double /*velIncrement*/ = 25)
        : myRobot(robot),
          myInput(input),
          myUp(this, &ArRatioInputKeydrive::up),
          myDown(this, &ArRatioInputKeydrive::down),
          myLeft(this, &ArRatioInputKeydrive::left),
          myRight(this, &ArRatioInputKeydrive::right),
          mySpace(this, &ArRatioInputKeydrive::space),
          myFaster(this, &ArRatioInputKeydrive::faster),
          mySlower(this, &ArRatioInputKeydrive::slower),
          myTake(this, &ArRatioInputKeydrive::take),
          myRelease(this, &ArRatioInputKeydrive::release) {
        myKeys.add(ArKeyHandler::UP, &myUp);
        myKeys.add(ArKeyHandler::DOWN, &myDown);
        myKeys.add(ArKeyHandler::LEFT, &myLeft);
        myKeys.add(ArKeyHandler::RIGHT, &myRight);
        myKeys.add(ArKeyHandler::SPACE, &mySpace);
        myKeys.add('z', &myFaster);
        myKeys.add('x', &mySlower);
        myInput->addActivateCallback(&myTake);
        myInput->addDeactivateCallback(&myRelease);
    }

  private:
    void up() { trans(kStep); }
    void down() { trans(-kStep); }
    void left() { myInput->setRotRatio(std::min(100.0, myInput->getRotRatio() + kTurn)); }
    void right() { myInput->setRotRatio(std::max(-100.0, myInput->getRotRatio() - kTurn)); }
    void space() { myInput->setRatios(0, 0, myInput->getThrottleRatio()); }
    void faster() { throttle(kStep); }
    void slower() { throttle(-kStep); }
    void take() { myKeys.take(myRobot); }
    void release() { myKeys.release(); }
    void trans(double step) {
        myInput->setTransRatio(std::max(-100.0, std::min(100.0, myInput->getTransRatio() + step)));
    }
    void throttle(double step) {
        myInput->setThrottleRatio(
            std::max(0.0, std::min(100.0, myInput->getThrottleRatio() + step)));
    }

    static constexpr double kStep = 5, kTurn = 10;  // per cent

    ArRobot* myRobot;
    ArActionRatioInput* myInput;
    ArFunctorC<ArRatioInputKeydrive> myUp, myDown, myLeft, myRight, mySpace, myFaster, mySlower,
        myTake, myRelease;
    sim_aria::ActionKeys myKeys;
};

#endif  // SIM_ARIA_ACTIONS_TELEOP_H
