// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "sense/depth.h"
#include "sense/photo.h"
#include "sense/pir_state.h"
#include "sense/radar_frame.h"
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

/// Movers on a mat: people with a leg on it, robots with the body over it; edges count.
struct MatState {
    std::vector<std::string> on;  ///< robots first, in the order of the scene
};

/// Passages of a gate since the start. A mover passes when its centre crosses the line between the
/// posts.
struct GateState {
    std::int64_t in = 0, out = 0;
    std::string last;  ///< mover that passed last; "" before the first
    bool last_in = false;
    bool broken = false;  ///< a mover interrupts the beam
};

/// A contact's door.
struct ContactState {
    double time = 0;  ///< seconds
    int frame = 0;
    Pose3 pose;
    bool open = false;
};

/// A reading of a sensor of any kind, of a sweep one scan.
using ReadingValue = std::variant<Scan, DepthFrame, Photo, Burst, Hearings, MatState, GateState,
                                  RadarFrame, PirState, ContactState>;

/// The scans of a sweep (or a single one), a depth picture, a burst, a picture, detections, or
/// the state of a PIR sensor or a contact.
using Reading =
    std::variant<std::vector<Scan>, DepthFrame, Burst, Photo, RadarFrame, PirState, ContactState>;

/// Returns the first scan of a sweep, or the value of another reading.
ReadingValue valueOf(Reading reading);

/// Carries the state of a sensor with memory on to its next reading: a PIR sensor holds its output.
void carryOn(const ReadingValue& before, ReadingValue& now);

struct TakerOptions {
    std::optional<std::uint64_t> noise_seed = {};  ///< empty: no noise
    double celsius = 20;                           ///< of the air, for the speed of sound
    /// Sensors move from job to job: their beams are rotated as a whole; see Beams.
    bool follows_poses = false;
    /// Required for cameras; null: no cameras. It outlives the sampler.
    const Photographer* photographer = nullptr;
    MoverVelocities velocities = {};  ///< of the movers whose bodies sensors meet
};

/// Returns true if readAtOnce() reads sensors like this one.
bool isReadAtOnce(const SensorModel& model);
/// Reads a ranger, a tag, a radar or a PIR sensor at a pose. \pre isReadAtOnce(sensor.model);
/// `mesh` are the surfaces that stop its rays
Reading readAtOnce(const Sensor& sensor, const Pose3& pose, int frame, double time,
                   const RayWorld& mesh, const MovingBodies& bodies,
                   std::span<const Sensor> receivers, const TakerOptions& options);

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
