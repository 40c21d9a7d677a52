// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "sense/depth.h"
#include "sense/scan.h"
#include "sense/sensors.h"
#include "sense/trajectory.h"
#include "sense/ultrasound.h"

namespace ispace {

/// A reading to be taken.
struct ReadingJob {
    std::size_t sensor = 0;  ///< in Sensors::read
    int frame = 0;
    double time = 0;  ///< seconds
    Pose3 pose;
    /// Where the sensor is from `time` on, until it is done; empty if it stands still. In order of
    /// time, the first not after `time`.
    std::vector<TimedPose> way;
};

/// A scan, or those of a sweep; a picture; a burst.
using Reading = std::variant<std::vector<Scan>, DepthFrame, Burst>;

struct TakerOptions {
    std::optional<std::uint64_t> noise_seed = {};  ///< empty: no noise
    double celsius = 20;                           ///< of the air, for sound
    /// Sensors are where jobs say, not where they are placed: beams are turned as a whole.
    bool follows_poses = false;
};

/// Takes readings in any order on any thread; each depends on its job alone.
class ReadingTaker {
  public:
    /// \pre all outlive it
    ReadingTaker(const Sensors& sensors, Worlds& worlds, const MovingBodies& bodies,
                 const TakerOptions& options);
    ~ReadingTaker();
    ReadingTaker(const ReadingTaker&) = delete;
    ReadingTaker& operator=(const ReadingTaker&) = delete;

    /// Makes ready what a job needs. By one thread, in the order of jobs; others may take readings
    /// meanwhile.
    void prepare(const ReadingJob& job);
    /// \pre the job is prepared
    [[nodiscard]] Reading take(const ReadingJob& job);

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
