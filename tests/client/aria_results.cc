// SPDX-License-Identifier: GPL-3.0-or-later
// Results of ARIA's functions that AriaCoda's examples print by printf(): another type than ARIA's
// would shift all that follow. Compiled alone; tests/client/ariacoda.sh compiles the examples.
#include <Aria/Aria.h>

#include <string>
#include <type_traits>

namespace {

template <class Wanted, class... Found>
constexpr bool allAre() {
    return (std::is_same_v<Wanted, Found> && ...);
}
#define RESULT(member) decltype(object->member())

[[maybe_unused]] void check(ArRobot* object) {
    static_assert(
        allAre<double, RESULT(getBatteryVoltage), RESULT(getRealBatteryVoltage), RESULT(getCompass),
               RESULT(getLatVel), RESULT(getLeftVel), RESULT(getRightVel), RESULT(getVel),
               RESULT(getRotVel), RESULT(getX), RESULT(getY), RESULT(getTh),
               RESULT(getRobotDiagonal), RESULT(getRobotLength), RESULT(getRobotLengthFront),
               RESULT(getRobotLengthRear), RESULT(getRobotRadius), RESULT(getRobotWidth),
               RESULT(getStateOfCharge), RESULT(getStateOfChargeLow),
               RESULT(getStateOfChargeShutdown)>());
    static_assert(allAre<int, RESULT(getFaultFlags), RESULT(getFlags), RESULT(getFlags3),
                         RESULT(getIOAnalogSize), RESULT(getIODigInSize), RESULT(getIODigOutSize),
                         RESULT(getMotorPacCount), RESULT(getSonarPacCount), RESULT(getNumSonar),
                         RESULT(getStallValue), RESULT(getTemperature), RESULT(getNumLasers)>());
    static_assert(allAre<long, RESULT(getLeftEncoder), RESULT(getRightEncoder)>());
    static_assert(allAre<unsigned int, RESULT(getNumFrontBumpers), RESULT(getNumRearBumpers)>());
    static_assert(allAre<const char*, RESULT(getChargeStateName)>());
    static_assert(
        allAre<bool, RESULT(areMotorsEnabled), RESULT(isConnected), RESULT(isEStopPressed),
               RESULT(getEstop), RESULT(isLeftMotorStalled), RESULT(isRightMotorStalled),
               RESULT(isLeftTableSensingIRTriggered), RESULT(isRightTableSensingIRTriggered),
               RESULT(hasFaultFlags), RESULT(hasFlags3), RESULT(hasLatVel),
               RESULT(hasSettableAccsDecs), RESULT(hasSettableVelMaxes), RESULT(hasStateOfCharge),
               RESULT(haveStateOfCharge), RESULT(hasTableSensingIR), RESULT(hasTemperature),
               RESULT(isChargerPowerGood), RESULT(isRunning), RESULT(asyncConnect),
               RESULT(blockingConnect)>());
    static_cast<void>(object);
}

[[maybe_unused]] void check(ArSeekurIMU* object) {
    static_assert(allAre<double, RESULT(getXSpeed), RESULT(getYSpeed), RESULT(getZSpeed),
                         RESULT(getXAccel), RESULT(getYAccel), RESULT(getZAccel), RESULT(getXPos),
                         RESULT(getYPos), RESULT(getZPos), RESULT(getTemperature)>());
    static_cast<void>(object);
}

[[maybe_unused]] void check(ArAnalogGyro* object) {
    static_assert(allAre<double, RESULT(getHeading), RESULT(getAverage)>());
    static_assert(allAre<int, RESULT(getTemperature)>());
    static_assert(allAre<bool, RESULT(hasGyroOnlyMode), RESULT(hasNoInternalData),
                         RESULT(haveGottenData), RESULT(isActive), RESULT(isGyroOnlyActive)>());
    static_cast<void>(object);
}

[[maybe_unused]] void check(ArGPS* object) {
    static_assert(allAre<double, RESULT(getLatitude), RESULT(getLongitude), RESULT(getAltitude),
                         RESULT(getSpeed), RESULT(getPDOP), RESULT(getHDOP), RESULT(getVDOP)>());
    static_assert(allAre<const char*, RESULT(getFixTypeName)>());
    static_assert(allAre<unsigned int, RESULT(getNumSatellitesTracked)>());
    static_cast<void>(object);
}

[[maybe_unused]] void check(ArDPPTU* object) {
    static_assert(allAre<double, RESULT(getPan), RESULT(getTilt), RESULT(getLastPanRequest),
                         RESULT(getLastTiltRequest), RESULT(getMaxPosPan), RESULT(getMaxNegPan),
                         RESULT(getMaxPosTilt), RESULT(getMaxNegTilt), RESULT(getMaxPanSlew),
                         RESULT(getMinPanSlew)>());
    static_assert(allAre<int, RESULT(getPanSlew), RESULT(getTiltSlew), RESULT(getZoom),
                         RESULT(getMaxZoom), RESULT(getMinZoom)>());
    static_assert(
        allAre<bool, RESULT(init), RESULT(reset), RESULT(resetCalib), RESULT(awaitExec),
               RESULT(haltAll), RESULT(blank), RESULT(canZoom), RESULT(canGetRealPanTilt)>());
    static_assert(allAre<const char*, RESULT(getTypeName)>());
    static_cast<void>(object);
}

[[maybe_unused]] void check(ArGripper* object) {
    static_assert(allAre<int, RESULT(getType), RESULT(getBreakBeamState), RESULT(getGripState),
                         RESULT(getPaddleState)>());
    static_assert(allAre<bool, RESULT(gripOpen), RESULT(gripClose), RESULT(gripperHalt),
                         RESULT(liftUp), RESULT(liftDown), RESULT(isLiftMaxed)>());
    static_cast<void>(object);
}

[[maybe_unused]] void check(ArJoyHandler* object) {
    static_assert(allAre<bool, RESULT(init), RESULT(haveJoystick), RESULT(haveZAxis)>());
    static_assert(allAre<unsigned int, RESULT(getNumAxes), RESULT(getNumButtons)>());
    static_cast<void>(object);
}

[[maybe_unused]] void check(ArRobotPacket* object) {
    static_assert(allAre<short, RESULT(bufToByte2)>());
    static_assert(allAre<unsigned char, RESULT(bufToUByte), RESULT(getID)>());
    static_assert(allAre<std::string, RESULT(bufToString)>());
    static_cast<void>(object);
}

[[maybe_unused]] void check(ArLaser* object) {
    static_assert(allAre<const char*, RESULT(getName)>());
    static_assert(
        allAre<bool, RESULT(isConnected), RESULT(isTryingToConnect), RESULT(asyncConnect)>());
    static_assert(allAre<double, RESULT(getStartDegrees), RESULT(getEndDegrees)>());
    static_cast<void>(object);
}

[[maybe_unused]] void check(ArRobotParams* object) {
    static_assert(allAre<int, RESULT(getLaserX), RESULT(getLaserY), RESULT(getLaserZ)>());
    static_assert(allAre<double, RESULT(getLaserTh)>());
    static_assert(allAre<const char*, RESULT(getLaserPowerOutput)>());
    static_assert(allAre<bool, RESULT(hasMoveCommand)>());
    static_cast<void>(object);
}

[[maybe_unused]] void check(ArSocket* object) {
    static_assert(allAre<const char*, RESULT(getIPString)>());
    static_assert(allAre<const std::string&, RESULT(getErrorStr)>());
    static_cast<void>(object);
}

[[maybe_unused]] void check(ArDataLogger* object) {
    static_assert(allAre<const char*, RESULT(getLogFileName)>());
    static_assert(allAre<int, RESULT(getLogInterval)>());
    static_cast<void>(object);
}

[[maybe_unused]] void check(ArBatteryMTX* object) {
    static_assert(allAre<bool, RESULT(isConnected), RESULT(sendEmergencyPowerOff)>());
    static_cast<void>(object);
}

[[maybe_unused]] void check(ArRobotConfigPacketReader* object) {
    static_assert(allAre<bool, RESULT(requestPacket), RESULT(getHasGripper)>());
    static_assert(allAre<int, RESULT(getGyroType), RESULT(getConfigFlags)>());
    static_cast<void>(object);
}

[[maybe_unused]] void check(ArSerialConnection* object) {
    static_assert(allAre<const char*, RESULT(getPortName)>());
    static_assert(allAre<bool, RESULT(openSimple)>());
    static_cast<void>(object);
}

#undef RESULT

}  // namespace
