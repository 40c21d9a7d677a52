// SPDX-License-Identifier: GPL-3.0-or-later
// Transforms and lines in the plane, in mm and degrees. Pure functions of their values.
#ifndef SIM_ARIA_GEOMETRY_H
#define SIM_ARIA_GEOMETRY_H

#include <cmath>

#include <sim_aria/math.h>

/// Moves points and poses from one frame to another.
class ArTransform {
  public:
    ArTransform() {}
    /// From the frame of this pose to that in which the pose is given.
    explicit ArTransform(ArPose pose) { setTransform(pose); }
    /// The transform that maps `from` to `to`.
    ArTransform(ArPose from, ArPose to) { setTransform(from, to); }
    virtual ~ArTransform() {}

    void setTransform(ArPose pose) {
        myTh = pose.getTh();
        myX = pose.getX();
        myY = pose.getY();
    }
    void setTransform(ArPose from, ArPose to) {
        myTh = ArMath::subAngle(to.getTh(), from.getTh());
        myX = myY = 0;
        const ArPose turned = doTransform(from);
        myX = to.getX() - turned.getX();
        myY = to.getY() - turned.getY();
    }
    ArPose doTransform(ArPose from) const {
        const double c = ArMath::cos(myTh), s = ArMath::sin(myTh);
        return ArPose(myX + c * from.getX() - s * from.getY(),
                      myY + s * from.getX() + c * from.getY(), from.getTh() + myTh);
    }
    ArPose doInvTransform(ArPose from) const {
        const double c = ArMath::cos(myTh), s = ArMath::sin(myTh);
        const double x = from.getX() - myX, y = from.getY() - myY;
        return ArPose(c * x + s * y, c * y - s * x, from.getTh() - myTh);
    }
    double getTh() const { return myTh; }

  private:
    double myTh = 0, myX = 0, myY = 0;
};

/// A line a x + b y + c = 0.
class ArLine {
  public:
    ArLine() {}
    ArLine(double a, double b, double c) : myA(a), myB(b), myC(c) {}
    ArLine(double x1, double y1, double x2, double y2)
        : myA(y1 - y2), myB(x2 - x1), myC(x1 * y2 - x2 * y1) {}
    double getA() const { return myA; }
    double getB() const { return myB; }
    double getC() const { return myC; }
    /// \return false if the lines are parallel
    bool intersects(const ArLine* other, ArPose* at) const {
        const double n = myA * other->myB - myB * other->myA;
        if (n == 0) return false;
        at->setX((myB * other->myC - myC * other->myB) / n);
        at->setY((myC * other->myA - myA * other->myC) / n);
        return true;
    }
    double getPerpDist(ArPose from) const {
        return std::fabs(myA * from.getX() + myB * from.getY() + myC) / std::hypot(myA, myB);
    }

  private:
    double myA = 0, myB = 0, myC = 0;
};

/// A line between two points.
class ArLineSegment {
  public:
    ArLineSegment() {}
    ArLineSegment(double x1, double y1, double x2, double y2) : myFrom(x1, y1), myTo(x2, y2) {}
    ArLineSegment(ArPose from, ArPose to) : myFrom(from), myTo(to) {}
    ArPose getEndPoint1() const { return myFrom; }
    ArPose getEndPoint2() const { return myTo; }
    double getX1() const { return myFrom.getX(); }
    double getY1() const { return myFrom.getY(); }
    double getX2() const { return myTo.getX(); }
    double getY2() const { return myTo.getY(); }
    ArLine getLine() const { return ArLine(getX1(), getY1(), getX2(), getY2()); }
    double getLengthOf() const { return myFrom.findDistanceTo(myTo); }
    ArPose getMidPoint() const { return ArPose((getX1() + getX2()) / 2, (getY1() + getY2()) / 2); }
    /// Distance from a point to the nearest point of the segment.
    double getDistToLine(ArPose point) const {
        const double dx = getX2() - getX1(), dy = getY2() - getY1(), square = dx * dx + dy * dy;
        const double along =
            square == 0 ? 0
                        : ((point.getX() - getX1()) * dx + (point.getY() - getY1()) * dy) / square;
        const double t = along < 0 ? 0 : along > 1 ? 1 : along;
        return point.findDistanceTo(ArPose(getX1() + t * dx, getY1() + t * dy));
    }

  private:
    ArPose myFrom, myTo;
};

#endif  // SIM_ARIA_GEOMETRY_H
