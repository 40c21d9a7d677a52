// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef SIM_ARIA_RANGE_DEVICE_H
#define SIM_ARIA_RANGE_DEVICE_H

#include <cstddef>
#include <list>
#include <mutex>
#include <string>
#include <vector>

#include <sim_aria/util.h>

class ArRobot;

/// Last measurement of one sonar.
class ArSensorReading {
  public:
    /// \param x, y, th pose of the sonar on the robot, mm and degrees
    ArSensorReading(double x = 0, double y = 0, double th = 0) : mySensor(x, y, th) {}

    /// mm from the sonar; 5000 if there was no echo.
    int getRange() const { return myRange; }
    /// Position of the echo in the frame of the robot's odometry, mm.
    double getX() const { return myHit.getX(); }
    double getY() const { return myHit.getY(); }
    ArPose getPose() const { return myHit; }
    /// The same in the robot's frame.
    double getLocalX() const { return myLocal.getX(); }
    double getLocalY() const { return myLocal.getY(); }
    double getSensorX() const { return mySensor.getX(); }
    double getSensorY() const { return mySensor.getY(); }
    double getSensorTh() const { return mySensor.getTh(); }
    /// Pose of the robot at that time.
    ArPose getPoseTaken() const { return myTaken; }
    bool isNew(unsigned int counter) const { return counter == myCounter; }
    unsigned int getCounterTaken() const { return myCounter; }

    /// For ArRobot: stores a range, measured at this pose of the robot in this cycle.
    void newData(int range, ArPose robot, unsigned int counter) {
        myRange = range;
        myTaken = robot;
        myCounter = counter;
        const double th = mySensor.getTh();
        myLocal.setPose(mySensor.getX() + range * ArMath::cos(th),
                        mySensor.getY() + range * ArMath::sin(th));
        const double c = ArMath::cos(robot.getTh()), s = ArMath::sin(robot.getTh());
        myHit.setPose(robot.getX() + c * myLocal.getX() - s * myLocal.getY(),
                      robot.getY() + s * myLocal.getX() + c * myLocal.getY());
    }

  private:
    ArPose mySensor, myHit, myLocal, myTaken;
    int myRange = 5000;
    unsigned int myCounter = 0;
};

/// A device on a robot that measures distances: stores recent points in the frame of the robot's
/// odometry.
class ArRangeDevice {
  public:
    ArRangeDevice(std::size_t currentBufferSize, std::size_t cumulativeBufferSize, const char* name,
                  unsigned int maxRange, int maxSecondsToKeepCurrent = 0,
                  int maxSecondsToKeepCumulative = 0, double maxDistToKeepCumulative = 0)
        : myName(name),
          myMaxRange(maxRange),
          myCurrent{currentBufferSize, maxSecondsToKeepCurrent, 0, {}},
          myCumulative{
              cumulativeBufferSize, maxSecondsToKeepCumulative, maxDistToKeepCumulative, {}} {}
    virtual ~ArRangeDevice() {
        clear(myCurrent);
        clear(myCumulative);
    }
    ArRangeDevice(const ArRangeDevice&) = delete;
    ArRangeDevice& operator=(const ArRangeDevice&) = delete;

    const char* getName() const { return myName.c_str(); }
    unsigned int getMaxRange() const { return myMaxRange; }
    void setMaxRange(unsigned int mm) { myMaxRange = mm; }
    ArRobot* getRobot() { return myRobot; }
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

    /// Distance from the robot's centre to the nearest point between the directions `startAngle`
    /// and, counter-clockwise, `endAngle` of the robot, mm; the maximum range if there is none.
    double currentReadingPolar(double startAngle, double endAngle, double* angle = nullptr) const {
        return nearestPolar(myCurrent, startAngle, endAngle, angle);
    }
    double cumulativeReadingPolar(double startAngle, double endAngle,
                                  double* angle = nullptr) const {
        return nearestPolar(myCumulative, startAngle, endAngle, angle);
    }
    /// The same of the points in a rectangle of the robot's frame.
    double currentReadingBox(double x1, double y1, double x2, double y2,
                             ArPose* reading = nullptr) const {
        return nearestBox(myCurrent, x1, y1, x2, y2, reading);
    }
    double cumulativeReadingBox(double x1, double y1, double x2, double y2,
                                ArPose* reading = nullptr) const {
        return nearestBox(myCumulative, x1, y1, x2, y2, reading);
    }
    const std::list<ArPoseWithTime*>* getCurrentBuffer() const { return &myCurrent.points; }
    const std::list<ArPoseWithTime*>* getCumulativeBuffer() const { return &myCumulative.points; }
    virtual void addReading(double x, double y) {
        add(myCurrent, x, y);
        add(myCumulative, x, y);
    }

    /// Called by ArRobot in each cycle.
    virtual void processReadings(const std::vector<ArSensorReading>&, const ArPose& robot) {
        myPose = robot;
        forget(myCurrent);
        forget(myCumulative);
    }

  protected:
    std::recursive_mutex myMutex;

  private:
    struct Buffer {
        std::size_t size;
        int seconds;      // 0: no limit
        double distance;  // mm from the robot; 0: no limit
        std::list<ArPoseWithTime*> points;
    };

    static void clear(Buffer& buffer) {
        for (ArPoseWithTime* point : buffer.points) delete point;
        buffer.points.clear();
    }
    static void add(Buffer& buffer, double x, double y) {
        buffer.points.push_front(new ArPoseWithTime(x, y));
        while (buffer.points.size() > buffer.size) {
            delete buffer.points.back();
            buffer.points.pop_back();
        }
    }
    void forget(Buffer& buffer) const {
        for (auto at = buffer.points.begin(); at != buffer.points.end();) {
            const bool old =
                buffer.seconds > 0 && (*at)->getTime().mSecSince() > 1000L * buffer.seconds;
            const bool far = buffer.distance > 0 && myPose.findDistanceTo(**at) > buffer.distance;
            if (old || far) {
                delete *at;
                at = buffer.points.erase(at);
            } else {
                ++at;
            }
        }
    }
    double nearestPolar(const Buffer& buffer, double start, double end, double* angle) const {
        double nearest = myMaxRange;
        for (const ArPoseWithTime* point : buffer.points) {
            const double bearing = ArMath::subAngle(myPose.findAngleTo(*point), myPose.getTh());
            const double distance = myPose.findDistanceTo(*point);
            if (distance >= nearest || !ArMath::angleBetween(bearing, start, end)) continue;
            nearest = distance;
            if (angle) *angle = bearing;
        }
        return nearest;
    }
    double nearestBox(const Buffer& buffer, double x1, double y1, double x2, double y2,
                      ArPose* reading) const {
        double nearest = myMaxRange;
        for (const ArPoseWithTime* point : buffer.points) {
            const double bearing = ArMath::subAngle(myPose.findAngleTo(*point), myPose.getTh());
            const double distance = myPose.findDistanceTo(*point);
            const double x = distance * ArMath::cos(bearing), y = distance * ArMath::sin(bearing);
            const bool inside = x >= ArUtil::findMin(x1, x2) && x <= ArUtil::findMax(x1, x2) &&
                                y >= ArUtil::findMin(y1, y2) && y <= ArUtil::findMax(y1, y2);
            if (!inside || distance >= nearest) continue;
            nearest = distance;
            if (reading) *reading = *point;
        }
        return nearest;
    }

    std::string myName;
    unsigned int myMaxRange;
    ArRobot* myRobot = nullptr;
    ArPose myPose;  // of the robot in the last cycle
    Buffer myCurrent, myCumulative;
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
