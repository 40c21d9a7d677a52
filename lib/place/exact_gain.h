// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "cover/sight.h"
#include "cover/target.h"
#include "layout/scene.h"

namespace ispace {

/// The exact gain of what at least `multiplicity` sensors see: its area in closed form (Overlay)
/// times the weight that it has. Lasers and rangers count one by one, all ultrasonic receivers
/// together as one, where enough of them hear.
///
/// What stands in the scene does not move: its regions, and the floor by its weights, are made
/// once.
class ExactGain {
  public:
    /// All sensors stand at their poses. Keeps the references.
    /// \throws UsageError for sensors without an exact region and for more than kMaxZones weights
    ExactGain(const Scene& scene, const Sight& sight, std::span<const Sensor> sensors,
              const FloorWeights& weights, int multiplicity);
    ~ExactGain();
    ExactGain(const ExactGain&) = delete;
    ExactGain& operator=(const ExactGain&) = delete;

    static constexpr std::size_t kMaxZones = 60;

    /// Weight of all floor that counts, m2 times weight.
    [[nodiscard]] double total() const;
    /// Weight of what is seen as all stand now. O(n log n) in all regions and walls.
    [[nodiscard]] double value() const;

    /// From here on this sensor moves and all others stay.
    void take(std::size_t sensor);
    /// What the sensor in hand would add to the others at each of these poses, worked out on all
    /// cores. Only what lies near it is looked at: O(n log n) in its region and those it meets.
    /// \pre take() was called
    [[nodiscard]] std::vector<double> gains(std::span<const Pose3> poses);
    /// Puts the sensor in hand there.
    void put(const Pose3& pose);

    /// False for a sensor that sees the same at every heading.
    [[nodiscard]] bool turns(std::size_t sensor) const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
