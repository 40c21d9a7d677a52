// SPDX-License-Identifier: GPL-3.0-or-later
// Implementation of ArLaser. Part of sim_aria/robot.h.
#ifndef SIM_ARIA_LASER_SCAN_H
#define SIM_ARIA_LASER_SCAN_H

#include <cmath>
#include <cstddef>
#include <list>
#include <string>
#include <vector>

#include <sim_aria/laser.h>
#include <sim_aria/robot.h>

inline bool ArLaser::blockingConnect() {
    if (myConnected) return true;
    ArRobot* const robot = getRobot();
    if (!robot) return false;
    robot->lock();
    try {
        const std::vector<std::string> lasers =
            robot->link() ? robot->link()->lasers() : std::vector<std::string>();
        const std::size_t index = static_cast<std::size_t>(myNumber) - 1;
        if (myId.empty() && index < lasers.size()) myId = lasers[index];
        if (robot->link() && !myId.empty()) {
            const ispace::client::Fields figures = robot->link()->laser(myId);
            myStart = figures.number("angle_min");
            myEnd = figures.number("angle_max");
            myStep = figures.number("step");
            setMaxRange(
                static_cast<unsigned int>(ArMath::roundInt(1000 * figures.number("range_max"))));
            setCurrentBufferSize(static_cast<std::size_t>(figures.integer("n")));
            mySensor = robot->link()->mount(myId);
            adopt(robot->link()->scan(myId));
            robot->addSensorInterpTask(getName(), 90, &myTask);
            myReader = robot;
            myConnected = true;
        }
    } catch (const ispace::client::Error& error) {
        ArLog::log(ArLog::Terse, "Could not connect to the laser %s: %s", getName(), error.what());
    }
    robot->unlock();
    return myConnected;
}

inline bool ArLaser::disconnect() {
    // The robot may be gone; then it has no task.
    if (myConnected && getRobot() == myReader && myReader) {
        myReader->remSensorInterpTask(&myTask);
        if (myReader->findLaser(myNumber) == this) myReader->remLaser(myNumber);
    }
    myConnected = false;
    myReader = nullptr;
    return true;
}

/// Reads the newest scan in each cycle of the robot.
inline void ArLaser::update() {
    ArRobot* const robot = getRobot();
    if (!robot || !robot->link()) return;
    const ispace::client::Scan scan = robot->link()->scan(myId);
    if (scan.seq == mySeq) return;
    lockDevice();
    adopt(scan);
    unlockDevice();
    for (ArFunctor* callback : std::list<ArFunctor*>(myCallbacks)) callback->invoke();
}

inline void ArLaser::adopt(const ispace::client::Scan& scan) {
    mySeq = scan.seq;
    ++myCount;
    if (myReadings.size() != scan.ranges.size()) {
        myReadings.assign(scan.ranges.size(), ArSensorReading());
        myPointers.clear();
        for (ArSensorReading& reading : myReadings) myPointers.push_back(&reading);
    }
    // The robot has moved since the scan.
    const ArPose taken = getRobot()->poseAt(scan.time);
    const ArTransform to_global(taken);
    myCurrentBuffer.clear();
    for (std::size_t k = 0; k < scan.ranges.size(); ++k) {
        const bool returned = std::isfinite(scan.ranges[k]);
        const double range =
            returned ? 1000.0 * static_cast<double>(scan.ranges[k]) : getMaxRange();
        const bool counts = returned && range >= myMinRange;
        ArSensorReading& reading = myReadings[k];
        reading.resetSensorPosition(mySensor.getX(), mySensor.getY(),
                                    mySensor.getTh() + scan.angle(k));
        reading.newData(range, taken, getRobot()->getEncoderPose(), to_global,
                        getRobot()->getCounter(), ArTime(), !counts);
        if (counts) myCurrentBuffer.addReading(reading.getX(), reading.getY());
    }
}

#endif  // SIM_ARIA_LASER_SCAN_H
