// SPDX-License-Identifier: GPL-3.0-or-later
// The getters of ArRobot, which lie on the newest packet: pose, speeds, sonars, bumpers, battery.
// Hold the robot's lock around them.
#ifndef SIM_ARIA_ROBOT_STATE_H
#define SIM_ARIA_ROBOT_STATE_H

#include <atomic>
#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include <sim_aria/interpolation.h>
#include <sim_aria/link.h>
#include <sim_aria/packet.h>
#include <sim_aria/range_device.h>
#include <sim_aria/robot_config.h>
#include <sim_aria/robot_params.h>

namespace sim_aria {

/// State of a robot as of its last status packet; base of ArRobot. Packets have the layout of a
/// Pioneer's server information packets (Pioneer 3 Operations Manual), little-endian, so that
/// programs which parse them find their fields.
class RobotState {
  public:
    enum ChargeState {
        CHARGING_UNKNOWN = -1,
        CHARGING_NOT = 0,
        CHARGING_BULK = 1,
        CHARGING_OVERCHARGE = 2,
        CHARGING_FLOAT = 3,
        CHARGING_BALANCE = 4
    };

    double getVel() const { return myPacket.vel; }
    double getRotVel() const { return myPacket.rot_vel; }
    double getLeftVel() const { return myPacket.vel - wheelVel(); }
    double getRightVel() const { return myPacket.vel + wheelVel(); }
    bool hasLatVel() const { return false; }
    double getLatVel() const { return 0; }
    ArPose getPose() const { return myPose; }
    /// Distance (mm), direction and turn (degrees) from the robot to a point.
    double findDistanceTo(ArPose to) const { return myPose.findDistanceTo(to); }
    double findAngleTo(ArPose to) const { return myPose.findAngleTo(to); }
    double findDeltaHeadingTo(ArPose to) const {
        return ArMath::subAngle(findAngleTo(to), getTh());
    }
    double getX() const { return myPose.getX(); }
    double getY() const { return myPose.getY(); }
    double getTh() const { return myPose.getTh(); }
    /// Pose by the wheels since the connection, independent of moveTo().
    ArPose getEncoderPose() const { return myPacket.pose; }
    ArPose getRawEncoderPose() const { return myPacket.pose; }
    /// Pose at a time, see ArInterpolation::getPose().
    int getPoseInterpPosition(ArTime timeStamp, ArPose* position,
                              ArPoseWithTime* mostRecent = nullptr) {
        return myPoses.getPose(timeStamp, position, mostRecent);
    }
    int getEncoderPoseInterpPosition(ArTime timeStamp, ArPose* position,
                                     ArPoseWithTime* mostRecent = nullptr) {
        return myEncoderPoses.getPose(timeStamp, position, mostRecent);
    }
    std::size_t getPoseInterpNumReadings() const { return myPoses.getNumberOfReadings(); }
    void setPoseInterpNumReadings(std::size_t number) { myPoses.setNumberOfReadings(number); }
    std::size_t getEncoderPoseInterpNumReadings() const {
        return myEncoderPoses.getNumberOfReadings();
    }
    void setEncoderPoseInterpNumReadings(std::size_t number) {
        myEncoderPoses.setNumberOfReadings(number);
    }
    /// From the frame of the robot to that of its pose.
    ArTransform getToGlobalTransform() const { return ArTransform(myPose); }
    ArTransform getToLocalTransform() const { return ArTransform(myPose, ArPose()); }
    ArTransform getEncoderTransform() const { return ArTransform(myPacket.pose, myPose); }
    /// mm and degrees driven since the connection or the last reset.
    double getOdometerDistance() const { return myDistance; }
    double getOdometerDegrees() const { return myTurn; }
    void resetOdometer() { myDistance = myTurn = 0; }
    /// Travel of the wheels since the connection, 128 to a mm.
    long getLeftEncoder() const { return std::lround(kTicks * (myTravel - myWheelTurn)); }
    long getRightEncoder() const { return std::lround(kTicks * (myTravel + myWheelTurn)); }

