// SPDX-License-Identifier: GPL-3.0-or-later
// Straight lines in scans: walls ahead, and the corner at which ArActionTriangleDriveTo docks.
// Millimetres.
#ifndef SIM_ARIA_LINE_FINDER_H
#define SIM_ARIA_LINE_FINDER_H

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <memory>
#include <vector>

#include <sim_aria/geometry.h>
#include <sim_aria/laser.h>
#include <sim_aria/robot.h>

/// A straight part of a scan.
class ArLineFinderSegment : public ArLineSegment {
  public:
    ArLineFinderSegment() {}
    ArLineFinderSegment(ArPose from, ArPose to, int numPoints, int startPoint, int endPoint)
        : ArLineSegment(from, to), myCount(numPoints), myStart(startPoint), myEnd(endPoint) {}
    int getNumPoints() const { return myCount; }
    int getStartPoint() const { return myStart; }
    int getEndPoint() const { return myEnd; }
    double getLength() const { return getLengthOf(); }
    double getLineAngle() const { return getEndPoint1().findAngleTo(getEndPoint2()); }

  private:
    int myCount = 0, myStart = 0, myEnd = 0;
};

/// Finds the straight lines in a laser's newest scan: splits the row of points at its farthest
/// point until each part is straight (U. Ramer, An iterative procedure for the polygonal
/// approximation of plane curves, 1972; "split and merge" without the merge), and fits a line to
/// each part by least squared distances. O(points^2) at worst, O(points log points) as a rule.
class ArLineFinder {
  public:
    explicit ArLineFinder(ArRangeDevice* device) : myDevice(device) {}
    virtual ~ArLineFinder() {}

    /// Lines in the frame of the robot's pose, mm, by their numbers in the order of the scan; valid
    /// until the next call.
    std::map<int, ArLineFinderSegment*>* getLines() {
        findPoints();
        mySegments.clear();
        myLines.clear();
        std::size_t begin = 0;
        for (std::size_t i = 1; i <= myPoints.size(); ++i) {
            if (i < myPoints.size() &&
                myPoints[i - 1].findDistanceTo(myPoints[i]) <= myMaxDistBetweenPoints)
                continue;
            split(begin, i);
            begin = i;
        }
        int number = 0;
        for (const auto& segment : mySegments) {
            myLines[number++] = segment.get();
            // Parts share their corners, so those of a dropped part may be on a line.
            myRest.erase(myRest.lower_bound(segment->getStartPoint()),
                         myRest.upper_bound(segment->getEndPoint()));
        }
        return &myLines;
    }
    /// Points without those of any line.
    std::map<int, ArPose>* getNonLinePoints() { return &myRest; }
    /// Pose of the robot at the scan.
    ArPose getLinesTakenPose() const { return myTaken; }
    /// Writes the points and lines of a new scan to the files `points` and `lines`.
    void getLinesAndSaveThem() {
        getLines();
        saveLast();
    }
    void saveLast() {
        if (std::FILE* const points = std::fopen("points", "w")) {
            for (const ArPose& point : myPoints)
                std::fprintf(points, "%.0f %.0f\n", point.getX(), point.getY());
            std::fclose(points);
        }
        if (std::FILE* const lines = std::fopen("lines", "w")) {
            for (const auto& line : mySegments)
                std::fprintf(lines, "%.0f %.0f %.0f %.0f\n", line->getX1(), line->getY1(),
                             line->getX2(), line->getY2());
            std::fclose(lines);
        }
        if (myVerbose)
            ArLog::log(ArLog::Normal, "%zu lines in %zu points", mySegments.size(),
                       myPoints.size());
    }
    void setVerbose(bool verbose) { myVerbose = verbose; }
    bool getVerbose() const { return myVerbose; }
    /// \param distance mm that a point of a line may be beside it
    void setMaxDistFromLine(int distance) { myMaxDistFromLine = distance; }
    void setMaxDistBetweenPoints(int distance) { myMaxDistBetweenPoints = distance; }
    void setLineCreationParams(int /*minDistance*/ = 40, int minPoints = 2) {
        myMinPoints = minPoints;
    }
    void setLineFilteringParams(int minPoints = 3, int minLength = 75) {
        myMinPoints = minPoints;
        myMinLength = minLength;
    }

  private:
    void findPoints() {
        myPoints.clear();
        myRest.clear();
        myDevice->lockDevice();
        if (const std::list<ArSensorReading*>* const readings = myDevice->getRawReadings())
            for (const ArSensorReading* reading : *readings) {
                if (reading->getIgnoreThisReading()) continue;
                myPoints.push_back(reading->getPose());
                myTaken = reading->getPoseTaken();
            }
        myDevice->unlockDevice();
    }
    void split(std::size_t begin, std::size_t end) {
        if (end - begin < static_cast<std::size_t>(myMinPoints)) return drop(begin, end);
        const ArLineSegment chord(myPoints[begin], myPoints[end - 1]);
        std::size_t farthest = begin;
        double most = 0;
        for (std::size_t i = begin + 1; i + 1 < end; ++i) {
            const double distance = chord.getDistToLine(myPoints[i]);
            if (distance <= most) continue;
            most = distance;
            farthest = i;
        }
        if (most > myMaxDistFromLine) {
            split(begin, farthest + 1);
            return split(farthest, end);
        }
        if (chord.getLengthOf() < myMinLength) return drop(begin, end);
        add(begin, end);
    }
    void drop(std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) myRest[static_cast<int>(i)] = myPoints[i];
    }
    /// Fits the line of least squared distances, and projects the ends of the part onto it.
    void add(std::size_t begin, std::size_t end) {
        const double n = static_cast<double>(end - begin);
        double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
        for (std::size_t i = begin; i < end; ++i) {
            x += myPoints[i].getX() / n;
            y += myPoints[i].getY() / n;
        }
        for (std::size_t i = begin; i < end; ++i) {
            const double dx = myPoints[i].getX() - x, dy = myPoints[i].getY() - y;
            xx += dx * dx, xy += dx * dy, yy += dy * dy;
        }
        const double th = std::atan2(2 * xy, xx - yy) / 2, c = std::cos(th), s = std::sin(th);
        const auto onto = [&](const ArPose& p) {
            const double along = (p.getX() - x) * c + (p.getY() - y) * s;
            return ArPose(x + along * c, y + along * s);
        };
        mySegments.emplace_back(new ArLineFinderSegment(
            onto(myPoints[begin]), onto(myPoints[end - 1]), static_cast<int>(end - begin),
            static_cast<int>(begin), static_cast<int>(end - 1)));
    }

    ArRangeDevice* myDevice;
    std::vector<ArPose> myPoints;
    ArPose myTaken;
    std::vector<std::unique_ptr<ArLineFinderSegment>> mySegments;
    std::map<int, ArLineFinderSegment*> myLines;
    std::map<int, ArPose> myRest;
    bool myVerbose = false;
    int myMaxDistFromLine = 30, myMaxDistBetweenPoints = 300, myMinPoints = 4, myMinLength = 75;
};

#endif  // SIM_ARIA_LINE_FINDER_H
