// SPDX-License-Identifier: GPL-3.0-or-later
// Points of sonars, lasers and bumpers for actions and programs. Directions and rectangles are in
// the robot's frame of the last cycle, points in that of its pose. Hold lockDevice() around lists
// of points: the robot's cycle changes them.
#ifndef SIM_ARIA_RANGE_DEVICE_H
#define SIM_ARIA_RANGE_DEVICE_H

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <sim_aria/geometry.h>
#include <sim_aria/range_buffer.h>
#include <sim_aria/util.h>

class ArRobot;

/// Last measurement of one sonar, or of one beam.
class ArSensorReading {
  public:
    /// \param x, y, th pose of the sonar on the robot, mm and degrees
    ArSensorReading(double x = 0, double y = 0, double th = 0) : mySensor(x, y, th) {}

    /// mm from the sonar; 5000 if a sonar had no echo.
    int getRange() const { return myRange; }
    /// Position of the echo in the frame of the robot's odometry, mm.
    double getX() const { return myHit.getX(); }
    double getY() const { return myHit.getY(); }
    ArPose getPose() const { return myHit; }
    /// The same in the robot's frame.
    double getLocalX() const { return myLocal.getX(); }
    double getLocalY() const { return myLocal.getY(); }
    ArPose getLocalPose() const { return myLocal; }
    double getSensorX() const { return mySensor.getX(); }
    double getSensorY() const { return mySensor.getY(); }
    double getSensorTh() const { return mySensor.getTh(); }
    ArPose getSensorPosition() const { return mySensor; }
    /// Pose of the robot at that time.
    ArPose getPoseTaken() const { return myTaken; }
    ArPose getEncoderPoseTaken() const { return myEncoderTaken; }
    ArTime getTimeTaken() const { return myTime; }
    bool isNew(unsigned int counter) const { return counter == myCounter; }
    unsigned int getCounterTaken() const { return myCounter; }
    void resetSensorPosition(double x, double y, double th) { mySensor = ArPose(x, y, th); }
    /// A reading that holds no obstacle.
    void setIgnoreThisReading(bool ignore) { myIgnored = ignore; }
    bool getIgnoreThisReading() const { return myIgnored; }
    int getExtraInt() const { return myExtra; }
    void setExtraInt(int extra) { myExtra = extra; }

    /// Stores a range, measured at these poses of the robot in this cycle.
    void newData(double range, ArPose robot, ArPose encoder, ArTransform toGlobal,
                 unsigned int counter, ArTime time, bool ignore = false, int extra = 0) {
        myRange = ArMath::roundInt(range);
        myTaken = robot;
        myEncoderTaken = encoder;
        myCounter = counter;
        myTime = time;
        myIgnored = ignore;
        myExtra = extra;
        const double th = mySensor.getTh();
        myLocal.setPose(mySensor.getX() + range * ArMath::cos(th),
                        mySensor.getY() + range * ArMath::sin(th));
        myHit = toGlobal.doTransform(myLocal);
    }
    /// Moves the echo and the poses at that time.
    void applyTransform(ArTransform change) {
        myHit = change.doTransform(myHit);
        myTaken = change.doTransform(myTaken);
    }
    void newData(int range, ArPose robot, unsigned int counter) {
        newData(range, robot, robot, ArTransform(robot), counter, ArTime());
    }

  private:
    ArPose mySensor, myHit, myLocal, myTaken, myEncoderTaken;
    int myRange = 5000, myExtra = 0;
    unsigned int myCounter = 0;
    bool myIgnored = false;
    ArTime myTime;
};

class ArColor {
  public:
    explicit ArColor(unsigned char red = 255, unsigned char green = 255, unsigned char blue = 255)
        : myRed(red), myGreen(green), myBlue(blue) {}
    unsigned char getRed() const { return myRed; }
    unsigned char getGreen() const { return myGreen; }
    unsigned char getBlue() const { return myBlue; }

  private:
    unsigned char myRed, myGreen, myBlue;
};

/// How a viewer of ARIA's would draw points; stored alone, as no viewer connects.
class ArDrawingData {
  public:
    ArDrawingData(const char* shape, ArColor primary, int size, int layer,
                  unsigned int refreshTime = 200, ArColor secondary = ArColor())
        : myShape(shape),
          myPrimary(primary),
          mySecondary(secondary),
          mySize(size),
          myLayer(layer),
          myRefreshTime(refreshTime) {}
    const char* getShape() const { return myShape.c_str(); }
    ArColor getPrimaryColor() const { return myPrimary; }
    ArColor getSecondaryColor() const { return mySecondary; }
    int getSize() const { return mySize; }
    int getLayer() const { return myLayer; }
    unsigned int getDefaultRefreshTime() const { return myRefreshTime; }

