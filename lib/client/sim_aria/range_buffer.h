// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef SIM_ARIA_RANGE_BUFFER_H
#define SIM_ARIA_RANGE_BUFFER_H

#include <cstddef>
#include <list>
#include <vector>

#include <sim_aria/geometry.h>
#include <sim_aria/util.h>

/// The last points that a range device measured, the newest first.
class ArRangeBuffer {
  public:
    explicit ArRangeBuffer(std::size_t size) : mySize(size) {}
    virtual ~ArRangeBuffer() { clear(); }
    ArRangeBuffer(const ArRangeBuffer&) = delete;
    ArRangeBuffer& operator=(const ArRangeBuffer&) = delete;

    std::size_t getSize() const { return mySize; }
    void setSize(std::size_t size) {
        mySize = size;
        shorten();
    }
    const std::list<ArPoseWithTime*>* getBuffer() const { return &myPoints; }
    std::list<ArPoseWithTime*>* getBuffer() { return &myPoints; }
    std::vector<ArPoseWithTime> getBufferAsVector() const {
        std::vector<ArPoseWithTime> points;
        for (const ArPoseWithTime* point : myPoints) points.push_back(*point);
        return points;
    }
    void addReading(double x, double y) {
        myPoints.push_front(new ArPoseWithTime(x, y));
        shorten();
    }
    void clear() {
        for (ArPoseWithTime* point : myPoints) delete point;
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
        for (ArPoseWithTime* point : myPoints) point->setPose(change.doTransform(*point));
    }

    /// Distance from a pose to the nearest point between these directions of it, counter-clockwise;
    /// `maxRange` if there is none.
    double getClosestPolar(double startAngle, double endAngle, ArPose from, unsigned int maxRange,
                           double* angle = nullptr) const {
        double nearest = maxRange;
        for (const ArPoseWithTime* point : myPoints) {
            const double bearing = ArMath::subAngle(from.findAngleTo(*point), from.getTh());
            const double distance = from.findDistanceTo(*point);
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
        for (const ArPoseWithTime* point : myPoints) {
            const double bearing = ArMath::subAngle(from.findAngleTo(*point), from.getTh());
            const double distance = from.findDistanceTo(*point);
            const double x = distance * ArMath::cos(bearing), y = distance * ArMath::sin(bearing);
            const bool inside = x >= ArUtil::findMin(x1, x2) && x <= ArUtil::findMax(x1, x2) &&
                                y >= ArUtil::findMin(y1, y2) && y <= ArUtil::findMax(y1, y2);
            if (!inside || distance >= nearest) continue;
            nearest = distance;
            if (reading) *reading = *point;
        }
        return nearest;
    }

  private:
    void shorten() {
        while (myPoints.size() > mySize) {
            delete myPoints.back();
            myPoints.pop_back();
        }
    }
    template <class Test>
    void removeIf(const Test& test) {
        for (auto at = myPoints.begin(); at != myPoints.end();) {
            if (test(**at)) {
                delete *at;
                at = myPoints.erase(at);
            } else {
                ++at;
            }
        }
    }

    std::size_t mySize;
    std::list<ArPoseWithTime*> myPoints;
};

#endif  // SIM_ARIA_RANGE_BUFFER_H
