// SPDX-License-Identifier: GPL-3.0-or-later
// Implementation of ArRobot: connecting, the cycle, commands. Part of sim_aria/robot.h.
//
// A cycle reads a packet, calls handlers and tasks of interpretation, resolves the actions, sends
// changed speeds, and calls user tasks, all with the lock held. A cycle that begins late is not
// made up for. With the clock `step` the cycle has no thread: Clock calls it while the program
// sleeps.
#ifndef SIM_ARIA_ROBOT_CYCLE_H
#define SIM_ARIA_ROBOT_CYCLE_H

#include <sim_aria/keys.h>
#include <sim_aria/robot.h>

inline bool ArRobot::blockingConnect(bool /*tryHarder*/) {
    const bool connected = connect();
    call(connected ? Connect : FailedConnect);
    return connected;
}

inline bool ArRobot::asyncConnect() {
    if (!myRunning) return false;
    myFailed = false;
    myConnectSoon = true;
    return true;
}

inline bool ArRobot::connect() {
    if (!myConnection || !myConnection->openSimple()) return false;
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    try {
        myLink.reset(new sim_aria::Link(myConnection->simulator(), myTimeout / 1000.0));
        adoptFigures();
        resetState();
        myMotorsEnabled = false;
        mySonarEnabled = true;
        myDirect = false;
        myTellsEncoders = myTellsSimulator = 0;
        mySentVel = mySentRotVel = 0;
        myMoved = myMovedFrom = ArPose();
        read();
    } catch (const ispace::client::Error& error) {
        ArLog::log(ArLog::Terse, "Could not connect to the robot: %s", error.what());
        myLink.reset();
        return false;
    }
    myStatus = myConnection->sharedStatus();
    myConnected = true;
    return true;
}

inline void ArRobot::adoptFigures() {
    sim_aria::FirmwareFigures& figures = myConfig.myFigures;
    figures.name = myLink->id();
    figures.sub_type = myParams.mySubClass = subTypeOf(myLink->model());
    figures.vel = myLink->maxVel();
    figures.rot_vel = myLink->maxRotVel();
    figures.accel = myLink->accel();
    figures.rot_accel = myLink->rotAccel();
    myParams.myRadius = myLink->radius();
    myParams.myFrontBumpers = myLink->frontBumpers();
    myParams.myRearBumpers = myLink->rearBumpers();
    mySonars.clear();
    for (const ArPose& at : myLink->sonars())
        mySonars.push_back(ArSensorReading(at.getX(), at.getY(), at.getTh()));
    myParams.myNumSonar = getNumSonar();
    figures.front_bumpers = myLink->frontBumpers();
    figures.rear_bumpers = myLink->rearBumpers();
    figures.sonars = getNumSonar();
    myParams.myLasers.clear();
    for (const std::string& id : myLink->lasers()) myParams.myLasers.push_back(myLink->mount(id));
    myMotion = sim_aria::Motion();
    myMotion.top_vel = myConfig.getTransVelTop();
    myMotion.top_rot_vel = myConfig.getRotVelTop();
    myMotion.max_vel = myConfig.getTransVelMax();
    myMotion.max_rot_vel = myConfig.getRotVelMax();
    myMotion.accel = myMotion.decel = myLink->accel();
    myMotion.rot_accel = myMotion.rot_decel = myLink->rotAccel();
}

inline bool ArRobot::disconnect() {
    {
        const std::lock_guard<std::recursive_mutex> hold(myMutex);
        if (!myLink) return true;
        try {
            myLink->close();
        } catch (const ispace::client::Error&) {
            // Already gone.
        }
        lose();
        if (myConnection) myConnection->close();
    }
    call(Disconnect);
    return true;
}

inline void ArRobot::dropConnection() {
    {
        const std::lock_guard<std::recursive_mutex> hold(myMutex);
        if (!myLink) return;
        lose();
    }
    call(Loss);
}

inline void ArRobot::lose() {
    myLink.reset();
    myConnected = false;
    myMotorsEnabled = false;
    myPacket.vel = myPacket.rot_vel = 0;
}

inline void ArRobot::read() {
    const sim_aria::Packet packet = myLink->read(mySonarEnabled);
    const double turn = ArMath::subAngle(myMoved.getTh(), myMovedFrom.getTh());
    const double dx = packet.pose.getX() - myMovedFrom.getX();
    const double dy = packet.pose.getY() - myMovedFrom.getY();
    const double c = ArMath::cos(turn), s = ArMath::sin(turn);
    ArPose pose(myMoved.getX() + c * dx - s * dy, myMoved.getY() + s * dx + c * dy,
                packet.pose.getTh() + turn);
    if (myCorrection && myConnected) {
        const ArPose change = packet.pose - myPacket.pose;
        pose.setTh(myPose.getTh() + myCorrection->invokeR(ArPoseWithTime(
                                        change.getX(), change.getY(), change.getTh())));
        myMoved = pose;
        myMovedFrom = packet.pose;
    }
    adopt(packet, pose);
    for (std::size_t i = 0; i < mySonars.size() && i < packet.sonar.size(); ++i)
        mySonars[i].newData(packet.sonar[i], myPose, myPacket.pose, getToGlobalTransform(),
                            myCounter, ArTime());
    for (ArRangeDevice* device : myDevices) {
        device->lockDevice();
        device->processReadings(packet.sonar.empty() ? std::vector<ArSensorReading>() : mySonars,
                                myPose);
        device->unlockDevice();
    }
}

