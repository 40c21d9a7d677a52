// SPDX-License-Identifier: GPL-3.0-or-later
// Implementation of ArRobot: callbacks, tasks, actions and range devices. Part of sim_aria/robot.h.
#ifndef SIM_ARIA_ROBOT_PARTS_H
#define SIM_ARIA_ROBOT_PARTS_H

#include <algorithm>

#include <sim_aria/keys.h>
#include <sim_aria/laser.h>
#include <sim_aria/robot.h>

inline ArRobot::~ArRobot() {
    sim_aria::Process::get().remove(this);
    end();
    Aria::delRobot(this);
    if (myKeys) myKeys->onDestroy(nullptr);
    for (const auto& action : myActions) action.second->myRobot = nullptr;
    for (ArActionGroup* group : myGroups) group->myRobot = nullptr;
    for (ArRangeDevice* device : myDevices) device->myRobot = nullptr;
    for (const auto& laser : myLasers) laser.second->myRobot = nullptr;
}

inline void ArRobot::add(Occasion occasion, ArFunctor* functor, ArListPos::Pos position) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    auto& list = myCallbacks[occasion];
    list.insert(position == ArListPos::FIRST ? list.begin() : list.end(), functor);
}

inline void ArRobot::remove(Occasion occasion, ArFunctor* functor) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    myCallbacks[occasion].remove(functor);
}

/// Without the lock, since a callback may wait for another thread.
inline void ArRobot::call(Occasion occasion) {
    std::list<ArFunctor*> callbacks;
    {
        const std::lock_guard<std::recursive_mutex> hold(myMutex);
        callbacks = myCallbacks[occasion];
    }
    for (ArFunctor* callback : callbacks) callback->invoke();
}

inline bool ArRobot::addSensorInterpTask(const char* name, int position, ArFunctor* functor) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    mySensorTasks.add(functor, position, functor, name);
    return true;
}

inline bool ArRobot::addUserTask(const char* name, int position, ArFunctor* functor) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    myUserTasks.add(functor, position, functor, name);
    return true;
}

inline void ArRobot::remSensorInterpTask(ArFunctor* functor) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    mySensorTasks.remove(functor);
}

inline void ArRobot::remSensorInterpTask(const char* name) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    mySensorTasks.removeNamed(name);
}

inline void ArRobot::remUserTask(ArFunctor* functor) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    myUserTasks.remove(functor);
}

inline void ArRobot::remUserTask(const char* name) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    myUserTasks.removeNamed(name);
}

inline void ArRobot::addPacketHandler(ArRetFunctor1<bool, ArRobotPacket*>* functor,
                                      ArListPos::Pos position) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    myHandlers.insert(position == ArListPos::FIRST ? myHandlers.begin() : myHandlers.end(),
                      functor);
}

inline void ArRobot::remPacketHandler(ArRetFunctor1<bool, ArRobotPacket*>* functor) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    myHandlers.remove(functor);
}

inline void ArRobot::attachKeyHandler(ArKeyHandler* handler, bool exitOnEscape,
                                      bool useExitNotShutdown) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    myKeys = handler;
    handler->onDestroy([this] {
        const std::lock_guard<std::recursive_mutex> held(myMutex);
        myKeys = nullptr;
    });
    if (exitOnEscape) handler->endOnEscape(useExitNotShutdown);
}

inline bool ArRobot::addAction(ArAction* action, int priority) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    if (!action) return false;
    myActions.emplace(priority, action);
    action->setRobot(this);
    return true;
}

inline bool ArRobot::remAction(ArAction* action) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    for (auto at = myActions.begin(); at != myActions.end(); ++at) {
        if (at->second != action) continue;
        myActions.erase(at);
        const auto again = [action](const ArResolver::ActionMap::value_type& one) {
            return one.second == action;
        };
        if (action->myRobot == this && std::none_of(myActions.begin(), myActions.end(), again))
            action->myRobot = nullptr;
        return true;
    }
    return false;
}

inline bool ArRobot::remAction(const char* name) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    ArAction* const action = findAction(name);
    return action && remAction(action);
}

/// Of several with this name, the one of the highest priority.
inline ArAction* ArRobot::findAction(const char* name) const {
    for (auto at = myActions.rbegin(); at != myActions.rend(); ++at)
        if (std::string(at->second->getName()) == name) return at->second;
    return nullptr;
}

