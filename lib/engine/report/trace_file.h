// SPDX-License-Identifier: GPL-3.0-or-later
// The poses that a search of arrange has tried, as a file that maps read. O(bytes).
//
//     const TraceFile trace = readTrace(readAll("tried.jsonl"), "tried.jsonl");
//     for (const TriedPose& tried : trace.poses) mark(tried.pose);
#pragma once

#include <string>
#include <vector>

#include "arrange/tried_pose.h"
#include "base/message.h"

namespace ispace {

/// The "assist info" of the thesis' Sensor Arranger as JSONL: a header object
/// {"schema":"ispace-trace/1","history":[...]}, then a line per pose,
/// {"sensor","pose":[x,y,z,heading,tilt,roll],"value"}, of a building with "storey", in whose frame
/// the pose is, for lasers with "slice_area", and with "chosen":true if a sensor was put there.
/// Metres and radians, as in every JSON pose.
struct TraceFile {
    History history;
    std::vector<TriedPose> poses;
};
std::string writeTrace(const TraceFile& trace);
/// Parses strict JSON; keys may be in any order, unknown keys and empty lines are skipped. \throws
/// FormatError with the line; `name` is the file's name
TraceFile readTrace(const std::string& text, const std::string& name);

}  // namespace ispace
