// SPDX-License-Identifier: GPL-3.0-or-later
// Devices of real robots that a robot of simrun does not have: programs compile, and find them
// missing.
#ifndef SIM_ARIA_HARDWARE_H
#define SIM_ARIA_HARDWARE_H

#include <memory>
#include <string>

#include <sim_aria/arguments.h>
#include <sim_aria/connector.h>
#include <sim_aria/range_device.h>
#include <sim_aria/robot.h>
#include <sim_aria/thread.h>

/// A gripper: there is none; commands return false.
class ArGripper {
  public:
    enum Type { QUERYTYPE, GENIO, USERIO, GRIPPAC, NOGRIPPER };

    explicit ArGripper(ArRobot* robot, int /*gripperType*/ = QUERYTYPE) : myRobot(robot) {}
    virtual ~ArGripper() {}
    int getType() const { return NOGRIPPER; }
    bool gripOpen() { return false; }
    bool gripClose() { return false; }
    bool gripStop() { return false; }
    bool liftUp() { return false; }
    bool liftDown() { return false; }
    bool liftStop() { return false; }
    bool gripperStore() { return false; }
    bool gripperDeploy() { return false; }
    bool gripperHalt() { return false; }
    bool gripPressure(int) { return false; }
    bool liftCarry(int) { return false; }
    int getGripState() const { return 0; }
    int getPaddleState() const { return 0; }
    int getBreakBeamState() const { return 0; }
    bool isGripMoving() const { return false; }
    bool isLiftMoving() const { return false; }
    bool isLiftMaxed() const { return false; }
    long getMSecSinceLastPacket() const { return -1; }
    int getGraspTime() const { return 0; }
    void logState() const { ArLog::log(ArLog::Normal, "%s has no gripper", myRobot->getName()); }

  private:
    ArRobot* myRobot;
};

/// The gyroscope of a Pioneer: there is none, and odometry needs no correction by it.
class ArAnalogGyro {
  public:
    explicit ArAnalogGyro(ArRobot* robot) : myRobot(robot) {}
    virtual ~ArAnalogGyro() {}
    bool isActive() const { return false; }
    bool haveGottenData() const { return false; }
    bool hasNoInternalData() const { return true; }
    bool hasGyroOnlyMode() const { return false; }
    bool isGyroOnlyActive() const { return false; }
    void activate() {}
    void activateGyroOnly() {}
    void deactivate() {}
    /// Heading by odometry.
    double getHeading() const { return myRobot->getEncoderPose().getTh(); }
    int getTemperature() const { return 0; }
    double getAverage() const { return 0; }
    void reZero() {}

  private:
    ArRobot* myRobot;
};

/// The inertial unit of a Seekur: there is none, all values are 0.
class ArSeekurIMU {
  public:
    explicit ArSeekurIMU(ArRobot*) {}
    double getXSpeed() const { return 0; }
    double getYSpeed() const { return 0; }
    double getZSpeed() const { return 0; }
    double getXAccel() const { return 0; }
    double getYAccel() const { return 0; }
    double getZAccel() const { return 0; }
    double getXPos() const { return 0; }
    double getYPos() const { return 0; }
    double getZPos() const { return 0; }
    double getTemperature() const { return 0; }
};

/// Infrared sensors: there are none, so that the device has no points.
class ArIRs : public ArRangeDevice {
  public:
    explicit ArIRs(std::size_t currentBufferSize = 30, std::size_t cumulativeBufferSize = 30,
                   const char* name = "irs", int maxSecondsToKeepCurrent = 10)
        : ArRangeDevice(currentBufferSize, cumulativeBufferSize, name, 5000,
                        maxSecondsToKeepCurrent) {}
};

/// Inputs and outputs of a Pioneer LX: the device is missing.
class ArMTXIO {
  public:
    explicit ArMTXIO(const char* /*device*/ = "/dev/mtx") {}
    bool isEnabled() const { return false; }
    int lock() { return myMutex.lock(); }
    int unlock() { return myMutex.unlock(); }
    bool getDigitalIOInputMon1(unsigned char*) { return false; }
    bool getDigitalIOInputMon2(unsigned char*) { return false; }
    bool getDigitalIOOutputMon1(unsigned char*) { return false; }
    bool getDigitalOutputControl1(unsigned char*) { return false; }
    bool getDigitalOutputControl2(unsigned char*) { return false; }
    bool setDigitalOutputControl1(unsigned char*) { return false; }
    bool setDigitalOutputControl2(unsigned char*) { return false; }
    bool getAnalogIOBlock1(unsigned int, unsigned short* value) { return none(value); }
    bool getAnalogIOBlock2(unsigned int, unsigned short* value) { return none(value); }
    bool setAnalogIOBlock2(unsigned int, unsigned short*) { return false; }
    bool setPowerOutput(int /*bank*/, int /*bit*/, bool /*on*/) { return false; }

