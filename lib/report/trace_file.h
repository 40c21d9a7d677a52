// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "arrange/tried_pose.h"
#include "base/message.h"

namespace ispace {

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
