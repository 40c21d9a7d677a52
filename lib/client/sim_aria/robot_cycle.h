// SPDX-License-Identifier: GPL-3.0-or-later
// Implementation of ArRobot: connecting, the cycle, commands. Part of sim_aria/robot.h.
#ifndef SIM_ARIA_ROBOT_CYCLE_H
#define SIM_ARIA_ROBOT_CYCLE_H

#include <sim_aria/robot.h>

inline bool ArRobot::blockingConnect(bool /*tryHarder*/) {
    if (!myConnection || !myConnection->openSimple()) return false;
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    try {
        myLink.reset(new sim_aria::Link(myConnection->simulator(), myTimeout / 1000.0));
        myRobotName = myLink->id();
        mySubType = subTypeOf(myLink->model());
        myRadius = myLink->radius();
        myFrontBumpers = myLink->frontBumpers();
        myRearBumpers = myLink->rearBumpers();
        myMotion = sim_aria::Motion();
        myMotion.max_vel = myLink->maxVel();
        myMotion.max_rot_vel = myLink->maxRotVel();
        myMotion.accel = myLink->accel();
        myMotion.rot_accel = myLink->rotAccel();
        myMotorsEnabled = false;
        mySonarEnabled = true;
        mySentVel = mySentRotVel = 0;
        myMoved = myMovedFrom = ArPose();
        mySonars.clear();
        for (const ArPose& at : myLink->sonars())
            mySonars.push_back(ArSensorReading(at.getX(), at.getY(), at.getTh()));
        read();
    } catch (const ispace::client::Error& error) {
        ArLog::log(ArLog::Terse, "Could not connect to the robot: %s", error.what());
        myLink.reset();
        return false;
    }
    myConnected = true;
    return true;
}

inline bool ArRobot::disconnect() {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    if (!myLink) return true;
    try {
        myLink->close();
    } catch (const ispace::client::Error&) {
        // Already gone.
    }
    lose();
    if (myConnection) myConnection->close();
    return true;
}

inline void ArRobot::lose() {
    myLink.reset();
    myConnected = false;
    myMotorsEnabled = false;
    myPacket.vel = myPacket.rot_vel = 0;
}

inline void ArRobot::read() {
    myPacket = myLink->read(mySonarEnabled);
    const double turn = ArMath::subAngle(myMoved.getTh(), myMovedFrom.getTh());
    const double dx = myPacket.pose.getX() - myMovedFrom.getX();
    const double dy = myPacket.pose.getY() - myMovedFrom.getY();
    const double c = ArMath::cos(turn), s = ArMath::sin(turn);
    myPose.setPose(myMoved.getX() + c * dx - s * dy, myMoved.getY() + s * dx + c * dy,
                   myPacket.pose.getTh() + turn);
    for (std::size_t i = 0; i < mySonars.size() && i < myPacket.sonar.size(); ++i)
        mySonars[i].newData(myPacket.sonar[i], myPose, myCounter);
    for (ArRangeDevice* device : myDevices) {
        device->lockDevice();
        device->processReadings(myPacket.sonar.empty() ? std::vector<ArSensorReading>() : mySonars,
                                myPose);
        device->unlockDevice();
    }
}

/// Sends changed speeds; the server keeps them. Repeats both twice a second to a stalled robot,
/// since a Pioneer keeps pushing.
inline void ArRobot::send() {
    const double vel = myMotorsEnabled ? myMotion.vel(myPose) : 0;
    const double rot_vel = myMotorsEnabled ? myMotion.rotVel(myPose) : 0;
    const bool changed = vel != mySentVel || rot_vel != mySentRotVel;
    const bool moves = vel != 0 || rot_vel != 0;
    const bool again = myPacket.stalled && (changed || (moves && mySent.mSecSince() >= 500));
    if (!changed && !again) return;
    if (vel != mySentVel || again) myLink->vel(vel);
    if (rot_vel != mySentRotVel || again) myLink->rotVel(rot_vel);
    mySentVel = vel;
    mySentRotVel = rot_vel;
    mySent.setToNow();
}

