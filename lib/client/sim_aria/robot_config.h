// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of a robot's firmware, as programs request them by the packet CONFIG.
#ifndef SIM_ARIA_ROBOT_CONFIG_H
#define SIM_ARIA_ROBOT_CONFIG_H

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>

#include <sim_aria/functor_kinds.h>
#include <sim_aria/math.h>
#include <sim_aria/packet.h>
#include <sim_aria/util.h>

class ArRobot;

namespace sim_aria {

/// Figures of a robot that its firmware reports, mm and degrees.
struct FirmwareFigures {
    std::string name, sub_type;
    double vel = 0, rot_vel = 0, accel = 0, rot_accel = 0;
    int front_bumpers = 0, rear_bumpers = 0, sonars = 0;
    friend bool operator==(const FirmwareFigures& a, const FirmwareFigures& b) {
        return a.name == b.name && a.sub_type == b.sub_type && a.vel == b.vel &&
               a.rot_vel == b.rot_vel && a.accel == b.accel && a.rot_accel == b.rot_accel &&
               a.front_bumpers == b.front_bumpers && a.rear_bumpers == b.rear_bumpers &&
               a.sonars == b.sonars;
    }
};

}  // namespace sim_aria

/// Figures that the firmware reports in a packet CONFIG: of the robot that holds this reader, or of
/// another, which answers a request in its next cycle.
class ArRobotConfigPacketReader {
  public:
    ArRobotConfigPacketReader() {}
    /// \param onlyOneRequest whether later requests return false
    /// \param packetedArrivedCB called with the arrival, in the cycle of the robot
    explicit ArRobotConfigPacketReader(ArRobot* robot, bool onlyOneRequest = false,
                                       ArFunctor* packetedArrivedCB = nullptr)
        : myRobot(robot),
          myOnlyOnce(onlyOneRequest),
          myArrivedCB(packetedArrivedCB),
          myHasArrived(false) {}
    ~ArRobotConfigPacketReader();
    ArRobotConfigPacketReader(const ArRobotConfigPacketReader&) = delete;
    ArRobotConfigPacketReader& operator=(const ArRobotConfigPacketReader&) = delete;

    /// \return false if not connected, or the only request was made
    bool requestPacket();
    bool hasPacketBeenRequested() const { return !myRobot || myRequested; }
    /// Then the figures stay as they are, also if read beside the cycle of the robot.
    bool hasPacketArrived() const { return myHasArrived.load(std::memory_order_acquire); }
    const char* getType() const { return "Pioneer"; }
    const char* getSubType() const { return myFigures.sub_type.c_str(); }
    const char* getName() const { return myFigures.name.c_str(); }
    const char* getSerialNumber() const { return "simrun"; }
    const char* getFirmwareVersion() const { return "simrun"; }
    /// 0: no gyroscope
    int getGyroType() const { return 0; }
    bool getHasGyro() const { return false; }
    bool getHasCharger() const { return false; }
    bool getHasGripper() const { return false; }
    bool getFrontSonar() const { return myFigures.sonars > 0; }
    bool getRearSonar() const { return myFigures.sonars > kFrontSonars; }
    int getNumFrontBumpers() const { return myFigures.front_bumpers; }
    int getNumRearBumpers() const { return myFigures.rear_bumpers; }
    int getConfigFlags() const { return 0; }
    int getTransVelTop() const { return static_cast<int>(myFigures.vel + kNear); }
    int getRotVelTop() const { return static_cast<int>(myFigures.rot_vel + kNear); }
    int getTransAccelTop() const { return ArMath::roundInt(myFigures.accel); }
    int getRotAccelTop() const { return ArMath::roundInt(myFigures.rot_accel); }
    /// Limits until a program sets others, as a Pioneer's firmware has them.
    int getTransVelMax() const { return std::min(750, getTransVelTop()); }
    int getRotVelMax() const { return std::min(100, getRotVelTop()); }
    int getTransAccel() const { return getTransAccelTop(); }
    int getTransDecel() const { return getTransAccelTop(); }
    int getRotAccel() const { return getRotAccelTop(); }
    int getRotDecel() const { return getRotAccelTop(); }
    int getSipCycleTime() const { return 100; }
    int getSonarCycle() const { return 100; }
    void log() const {
        ArLog::log(ArLog::Terse, "%s %s: %d sonars, %d front and %d rear bumpers", getName(),
                   getSubType(), myFigures.sonars, getNumFrontBumpers(), getNumRearBumpers());
        logMovement();
    }
    void logMovement() const {
        ArLog::log(ArLog::Terse, "%s: at most %d mm/s, %d deg/s, accelerations %d mm/s2, %d deg/s2",
                   getName(), getTransVelTop(), getRotVelTop(), getTransAccelTop(),
                   getRotAccelTop());
    }

  private:
    friend class ArRobot;
    using Handler = ArRetFunctor1C<bool, ArRobotConfigPacketReader, ArRobotPacket*>;

    bool arrive(ArRobotPacket* packet);

    static constexpr double kNear = 1e-6;  // of metres in mm
    static constexpr int kFrontSonars = 8;

    sim_aria::FirmwareFigures myFigures;
    ArRobot* myRobot = nullptr;
    bool myOnlyOnce = false, myRequested = false;
    ArFunctor* myArrivedCB = nullptr;
    std::unique_ptr<Handler> myHandler;
    std::atomic<bool> myHasArrived{true};
};

#endif  // SIM_ARIA_ROBOT_CONFIG_H
