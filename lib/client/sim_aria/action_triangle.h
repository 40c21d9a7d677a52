// SPDX-License-Identifier: GPL-3.0-or-later
// The target is seen by the line finder of the program, else by one of the robot's first laser. The
// search asks for 10 degrees more in each cycle, in at most 144 cycles; a target that is out of
// sight for more than 20 cycles fails the drive. Hold the robot's lock around getState() and
// getVertex().
#ifndef SIM_ARIA_ACTION_TRIANGLE_H
#define SIM_ARIA_ACTION_TRIANGLE_H

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>

#include <sim_aria/action.h>
#include <sim_aria/line_finder.h>
#include <sim_aria/robot.h>

/// Drives up to a target of two walls that meet at an angle and point to the robot: first to
/// `approachDist` before the vertex, then straight on until the robot's centre is
/// `finalDistFromVertex` away (mm). Starts inactive; activate() looks for the target.
class ArActionTriangleDriveTo : public ArAction {
  public:
    enum State {
        STATE_INACTIVE,
        STATE_ACQUIRE,
        STATE_SEARCHING,
        STATE_GOTO_VERTEX,
        STATE_ALIGN_VERTEX,
        STATE_SUCCEEDED,
        STATE_FAILED
    };

    explicit ArActionTriangleDriveTo(const char* name = "triangleDriveTo",
                                     double finalDistFromVertex = 400, double approachDist = 1000,
                                     double speed = 200, double closeDist = 100,
                                     double /*acquireTurnDist*/ = 5)
        : ArAction(name, "Drives up to a corner that points to the robot."),
          myFinal(finalDistFromVertex),
          myApproach(approachDist),
          mySpeed(speed),
          myClose(closeDist) {
        ArAction::deactivate();
    }
    void activate() override {
        ArAction::activate();
        myState = STATE_ACQUIRE;
        mySearched = 0;
        myMisses = 0;
    }
    void deactivate() override {
        ArAction::deactivate();
        myState = STATE_INACTIVE;
    }
    State getState() const { return myState; }
    void setParameters(double finalDistFromVertex = 400, double approachDist = 1000,
                       double speed = 200, double closeDist = 100, double /*acquireTurnDist*/ = 5) {
        myFinal = finalDistFromVertex;
        myApproach = approachDist;
        mySpeed = speed;
        myClose = closeDist;
    }
    /// Angle between the walls (degrees), and the least length of each (mm).
    void setTriangleParams(double angleBetween = 135, double minLineLength = 250) {
        myAngle = angleBetween;
        myLength = minLineLength;
    }
    void setLineFinder(ArLineFinder* finder) { myFinder = finder; }
    ArLineFinder* getLineFinder() { return myFinder; }
    /// Vertex of the target in the frame of the robot's pose; the heading points into the target.
    ArPose getVertex() const { return myVertex; }

    ArActionDesired* fire(ArActionDesired) override {
        if (myState == STATE_INACTIVE) return nullptr;
        myDesired.reset();
        const bool sees = findVertex();
        if (myState == STATE_ACQUIRE || myState == STATE_SEARCHING) {
            if (!sees) return search();
            myState = STATE_GOTO_VERTEX;
        } else if (!sees && ++myMisses > kMaxMisses) {
            myState = STATE_FAILED;
        }
        if (sees) myMisses = 0;
        if (myState == STATE_GOTO_VERTEX || myState == STATE_ALIGN_VERTEX) return approach();
        stand();
        return &myDesired;
    }
    ArActionDesired* getDesired() override { return &myDesired; }

  private:
    static constexpr double kAngleTolerance = 10;  // degrees
    static constexpr double kJoint = 100;          // mm between the ends of the walls
    static constexpr int kMaxMisses = 20;          // cycles without a sight of the target

    void stand() {
        myDesired.setVel(0);
        myDesired.setDeltaHeading(0);
    }
    /// Turns on the spot.
    ArActionDesired* search() {
        myState = STATE_SEARCHING;
        mySearched += kAngleTolerance;
        if (mySearched > 4 * 360) myState = STATE_FAILED;
        myDesired.setVel(0);
        myDesired.setDeltaHeading(myState == STATE_FAILED ? 0 : kAngleTolerance);
        return &myDesired;
    }
    ArActionDesired* approach() {
        const ArPose at = getRobot()->getPose();
        const double distance = at.findDistanceTo(myVertex);
        const double th = myVertex.getTh();
        const ArPose start(myVertex.getX() - myApproach * ArMath::cos(th),
                           myVertex.getY() - myApproach * ArMath::sin(th));
        if (myState == STATE_GOTO_VERTEX &&
            (at.findDistanceTo(start) < myClose || distance < myApproach))
            myState = STATE_ALIGN_VERTEX;
        const bool aligns = myState == STATE_ALIGN_VERTEX;
        const double left = aligns ? distance - myFinal : at.findDistanceTo(start);
        if (aligns && left < myClose / 10) {
            myState = STATE_SUCCEEDED;
            stand();
            return &myDesired;
        }
        const double turn = ArMath::subAngle(at.findAngleTo(aligns ? myVertex : start), at.getTh());
        const double brake = std::sqrt(getRobot()->getTransDecel() * std::max(0.0, left)) / 2;
        myDesired.setVel(std::fabs(turn) > kAngleTolerance ? 0 : std::min(mySpeed, brake));
        myDesired.setDeltaHeading(turn);
        return &myDesired;
    }
    /// Looks for two neighbouring walls at the angle of the target.
    bool findVertex() {
        ArLineFinder* const finder = lineFinder();
        if (!finder) return false;
        const std::map<int, ArLineFinderSegment*>& lines = *finder->getLines();
        for (auto at = lines.begin(); at != lines.end() && std::next(at) != lines.end(); ++at) {
            const ArLineFinderSegment &right = *at->second, &left = *std::next(at)->second;
            if (right.getLength() < myLength || left.getLength() < myLength) continue;
            if (right.getEndPoint2().findDistanceTo(left.getEndPoint1()) > kJoint) continue;
            // Counter-clockwise, the first wall comes nearer and the second one goes off.
            const double bend = ArMath::subAngle(left.getLineAngle(), right.getLineAngle());
            if (std::fabs(-bend - (180 - myAngle)) > kAngleTolerance) continue;
            ArPose vertex;
            const ArLine other = left.getLine();
            if (!right.getLine().intersects(&other, &vertex)) continue;
            vertex.setTh(right.getLineAngle() + bend / 2 - 90);
            myVertex = vertex;
            return true;
        }
        return false;
    }
    ArLineFinder* lineFinder() {
        if (myFinder) return myFinder;
        ArLaser* const laser = getRobot()->findLaser(1);
        if (!laser) return nullptr;
        myOwn.reset(new ArLineFinder(laser));
        return myFinder = myOwn.get();
    }

    double myFinal, myApproach, mySpeed, myClose, myAngle = 135, myLength = 250;
    State myState = STATE_INACTIVE;
    double mySearched = 0;
    int myMisses = 0;
    ArPose myVertex;
    ArLineFinder* myFinder = nullptr;
    std::unique_ptr<ArLineFinder> myOwn;
    ArActionDesired myDesired;
};

#endif  // SIM_ARIA_ACTION_TRIANGLE_H
