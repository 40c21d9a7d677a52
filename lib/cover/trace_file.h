// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/program.h"
#include "geom/pose.h"

namespace ispace {

/// A pose that a search for an arrangement tried for a sensor, and what it would cover.
struct TriedPose {
    std::string sensor;  ///< id; of several that are alike the first
    Pose3 pose;
    double value = 0;  ///< share of what counts that it would add to what stands already
    bool is_chosen = false;
    std::optional<double> slice_area = {};  ///< of a laser, eq. (4.4), m2
};

/// The "assist info" of the thesis' Sensor Arranger as JSONL: a header object
/// {"schema":"ispace-trace/1","history":[...]}, then a line a pose,
/// {"sensor","pose":[x,y,z,heading,tilt,roll],"value"}, of lasers with "slice_area", and with
/// "chosen":true where a sensor was placed. Metres and radians, as in every JSON pose.
struct TraceFile {
    History history;
    std::vector<TriedPose> poses;
};
std::string writeTrace(const TraceFile& trace);
/// Strict JSON; keys may come in any order, unknown ones and empty lines are passed over.
/// \throws FormatError with the line; `name` is the file's
TraceFile readTrace(const std::string& text, const std::string& name);

}  // namespace ispace