/// Sends changed speeds; the server keeps them. Repeats both twice a second to a stalled robot,
/// since a Pioneer keeps pushing.
inline void ArRobot::send() {
    if (!myReflects) return;
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
    if (!myConnected && myConnectSoon.exchange(false)) myFailed = !blockingConnect();
    // Do not wait for ever if the program stops the robot while it holds the lock, or sleeps.
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    while (!myMutex.try_lock()) {
        if (!myRunning || std::chrono::steady_clock::now() > patience) return true;
        std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    {
        const std::lock_guard<std::recursive_mutex> hold(myMutex, std::adopt_lock);
        if (!myLink) return myConnected;
        try {
            ++myCounter;
            if (!myStatus || *myStatus == ArDeviceConnection::STATUS_OPEN) {
                read();
                think();
                return true;
            }
            ArLog::log(ArLog::Terse, "The program has closed the connection to the robot");
        } catch (const ispace::client::Error& error) {
            ArLog::log(ArLog::Terse, "Lost the robot: %s", error.what());
            int open = ArDeviceConnection::STATUS_OPEN;
            if (myStatus)
                myStatus->compare_exchange_strong(open, ArDeviceConnection::STATUS_CLOSED_ERROR);
        }
        lose();
    }
    call(Loss);
    return false;
}

/// The tasks of a cycle; each may end the connection.
inline void ArRobot::think() {
    handlePackets();
    for (const auto& task : std::list<Tasks::Item>(mySensorTasks.items())) task.call->invoke();
    if (myLink) resolveActions();
    if (myLink) send();
    if (myKeys) myKeys->checkKeys();
    for (const auto& task : std::list<Tasks::Item>(myUserTasks.items())) task.call->invoke();
}

inline void ArRobot::handlePackets() {
    if (!myHandlers.empty()) {
        handle(statusPacket());
        if (myTellsEncoders > 0) handle(encoderPacket());
        if (myTellsSimulator > 0 && myLink)
            handle(simulatorPacket(myLink->truePose(), myCycleTime));
    }
    if (myTellsEncoders < kEachCycle) myTellsEncoders = 0;
    if (myTellsSimulator < kEachCycle) myTellsSimulator = 0;
}

inline void ArRobot::handle(ArRobotPacket packet) {
    for (auto* handler : std::list<ArRetFunctor1<bool, ArRobotPacket*>*>(myHandlers)) {
        packet.resetRead();
        if (handler->invokeR(&packet)) break;
    }
}

inline ArPose ArRobot::poseInSimulator() {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    try {
        if (myLink) return myLink->truePose();
    } catch (const ispace::client::Error&) {
        // The next cycle notices.
    }
    return ArPose();
}

inline bool ArRobot::placeInSimulator(const ArPose& to) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    if (!myLink) return false;
    try {
        myLink->place(to);
        mySentVel = mySentRotVel = 0;
    } catch (const ispace::client::Error& error) {
        ArLog::log(ArLog::Terse, "Could not place the robot: %s", error.what());
        return false;
    }
    return true;
}

/// Lets the actions move the robot, unless the program does.
inline void ArRobot::resolveActions() {
    if (myDirect && myPrecedence > 0 && myDirectSince.mSecSince() >= myPrecedence)
        clearDirectMotion();
    if (myDirect || myActions.empty()) return;
    const ArActionDesired* const wish = myResolver->resolve(&myActions, this);
    if (!wish) return;
    constexpr double kMin = ArActionDesired::MIN_STRENGTH, kNoLimit = 1e9;
    myMotion.limit(
        wish->getMaxVelStrength() >= kMin ? std::max(0.0, wish->getMaxVel()) : kNoLimit,
        wish->getMaxNegVelStrength() >= kMin ? -std::fabs(wish->getMaxNegVel()) : -kNoLimit,
        wish->getMaxRotVelStrength() >= kMin ? std::fabs(wish->getMaxRotVel()) : kNoLimit);
    if (wish->getVelStrength() >= kMin) myMotion.setVel(wish->getVel());
    if (wish->getDeltaHeadingStrength() >= kMin)
        myMotion.setHeading(ArMath::addAngle(getTh(), wish->getDeltaHeading()));
    else if (wish->getRotVelStrength() >= kMin)
        myMotion.setRotVel(wish->getRotVel());
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
    ended();
}