inline void ArRobot::deactivateActions() {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    for (const auto& action : myActions) action.second->deactivate();
}

inline void ArRobot::logActions(bool logDeactivated) const {
    for (auto at = myActions.rbegin(); at != myActions.rend(); ++at)
        if (logDeactivated || at->second->isActive()) {
            ArLog::log(ArLog::Terse, "Priority %d:", at->first);
            at->second->log();
        }
}

inline ArAction::~ArAction() {
    if (myRobot) myRobot->remAction(this);
}

inline ArRangeDevice::~ArRangeDevice() {
    if (myRobot) myRobot->remRangeDevice(this);
}

inline ArActionDesired* ArPriorityResolver::resolve(ActionMap* actions, ArRobot* robot,
                                                    bool logActions) {
    myDesired.reset();
    for (auto at = actions->rbegin(); at != actions->rend();) {
        const int priority = at->first;
        ArActionDesired equal;
        equal.startAverage();
        for (; at != actions->rend() && at->first == priority; ++at) {
            if (!at->second->isActive()) continue;
            ArActionDesired* const wish = at->second->fire(myDesired);
            if (!wish) continue;
            if (robot) wish->accountForRobotHeading(robot->getTh());
            equal.addAverage(wish);
            if (logActions)
                ArLog::log(ArLog::Terse, "%s: vel %g (%g), turn %g (%g)", at->second->getName(),
                           wish->getVel(), wish->getVelStrength(), wish->getDeltaHeading(),
                           wish->getDeltaHeadingStrength());
        }
        equal.endAverage();
        myDesired.merge(&equal);
    }
    return &myDesired;
}

inline ArActionGroup::ArActionGroup(ArRobot* robot) : myRobot(robot) {
    if (!myRobot) return;
    const std::lock_guard<std::recursive_mutex> hold(myRobot->myMutex);
    myRobot->myGroups.push_back(this);
}

inline ArActionGroup::~ArActionGroup() {
    removeActions();
    for (ArAction* action : myOwned) delete action;
    if (!myRobot) return;
    const std::lock_guard<std::recursive_mutex> hold(myRobot->myMutex);
    myRobot->myGroups.remove(this);
}

inline void ArActionGroup::addAction(ArAction* action, int priority) {
    if (!action) return;
    myActions.push_back(action);
    if (myRobot) myRobot->addAction(action, priority);
}

inline void ArActionGroup::remAction(ArAction* action) {
    myActions.remove(action);
    if (myRobot) myRobot->remAction(action);
}

inline void ArActionGroup::activateExclusive() {
    if (myRobot) myRobot->deactivateActions();
    activate();
}

inline void ArActionGroup::removeActions() {
    while (!myActions.empty()) remAction(myActions.front());
}

inline void ArRobot::addRangeDevice(ArRangeDevice* device) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    device->setRobot(this);
    myDevices.push_back(device);
}

inline bool ArRobot::remRangeDevice(ArRangeDevice* device) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    const std::size_t before = myDevices.size();
    myDevices.remove(device);
    if (device->myRobot == this) device->myRobot = nullptr;
    return myDevices.size() < before;
}

inline bool ArRobot::remRangeDevice(const char* name) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    ArRangeDevice* const device = findRangeDevice(name);
    return device && remRangeDevice(device);
}

inline ArRangeDevice* ArRobot::findRangeDevice(const char* name) const {
    for (ArRangeDevice* device : myDevices)
        if (std::string(device->getName()) == name) return device;
    return nullptr;
}

inline bool ArRobot::hasRangeDevice(ArRangeDevice* device) const {
    return std::find(myDevices.begin(), myDevices.end(), device) != myDevices.end();
}

/// \param of_device computes the distance of a device's nearest reading; the index is that of the
/// device
template <class Nearest>
double ArRobot::nearest(const Nearest& of_device, const ArRangeDevice** device) const {
    // Without a device as with one that sees nothing: a sonar's maximum range.
    double least = myDevices.empty() ? 5000 : 1e9;
    for (ArRangeDevice* candidate : myDevices) {
        candidate->lockDevice();
        const double distance = of_device(*candidate, least);
        candidate->unlockDevice();
        if (distance >= least) continue;
        least = distance;
        if (device) *device = candidate;
    }
    return least;
}

