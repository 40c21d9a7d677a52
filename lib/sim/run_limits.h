// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/error.h"
#include "scene/scene.h"
#include "sim/recorder.h"

namespace ispace {

/// What a scene costs a run, over all that is in it.
struct RunLoad {
    double records = 0;
    /// Of one scan of each laser, and rays of one echo of each sonar and of each tag at each
    /// receiver.
    double beams = 0;
    double beam_rate = 0;       ///< of lasers, tags and receivers, in a simulated second
    double pixels = 0;          ///< of one frame of each camera and ranger
    double pixel_rate = 0;      ///< in a simulated second, if somebody reads all of them
    double recorded_bytes = 0;  ///< in a simulated second, about; 0: nothing is recorded
};

/// \param record null: nothing is recorded
RunLoad loadOf(const Scene& scene, SimTime step, const RecordOptions* record);

/// A change would make a world too large.
class OverLimit : public FormatError {
  public:
    using FormatError::FormatError;
};

/// Refuses what clients may not add: the bounds are in run_limits.cc, and simrun(1) lists them. A
/// world that begins with more, as its user asked for, may stay as it is.
/// \throws OverLimit naming the sum and its bound, if it is exceeded and was less `before`
void checkLoad(const RunLoad& before, const RunLoad& after);

/// Of one frame of a camera or a ranger; 0 of others.
double pixelsOf(const RunSensor& sensor);

/// Pixels of pictures and depth frames that clients may let wait to be made, all together.
constexpr double kMaxWaitingPixels = 64e6;

}  // namespace ispace