  private:
    static bool none(unsigned short* value) {
        *value = 0;
        return false;
    }
    ArMutex myMutex;
};

/// The battery of a Pioneer LX: none is connected, commands return false.
class ArBatteryMTX {
  public:
    explicit ArBatteryMTX(int batteryBoardNum = 0, const char* name = "MTXBattery",
                          ArDeviceConnection* /*connection*/ = nullptr,
                          ArRobot* /*robot*/ = nullptr)
        : myName(std::string(name) + std::to_string(batteryBoardNum)) {}
    virtual ~ArBatteryMTX() {}
    const char* getName() const { return myName.c_str(); }
    bool blockingConnect() { return false; }
    bool asyncConnect() { return false; }
    bool disconnect() { return false; }
    bool isConnected() const { return false; }
    bool isTryingToConnect() const { return false; }
    int getChargeState() const { return -1; }
    bool sendStartCharge() { return false; }
    bool sendStopCharge() { return false; }
    bool sendPowerOff() { return false; }
    bool sendPowerOffCancel() { return false; }
    bool sendEmergencyPowerOff() { return false; }

  private:
    std::string myName;
};

/// A pan-tilt unit or camera: there is none. Stores the last command, as ARIA does for units that
/// report no position; init() returns false.
class ArPTZ {
  public:
    explicit ArPTZ(ArRobot* robot = nullptr) : myRobot(robot) {}
    virtual ~ArPTZ() {}
    virtual bool init() { return missing(); }
    virtual bool reset() {
        panTilt(0, 0);
        return missing();
    }
    virtual bool isInitted() const { return false; }
    virtual bool setDeviceConnection(ArDeviceConnection* connection,
                                     bool /*driveFromRobot*/ = true) {
        myConnection = connection;
        return true;
    }
    ArDeviceConnection* getDeviceConnection() const { return myConnection; }
    virtual bool setAuxPort(int) { return missing(); }
    virtual const char* getTypeName() const { return "none"; }
    virtual bool pan(double degrees) {
        myPan = degrees;
        return missing();
    }
    virtual bool tilt(double degrees) {
        myTilt = degrees;
        return missing();
    }
    virtual bool panRel(double degrees) { return pan(myPan + degrees); }
    virtual bool tiltRel(double degrees) { return tilt(myTilt + degrees); }
    virtual bool panTilt(double panDegrees, double tiltDegrees) {
        pan(panDegrees);
        return tilt(tiltDegrees);
    }
    virtual bool panTiltRel(double panDegrees, double tiltDegrees) {
        return panTilt(myPan + panDegrees, myTilt + tiltDegrees);
    }
    virtual bool zoom(int value) {
        myZoom = value;
        return missing();
    }
    virtual bool zoomRel(int value) { return zoom(myZoom + value); }
    virtual bool haltPanTilt() { return missing(); }
    virtual bool haltZoom() { return missing(); }
    virtual bool canZoom() const { return false; }
    virtual bool canGetRealPanTilt() const { return false; }
    virtual bool canGetRealZoom() const { return false; }
    virtual bool canPanTilt() const { return false; }
    virtual bool setAutoFocus(bool) { return missing(); }
    double getPan() const { return myPan; }
    double getTilt() const { return myTilt; }
    int getZoom() const { return myZoom; }
    int getMaxZoom() const { return 0; }
    int getMinZoom() const { return 0; }
    double getMaxPosPan() const { return 90; }
    double getMaxNegPan() const { return -90; }
    double getMaxPosTilt() const { return 30; }
    double getMaxNegTilt() const { return -45; }

  protected:
    static bool missing() { return false; }
    ArRobot* myRobot;
    ArDeviceConnection* myConnection = nullptr;
    double myPan = 0, myTilt = 0;
    int myZoom = 0;
};

class ArDPPTU : public ArPTZ {
  public:
    enum DeviceType { PANTILT_DEFAULT, PANTILT_PTUD46, PANTILT_PTUD47 };