inline double ArRobot::checkRangeDevicesCurrentPolar(double startAngle, double endAngle,
                                                     double* angle,
                                                     const ArRangeDevice** device) const {
    return nearest(
        [&](const ArRangeDevice& candidate, double least) {
            double at = 0;
            const double distance = candidate.currentReadingPolar(startAngle, endAngle, &at);
            if (angle && distance < least) *angle = at;
            return distance;
        },
        device);
}

inline double ArRobot::checkRangeDevicesCumulativePolar(double startAngle, double endAngle,
                                                        double* angle,
                                                        const ArRangeDevice** device) const {
    return nearest(
        [&](const ArRangeDevice& candidate, double least) {
            double at = 0;
            const double distance = candidate.cumulativeReadingPolar(startAngle, endAngle, &at);
            if (angle && distance < least) *angle = at;
            return distance;
        },
        device);
}

inline double ArRobot::checkRangeDevicesCurrentBox(double x1, double y1, double x2, double y2,
                                                   ArPose* reading,
                                                   const ArRangeDevice** device) const {
    return nearest(
        [&](const ArRangeDevice& candidate, double least) {
            ArPose at;
            const double distance = candidate.currentReadingBox(x1, y1, x2, y2, &at);
            if (reading && distance < least) *reading = at;
            return distance;
        },
        device);
}

inline double ArRobot::checkRangeDevicesCumulativeBox(double x1, double y1, double x2, double y2,
                                                      ArPose* reading,
                                                      const ArRangeDevice** device) const {
    return nearest(
        [&](const ArRangeDevice& candidate, double least) {
            ArPose at;
            const double distance = candidate.cumulativeReadingBox(x1, y1, x2, y2, &at);
            if (reading && distance < least) *reading = at;
            return distance;
        },
        device);
}

inline bool ArRobot::addLaser(ArLaser* laser, int number, bool addAsRangeDevice) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    if (!laser || hasLaser(number)) return false;
    myLasers[number] = laser;
    if (addAsRangeDevice)
        addRangeDevice(laser);
    else
        laser->setRobot(this);
    return true;
}

inline bool ArRobot::remLaser(int number) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    ArLaser* const laser = findLaser(number);
    if (!laser) return false;
    remRangeDevice(laser);
    myLasers.erase(number);
    return true;
}

inline ArLaser* ArRobot::findLaser(int number) {
    const auto found = myLasers.find(number);
    return found == myLasers.end() ? nullptr : found->second;
}

inline const ArLaser* ArRobot::findLaser(int number) const {
    const auto found = myLasers.find(number);
    return found == myLasers.end() ? nullptr : found->second;
}

inline bool ArRobotConfigPacketReader::requestPacket() {
    if (!myRobot) return true;
    if (!myRobot->isConnected() || (myOnlyOnce && myRequested)) return false;
    // The cycle may answer as soon as it knows the handler.
    myRobot->lock();
    if (!myHandler) myHandler.reset(new Handler(this, &ArRobotConfigPacketReader::arrive));
    myRobot->remPacketHandler(myHandler.get());
    myRobot->addPacketHandler(myHandler.get(), ArListPos::FIRST);
    myRequested = true;
    myHasArrived = false;
    myRobot->unlock();
    return myRobot->comInt(ArCommands::CONFIG, 1);
}

inline bool ArRobotConfigPacketReader::arrive(ArRobotPacket* /*packet*/) {
    myRobot->remPacketHandler(myHandler.get());
    // Another thread may read the figures of an earlier request: the same are not written again.
    const sim_aria::FirmwareFigures& figures = myRobot->getOrigRobotConfig()->myFigures;
    if (!(myFigures == figures)) myFigures = figures;
    myHasArrived.store(true, std::memory_order_release);
    if (myArrivedCB) myArrivedCB->invoke();
    return false;
}

/// The robot may have been destroyed before.
inline ArRobotConfigPacketReader::~ArRobotConfigPacketReader() {
    if (!myHandler) return;
    for (ArRobot* robot : *Aria::getRobotList())
        if (robot == myRobot) robot->remPacketHandler(myHandler.get());
}

#endif  // SIM_ARIA_ROBOT_PARTS_H
