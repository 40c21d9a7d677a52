// SPDX-License-Identifier: GPL-3.0-or-later
// A wish is a value with a strength from 0 to 1; below MIN_STRENGTH it is no wish. The merged value
// is the mean by strengths, of which lower priorities get the rest up to 1. Limits do not share:
// the lowest of all holds.
#ifndef SIM_ARIA_ACTION_DESIRED_H
#define SIM_ARIA_ACTION_DESIRED_H

#include <algorithm>
#include <cmath>

#include <sim_aria/math.h>

/// One quantity that actions want: a value, and a strength from 0 (no wish) to 1.
class ArActionDesiredChannel {
  public:
    static constexpr double NO_STRENGTH = 0;
    static constexpr double MIN_STRENGTH = 0.000001;
    static constexpr double MAX_STRENGTH = 1;

    void setDesired(double desired, double strength) {
        myDesired = desired;
        myStrength = std::max(0.0, std::min(1.0, strength));
    }
    double getDesired() const { return myDesired; }
    double getStrength() const { return myStrength; }
    void reset() { *this = ArActionDesiredChannel(); }

    /// Gives a wish of lower priority the strength that this one leaves.
    void merge(const ArActionDesiredChannel& lower) {
        const double share = std::min(lower.myStrength, 1 - myStrength);
        if (share < MIN_STRENGTH) return;
        myDesired = (myDesired * myStrength + lower.myDesired * share) / (myStrength + share);
        myStrength += share;
    }
    /// Adopts the lower of two limits: a limit of any priority holds.
    void mergeLimit(const ArActionDesiredChannel& other) {
        if (other.myStrength < MIN_STRENGTH) return;
        myDesired = myStrength < MIN_STRENGTH                           ? other.myDesired
                    : std::fabs(other.myDesired) < std::fabs(myDesired) ? other.myDesired
                                                                        : myDesired;
        myStrength = std::max(myStrength, other.myStrength);
    }

  private:
    double myDesired = 0, myStrength = 0;
};

/// The motion that an action wants: speeds or headings, and limits of them, in mm and degrees per
/// second. Without a wish for speed or rotation the robot keeps the last one.
class ArActionDesired {
  public:
    static constexpr double NO_STRENGTH = ArActionDesiredChannel::NO_STRENGTH;
    static constexpr double MIN_STRENGTH = ArActionDesiredChannel::MIN_STRENGTH;
    static constexpr double MAX_STRENGTH = ArActionDesiredChannel::MAX_STRENGTH;

    virtual ~ArActionDesired() {}
    ArActionDesired() {}
    ArActionDesired(const ArActionDesired&) = default;
    ArActionDesired& operator=(const ArActionDesired&) = default;

    void reset() { *this = ArActionDesired(); }

    void setVel(double vel, double strength = MAX_STRENGTH) { myVel.setDesired(vel, strength); }
    /// Of the three wishes for rotation the last one holds.
    void setDeltaHeading(double delta, double strength = MAX_STRENGTH) {
        setTurn(&myDelta, delta, strength);
    }
    void setHeading(double heading, double strength = MAX_STRENGTH) {
        setTurn(&myHeading, heading, strength);
    }
    void setRotVel(double rotVel, double strength = MAX_STRENGTH) {
        setTurn(&myRotVel, rotVel, strength);
    }
    void setMaxVel(double vel, double strength = MAX_STRENGTH) {
        myMaxVel.setDesired(vel, strength);
    }
    /// \param vel negative or 0
    void setMaxNegVel(double vel, double strength = MAX_STRENGTH) {
        myMaxNegVel.setDesired(vel, strength);
    }
    void setMaxRotVel(double rotVel, double strength = MAX_STRENGTH) {
        myMaxRotVel.setDesired(rotVel, strength);
    }
    /// The simulated robot keeps the accelerations of its model.
    void setTransAccel(double accel, double strength = MAX_STRENGTH) {
        myTransAccel.setDesired(accel, strength);
    }
    void setTransDecel(double decel, double strength = MAX_STRENGTH) {
        myTransDecel.setDesired(decel, strength);
    }
    void setRotAccel(double accel, double strength = MAX_STRENGTH) {
        myRotAccel.setDesired(accel, strength);
    }
    void setRotDecel(double decel, double strength = MAX_STRENGTH) {
        myRotDecel.setDesired(decel, strength);
    }

