// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "sense/depth.h"
#include "sense/photo.h"
#include "sense/scan.h"
#include "sense/selection.h"
#include "sense/trajectory.h"
#include "sense/ultrasound.h"

namespace ispace {

/// A requested reading.
struct ReadingJob {
    std::size_t sensor = 0;  ///< index in Sensors::read
    int frame = 0;
    double time = 0;  ///< seconds
    Pose3 pose;
    /// Poses from `time` to the end of the reading, sorted by time, the first one not after `time`;
    /// empty if the sensor stands still.
    std::vector<TimedPose> way;
};

/// The scans of a sweep (or a single one), a depth picture, a burst, or a picture.
using Reading = std::variant<std::vector<Scan>, DepthFrame, Burst, Photo>;

struct TakerOptions {
    std::optional<std::uint64_t> noise_seed = {};  ///< empty: no noise
    double celsius = 20;                           ///< of the air, for the speed of sound
    /// Sensors move from job to job: their beams are rotated as a whole; see Beams.
    bool follows_poses = false;
    /// Required for cameras; null: no cameras. It outlives the sampler.
    const Photographer* photographer = nullptr;
};

/// Takes readings in any order on any thread; each depends only on its job.
class ReadingSampler {
  public:
    /// Prepares the sensors. \pre all arguments outlive it
    ReadingSampler(const Sensors& sensors, Worlds& worlds, const MovingBodies& bodies,
                   const TakerOptions& options);
    ~ReadingSampler();
    ReadingSampler(const ReadingSampler&) = delete;
    ReadingSampler& operator=(const ReadingSampler&) = delete;

    /// Prepares the worlds for a job. One thread calls it, in the order of jobs, while other
    /// threads take readings.
    void prepare(const ReadingJob& job);
    /// Takes the reading of a job. \pre the job is prepared
    [[nodiscard]] Reading take(const ReadingJob& job);

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
