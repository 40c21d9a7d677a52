// SPDX-License-Identifier: GPL-3.0-or-later
// Without -robotPort TCP is tried first and the serial line next, as ARIA does for a simulator and
// a robot; here both lead to simrun.
#ifndef SIM_ARIA_CONNECTOR_H
#define SIM_ARIA_CONNECTOR_H

#include <cstdlib>
#include <string>

#include <sim_aria/arguments.h>
#include <sim_aria/robot.h>

class ArLaser;

/// Connects a robot by the command line: -remoteHost (-rh), -remoteRobotTcpPort (-rrtp), -robotPort
/// (-rp). The variable ISPACE_SIMRUN overrides the server.
class ArSimpleConnector {
  public:
    ArSimpleConnector(int* argc, char** argv) : myOwn(argc, argv), myParser(&myOwn) { enroll(); }
    /// \param parser null: the defaults
    explicit ArSimpleConnector(ArArgumentParser* parser)
        : myOwn(&myNone, nullptr), myParser(parser ? parser : &myOwn) {
        enroll();
    }
    virtual ~ArSimpleConnector() { Aria::removeConnector(this); }
    ArSimpleConnector(const ArSimpleConnector&) = delete;
    ArSimpleConnector& operator=(const ArSimpleConnector&) = delete;

    bool parseArgs() {
        for (const char* word : {"-remoteHost", "-rh"})
            if (const char* value = myParser->checkParameterArgument(word)) myHost = value;
        for (const char* word : {"-robotPort", "-rp"})
            if (const char* value = myParser->checkParameterArgument(word)) mySerialPort = value;
        bool good = true;
        for (const char* word : {"-remoteRobotTcpPort", "-rrtp"})
            good = myParser->checkParameterArgumentInteger(word, &myPort) && good;
        // Without an effect here.
        for (const char* word : {"-robotBaud", "-rb", "-remoteLaserTcpPort", "-rltp"})
            myParser->checkParameterArgument(word);
        for (const char* word : {"-remoteIsSim", "-ris", "-remoteIsNotSim", "-rins"})
            myParser->checkArgument(word);
        return good;
    }
    bool parseArgs(ArArgumentParser* parser) {
        myParser = parser;
        return parseArgs();
    }
    void logOptions() const {
        ArLog::log(ArLog::Terse,
                   "-remoteHost <host>, -remoteRobotTcpPort <port>, -robotPort <device>\n"
                   "In the environment: ISPACE_SIMRUN=HOST:PORT, ISPACE_ROBOT=ID");
    }
    /// Chooses and opens the connection.
    bool setupRobot(ArRobot* robot) {
        myRobot = robot;
        if (mySerialPort.empty()) {
            myTcp.setPort(myHost.c_str(), myPort);
            if (myTcp.openSimple()) {
                robot->setDeviceConnection(&myTcp);
                return true;
            }
        }
        if (!mySerialPort.empty()) mySerial.setPort(mySerialPort.c_str());
        robot->setDeviceConnection(&mySerial);
        return mySerial.openSimple();
    }
    bool connectRobot(ArRobot* robot) {
        if (!setupRobot(robot))
            ArLog::log(
                ArLog::Terse, "No simrun at %s",
                sim_aria::serverName().empty() ? "127.0.0.1:7001" : sim_aria::serverName().c_str());
        return robot->blockingConnect();
    }
    /// Lets the laser read from the robot that was set up, unless it has another.
    bool setupLaser(ArLaser* laser);
    bool connectLaser(ArLaser* laser);

  private:
    void enroll() {
        Aria::addConnector(
            this, [this] { return parseArgs(); }, [this] { logOptions(); });
    }

    int myNone = 0;
    ArRobot* myRobot = nullptr;
    ArArgumentParser myOwn;
    ArArgumentParser* myParser;
    std::string myHost = "localhost", mySerialPort;
    int myPort = 8101;
    ArTcpConnection myTcp;
    ArSerialConnection mySerial;
};

/// The same class in newer versions of ARIA.
class ArRobotConnector {
  public:
    ArRobotConnector(ArArgumentParser* parser, ArRobot* robot, bool autoParseArgs = true)
        : mySimple(parser), myRobot(robot), myParses(autoParseArgs) {}
    bool parseArgs() { return mySimple.parseArgs(); }
    void logOptions() const { mySimple.logOptions(); }
    bool connectRobot() { return connectRobot(myRobot); }
    bool connectRobot(ArRobot* robot) {
        if (myParses) mySimple.parseArgs();
        return mySimple.connectRobot(robot);
    }
    bool setupRobot() { return setupRobot(myRobot); }
    bool setupRobot(ArRobot* robot) {
        if (myParses) mySimple.parseArgs();
        return mySimple.setupRobot(robot);
    }
    ArRobot* getRobot() const { return myRobot; }
    void setRobot(ArRobot* robot) { myRobot = robot; }
    void setResetOldConnection(bool) {}
    bool getRemoteIsSim() const { return true; }

  private:
    ArSimpleConnector mySimple;
    ArRobot* myRobot;
    bool myParses;
};

#endif  // SIM_ARIA_CONNECTOR_H