/// \return false if the connection was lost
inline bool ArRobot::cycle() {
    // Do not wait for ever if the program stops the robot while it holds the lock, or sleeps.
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    while (!myMutex.try_lock()) {
        if (!myRunning || std::chrono::steady_clock::now() > patience) return true;
        std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    const std::lock_guard<std::recursive_mutex> hold(myMutex, std::adopt_lock);
    if (!myLink) return myConnected;
    try {
        ++myCounter;
        read();
        for (ArFunctor* task : std::list<ArFunctor*>(myTasks)) task->invoke();
        if (myLink) send();
    } catch (const ispace::client::Error& error) {
        ArLog::log(ArLog::Terse, "Lost the robot: %s", error.what());
        lose();
        if (myConnection) myConnection->setStatus(ArDeviceConnection::STATUS_CLOSED_ERROR);
        return false;
    }
    return true;
}

inline void ArRobot::loop(bool stop_if_not_connected) {
    sim_aria::Clock& clock = sim_aria::Clock::get();
    double due = clock.now();
    while (myRunning && !clock.bySteps()) {
        cycle();
        if (stop_if_not_connected && !myConnected) break;
        due += myCycleTime;
        const double now = clock.now();
        if (due > now) {
            clock.sleep(due - now);
        } else {
            due = now;
        }
    }
    if (myRunning && clock.bySteps()) return runBySteps(stop_if_not_connected);
    myRunning = false;
}

/// The world advances while the program sleeps, and so does the robot.
inline void ArRobot::runBySteps(bool stop_if_not_connected) {
    sim_aria::Clock::get().add(this, myCycleTime, [this, stop_if_not_connected] {
        if (!myRunning) return;
        cycle();
        if (!stop_if_not_connected || myConnected) return;
        myRunning = false;
        sim_aria::Clock::get().remove(this);
    });
}

inline void ArRobot::runAsync(bool stopRunIfNotConnected, bool) {
    if (myRunning) return;
    if (myThread.joinable()) myThread.join();
    myRunning = true;
    if (sim_aria::Clock::get().bySteps()) return runBySteps(stopRunIfNotConnected);
    myThread = std::thread([this, stopRunIfNotConnected] { loop(stopRunIfNotConnected); });
}

inline void ArRobot::run(bool stopRunIfNotConnected, bool) {
    if (myRunning) return;
    if (sim_aria::Clock::get().bySteps()) {
        runAsync(stopRunIfNotConnected);
        while (myRunning) sim_aria::Clock::get().sleep(myCycleTime);
        return;
    }
    myRunning = true;
    loop(stopRunIfNotConnected);
}

inline void ArRobot::stopRunning(bool doDisconnect) {
    myRunning = false;
    sim_aria::Clock::get().remove(this);
    if (myThread.joinable() && myThread.get_id() != std::this_thread::get_id()) myThread.join();
    if (doDisconnect) disconnect();
}

inline void ArRobot::end() {
    stopRunning(true);
    // A robot destroyed within its own cycle cannot be joined.
    if (myThread.joinable()) myThread.detach();
}

inline ArRobot::WaitState ArRobot::waitForRunExit(unsigned int msecs) {
    const ArTime begun;
    while (myRunning) {
        if (msecs > 0 && begun.mSecSince() >= static_cast<long>(msecs)) return WAIT_TIMEDOUT;
        ArUtil::sleep(10);
    }
    return WAIT_RUN_EXIT;
}

inline bool ArRobot::addUserTask(const char*, int, ArFunctor* functor) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    myTasks.push_back(functor);
    return true;
}

inline void ArRobot::remUserTask(ArFunctor* functor) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    myTasks.remove(functor);
}

inline bool ArRobot::comInt(unsigned char command, short argument) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    if (!myLink) return false;
    switch (command) {
        case ArCommands::ENABLE:
            myMotorsEnabled = argument != 0;
            break;
        case ArCommands::SONAR:
            mySonarEnabled = argument != 0;
            break;
        case ArCommands::VEL:
            setVel(argument);
            break;
        case ArCommands::RVEL:
            setRotVel(argument);
            break;
        case ArCommands::MOVE:
            move(argument);
            break;
        case ArCommands::HEAD:
            setHeading(argument);
            break;
        case ArCommands::DHEAD:
        case ArCommands::ROTATE:
            setDeltaHeading(argument);
            break;
        case ArCommands::STOP:
        case ArCommands::ESTOP:
            stop();
            break;
        case ArCommands::SETO:
            moveTo(ArPose());
            break;
        default:
            break;
    }
    return true;
}

/// VEL2 has the speeds of the wheels in units of 20 mm/s.
inline bool ArRobot::com2Bytes(unsigned char command, char high, char low) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    if (command == ArCommands::VEL2) setVel2(20.0 * low, 20.0 * high);
    return myLink != nullptr;
}

inline void ArRobot::stop() {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    setVel(0);
    setRotVel(0);
    if (!myLink) return;
    try {
        myLink->stop();
        mySentVel = mySentRotVel = 0;
    } catch (const ispace::client::Error&) {
        // The next cycle notices.
    }
}

inline void ArRobot::moveTo(ArPose pose) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    myMoved = pose;
    myMovedFrom = myPacket.pose;
    myPose = pose;
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
    return myDevices.size() < before;
}

inline bool ArRobot::remRangeDevice(const char* name) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    for (ArRangeDevice* device : myDevices)
        if (std::string(device->getName()) == name) return remRangeDevice(device);
    return false;
}

inline int ArRobot::getClosestSonarRange(double startDeg, double endDeg) const {
    int nearest = -1;
    for (const ArSensorReading& sonar : mySonars) {
        if (!ArMath::angleBetween(sonar.getSensorTh(), startDeg, endDeg)) continue;
        if (nearest < 0 || sonar.getRange() < nearest) nearest = sonar.getRange();
    }
    return nearest;
}

#endif  // SIM_ARIA_ROBOT_CYCLE_H