/// The world advances while the program sleeps, and so does the robot.
inline void ArRobot::runBySteps(bool stop_if_not_connected) {
    sim_aria::Clock::get().add(this, myCycleTime, [this, stop_if_not_connected] {
        if (!myRunning) return;
        cycle();
        if (!stop_if_not_connected || myConnected) return;
        sim_aria::Clock::get().remove(this);
        ended();
    });
}

inline void ArRobot::ended() {
    if (myRunning.exchange(false)) call(RunExit);
}

inline void ArRobot::runAsync(bool stopRunIfNotConnected, bool) {
    if (myRunning) return;
    if (myThread.joinable()) myThread.join();
    myRunning = true;
    if (sim_aria::Clock::get().bySteps()) return runBySteps(stopRunIfNotConnected);
    myInThread = true;
    myThread = std::thread([this, stopRunIfNotConnected] {
        loop(stopRunIfNotConnected);
        myInThread = false;
    });
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
    sim_aria::Clock::get().remove(this);
    ended();
    if (myThread.joinable() && myThread.get_id() != std::this_thread::get_id()) myThread.join();
    if (doDisconnect) disconnect();
}

/// At the end of the process or of the object: a thread that waits for this end cannot be joined.
inline void ArRobot::end() {
    sim_aria::Clock::get().remove(this);
    ended();
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(2);
    const auto wait = [&] {
        std::this_thread::sleep_for(std::chrono::microseconds(200));
        return std::chrono::steady_clock::now() < patience;
    };
    const bool self = myThread.get_id() == std::this_thread::get_id();
    while (!self && myInThread && wait()) {
    }
    if (myThread.joinable() && !self && !myInThread) myThread.join();
    if (myThread.joinable()) myThread.detach();
    bool locked = false;
    while (!(locked = myMutex.try_lock()) && wait()) {
    }
    if (!locked) return;
    const std::lock_guard<std::recursive_mutex> hold(myMutex, std::adopt_lock);
    disconnect();
}

inline ArRobot::WaitState ArRobot::waitForRunExit(unsigned int msecs) {
    const ArTime begun;
    while (myRunning) {
        if (msecs > 0 && begun.mSecSince() >= static_cast<long>(msecs)) return WAIT_TIMEDOUT;
        ArUtil::sleep(10);
    }
    return WAIT_RUN_EXIT;
}

inline ArRobot::WaitState ArRobot::waitForConnect(unsigned int msecs) {
    const ArTime begun;
    while (!myConnected) {
        if (!myRunning) return WAIT_RUN_EXIT;
        if (msecs > 0 && begun.mSecSince() >= static_cast<long>(msecs)) return WAIT_TIMEDOUT;
        ArUtil::sleep(10);
    }
    return WAIT_CONNECTED;
}

inline ArRobot::WaitState ArRobot::waitForConnectOrConnFail(unsigned int msecs) {
    const ArTime begun;
    while (!myConnected) {
        if (myFailed) return WAIT_FAILED_CONN;
        if (!myRunning) return WAIT_RUN_EXIT;
        if (msecs > 0 && begun.mSecSince() >= static_cast<long>(msecs)) return WAIT_TIMEDOUT;
        ArUtil::sleep(10);
    }
    return WAIT_CONNECTED;
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
        case ArCommands::ENCODER:
            myTellsEncoders = argument;
            break;
        case ArCommands::SIM_STAT:
            myTellsSimulator = argument;
            break;
        case ArCommands::SETO:
            moveTo(ArPose());
            break;
        default:
            break;
    }
    return true;
}

/// VEL2 has the speeds of the wheels in units of 20 mm/s: the left one's is the high byte, with a
/// sign whether or not `char` has one.
inline bool ArRobot::com2Bytes(unsigned char command, char high, char low) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    if (command == ArCommands::VEL2)
        setVel2(20.0 * static_cast<signed char>(high), 20.0 * static_cast<signed char>(low));
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

inline void ArRobot::moveTo(ArPose pose, bool doCumulative) {
    const std::lock_guard<std::recursive_mutex> hold(myMutex);
    const ArTransform change(myPose, pose);
    for (ArRangeDevice* device : myDevices) {
        device->lockDevice();
        device->applyTransform(change, doCumulative);
        device->unlockDevice();
    }
    for (ArSensorReading& sonar : mySonars) sonar.applyTransform(change);
    movePast(change);
    myMoved = pose;
    myMovedFrom = myPacket.pose;
    myPose = pose;
}

#endif  // SIM_ARIA_ROBOT_CYCLE_H
