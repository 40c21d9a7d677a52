// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers are the linear congruence of Press et al. (Numerical Recipes, 7.1), equal in each
// run of one thread; the lowest bits repeat early, so they are no source for statistics.
#ifndef SIM_ARIA_MATH_H
#define SIM_ARIA_MATH_H

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>

/// Angles of ARIA: degrees, counter-clockwise, in (-180, 180].
class ArMath {
  public:
    static double degToRad(double deg) { return deg * pi() / 180; }
    static double radToDeg(double rad) { return rad * 180 / pi(); }
    static double sin(double deg) { return std::sin(degToRad(deg)); }
    static double cos(double deg) { return std::cos(degToRad(deg)); }
    static double tan(double deg) { return std::tan(degToRad(deg)); }
    static double atan2(double y, double x) { return radToDeg(std::atan2(y, x)); }
    static double fixAngle(double angle) {
        if (angle > -180 && angle <= 180) return angle;
        angle = std::fmod(angle, 360);
        if (angle > 180) angle -= 360;
        if (angle <= -180) angle += 360;
        return angle;
    }
    static double addAngle(double a, double b) { return fixAngle(a + b); }
    static double subAngle(double a, double b) { return fixAngle(a - b); }
    /// True if `angle` lies between `start` and, counter-clockwise, `end`; -180 to 180 is a whole
    /// turn.
    static bool angleBetween(double angle, double start, double end) {
        return end - start >= 360 || positive(angle - start) <= positive(end - start);
    }
    static double distanceBetween(double x1, double y1, double x2, double y2) {
        return std::sqrt(squaredDistanceBetween(x1, y1, x2, y2));
    }
    static double squaredDistanceBetween(double x1, double y1, double x2, double y2) {
        return (x2 - x1) * (x2 - x1) + (y2 - y1) * (y2 - y1);
    }
    /// Rounds halves away from zero.
    static int roundInt(double value) { return static_cast<int>(std::lround(value)); }
    static short roundShort(double value) { return static_cast<short>(std::lround(value)); }
    static double fabs(double value) { return std::fabs(value); }
    static int ceilInt(double value) { return static_cast<int>(std::ceil(value)); }
    static int floorInt(double value) { return static_cast<int>(std::floor(value)); }
    static bool isNan(double value) { return std::isnan(value); }
    static bool compareFloats(double a, double b, double epsilon = 1e-6) {
        return std::fabs(a - b) <= epsilon;
    }
    /// A whole number from `low` to `high`; the same sequence in each run.
    static long randomInRange(long low, long high) {
        if (high <= low) return low;
        const std::uint64_t span = static_cast<std::uint64_t>(high - low) + 1;
        return low + static_cast<long>(random() % span);
    }
    static std::uint32_t random() {
        static std::atomic<std::uint32_t> state{1};
        return state = state * 1664525U + 1013904223U;
    }

  private:
    static double pi() { return 3.14159265358979323846; }
    static double positive(double angle) {
        const double rest = std::fmod(angle, 360);
        return rest < 0 ? rest + 360 : rest;
    }
};

/// A pose in mm and degrees.
class ArPose {
  public:
    ArPose(double x = 0, double y = 0, double th = 0)  // NOLINT: a program may pass numbers
        : myX(x), myY(y), myTh(ArMath::fixAngle(th)) {}
    ArPose(const ArPose&) = default;
    ArPose& operator=(const ArPose&) = default;
    virtual ~ArPose() {}

    double getX() const { return myX; }
    double getY() const { return myY; }
    double getTh() const { return myTh; }
    double getThRad() const { return ArMath::degToRad(myTh); }
    void getPose(double* x, double* y, double* th = nullptr) const {
        *x = myX;
        *y = myY;
        if (th) *th = myTh;
    }
    void setX(double x) { myX = x; }
    void setY(double y) { myY = y; }
    void setTh(double th) { myTh = ArMath::fixAngle(th); }
    void setThRad(double th) { setTh(ArMath::radToDeg(th)); }
    virtual void setPose(double x, double y, double th = 0) {
        setX(x);
        setY(y);
        setTh(th);
    }
    virtual void setPose(ArPose pose) { setPose(pose.myX, pose.myY, pose.myTh); }
    /// Writes the pose to the log.
    void log() const;

    double findDistanceTo(ArPose to) const { return std::sqrt(squaredFindDistanceTo(to)); }
    double squaredFindDistanceTo(ArPose to) const {
        return ArMath::squaredDistanceBetween(myX, myY, to.myX, to.myY);
    }
    /// Direction to another position, in the world.
    double findAngleTo(ArPose to) const { return ArMath::atan2(to.myY - myY, to.myX - myX); }

    ArPose operator+(const ArPose& o) const {
        return ArPose(myX + o.myX, myY + o.myY, myTh + o.myTh);
    }
    ArPose operator-(const ArPose& o) const {
        return ArPose(myX - o.myX, myY - o.myY, myTh - o.myTh);
    }
    ArPose& operator+=(const ArPose& o) { return *this = *this + o; }
    ArPose& operator-=(const ArPose& o) { return *this = *this - o; }
    bool operator==(const ArPose& o) const {
        return std::fabs(myX - o.myX) < kNear && std::fabs(myY - o.myY) < kNear &&
               std::fabs(ArMath::subAngle(myTh, o.myTh)) < kNear;
    }
    bool operator!=(const ArPose& o) const { return !(*this == o); }
    bool operator<(const ArPose& o) const {
        if (myX != o.myX) return myX < o.myX;
        return myY != o.myY ? myY < o.myY : myTh < o.myTh;
    }

  protected:
    static constexpr double kNear = 1e-10;
    double myX, myY, myTh;
};

namespace sim_aria {

/// Returns the pose at the share t of the way from a to b, by the shorter turn; beyond b for t > 1.
inline ArPose between(const ArPose& a, const ArPose& b, double t) {
    return ArPose(a.getX() + t * (b.getX() - a.getX()), a.getY() + t * (b.getY() - a.getY()),
                  a.getTh() + t * ArMath::subAngle(b.getTh(), a.getTh()));
}

}  // namespace sim_aria

#endif  // SIM_ARIA_MATH_H