    /// A simulated robot stalls as a whole.
    bool isLeftMotorStalled() const { return myPacket.stalled; }
    bool isRightMotorStalled() const { return myPacket.stalled; }
    /// Bits 0 and 8: the motors; bumpers clockwise, front ones from bit 9 on, rear ones from bit 1
    /// on.
    int getStallValue() const {
        return myPacket.bumpers | (myPacket.stalled ? ArUtil::BIT0 | ArUtil::BIT8 : 0);
    }
    bool hasFrontBumpers() const { return getNumFrontBumpers() > 0; }
    bool hasRearBumpers() const { return getNumRearBumpers() > 0; }
    unsigned int getNumFrontBumpers() const {
        return static_cast<unsigned int>(myParams.numFrontBumpers());
    }
    unsigned int getNumRearBumpers() const {
        return static_cast<unsigned int>(myParams.numRearBumpers());
    }
    bool hasTableSensingIR() const { return false; }
    bool isLeftTableSensingIRTriggered() const { return false; }
    bool isRightTableSensingIRTriggered() const { return false; }
    bool isLeftBreakBeamTriggered() const { return false; }
    bool isRightBreakBeamTriggered() const { return false; }
    bool isEStopPressed() const { return false; }
    bool getEstop() const { return false; }
    int getFlags() const { return myMotorsEnabled ? ArUtil::BIT0 : 0; }
    /// Flags of later robots, which a Pioneer's packets do not have.
    bool hasFaultFlags() const { return false; }
    int getFaultFlags() const { return 0; }
    bool hasFlags3() const { return false; }
    int getFlags3() const { return 0; }
    bool hasSettableVelMaxes() const { return true; }
    bool hasSettableAccsDecs() const { return true; }
    bool areMotorsEnabled() const { return myMotorsEnabled; }
    bool areSonarsEnabled() const { return mySonarEnabled; }
    /// Voltage of a full battery; its charge is not simulated.
    double getBatteryVoltage() const { return 13; }
    double getBatteryVoltageNow() const { return 13; }
    double getRealBatteryVoltage() const { return 13; }
    double getRealBatteryVoltageNow() const { return 13; }
    bool hasStateOfCharge() const { return false; }
    bool haveStateOfCharge() const { return false; }
    double getStateOfCharge() const { return 100; }
    double getStateOfChargeLow() const { return 0; }
    double getStateOfChargeShutdown() const { return 0; }
    ChargeState getChargeState() const { return CHARGING_NOT; }
    const char* getChargeStateName() const { return "not"; }
    bool isChargerPowerGood() const { return false; }
    bool hasTemperature() const { return false; }
    int getTemperature() const { return -128; }
    /// The inputs and outputs of the controller are not connected.
    unsigned char getDigIn() const { return 0; }
    unsigned char getDigOut() const { return 0; }
    int getAnalog() const { return 0; }
    int getAnalogPortSelected() const { return 0; }
    int getIOAnalog(int /*number*/) const { return 0; }
    double getIOAnalogVoltage(int /*number*/) const { return 0; }
    unsigned char getIODigIn(int /*number*/) const { return 0; }
    unsigned char getIODigOut(int /*number*/) const { return 0; }
    void requestIOPackets() {}
    void stopIOPackets() {}
    int getIOAnalogSize() const { return 0; }
    int getIODigInSize() const { return 0; }
    int getIODigOutSize() const { return 0; }
    /// No such packet comes: the time of the robot's construction.
    ArTime getIOPacketTime() const { return myIOPacketTime; }
    double getCompass() const { return 0; }
    /// Packets in the last second.
    int getMotorPacCount() const { return packets(); }
    int getSonarPacCount() const { return mySonars.empty() || !mySonarEnabled ? 0 : packets(); }
    unsigned int getCounter() const { return myCounter; }

