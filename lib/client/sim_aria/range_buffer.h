// SPDX-License-Identifier: GPL-3.0-or-later
// Recent points of a range device, for the searches of actions: the nearest in a box or a sector.
#ifndef SIM_ARIA_RANGE_BUFFER_H
#define SIM_ARIA_RANGE_BUFFER_H

#include <cstddef>
#include <cstdio>
#include <iterator>
#include <list>
#include <vector>

#include <sim_aria/geometry.h>
#include <sim_aria/util.h>

/// The last points that a range device measured, the newest first. Adding is O(1), searches visit
/// all points. Not thread-safe: its device's lock guards it.
class ArRangeBuffer {
  public:
    using Points = std::list<ArPoseWithTime>;

    explicit ArRangeBuffer(std::size_t size) : mySize(size) {}
    virtual ~ArRangeBuffer() {}
    ArRangeBuffer(const ArRangeBuffer&) = delete;
    ArRangeBuffer& operator=(const ArRangeBuffer&) = delete;

    /// The largest number of points.
    std::size_t getSize() const { return mySize; }
    std::size_t getCapacity() const { return mySize; }
    std::size_t getCurrentSize() const { return myPoints.size(); }
    void setSize(std::size_t size) {
        mySize = size;
        shorten();
    }
    void setCapacity(std::size_t size) { setSize(size); }
    /// The points, and, as in older versions of ARIA, pointers to them.
    const Points& getReadings() const { return myPoints; }
    Points::const_iterator getBegin() const { return myPoints.begin(); }
    Points::const_iterator getEnd() const { return myPoints.end(); }
    const std::list<ArPoseWithTime*>* getBuffer() const { return &myPointers; }
    std::list<ArPoseWithTime*>* getBuffer() { return &myPointers; }
    std::vector<ArPoseWithTime> getBufferAsVector() const {
        return std::vector<ArPoseWithTime>(myPoints.begin(), myPoints.end());
    }

    void addReading(double x, double y) { addReading(ArPoseWithTime(x, y)); }
    void addReading(const ArPoseWithTime& point) {
        myPoints.push_front(point);
        myPointers.push_front(&myPoints.front());
        shorten();
    }
    /// Adds a point, unless another is nearer than the root of `closeDistSquared`, mm: that one
    /// becomes the newest, with the present time.
    void addReadingConditional(double x, double y, double closeDistSquared,
                               bool* wasAdded = nullptr) {
        auto pointer = myPointers.begin();
        for (auto at = myPoints.begin(); at != myPoints.end(); ++at, ++pointer) {
            if (at->squaredFindDistanceTo(ArPose(x, y)) >= closeDistSquared) continue;
            at->setTimeToNow();
            myPoints.splice(myPoints.begin(), myPoints, at);
            myPointers.splice(myPointers.begin(), myPointers, pointer);
            if (wasAdded) *wasAdded = false;
            return;
        }
        addReading(x, y);
        if (wasAdded) *wasAdded = true;
    }
    /// Removes points one by one: those named in between go at the end of the sweep.
    void beginInvalidationSweep() { myInvalid.clear(); }
    void invalidateReading(Points::const_iterator reading) { myInvalid.push_back(&*reading); }
    void endInvalidationSweep() {
        // Named in the order of the list, or in another.
        for (const ArPoseWithTime* const invalid : myInvalid)
            removeIf([invalid](const ArPoseWithTime& point) { return &point == invalid; });
        myInvalid.clear();
    }
    void clear() {
        myPointers.clear();
        myPoints.clear();
    }
    void clearOlderThan(int milliseconds) {
        removeIf([&](const ArPoseWithTime& point) {
            return point.getTime().mSecSince() > milliseconds;
        });
    }
    void clearOlderThanSeconds(int seconds) { clearOlderThan(1000 * seconds); }
    /// Removes points farther than this from a position, mm.
    void clearFartherThan(double distance, ArPose from) {
        removeIf([&](const ArPose& point) { return from.findDistanceTo(point) > distance; });
    }

    void applyTransform(ArTransform change) {
        for (ArPoseWithTime& point : myPoints) point.setPose(change.doTransform(point));
    }

    /// Distance from a pose to the nearest point between these directions of it, counter-clockwise;
    /// `maxRange` if there is none.
    double getClosestPolar(double startAngle, double endAngle, ArPose from, unsigned int maxRange,
                           double* angle = nullptr) const {
        double nearest = maxRange;
        for (const ArPoseWithTime& point : myPoints) {
            const double bearing = ArMath::subAngle(from.findAngleTo(point), from.getTh());
            const double distance = from.findDistanceTo(point);
            if (distance >= nearest || !ArMath::angleBetween(bearing, startAngle, endAngle))
                continue;
            nearest = distance;
            if (angle) *angle = bearing;
        }
        return nearest;
    }
    /// The same of the points in a rectangle of the pose's frame.
    double getClosestBox(double x1, double y1, double x2, double y2, ArPose from,
                         unsigned int maxRange, ArPose* reading = nullptr) const {
        double nearest = maxRange;
        for (const ArPoseWithTime& point : myPoints) {
            const double bearing = ArMath::subAngle(from.findAngleTo(point), from.getTh());
            const double distance = from.findDistanceTo(point);
            const double x = distance * ArMath::cos(bearing), y = distance * ArMath::sin(bearing);
            const bool inside = x >= ArUtil::findMin(x1, x2) && x <= ArUtil::findMax(x1, x2) &&
                                y >= ArUtil::findMin(y1, y2) && y <= ArUtil::findMax(y1, y2);
            if (!inside || distance >= nearest) continue;
            nearest = distance;
            if (reading) *reading = point;
        }
        return nearest;
    }

    /// Writes the points, or how many there are, to the log or into a file.
    void logData(ArLog::LogLevel level = ArLog::Normal, const char* linePrefix = "",
                 const char* sensorName = "", const char* bufferName = "") const {
        for (const ArPoseWithTime& point : myPoints)
            ArLog::log(level, "%s%s %s: %.0f, %.0f", linePrefix, sensorName, bufferName,
                       point.getX(), point.getY());
    }
    void logInternal(ArLog::LogLevel level = ArLog::Normal, const char* name = "") const {
        ArLog::log(level, "%s: %zu of at most %zu points", name, getCurrentSize(), mySize);
    }
    void logInternal(std::FILE* file, const char* linePrefix = "", const char* name = "") const {
        std::fprintf(file, "%s%s: %zu of at most %zu points\n", linePrefix, name, getCurrentSize(),
                     mySize);
    }

  private:
    void shorten() {
        while (myPoints.size() > mySize) {
            myPointers.pop_back();
            myPoints.pop_back();
        }
    }
    template <class Test>
    void removeIf(const Test& test) {
        auto pointer = myPointers.begin();
        for (auto at = myPoints.begin(); at != myPoints.end();) {
            if (test(*at)) {
                at = myPoints.erase(at);
                pointer = myPointers.erase(pointer);
            } else {
                ++at;
                ++pointer;
            }
        }
    }

    std::size_t mySize;
    Points myPoints;
    std::list<ArPoseWithTime*> myPointers;  // to the same, in the same order
    std::vector<const ArPoseWithTime*> myInvalid;
};

#endif  // SIM_ARIA_RANGE_BUFFER_H
