// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef SIM_ARIA_ROBOT_H
#define SIM_ARIA_ROBOT_H

#include <atomic>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <sim_aria/commands.h>
#include <sim_aria/connection.h>
#include <sim_aria/link.h>
#include <sim_aria/motion.h>
#include <sim_aria/process.h>
#include <sim_aria/range_device.h>

/// A robot of simrun as ARIA's: mm, degrees, mm/s, degrees/s. Takes the first free robot, of those
/// in the variable ISPACE_ROBOT ("r1,r2") if set. Its pose is its odometry since the connection.
/// Commands take effect and getters are updated in cycles of 100 ms; hold the lock around both.
/// Supports direct motion, not actions.
class ArRobot {
  public:
    enum WaitState {
        WAIT_CONNECTED,
        WAIT_FAILED_CONN,
        WAIT_RUN_EXIT,
        WAIT_TIMEDOUT,
        WAIT_INTR,
        WAIT_FAIL
    };

    explicit ArRobot(const char* name = nullptr, bool /*unused*/ = true,
                     bool /*doSigHandle*/ = true, bool /*normalInit*/ = true,
                     bool addAriaExitCallback = true)
        : myName(name ? name : "robot") {
        if (addAriaExitCallback) sim_aria::Process::get().add(this, [this] { end(); });
    }
    virtual ~ArRobot() {
        sim_aria::Process::get().remove(this);
        end();
    }
    ArRobot(const ArRobot&) = delete;
    ArRobot& operator=(const ArRobot&) = delete;

    // Connection.
    void setDeviceConnection(ArDeviceConnection* connection) { myConnection = connection; }
    ArDeviceConnection* getDeviceConnection() const { return myConnection; }
    /// Opens the device if it is closed.
    bool blockingConnect(bool tryHarder = true);
    bool disconnect();
    bool isConnected() const { return myConnected; }
    void setConnectionTimeoutTime(int ms) { myTimeout = ms; }
    int getConnectionTimeoutTime() const { return myTimeout; }

    // The cycle.
    void runAsync(bool stopRunIfNotConnected, bool runNonThreadedPacketReader = false);
    void run(bool stopRunIfNotConnected, bool runNonThreadedPacketReader = false);
    void stopRunning(bool doDisconnect = true);
    bool isRunning() const { return myRunning; }
    WaitState waitForRunExit(unsigned int msecs = 0);
    unsigned int getCycleTime() const { return myCycleTime; }
    void setCycleTime(unsigned int ms) { myCycleTime = ms; }
    unsigned int getCounter() const { return myCounter; }
    int lock() {
        myMutex.lock();
        return 0;
    }
    int tryLock() { return myMutex.try_lock() ? 0 : 1; }
    int unlock() {
        myMutex.unlock();
        return 0;
    }
    bool addUserTask(const char* name, int position, ArFunctor* functor);
    void remUserTask(ArFunctor* functor);

    // Commands of the firmware; true: connected.
    bool com(unsigned char command) { return comInt(command, 0); }
    bool comInt(unsigned char command, short argument);
    bool com2Bytes(unsigned char command, char high, char low);
    bool comStr(unsigned char, const char*) { return myConnected; }
    bool comStrN(unsigned char, const char*, int) { return myConnected; }
    void enableMotors() { comInt(ArCommands::ENABLE, 1); }
    void disableMotors() { comInt(ArCommands::ENABLE, 0); }
    void enableSonar() { comInt(ArCommands::SONAR, 1); }
    void disableSonar() { comInt(ArCommands::SONAR, 0); }

    // Direct motion: stays in effect until changed.
    void setVel(double mmPerSec) { myMotion.setVel(mmPerSec); }
    void setRotVel(double degPerSec) { myMotion.setRotVel(degPerSec); }
    void setVel2(double left, double right) {
        setVel((left + right) / 2);
        setRotVel(ArMath::radToDeg((right - left) / 2 * kRadiansPerMm));
    }
    void move(double mm) { myMotion.move(mm, myPose); }
    void setHeading(double deg) { myMotion.setHeading(deg); }
    void setDeltaHeading(double deg) { setHeading(ArMath::addAngle(getTh(), deg)); }
    void stop();
    void clearDirectMotion() { myMotion.clear(); }
    void setDirectMotionPrecedenceTime(int) {}
    bool isMoveDone(double delta = 0) const { return myMotion.isMoveDone(myPose, delta); }
    bool isHeadingDone(double delta = 0) const { return myMotion.isHeadingDone(myPose, delta); }
    bool setTransVelMax(double value) { return set(myMotion.max_vel, value); }
    bool setRotVelMax(double value) { return set(myMotion.max_rot_vel, value); }
    /// Used for move() and headings; speeds change as the simulated robot's motors do.
    bool setTransAccel(double value) { return set(myMotion.accel, value); }
    bool setTransDecel(double value) { return set(myMotion.accel, value); }
    bool setRotAccel(double value) { return set(myMotion.rot_accel, value); }
    bool setRotDecel(double value) { return set(myMotion.rot_accel, value); }
    double getTransVelMax() const { return myMotion.max_vel; }
    double getRotVelMax() const { return myMotion.max_rot_vel; }
    double getTransAccel() const { return myMotion.accel; }
    double getTransDecel() const { return myMotion.accel; }
    double getRotAccel() const { return myMotion.rot_accel; }
    double getRotDecel() const { return myMotion.rot_accel; }

