// SPDX-License-Identifier: GPL-3.0-or-later
// The true pose of a robot, which simulators know and real robots do not: to judge odometry, or to
// set a robot elsewhere.
#ifndef SIM_ARIA_SIM_UTIL_H
#define SIM_ARIA_SIM_UTIL_H

#include <sim_aria/functor_kinds.h>
#include <sim_aria/gps_coords.h>
#include <sim_aria/robot.h>
#include <sim_aria/thread.h>

/// What a simulator knows of a robot: its true pose in the room, in whole mm and degrees. A robot
/// without a connection stays at 0, 0.
class ArSimUtil {
  public:
    explicit ArSimUtil(ArRobot* robot) : myRobot(robot), myPoseFunc(this, &ArSimUtil::pose) {}
    virtual ~ArSimUtil() {}
    ArSimUtil(const ArSimUtil&) = delete;
    ArSimUtil& operator=(const ArSimUtil&) = delete;

    void lock() { myMutex.lock(); }
    void unlock() { myMutex.unlock(); }

    ArPose getSimTruePose() { return pose(); }
    double getSimTrueX() { return pose().getX(); }
    double getSimTrueY() { return pose().getY(); }
    double getSimTrueTh() { return pose().getTh(); }
    ArRetFunctor<ArPose>* getSimTruePoseFunc() { return &myPoseFunc; }
    /// Moves the robot there; its odometry does not change. \return false if it is not connected,
    /// or would overlap a body there
    bool setSimTruePose(const ArPose& to) { return myRobot->placeInSimulator(to); }

    /// Rooms have no place on the earth, and the errors of odometry are no pose.
    ArLLACoords getSimGPSPos() const { return ArLLACoords(); }
    bool getHaveSimOdomError() const { return false; }
    ArPose getSimOdomError() const { return ArPose(); }

  private:
    ArPose pose() {
        const ArPose at = myRobot->poseInSimulator();
        myMutex.lock();
        if (myRobot->isConnected()) myPose = at;
        const ArPose last = myPose;
        myMutex.unlock();
        return last;
    }

    ArRobot* myRobot;
    ArMutex myMutex;
    ArPose myPose;
    ArRetFunctorC<ArPose, ArSimUtil> myPoseFunc;
};

#endif  // SIM_ARIA_SIM_UTIL_H
