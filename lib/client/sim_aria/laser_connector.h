// SPDX-License-Identifier: GPL-3.0-or-later
// Connects a robot's lasers, with the words of ARIA's command lines.
#ifndef SIM_ARIA_LASER_CONNECTOR_H
#define SIM_ARIA_LASER_CONNECTOR_H

#include <list>
#include <memory>
#include <string>

#include <sim_aria/connector.h>
#include <sim_aria/laser.h>

/// Connects the lasers that simrun has on the robot, as if its parameter file listed each with
/// LaserAutoConnect. Options that configure a laser are accepted without effect: the scene
/// configures it.
class ArLaserConnector {
  public:
    ArLaserConnector(ArArgumentParser* parser, ArRobot* robot,
                     ArRobotConnector* /*robotConnector*/ = nullptr, bool /*autoParseArgs*/ = true,
                     ArLog::LogLevel /*infoLogLevel*/ = ArLog::Verbose)
        : myParser(parser), myRobot(robot) {
        Aria::addConnector(
            this, [this] { return parseArgs(); }, [this] { logOptions(); });
    }
    virtual ~ArLaserConnector() { Aria::removeConnector(this); }
    ArLaserConnector(const ArLaserConnector&) = delete;
    ArLaserConnector& operator=(const ArLaserConnector&) = delete;

    bool parseArgs() {
        if (!myParser) return true;
        for (const std::string number : {"", "1", "2", "3"}) {
            for (const std::string word : {"-connectLaser", "-cl"})
                myParser->checkArgument((word + number).c_str());
            for (const std::string word :
                 {"-laserPort",          "-lp",   "-laserPortType",      "-lpt",
                  "-laserType",          "-lt",   "-laserDegrees",       "-ld",
                  "-laserIncrement",     "-li",   "-laserUnits",         "-lu",
                  "-laserRemoteTcpPort", "-lrtp", "-laserFlipped",       "-lf",
                  "-laserMaxRange",      "-lmr",  "-laserStartDegrees",  "-lsd",
                  "-laserEndDegrees",    "-led",  "-laserAdditionalArgs"})
                myParser->checkParameterArgument((word + number).c_str());
        }
        return true;
    }
    void logOptions() const {
        ArLog::log(
            ArLog::Terse,
            "-connectLaser, -laserDegrees and the like: without effect, the lasers are those "
            "that the scene has on the robot");
    }

    /// \return false if a laser could not be connected; true without lasers
    bool connectLasers(bool continueOnFailedConnect = false, bool addConnectedLasersToRobot = true,
                       bool addAllLasersToRobot = false, bool /*turnOnLasers*/ = true,
                       bool /*powerCycleLaserOnFailedConnect*/ = true,
                       int* failedOnLaser = nullptr) {
        bool good = true;
        int number = 0;
        for (const std::string& id : ids()) {
            ++number;
            if (myRobot->hasLaser(number)) continue;
            myLasers.emplace_back(new ArLaser(number, id));
            ArLaser* const laser = myLasers.back().get();
            laser->setRobot(myRobot);
            const bool connected = laser->blockingConnect();
            if (addAllLasersToRobot || (connected && addConnectedLasersToRobot))
                myRobot->addLaser(laser, number);
            if (connected) continue;
            good = false;
            if (failedOnLaser) *failedOnLaser = number;
            if (!continueOnFailedConnect) return false;
        }
        return good;
    }
    bool connectLaser(ArLaser* laser, int number, bool addConnectedLaserToRobot = true) {
        laser->setRobot(myRobot);
        if (!laser->blockingConnect()) return false;
        return !addConnectedLaserToRobot || myRobot->addLaser(laser, number);
    }
    void logLaserData() const {
        for (const auto& laser : myLasers)
            ArLog::log(ArLog::Terse, "laser #%d: %s in simrun, %g to %g degrees by %g, up to %u mm",
                       laser->getLaserNumber(), laser->getSimId(), laser->getStartDegrees(),
                       laser->getEndDegrees(), laser->getIncrement(), laser->getMaxRange());
    }

  private:
    std::vector<std::string> ids() {
        std::vector<std::string> found;
        myRobot->lock();
        try {
            if (myRobot->link()) found = myRobot->link()->lasers();
        } catch (const ispace::client::Error& error) {
            ArLog::log(ArLog::Terse, "Could not list the lasers: %s", error.what());
        }
        myRobot->unlock();
        return found;
    }

    ArArgumentParser* myParser;
    ArRobot* myRobot;
    std::list<std::unique_ptr<ArLaser>> myLasers;
};

inline bool ArSimpleConnector::setupLaser(ArLaser* laser) {
    if (!laser->getRobot()) laser->setRobot(myRobot);
    return laser->getRobot() != nullptr;
}

inline bool ArSimpleConnector::connectLaser(ArLaser* laser) {
    return setupLaser(laser) && laser->blockingConnect();
}

#endif  // SIM_ARIA_LASER_CONNECTOR_H