    int getNumSonar() const { return static_cast<int>(mySonars.size()); }
    /// mm; -1 for an unknown number.
    int getSonarRange(int number) const {
        const ArSensorReading* const sonar = getSonarReading(number);
        return sonar ? sonar->getRange() : -1;
    }
    bool isSonarNew(int number) const {
        const ArSensorReading* const sonar = getSonarReading(number);
        return sonar && sonar->isNew(myCounter);
    }
    ArSensorReading* getSonarReading(int number) const {
        if (number < 0 || number >= getNumSonar()) return nullptr;
        return const_cast<ArSensorReading*>(&mySonars[static_cast<std::size_t>(number)]);
    }
    /// The sonar with the minimum range of those that face these directions; -1 without any.
    int getClosestSonarNumber(double startDeg, double endDeg) const {
        int nearest = -1;
        for (int i = 0; i < getNumSonar(); ++i)
            if (ArMath::angleBetween(getSonarReading(i)->getSensorTh(), startDeg, endDeg) &&
                (nearest < 0 || getSonarRange(i) < getSonarRange(nearest)))
                nearest = i;
        return nearest;
    }
    /// Its range, mm; -1 without any.
    int getClosestSonarRange(double startDeg, double endDeg) const {
        return getSonarRange(getClosestSonarNumber(startDeg, endDeg));
    }

    const char* getRobotName() const { return myConfig.getName(); }
    const char* getRobotType() const { return "Pioneer"; }
    const char* getRobotSubType() const { return myConfig.getSubType(); }
    double getRobotRadius() const { return myParams.getRobotRadius(); }
    double getRobotDiagonal() const { return myParams.getRobotDiagonal(); }
    /// Diameter of its circle.
    double getRobotLength() const { return myParams.getRobotLength(); }
    double getRobotLengthFront() const { return getRobotLength() / 2; }
    double getRobotLengthRear() const { return getRobotLength() / 2; }
    double getRobotWidth() const { return myParams.getRobotWidth(); }
    const ArRobotParams* getRobotParams() const { return &myParams; }
    const ArRobotConfigPacketReader* getOrigRobotConfig() const { return &myConfig; }

    /// Pose at this simulated time (s) in the last two seconds, for readings that are older than
    /// the last packet; the nearest known one beyond.
    ArPose poseAt(double time) const {
        if (myHistory.empty()) return myPose;
        if (time >= myHistory.back().time) return myHistory.back().pose;
        std::size_t i = myHistory.size() - 1;
        while (i > 0 && myHistory[i - 1].time > time) --i;
        if (i == 0) return myHistory.front().pose;
        const Past &a = myHistory[i - 1], &b = myHistory[i];
        const double t = (time - a.time) / (b.time - a.time);
        return between(a.pose, b.pose, t);
    }

    /// The state as a status packet of a Pioneer.
    ArRobotPacket statusPacket() const {
        ArRobotPacket packet;
        const bool moves = myPacket.vel != 0 || myPacket.rot_vel != 0;
        packet.setID(moves ? 0x33 : 0x32);
        for (const double value : {myPacket.pose.getX(), myPacket.pose.getY(),
                                   4096 * myPacket.pose.getTh() / 360, getLeftVel(), getRightVel()})
            packet.byte2ToBuf(static_cast<ArTypes::Byte2>(std::lround(value)));
        packet.uByteToBuf(static_cast<ArTypes::UByte>(10 * getBatteryVoltage()));
        packet.uByte2ToBuf(static_cast<ArTypes::UByte2>(getStallValue()));
        packet.byte2ToBuf(0);  // control: the heading to reach
        packet.uByte2ToBuf(static_cast<ArTypes::UByte2>(getFlags()));
        packet.byteToBuf(0);  // compass
        packet.uByteToBuf(static_cast<ArTypes::UByte>(mySonars.size()));
        for (std::size_t i = 0; i < mySonars.size(); ++i) {
            packet.uByteToBuf(static_cast<ArTypes::UByte>(i));
            packet.uByte2ToBuf(static_cast<ArTypes::UByte2>(mySonars[i].getRange()));
        }
        for (int i = 0; i < 5; ++i) packet.uByteToBuf(0);  // gripper, inputs and outputs
        packet.uByte2ToBuf(static_cast<ArTypes::UByte2>(10 * getRealBatteryVoltage()));
        packet.uByteToBuf(CHARGING_NOT);
        packet.finalizePacket();
        return packet;
    }

