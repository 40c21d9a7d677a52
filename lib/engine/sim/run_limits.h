// SPDX-License-Identifier: GPL-3.0-or-later
// Limits of additions by clients to a running world, so that no client brings it to a halt.
//
// Loads are sums over records, computed before a change is made: O(records). They bound memory and
// work roughly; pace.h measures the work.
//
//     checkLoad(loadOf(before, step, nullptr), loadOf(after, step, nullptr));   // throws OverLimit
#pragma once

#include <string>

#include "base/error.h"
#include "scene/scene.h"
#include "sim/recorder.h"

namespace ispace {

/// Cost of a scene in a run, summed over its sensors and movers.
struct RunLoad {
    double records = 0;
    /// Beams of one scan of each laser, and rays of one echo of each sonar and of each tag at each
    /// receiver.
    double beams = 0;
    double beam_rate = 0;       ///< of lasers, tags and receivers, per simulated second
    double pixels = 0;          ///< of one frame of each camera and ranger
    double pixel_rate = 0;      ///< per simulated second, if all of them are read
    double recorded_bytes = 0;  ///< per simulated second, roughly; 0: no record
    double readings = 0;        ///< see readingRate(); no bound by itself
};

/// Returns the sums of two loads.
RunLoad operator+(const RunLoad& a, const RunLoad& b);

/// Returns the readings of sensors in a simulated second, without pictures and depth frames.
double readingRate(const Scene& scene);

/// Computes the load of a scene. \param record null: no record
RunLoad loadOf(const Scene& scene, SimTime step, const RecordOptions* record);

/// A change would exceed a limit.
class OverLimit : public FormatError {
  public:
    using FormatError::FormatError;
};

/// Rejects additions by clients beyond the bounds of run_limits.cc, which simrun(1) lists. A world
/// that starts above a bound, at its user's request, may stay there.
/// \throws OverLimit naming the sum and its bound, if it is exceeded and was less `before`
void checkLoad(const RunLoad& before, const RunLoad& after);

/// Rejects additions by clients to a world that takes longer for its time than it may.
/// \param work measured seconds for a second of wall time, see Pace \throws OverLimit
void checkPace(const RunLoad& before, const RunLoad& after, double work);

/// Returns the pixels of one frame of a camera or a ranger; 0 for other sensors.
double pixelsOf(const Sensor& sensor);

/// Limit of pixels of pictures and depth frames that all clients together may have pending.
constexpr double kMaxWaitingPixels = 64e6;

}  // namespace ispace