    explicit ArDPPTU(ArRobot* robot, DeviceType = PANTILT_DEFAULT, int /*deviceIndex*/ = 0)
        : ArPTZ(robot) {}
    const char* getTypeName() const override { return "dpptu"; }
    bool resetCalib() { return missing(); }
    bool awaitExec() { return missing(); }
    bool haltAll() { return missing(); }
    bool blank() { return missing(); }
    bool initMon(double, double, double, double) { return missing(); }
    bool panSlew(double degrees) {
        myPanSlew = ArMath::roundInt(degrees);
        return missing();
    }
    bool tiltSlew(double degrees) {
        myTiltSlew = ArMath::roundInt(degrees);
        return missing();
    }
    int getPanSlew() const { return myPanSlew; }
    int getTiltSlew() const { return myTiltSlew; }
    double getLastPanRequest() const { return myPan; }
    double getLastTiltRequest() const { return myTilt; }
    double getMaxPanSlew() const { return 149; }
    double getMinPanSlew() const { return 0; }
    double getMaxTiltSlew() const { return 149; }
    double getMinTiltSlew() const { return 0; }

  private:
    int myPanSlew = 0, myTiltSlew = 0;
};

class ArVCC4 : public ArPTZ {
  public:
    enum CommState { COMM_UNKNOWN, COMM_BIDIRECTIONAL, COMM_UNIDIRECTIONAL };
    enum CameraType { CAMERA_VCC4, CAMERA_C50I };
    explicit ArVCC4(ArRobot* robot, bool /*inverted*/ = false, CommState = COMM_UNKNOWN,
                    bool /*autoUpdate*/ = true, bool /*disableLED*/ = false,
                    CameraType = CAMERA_VCC4)
        : ArPTZ(robot) {}
    const char* getTypeName() const override { return "vcc4"; }
};

class ArRVisionPTZ : public ArPTZ {
  public:
    explicit ArRVisionPTZ(ArRobot* robot) : ArPTZ(robot) {}
    const char* getTypeName() const override { return "rvision"; }
};

/// Connects the cameras of a robot: none.
class ArPTZConnector {
  public:
    ArPTZConnector(ArArgumentParser*, ArRobot* = nullptr) {}
    bool connect() { return true; }
    std::size_t getNumPTZs() const { return 0; }
    ArPTZ* getPTZ(std::size_t /*number*/ = 0) { return nullptr; }
};

/// A receiver of satellite positions: rooms have none; connect() fails.
class ArGPS {
  public:
    enum ReadFlags { ReadError = 1, ReadUpdated = 2, ReadData = 4, ReadFinished = 8 };
    enum FixType { NoFix, BadFix, GPSFix, DGPSFix, PPSFix, RTKFloatFix, RTKIntFix, SimulatedFix };

    virtual ~ArGPS() {}
    virtual bool connect(unsigned long /*connectTimeout*/ = 10000) { return false; }
    virtual int read(unsigned int /*maxTime*/ = 0) { return ReadError; }
    bool havePosition() const { return false; }
    FixType getFixType() const { return NoFix; }
    const char* getFixTypeName() const { return "NoFix"; }
    double getLatitude() const { return 0; }
    double getLongitude() const { return 0; }
    double getAltitude() const { return 0; }
    bool haveSpeed() const { return false; }
    double getSpeed() const { return 0; }
    unsigned int getNumSatellitesTracked() const { return 0; }
    double getPDOP() const { return 0; }
    double getHDOP() const { return 0; }
    double getVDOP() const { return 0; }
    ArTime getGPSPositionTimestamp() const { return ArTime(); }
    ArTime getTimeReceived() const { return ArTime(); }
    void printDataLabelsHeader() const { std::puts("Fix"); }
    void printData(bool /*refresh*/ = true) const { std::printf("%s", getFixTypeName()); }
};

class ArGPSConnector {
  public:
    enum GPSType { Invalid, Standard, Novatel, NovatelSPAN, Trimble, Simulator, SuperStar };

    explicit ArGPSConnector(ArArgumentParser* parser) : myParser(parser) {
        for (const char* word : {"-gpsType", "-gpsPort", "-gpsBaud"})
            if (myParser) myParser->checkParameterArgument(word);
    }
    GPSType getGPSType() const { return Standard; }
    /// The connector keeps it.
    ArGPS* createGPS(ArRobot* = nullptr) {
        myGPS.reset(new ArGPS);
        return myGPS.get();
    }
    ArGPS* create(ArRobot* robot = nullptr) { return createGPS(robot); }

  private:
    ArArgumentParser* myParser;
    std::unique_ptr<ArGPS> myGPS;
};

#endif  // SIM_ARIA_HARDWARE_H
