// SPDX-License-Identifier: GPL-3.0-or-later
// Lasers as range devices: the points of the newest scan, in the frame of the robot's odometry.
// Millimetres and degrees. Their implementation is laser_scan.h.
#ifndef SIM_ARIA_LASER_H
#define SIM_ARIA_LASER_H

#include <list>
#include <string>
#include <vector>

#include <ispace_client/reading.h>
#include <sim_aria/functor_kinds.h>
#include <sim_aria/range_device.h>
#include <sim_aria/typedefs.h>

/// A laser on a robot of simrun: its current buffer holds the points of the newest scan, each at
/// the pose of the robot when it was measured. It is read in the robot's cycle: scans that come
/// between two cycles are skipped. Hold lockDevice() around readings in other threads.
class ArLaser : public ArRangeDevice {
  public:
    /// \param id the laser in simrun; "": the one of this number on the robot
    ArLaser(int number, const std::string& id, const std::string& name = "sim_lms_",
            bool appendNumber = true)
        : ArRangeDevice(0, 0, (name + (appendNumber ? std::to_string(number) : "")).c_str(), 0),
          myNumber(number),
          myId(id),
          myTask(this, &ArLaser::update) {}
    ~ArLaser() override { disconnect(); }

    int getLaserNumber() const { return myNumber; }
    const char* getSimId() const { return myId.c_str(); }
    virtual bool isConnected() { return myConnected; }
    bool isTryingToConnect() const { return false; }
    /// Begins to read scans in the cycles of the robot.
    virtual bool blockingConnect();
    virtual bool asyncConnect() { return blockingConnect(); }
    virtual bool disconnect();
    /// The robot's cycle reads it, without a thread of its own.
    void runAsync() {}
    void stopRunning() {}

    /// Bearings of the first and last beam, degrees.
    double getStartDegrees() const { return myStart; }
    double getEndDegrees() const { return myEnd; }
    double getDegrees() const { return myEnd - myStart; }
    double getIncrement() const { return myStep; }
    double getIncrementDouble() const { return myStep; }
    bool isFlipped() const { return false; }
    ArPose getSensorPosition() const { return mySensor; }
    bool hasSensorPosition() const { return true; }
    /// Beams that end nearer than this are to ignore, mm.
    void setMinRange(unsigned int mm) { myMinRange = mm; }
    unsigned int getMinRange() const { return myMinRange; }
    double getAbsoluteMaxRange() const { return getMaxRange(); }
    /// Scans read in total.
    int getReadingCount() const { return myCount; }

    /// One reading for each beam, clockwise if the laser turns so; beams without a return have the
    /// maximum range and are to ignore.
    const std::list<ArSensorReading*>* getRawReadings() const override { return &myPointers; }
    const std::list<ArSensorReading*>* getAdjustedRawReadings() const { return &myPointers; }
    std::vector<ArSensorReading> getRawReadingsAsVector() const { return myReadings; }

    void applyTransform(ArTransform change, bool doCumulative = true) override {
        ArRangeDevice::applyTransform(change, doCumulative);
        for (ArSensorReading& reading : myReadings) reading.applyTransform(change);
    }

    /// Functions to call after each new scan, in the robot's cycle.
    void addReadingCB(ArFunctor* functor, ArListPos::Pos position = ArListPos::LAST) {
        myCallbacks.insert(position == ArListPos::FIRST ? myCallbacks.begin() : myCallbacks.end(),
                           functor);
    }
    void remReadingCB(ArFunctor* functor) { myCallbacks.remove(functor); }

  private:
    friend class ArRobot;
    void update();
    void adopt(const ispace::client::Scan& scan);

    int myNumber;
    unsigned int myMinRange = 0;
    std::string myId;
    ArFunctorC<ArLaser> myTask;
    ArRobot* myReader = nullptr;  // robot whose cycle runs the task
    bool myConnected = false;
    ArPose mySensor;
    double myStart = 0, myEnd = 0, myStep = 1;
    int myCount = 0;
    long mySeq = -1;
    std::vector<ArSensorReading> myReadings;
    std::list<ArSensorReading*> myPointers;
    std::list<ArFunctor*> myCallbacks;
};

/// The kinds of lasers that programs make: the laser of that number on the robot, of any kind.
class ArLMS2xx : public ArLaser {
  public:
    explicit ArLMS2xx(int laserNumber = 1, const char* name = "lms2xx_", bool appendNumber = true)
        : ArLaser(laserNumber, "", name, appendNumber) {}
};
class ArSick : public ArLMS2xx {
  public:
    explicit ArSick(int laserNumber = 1, const char* name = "sick_", bool appendNumber = true)
        : ArLMS2xx(laserNumber, name, appendNumber) {}
};
class ArLMS1XX : public ArLaser {
  public:
    explicit ArLMS1XX(int laserNumber = 1, const char* name = "lms1XX_", bool appendNumber = true)
        : ArLaser(laserNumber, "", name, appendNumber) {}
};
class ArUrg : public ArLaser {
  public:
    explicit ArUrg(int laserNumber = 1, const char* name = "urg_", bool appendNumber = true)
        : ArLaser(laserNumber, "", name, appendNumber) {}
};

#include <sim_aria/robot.h>

#endif  // SIM_ARIA_LASER_H
