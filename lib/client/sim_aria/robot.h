// SPDX-License-Identifier: GPL-3.0-or-later
// The robot of a program: connection, cycle, motion, tasks and actions. Its implementation is
// robot_cycle.h and robot_parts.h.
//
//     ArRobot robot;
//     ArSimpleConnector connector(&argc, argv);
//     if (!connector.connectRobot(&robot)) return 1;
//     robot.runAsync(true);
//     robot.lock();
//     robot.enableMotors();
//     robot.move(1500);  // mm
//     robot.unlock();
#ifndef SIM_ARIA_ROBOT_H
#define SIM_ARIA_ROBOT_H

#include <atomic>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <sim_aria/action.h>
#include <sim_aria/aria.h>
#include <sim_aria/commands.h>
#include <sim_aria/connection.h>
#include <sim_aria/motion.h>
#include <sim_aria/robot_state.h>

class ArBatteryMTX;
class ArLaser;
class ArPTZ;

/// A robot of simrun as ARIA's: mm, degrees, mm/s, degrees/s. Takes the first free robot, of those
/// in the variable ISPACE_ROBOT ("r1,r2") if set. Its pose is its odometry since the connection.
/// Commands take effect and getters are updated in cycles of 100 ms: packets, tasks of sensor
/// interpretation, actions, commands, user tasks. Hold the lock around commands and getters.
class ArRobot : public sim_aria::RobotState {
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
        Aria::addRobot(this);
        if (addAriaExitCallback)
            sim_aria::Process::get().add(
                this, [this] { end(); }, kLastAtExit);
    }
    virtual ~ArRobot();
    ArRobot(const ArRobot&) = delete;
    ArRobot& operator=(const ArRobot&) = delete;

    // Connection.
    void setDeviceConnection(ArDeviceConnection* connection) { myConnection = connection; }
    ArDeviceConnection* getDeviceConnection() const { return myConnection; }
    /// Opens the device if it is closed.
    bool blockingConnect(bool tryHarder = true);
    /// Lets the next cycle connect. \return false if the cycle does not run
    bool asyncConnect();
    bool disconnect();
    /// Loses the connection, as by a fault of the line: calls the functions for that.
    void dropConnection();
    bool isConnected() const { return myConnected; }
    void setConnectionTimeoutTime(int ms) { myTimeout = ms; }
    int getConnectionTimeoutTime() const { return myTimeout; }
    void setAsyncConnectSyncPacketRetries(int) {}
    /// There are no files of parameters: a robot connects without.
    void setConnectWithNoParams(bool connect) { myNoParams = connect; }
    bool getConnectWithNoParams() const { return myNoParams; }
    /// Functions to call after a connection, after its failure, its end, its loss, and after run().
    void addConnectCB(ArFunctor* f, ArListPos::Pos at = ArListPos::LAST) { add(Connect, f, at); }
    void addFailedConnectCB(ArFunctor* f, ArListPos::Pos at = ArListPos::LAST) {
        add(FailedConnect, f, at);
    }
    void addDisconnectNormallyCB(ArFunctor* f, ArListPos::Pos at = ArListPos::LAST) {
        add(Disconnect, f, at);
    }
    void addDisconnectOnErrorCB(ArFunctor* f, ArListPos::Pos at = ArListPos::LAST) {
        add(Loss, f, at);
    }
    void addRunExitCB(ArFunctor* f, ArListPos::Pos at = ArListPos::LAST) { add(RunExit, f, at); }
    void remConnectCB(ArFunctor* f) { remove(Connect, f); }
    void remFailedConnectCB(ArFunctor* f) { remove(FailedConnect, f); }
    void remDisconnectNormallyCB(ArFunctor* f) { remove(Disconnect, f); }
    void remDisconnectOnErrorCB(ArFunctor* f) { remove(Loss, f); }
    void remRunExitCB(ArFunctor* f) { remove(RunExit, f); }

    // The cycle.
    void runAsync(bool stopRunIfNotConnected = true, bool runNonThreadedPacketReader = false);
    void run(bool stopRunIfNotConnected = true, bool runNonThreadedPacketReader = false);
    /// One cycle, in a loop of the program.
    void loopOnce() { cycle(); }
    void stopRunning(bool doDisconnect = true);
    bool isRunning() const { return myRunning; }
    WaitState waitForRunExit(unsigned int msecs = 0);
    WaitState waitForConnect(unsigned int msecs = 0);
    /// Also ends, with WAIT_FAILED_CONN, when asyncConnect() has failed.
    WaitState waitForConnectOrConnFail(unsigned int msecs = 0);
    unsigned int getCycleTime() const { return myCycleTime; }
    void setCycleTime(unsigned int ms) { myCycleTime = ms; }
    int lock() {
        myMutex.lock();
        return 0;
    }
    int tryLock() { return myMutex.try_lock() ? 0 : 1; }
    int unlock() {
        myMutex.unlock();
        return 0;
    }
    /// Tasks of each cycle, those of higher positions first: before and after the actions.
    bool addSensorInterpTask(const char* name, int position, ArFunctor* functor);
    bool addUserTask(const char* name, int position, ArFunctor* functor);
    void remSensorInterpTask(ArFunctor* functor);
    void remSensorInterpTask(const char* name);
    void remUserTask(ArFunctor* functor);
    void remUserTask(const char* name);
    /// Functions that read the robot's packets, until one returns true; each cycle has a status
    /// packet.
    void addPacketHandler(ArRetFunctor1<bool, ArRobotPacket*>* functor,
                          ArListPos::Pos position = ArListPos::LAST);
    void remPacketHandler(ArRetFunctor1<bool, ArRobotPacket*>* functor);
    /// Reads the keyboard in each cycle; Escape ends the program.
    void attachKeyHandler(ArKeyHandler* handler, bool exitOnEscape = true,
                          bool useExitNotShutdown = true);
    ArKeyHandler* getKeyHandler() const { return myKeys; }

    // Commands of the firmware; true: connected.
    bool com(unsigned char command) { return comInt(command, 0); }
    bool comInt(unsigned char command, short argument);
    bool com2Bytes(unsigned char command, char high, char low);
    bool comStr(unsigned char, const char*) { return myConnected; }
    bool comStrN(unsigned char, const char*, int) { return myConnected; }
    bool comDataN(unsigned char, const char*, int) { return myConnected; }
    void enableMotors() { comInt(ArCommands::ENABLE, 1); }
    void disableMotors() { comInt(ArCommands::ENABLE, 0); }
    void enableSonar() { comInt(ArCommands::SONAR, 1); }
    void disableSonar() { comInt(ArCommands::SONAR, 0); }
    /// Lets each cycle have a packet of the wheels' travel, too (0x90).
    void requestEncoderPackets() { comInt(ArCommands::ENCODER, kEachCycle); }
    void stopEncoderPackets() { comInt(ArCommands::ENCODER, 0); }

    // Direct motion: stays in effect until changed, and suspends actions until
    // clearDirectMotion().
    void setVel(double mmPerSec) {
        takeOver();
        myMotion.setVel(mmPerSec);
    }
    void setRotVel(double degPerSec) {
        takeOver();
        myMotion.setRotVel(degPerSec);
    }
    void setVel2(double left, double right) {
        setVel((left + right) / 2);
        setRotVel(ArMath::radToDeg((right - left) / 2 * kRadiansPerMm));
    }
    void move(double mm) {
        takeOver();
        myMotion.move(mm, myPose);
    }
    void setHeading(double deg) {
        takeOver();
        myMotion.setHeading(deg);
    }
    void setDeltaHeading(double deg) { setHeading(ArMath::addAngle(getTh(), deg)); }
    void stop();
    void clearDirectMotion() {
        myMotion.clear();
        myDirect = false;
        myReflects = true;
    }
    /// Sends no motion in the cycles until the next motion or clearDirectMotion().
    void stopStateReflection() {
        takeOver();
        myReflects = false;
    }
    /// The server keeps speeds: they are not repeated.
    void setStateReflectionRefreshTime(int ms) { myRefreshTime = ms; }
    int getStateReflectionRefreshTime() const { return myRefreshTime; }
    bool isDirectMotion() const { return myDirect; }
    /// Lets actions continue this long after the last direct motion; 0: never.
    void setDirectMotionPrecedenceTime(int ms) { myPrecedence = ms; }
    unsigned int getDirectMotionPrecedenceTime() const {
        return static_cast<unsigned int>(myPrecedence);
    }
    bool isMoveDone(double delta = 0) const { return myMotion.isMoveDone(myPose, delta); }
    bool isHeadingDone(double delta = 0) const { return myMotion.isHeadingDone(myPose, delta); }
    void setMoveDoneDist(double mm) { myMotion.move_done = mm; }
    double getMoveDoneDist() const { return myMotion.move_done; }
    void setHeadingDoneDiff(double deg) { myMotion.heading_done = deg; }
    double getHeadingDoneDiff() const { return myMotion.heading_done; }
    /// Maxima of speed. One above the absolute maximum is lowered to it, with false.
    bool setTransVelMax(double value) {
        return myMotion.setMax(myMotion.max_vel, value, myMotion.top_vel);
    }
    bool setRotVelMax(double value) {
        return myMotion.setMax(myMotion.max_rot_vel, value, myMotion.top_rot_vel);
    }
    /// Lowers the absolute maximum; the robot's own is the highest.
    bool setAbsoluteMaxTransVel(double value) {
        const bool is_good = myMotion.setMax(myMotion.top_vel, value, myConfig.getTransVelTop());
        return setTransVelMax(std::min(myMotion.max_vel, myMotion.top_vel)) && is_good;
    }
    bool setAbsoluteMaxRotVel(double value) {
        const bool is_good = myMotion.setMax(myMotion.top_rot_vel, value, myConfig.getRotVelTop());
        return setRotVelMax(std::min(myMotion.max_rot_vel, myMotion.top_rot_vel)) && is_good;
    }
    /// Decelerations are used for move() and headings; speeds change as the simulated robot's
    /// motors do.
    bool setTransAccel(double value) { return set(myMotion.accel, value); }
    bool setTransDecel(double value) { return set(myMotion.decel, value); }
    bool setRotAccel(double value) { return set(myMotion.rot_accel, value); }
    bool setRotDecel(double value) { return set(myMotion.rot_decel, value); }
    double getTransVelMax() const { return myMotion.max_vel; }
    double getRotVelMax() const { return myMotion.max_rot_vel; }
    double getAbsoluteMaxTransVel() const { return myMotion.top_vel; }
    double getAbsoluteMaxRotVel() const { return myMotion.top_rot_vel; }
    double getTransAccel() const { return myMotion.accel; }
    double getTransDecel() const { return myMotion.decel; }
    double getRotAccel() const { return myMotion.rot_accel; }
    double getRotDecel() const { return myMotion.rot_decel; }
    /// Sets the pose that the program sees; points of range devices move along.
    /// \param doCumulative whether those of the cumulative buffers do
    void moveTo(ArPose pose, bool doCumulative = true);
    void setDeadReconPose(ArPose pose) { moveTo(pose); }

    /// Computes the change of heading (degrees) in each cycle, from the change of the wheels' pose;
    /// null: that of the wheels.
    void setEncoderCorrectionCallback(ArRetFunctor1<double, ArPoseWithTime>* functor) {
        myCorrection = functor;
    }
    ArRetFunctor1<double, ArPoseWithTime>* getEncoderCorrectionCallback() const {
        return myCorrection;
    }

    // Actions: move the robot while it has no direct motion.
    bool addAction(ArAction* action, int priority);
    bool remAction(ArAction* action);
    bool remAction(const char* name);
    ArAction* findAction(const char* name) const;
    ArResolver::ActionMap* getActionMap() { return &myActions; }
    void deactivateActions();
    void logActions(bool logDeactivated = false) const;
    ArResolver* getResolver() { return myResolver; }
    void setResolver(ArResolver* resolver) { myResolver = resolver; }

    // Sonars, lasers and other range devices.
    void addRangeDevice(ArRangeDevice* device);
    bool remRangeDevice(ArRangeDevice* device);
    bool remRangeDevice(const char* name);
    ArRangeDevice* findRangeDevice(const char* name) const;
    bool hasRangeDevice(ArRangeDevice* device) const;
    std::list<ArRangeDevice*>* getRangeDeviceList() { return &myDevices; }
    /// Nearest current reading of all range devices, see ArRangeDevice.
    double checkRangeDevicesCurrentPolar(double startAngle, double endAngle,
                                         double* angle = nullptr,
                                         const ArRangeDevice** device = nullptr) const;
    double checkRangeDevicesCumulativePolar(double startAngle, double endAngle,
                                            double* angle = nullptr,
                                            const ArRangeDevice** device = nullptr) const;
    double checkRangeDevicesCurrentBox(double x1, double y1, double x2, double y2,
                                       ArPose* reading = nullptr,
                                       const ArRangeDevice** device = nullptr) const;
    double checkRangeDevicesCumulativeBox(double x1, double y1, double x2, double y2,
                                          ArPose* reading = nullptr,
                                          const ArRangeDevice** device = nullptr) const;
    /// Lasers by their numbers, which begin with 1.
    bool addLaser(ArLaser* laser, int number, bool addAsRangeDevice = true);
    bool remLaser(int number);
    ArLaser* findLaser(int number);
    const ArLaser* findLaser(int number) const;
    std::map<int, ArLaser*>* getLaserMap() { return &myLasers; }
    int getNumLasers() const { return static_cast<int>(myLasers.size()); }
    bool hasLaser(int number) const { return findLaser(number) != nullptr; }

    /// Devices that a program adds; a robot of simrun has none.
    void setPTZ(ArPTZ* camera) { myCamera = camera; }
    ArPTZ* getPTZ() const { return myCamera; }
    std::map<int, ArBatteryMTX*>* getBatteryMap() { return &myBatteries; }

    const char* getName() const { return myName.c_str(); }
    void setName(const char* name) { myName = name; }

    /// True pose in the room, mm and degrees; 0, 0, 0 without a connection.
    ArPose poseInSimulator();
    /// Moves the robot there; odometry does not change. \return false without a connection, and
    /// where it would overlap a body
    bool placeInSimulator(const ArPose& to);
    /// The connection to simrun, null if not connected. Hold the lock.
    sim_aria::Link* link() { return myLink.get(); }

  private:
    friend class ArActionGroup;
    static constexpr int kLastAtExit = -100;
    static constexpr short kEachCycle = 2;  // of commands that ask for packets; 1: the next one
    enum Occasion { Connect, FailedConnect, Disconnect, Loss, RunExit, kOccasions };
    using Tasks = sim_aria::Ordered<ArFunctor*>;

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

    void add(Occasion occasion, ArFunctor* functor, ArListPos::Pos position);
    void remove(Occasion occasion, ArFunctor* functor);
    void call(Occasion occasion);
    bool connect();
    void adoptFigures();
    bool cycle();
    void think();
    void read();
    void handlePackets();
    void handle(ArRobotPacket packet);
    void resolveActions();
    void send();
    void lose();
    void loop(bool stop_if_not_connected);
    void runBySteps(bool stop_if_not_connected);
    void ended();
    void end();
    /// Direct motion begins.
    void takeOver() {
        myDirect = true;
        myReflects = true;
        myDirectSince.setToNow();
        myMotion.unlimited();
    }
    template <class Nearest>
    double nearest(const Nearest& of_device, const ArRangeDevice** device) const;

    std::string myName;
    ArDeviceConnection* myConnection = nullptr;
    std::shared_ptr<std::atomic<int>> myStatus;  // of the connection
    std::unique_ptr<sim_aria::Link> myLink;
    std::recursive_mutex myMutex;
    std::thread myThread;
    std::atomic<bool> myRunning{false}, myConnected{false}, myConnectSoon{false}, myInThread{false};
    std::atomic<bool> myFailed{false};  // the last asyncConnect()
    unsigned int myCycleTime = 100;
    int myTimeout = 8000;

    sim_aria::Motion myMotion;
    ArPose myMoved, myMovedFrom;  // a packet's pose at myMovedFrom is reported as myMoved
    double mySentVel = 0, mySentRotVel = 0;
    ArTime mySent, myDirectSince;
    bool myDirect = false, myReflects = true;
    int myPrecedence = 0, myRefreshTime = 500;
    bool myNoParams = true;
    short myTellsEncoders = 0, myTellsSimulator = 0;
    ArRetFunctor1<double, ArPoseWithTime>* myCorrection = nullptr;

    Tasks mySensorTasks, myUserTasks;
    std::list<ArFunctor*> myCallbacks[kOccasions];
    std::list<ArRetFunctor1<bool, ArRobotPacket*>*> myHandlers;
    ArKeyHandler* myKeys = nullptr;
    ArPriorityResolver myOwnResolver;
    ArResolver* myResolver = &myOwnResolver;
    ArResolver::ActionMap myActions;
    std::list<ArActionGroup*> myGroups;
    std::list<ArRangeDevice*> myDevices;
    std::map<int, ArLaser*> myLasers;
    ArPTZ* myCamera = nullptr;
    std::map<int, ArBatteryMTX*> myBatteries;
};

#include <sim_aria/robot_cycle.h>
#include <sim_aria/robot_parts.h>

#include <sim_aria/laser_scan.h>

#endif  // SIM_ARIA_ROBOT_H
