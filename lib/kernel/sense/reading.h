// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of sensors of all kinds. A reading depends on its job and on the seed alone: jobs may be
// taken in any order, on any thread, and again.
//
//     ReadingSampler taker(sensors, worlds, bodies, {.noise_seed = 1});
//     const ReadingJob job{.sensor = 0, .pose = sensors.read[0].pose, .way = {}};
//     taker.prepare(job);                          // one thread
//     const Reading reading = taker.take(job);     // any thread
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "sense/added_reading.h"
#include "sense/depth.h"
#include "sense/moment.h"
#include "sense/photo.h"
#include "sense/scan.h"
#include "sense/selection.h"
#include "sense/trajectory.h"
#include "sense/ultrasound_burst.h"

namespace ispace {

struct ReadingKind;

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
    static const ReadingKind kKind;
};

/// Passages of a gate since the start. A mover passes when its centre crosses the line between the
/// posts.
struct GateState {
    std::int64_t in = 0, out = 0;
    std::string last;  ///< mover that passed last; "" before the first
    bool last_in = false;
    bool broken = false;  ///< a mover interrupts the beam
    static const ReadingKind kKind;
};

/// A reading of a sensor of any kind, of a sweep one scan: sorted as the alternatives of
/// SensorModel.
using ReadingValue =
    std::variant<Scan, DepthFrame, Hearings, Burst, Photo, AddedReading, MatState, GateState>;

/// The scans of a sweep (or a single one), or the reading of another sensor.
using Reading = std::variant<std::vector<Scan>, DepthFrame, Burst, Photo, AddedReading>;

/// Returns the first scan of a sweep, or the value of another reading.
ReadingValue valueOf(Reading reading);

/// Carries the state of a sensor with memory on to its next reading, by `follow(before, now)` of
/// its value.
void carryOn(const ReadingValue& before, ReadingValue& now);

/// Returns true if readAtOnce() reads sensors like this one by rays in a mesh.
bool isReadAtOnce(const SensorModel& model);
/// Reads a sensor by its readingOf(), see moment.h. \pre it is no laser and no camera; the surfaces
/// that stop its rays are prepared if isReadAtOnce(sensor.model)
Reading readAtOnce(const Moment& moment);

/// Takes readings in any order on any thread; each depends only on its job. Each thread keeps the
/// beams of the lasers that it has read.
class ReadingSampler {
  public:
    /// Prepares the sensors. \pre all arguments outlive it
    ReadingSampler(const Sensors& sensors, RayScenes& worlds, const MovingBodies& bodies,
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