    double getVel() const { return myVel.getDesired(); }
    double getVelStrength() const { return myVel.getStrength(); }
    double getHeading() const { return myHeading.getDesired(); }
    double getHeadingStrength() const { return myHeading.getStrength(); }
    double getDeltaHeading() const { return myDelta.getDesired(); }
    double getDeltaHeadingStrength() const { return myDelta.getStrength(); }
    double getRotVel() const { return myRotVel.getDesired(); }
    double getRotVelStrength() const { return myRotVel.getStrength(); }
    double getMaxVel() const { return myMaxVel.getDesired(); }
    double getMaxVelStrength() const { return myMaxVel.getStrength(); }
    double getMaxNegVel() const { return myMaxNegVel.getDesired(); }
    double getMaxNegVelStrength() const { return myMaxNegVel.getStrength(); }
    double getMaxRotVel() const { return myMaxRotVel.getDesired(); }
    double getMaxRotVelStrength() const { return myMaxRotVel.getStrength(); }
    double getTransAccel() const { return myTransAccel.getDesired(); }
    double getTransDecel() const { return myTransDecel.getDesired(); }
    double getRotAccel() const { return myRotAccel.getDesired(); }
    double getRotDecel() const { return myRotDecel.getDesired(); }

    /// Adds the wishes of a lower priority.
    void merge(const ArActionDesired* lower) {
        myVel.merge(lower->myVel);
        // Rotation is one quantity: a speed and a heading do not mix.
        const bool turns = myDelta.getStrength() >= MIN_STRENGTH;
        const bool spins = myRotVel.getStrength() >= MIN_STRENGTH;
        if (!spins) myDelta.merge(lower->myDelta);
        if (!turns) myRotVel.merge(lower->myRotVel);
        mergeLimits(*lower);
    }
    void startAverage() {
        myAverages = 0;
        mySums = Sums();
    }
    /// Averages actions of the same priority, by their strengths.
    void addAverage(const ArActionDesired* other) {
        ++myAverages;
        mySums.vel.add(other->myVel);
        mySums.delta.add(other->myDelta);
        mySums.rot_vel.add(other->myRotVel);
        mergeLimits(*other);
    }
    void endAverage() {
        if (myAverages == 0) return;
        mySums.vel.end(&myVel);
        mySums.delta.end(&myDelta);
        mySums.rot_vel.end(&myRotVel);
        if (myDelta.getStrength() >= MIN_STRENGTH) myRotVel.reset();
        myAverages = 0;
    }
    /// Turns a heading into a change of heading, for a robot with this heading.
    void accountForRobotHeading(double heading) {
        if (myHeading.getStrength() < MIN_STRENGTH) return;
        myDelta.setDesired(ArMath::subAngle(myHeading.getDesired(), heading),
                           myHeading.getStrength());
        myHeading.reset();
    }

  private:
    struct Sum {
        double value = 0, strength = 0;
        void add(const ArActionDesiredChannel& channel) {
            value += channel.getDesired() * channel.getStrength();
            strength += channel.getStrength();
        }
        void end(ArActionDesiredChannel* channel) const {
            if (strength >= MIN_STRENGTH) channel->setDesired(value / strength, strength);
        }
    };
    struct Sums {
        Sum vel, delta, rot_vel;
    };

    void setTurn(ArActionDesiredChannel* channel, double value, double strength) {
        myDelta.reset();
        myHeading.reset();
        myRotVel.reset();
        channel->setDesired(value, strength);
    }
    void mergeLimits(const ArActionDesired& other) {
        myMaxVel.mergeLimit(other.myMaxVel);
        myMaxNegVel.mergeLimit(other.myMaxNegVel);
        myMaxRotVel.mergeLimit(other.myMaxRotVel);
        myTransAccel.mergeLimit(other.myTransAccel);
        myTransDecel.mergeLimit(other.myTransDecel);
        myRotAccel.mergeLimit(other.myRotAccel);
        myRotDecel.mergeLimit(other.myRotDecel);
    }

    ArActionDesiredChannel myVel, myDelta, myHeading, myRotVel;
    ArActionDesiredChannel myMaxVel, myMaxNegVel, myMaxRotVel;
    ArActionDesiredChannel myTransAccel, myTransDecel, myRotAccel, myRotDecel;
    int myAverages = 0;
    Sums mySums;
};

#endif  // SIM_ARIA_ACTION_DESIRED_H
