// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef SIM_ARIA_CONNECTOR_H
#define SIM_ARIA_CONNECTOR_H

#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <sim_aria/robot.h>

/// The words of the command line, without those already parsed.
class ArArgumentParser {
  public:
    ArArgumentParser(int* argc, char** argv) : myCount(argc), myWords(argv) {}

    void loadDefaultArguments(int = 1) {}
    /// Finds and removes `-word` or `--word`.
    bool checkArgument(const char* word) {
        const int i = find(word);
        if (i < 0) return false;
        take(i, 1);
        return true;
    }
    /// Finds and removes an option; returns its value, null if missing.
    const char* checkParameterArgument(const char* word) {
        const int i = find(word);
        if (i < 0) return nullptr;
        if (i + 1 >= *myCount) {
            take(i, 1);
            return nullptr;
        }
        const char* const value = myWords[i + 1];
        take(i, 2);
        return value;
    }
    bool checkHelpAndWarnUnparsed(unsigned int = 1) {
        if (checkArgument("-help") || checkArgument("-h")) return false;
        for (int i = 1; i < *myCount; ++i)
            ArLog::log(ArLog::Terse, "Unknown argument: %s", myWords[i]);
        return true;
    }
    int getArgc() const { return *myCount; }
    char** getArgv() const { return myWords; }

  private:
    int find(const char* word) const {
        for (int i = 1; i < *myCount; ++i)
            if (std::strcmp(myWords[i], word) == 0 ||
                (myWords[i][0] == '-' && std::strcmp(myWords[i] + 1, word) == 0))
                return i;
        return -1;
    }
    void take(int i, int count) {
        for (int k = i; k + count < *myCount; ++k) myWords[k] = myWords[k + count];
        *myCount -= count;
        myWords[*myCount] = nullptr;
    }

    int* myCount;
    char** myWords;
};

/// Connects a robot by the command line: -remoteHost (-rh), -remoteRobotTcpPort (-rrtp), -robotPort
/// (-rp). The variable ISPACE_SIMRUN overrides the server.
class ArSimpleConnector {
  public:
    ArSimpleConnector(int* argc, char** argv) : myOwn(argc, argv), myParser(&myOwn) {}
    explicit ArSimpleConnector(ArArgumentParser* parser)
        : myOwn(nullptr, nullptr), myParser(parser) {}

    bool parseArgs() {
        for (const char* word : {"-remoteHost", "-rh"})
            if (const char* value = myParser->checkParameterArgument(word)) myHost = value;
        for (const char* word : {"-remoteRobotTcpPort", "-rrtp"})
            if (const char* value = myParser->checkParameterArgument(word))
                myPort = std::atoi(value);
        for (const char* word : {"-robotPort", "-rp"})
            if (const char* value = myParser->checkParameterArgument(word)) mySerialPort = value;
        return true;
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
    bool setupRobot(ArRobot* robot) {
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
    bool connectRobot(ArRobot* robot) { return setupRobot(robot) && robot->blockingConnect(); }

  private:
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
    ArRobotConnector(ArArgumentParser* parser, ArRobot* robot, bool /*autoParseArgs*/ = true)
        : mySimple(parser), myRobot(robot) {
        mySimple.parseArgs();
    }
    bool parseArgs() { return mySimple.parseArgs(); }
    void logOptions() const { mySimple.logOptions(); }
    bool connectRobot() { return connectRobot(myRobot); }
    bool connectRobot(ArRobot* robot) { return mySimple.connectRobot(robot); }

  private:
    ArSimpleConnector mySimple;
    ArRobot* myRobot;
};

#endif  // SIM_ARIA_CONNECTOR_H