  private:
    std::string myShape;
    ArColor myPrimary, mySecondary;
    int mySize, myLayer;
    unsigned int myRefreshTime;
};

/// A device on a robot that measures distances: stores recent points in the frame of the robot's
/// odometry.
class ArRangeDevice {
  public:
    ArRangeDevice(std::size_t currentBufferSize, std::size_t cumulativeBufferSize, const char* name,
                  unsigned int maxRange, int maxSecondsToKeepCurrent = 0,
                  int maxSecondsToKeepCumulative = 0, double maxDistToKeepCumulative = 0,
                  bool locationDependent = false)
        : myCurrentBuffer(currentBufferSize),
          myCumulativeBuffer(cumulativeBufferSize),
          myName(name),
          myMaxRange(maxRange),
          myCurrentSeconds(maxSecondsToKeepCurrent),
          myCumulativeSeconds(maxSecondsToKeepCumulative),
          myCumulativeDistance(maxDistToKeepCumulative),
          myLocationDependent(locationDependent) {}
    /// Removes itself from its robot.
    virtual ~ArRangeDevice();
    ArRangeDevice(const ArRangeDevice&) = delete;
    ArRangeDevice& operator=(const ArRangeDevice&) = delete;

    const char* getName() const { return myName.c_str(); }
    void setName(const char* name) { myName = name; }
    unsigned int getMaxRange() const { return myMaxRange; }
    void setMaxRange(unsigned int mm) { myMaxRange = mm; }
    bool isLocationDependent() const { return myLocationDependent; }
    ArRobot* getRobot() { return myRobot; }
    /// Called by ArRobot::addRangeDevice().
    virtual void setRobot(ArRobot* robot) { myRobot = robot; }

    int lockDevice() {
        myMutex.lock();
        return 0;
    }
    int unlockDevice() {
        myMutex.unlock();
        return 0;
    }
    int tryLockDevice() { return myMutex.try_lock() ? 0 : 1; }
    int lock() { return lockDevice(); }
    int unlock() { return unlockDevice(); }
    int tryLock() { return tryLockDevice(); }

    /// Distance from the robot's centre to the nearest point between the directions `startAngle`
    /// and, counter-clockwise, `endAngle` of the robot, mm; the maximum range if there is none.
    virtual double currentReadingPolar(double startAngle, double endAngle,
                                       double* angle = nullptr) const {
        return myCurrentBuffer.getClosestPolar(startAngle, endAngle, myPose, myMaxRange, angle);
    }
    virtual double cumulativeReadingPolar(double startAngle, double endAngle,
                                          double* angle = nullptr) const {
        return myCumulativeBuffer.getClosestPolar(startAngle, endAngle, myPose, myMaxRange, angle);
    }
    /// The same of the points in a rectangle of the robot's frame.
    virtual double currentReadingBox(double x1, double y1, double x2, double y2,
                                     ArPose* reading = nullptr) const {
        return myCurrentBuffer.getClosestBox(x1, y1, x2, y2, myPose, myMaxRange, reading);
    }
    virtual double cumulativeReadingBox(double x1, double y1, double x2, double y2,
                                        ArPose* reading = nullptr) const {
        return myCumulativeBuffer.getClosestBox(x1, y1, x2, y2, myPose, myMaxRange, reading);
    }
    /// Points in the frame of the robot's odometry, the newest first.
    const std::list<ArPoseWithTime>& getCurrentReadings() const {
        return myCurrentBuffer.getReadings();
    }
    const std::list<ArPoseWithTime>& getCumulativeReadings() const {
        return myCumulativeBuffer.getReadings();
    }
    const ArRangeBuffer& getCurrentRangeBuffer() const { return myCurrentBuffer; }
    const ArRangeBuffer& getCumulativeRangeBuffer() const { return myCumulativeBuffer; }
    ArRangeBuffer* getCurrentRangeBufferPtr() { return &myCurrentBuffer; }
    ArRangeBuffer* getCumulativeRangeBufferPtr() { return &myCumulativeBuffer; }
    /// Pointers to the points, as in older versions of ARIA.
    std::list<ArPoseWithTime*>* getCurrentBuffer() { return myCurrentBuffer.getBuffer(); }
    std::list<ArPoseWithTime*>* getCumulativeBuffer() { return myCumulativeBuffer.getBuffer(); }
    std::vector<ArPoseWithTime> getCurrentBufferAsVector() const {
        return myCurrentBuffer.getBufferAsVector();
    }
    std::vector<ArPoseWithTime> getCumulativeBufferAsVector() const {
        return myCumulativeBuffer.getBufferAsVector();
    }
    void setCurrentBufferSize(std::size_t size) { myCurrentBuffer.setSize(size); }
    void setCumulativeBufferSize(std::size_t size) { myCumulativeBuffer.setSize(size); }
    void clearCurrentReadings() { myCurrentBuffer.clear(); }
    void clearCumulativeReadings() { myCumulativeBuffer.clear(); }
    virtual void addReading(double x, double y) {
        myCurrentBuffer.addReading(x, y);
        myCumulativeBuffer.addReading(x, y);
    }
    /// Moves all points with the robot, see ArRobot::moveTo().
    virtual void applyTransform(ArTransform change, bool doCumulative = true) {
        myCurrentBuffer.applyTransform(change);
        if (doCumulative) myCumulativeBuffer.applyTransform(change);
        myPose = change.doTransform(myPose);
    }
    /// Readings of all beams in the last sweep; null for a device without.
    virtual const std::list<ArSensorReading*>* getRawReadings() const { return nullptr; }