    // State.
    double getVel() const { return myPacket.vel; }
    double getRotVel() const { return myPacket.rot_vel; }
    double getLeftVel() const { return myPacket.vel - wheelVel(); }
    double getRightVel() const { return myPacket.vel + wheelVel(); }
    ArPose getPose() const { return myPose; }
    double getX() const { return myPose.getX(); }
    double getY() const { return myPose.getY(); }
    double getTh() const { return myPose.getTh(); }
    /// Sets the pose that the program sees.
    void moveTo(ArPose pose);
    /// A simulated robot stalls as a whole.
    bool isLeftMotorStalled() const { return myPacket.stalled; }
    bool isRightMotorStalled() const { return myPacket.stalled; }
    /// Bits 0 and 8: the motors; bumpers clockwise, front ones from bit 9 on, rear ones from bit 1
    /// on.
    int getStallValue() const {
        return myPacket.bumpers | (myPacket.stalled ? ArUtil::BIT0 | ArUtil::BIT8 : 0);
    }
    bool hasFrontBumpers() const { return myFrontBumpers > 0; }
    bool hasRearBumpers() const { return myRearBumpers > 0; }
    unsigned int getNumFrontBumpers() const { return static_cast<unsigned int>(myFrontBumpers); }
    unsigned int getNumRearBumpers() const { return static_cast<unsigned int>(myRearBumpers); }
    int getFlags() const { return myMotorsEnabled ? ArUtil::BIT0 : 0; }
    bool areMotorsEnabled() const { return myMotorsEnabled; }
    /// Voltage of a full battery.
    double getBatteryVoltage() const { return 13; }
    double getRealBatteryVoltage() const { return 13; }

    // Sonars and other range devices.
    void addRangeDevice(ArRangeDevice* device);
    bool remRangeDevice(ArRangeDevice* device);
    bool remRangeDevice(const char* name);
    const std::list<ArRangeDevice*>* getRangeDeviceList() const { return &myDevices; }
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
    /// Minimum range of the sonars that face these directions, mm; -1 without such sonars.
    int getClosestSonarRange(double startDeg, double endDeg) const;

    // Identity and dimensions.
    const char* getName() const { return myName.c_str(); }
    void setName(const char* name) { myName = name; }
    const char* getRobotName() const { return myRobotName.c_str(); }
    const char* getRobotType() const { return "Pioneer"; }
    const char* getRobotSubType() const { return mySubType.c_str(); }
    double getRobotRadius() const { return myRadius; }
    /// Diameter of its circle.
    double getRobotLength() const { return 2 * myRadius; }
    double getRobotWidth() const { return 2 * myRadius; }

  private:
    /// Rotation by wheels that turn by a mm each, in opposite directions: of a Pioneer 2 and 3 DX.
    static constexpr double kRadiansPerMm = 0.0056;

    double wheelVel() const { return ArMath::degToRad(myPacket.rot_vel) / kRadiansPerMm; }
    static bool set(double& where, double value) {
        if (!(value > 0)) return false;
        where = value;
        return true;
    }
    static std::string subTypeOf(const std::string& model) {
        const std::string maker = "pioneer-";
        return model.compare(0, maker.size(), maker) == 0 ? "p" + model.substr(maker.size())
                                                          : model;
    }

    bool cycle();
    void read();
    void send();
    void lose();
    void loop(bool stop_if_not_connected);
    void runBySteps(bool stop_if_not_connected);
    void end();

    std::string myName, myRobotName, mySubType;
    ArDeviceConnection* myConnection = nullptr;
    std::unique_ptr<sim_aria::Link> myLink;
    std::recursive_mutex myMutex;
    std::thread myThread;
    std::atomic<bool> myRunning{false}, myConnected{false};
    std::atomic<unsigned int> myCounter{0};
    unsigned int myCycleTime = 100;
    int myTimeout = 8000;
    double myRadius = 250;
    int myFrontBumpers = 0, myRearBumpers = 0;

    sim_aria::Motion myMotion;
    sim_aria::Packet myPacket;
    ArPose myPose, myMoved,
        myMovedFrom;  // a packet's pose at myMovedFrom is reported as myMoved
    bool myMotorsEnabled = false, mySonarEnabled = true;
    double mySentVel = 0, mySentRotVel = 0;
    ArTime mySent;
    std::vector<ArSensorReading> mySonars;
    std::list<ArRangeDevice*> myDevices;
    std::list<ArFunctor*> myTasks;
};

#include <sim_aria/robot_cycle.h>

#endif  // SIM_ARIA_ROBOT_H
