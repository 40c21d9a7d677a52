// SPDX-License-Identifier: GPL-3.0-or-later
// Bumpers as points around the robot, for actions that avoid whatever range devices see.
#ifndef SIM_ARIA_BUMPERS_H
#define SIM_ARIA_BUMPERS_H

#include <cstddef>
#include <vector>

#include <sim_aria/range_device.h>
#include <sim_aria/robot.h>

/// The bumpers as a range device: a point on the robot's rim for each that is hit, kept for 15 s
/// (30 of them). As in ARIA the point is in the middle of the bumper's share of `angleRange`, in
/// front and behind.
class ArBumpers : public ArRangeDevice {
  public:
    ArBumpers(std::size_t currentBufferSize = 30, std::size_t cumulativeBufferSize = 30,
              const char* name = "bumpers", int maxSecondsToKeepCurrent = 15,
              double angleRange = 135)
        : ArRangeDevice(currentBufferSize, cumulativeBufferSize, name, 5000,
                        maxSecondsToKeepCurrent),
          myAngleRange(angleRange) {}

    void processReadings(const std::vector<ArSensorReading>& sonars, const ArPose& robot) override {
        ArRangeDevice::processReadings(sonars, robot);
        if (!getRobot()) return;
        const int stall = getRobot()->getStallValue();
        addHits(stall >> 8, getRobot()->getNumFrontBumpers(), 0, robot);
        addHits(stall, getRobot()->getNumRearBumpers(), 180, robot);
    }

  private:
    void addHits(int bits, unsigned int count, double middle, const ArPose& robot) {
        for (unsigned int i = 0; i < count; ++i) {
            if ((bits & (ArUtil::BIT1 << i)) == 0) continue;
            const double th = robot.getTh() + middle + myAngleRange * (0.5 - (i + 0.5) / count);
            const double radius = getRobot()->getRobotRadius();
            addReading(robot.getX() + radius * ArMath::cos(th),
                       robot.getY() + radius * ArMath::sin(th));
        }
    }

    double myAngleRange;
};

#endif  // SIM_ARIA_BUMPERS_H