    /// Writes the limits, or the points, to the log.
    void logConfig(ArLog::LogLevel level = ArLog::Normal, const char* prefix = "") const {
        ArLog::log(level,
                   "%s%s: range %u mm; current: %zu points, %d s; cumulative: %zu points, %d s, "
                   "%.0f mm",
                   prefix, getName(), myMaxRange, myCurrentBuffer.getSize(), myCurrentSeconds,
                   myCumulativeBuffer.getSize(), myCumulativeSeconds, myCumulativeDistance);
    }
    void logData(ArLog::LogLevel level = ArLog::Normal, const char* prefix = "") const {
        myCurrentBuffer.logData(level, prefix, getName(), "current");
        myCumulativeBuffer.logData(level, prefix, getName(), "cumulative");
    }

    void setCurrentDrawingData(ArDrawingData* data, bool takeOwnership) {
        myCurrentDrawing = Drawing(data, takeOwnership ? destroy : keep);
    }
    void setCumulativeDrawingData(ArDrawingData* data, bool takeOwnership) {
        myCumulativeDrawing = Drawing(data, takeOwnership ? destroy : keep);
    }
    ArDrawingData* getCurrentDrawingData() { return myCurrentDrawing.get(); }
    ArDrawingData* getCumulativeDrawingData() { return myCumulativeDrawing.get(); }

    /// Called by ArRobot in each cycle.
    virtual void processReadings(const std::vector<ArSensorReading>&, const ArPose& robot) {
        myPose = robot;
        if (myCurrentSeconds > 0) myCurrentBuffer.clearOlderThanSeconds(myCurrentSeconds);
        if (myCumulativeSeconds > 0) myCumulativeBuffer.clearOlderThanSeconds(myCumulativeSeconds);
        if (myCumulativeDistance > 0)
            myCumulativeBuffer.clearFartherThan(myCumulativeDistance, myPose);
    }

  protected:
    ArRangeBuffer myCurrentBuffer, myCumulativeBuffer;
    std::recursive_mutex myMutex;

  private:
    friend class ArRobot;
    using Drawing = std::unique_ptr<ArDrawingData, void (*)(ArDrawingData*)>;
    static void destroy(ArDrawingData* data) { delete data; }
    static void keep(ArDrawingData*) {}

    std::string myName;
    unsigned int myMaxRange;
    int myCurrentSeconds, myCumulativeSeconds;  // 0: no limit
    double myCumulativeDistance;                // mm; 0: no limit
    bool myLocationDependent;
    ArRobot* myRobot = nullptr;
    ArPose myPose;  // of the robot in the last cycle
    Drawing myCurrentDrawing{nullptr, keep}, myCumulativeDrawing{nullptr, keep};
};

/// The ring of sonars: points for 5 s (24 of them) and 15 s (64 within 3 m).
class ArSonarDevice : public ArRangeDevice {
  public:
    ArSonarDevice(std::size_t currentBufferSize = 24, std::size_t cumulativeBufferSize = 64,
                  const char* name = "sonar")
        : ArRangeDevice(currentBufferSize, cumulativeBufferSize, name, 5000, 5, 15, 3000) {}

    void processReadings(const std::vector<ArSensorReading>& sonars, const ArPose& robot) override {
        ArRangeDevice::processReadings(sonars, robot);
        for (const ArSensorReading& sonar : sonars)
            if (sonar.getRange() < static_cast<int>(getMaxRange()))
                addReading(sonar.getX(), sonar.getY());
    }
};

#endif  // SIM_ARIA_RANGE_DEVICE_H