    /// The travel of the wheels as a packet of a Pioneer.
    ArRobotPacket encoderPacket() const {
        ArRobotPacket packet;
        packet.setID(0x90);
        packet.byte4ToBuf(static_cast<ArTypes::Byte4>(getLeftEncoder()));
        packet.byte4ToBuf(static_cast<ArTypes::Byte4>(getRightEncoder()));
        packet.finalizePacket();
        return packet;
    }
    /// A true pose as a packet of a Pioneer's simulator. \param interval ms of a cycle
    static ArRobotPacket simulatorPacket(const ArPose& pose, unsigned int interval) {
        ArRobotPacket packet;
        packet.setID(0x62);
        packet.byte2ToBuf(0);   // the device, and a byte of no use
        packet.uByte4ToBuf(1);  // has a map, but no place on the earth
        for (int i = 0; i < 3; ++i) packet.uByte2ToBuf(static_cast<ArTypes::UByte2>(interval));
        for (const double value : {pose.getX(), pose.getY(), 0.0, pose.getTh()})
            packet.byte4ToBuf(static_cast<ArTypes::Byte4>(std::lround(value)));
        packet.finalizePacket();
        return packet;
    }

  protected:
    RobotState() {}
    ~RobotState() {}

    /// Rotation by wheels that turn by a mm each, in opposite directions: of a Pioneer 2 and 3 DX.
    static constexpr double kRadiansPerMm = 0.0056;

    /// Adopts a packet. \param pose the same pose after moveTo()
    void adopt(const Packet& packet, const ArPose& pose) {
        const ArPose& before = myPacket.pose;
        const double turn = ArMath::subAngle(packet.pose.getTh(), before.getTh());
        const double way = before.findDistanceTo(packet.pose);
        myDistance += way;
        myTurn += std::fabs(turn);
        const double ahead = ArMath::subAngle(before.findAngleTo(packet.pose), before.getTh());
        myTravel += std::fabs(ahead) > 90 ? -way : way;
        myWheelTurn += ArMath::degToRad(turn) / kRadiansPerMm;
        myPacket = packet;
        myPose = pose;
        myPoses.addReading(ArTime(), pose);
        myEncoderPoses.addReading(ArTime(), packet.pose);
        myHistory.push_back(Past{packet.time, pose});
        while (myHistory.front().time < packet.time - 2) myHistory.pop_front();
    }
    /// Moves the poses of the last seconds.
    void movePast(const ArTransform& change) {
        for (Past& past : myHistory) past.pose = change.doTransform(past.pose);
    }
    void resetState() {
        myPacket = Packet();
        myPose = ArPose();
        myHistory.clear();
        myPoses.reset();
        myEncoderPoses.reset();
        myDistance = myTurn = myTravel = myWheelTurn = 0;
    }

    Packet myPacket;
    ArPose myPose;
    std::vector<ArSensorReading> mySonars;
    std::atomic<unsigned int> myCounter{0};
    bool myMotorsEnabled = false, mySonarEnabled = true;
    ArRobotParams myParams;
    ArRobotConfigPacketReader myConfig;

  private:
    ArTime myIOPacketTime;
    ArInterpolation myPoses, myEncoderPoses;
    static constexpr double kTicks = 128;
    struct Past {
        double time;
        ArPose pose;
    };

    double wheelVel() const { return ArMath::degToRad(myPacket.rot_vel) / kRadiansPerMm; }
    int packets() const {
        int count = 0;
        for (const Past& past : myHistory) count += past.time > myPacket.time - 1 ? 1 : 0;
        return count;
    }

    double myDistance = 0, myTurn = 0, myTravel = 0, myWheelTurn = 0;
    std::deque<Past> myHistory;
};

}  // namespace sim_aria

#endif  // SIM_ARIA_ROBOT_STATE_H
