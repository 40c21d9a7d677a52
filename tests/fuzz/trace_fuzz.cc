// SPDX-License-Identifier: GPL-3.0-or-later
// Traces of arrange: writes a trace that it has read, and reads the same back, up to last bits of
// angles.
#include "fuzz.h"
#include "report/trace_file.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    const TraceFile trace = readTrace(std::string(bytes), "trace.jsonl");
    const std::string text = writeTrace(trace);
    const TraceFile again = readBack([&] { return readTrace(text, "again.jsonl"); });
    require(again.poses.size() == trace.poses.size(), "another number of poses");
    for (std::size_t i = 0; i < trace.poses.size(); ++i) {
        const TriedPose &before = trace.poses[i], &after = again.poses[i];
        require(after.sensor == before.sensor && after.value == before.value &&
                    after.is_chosen == before.is_chosen && after.slice_area == before.slice_area &&
                    after.pose.position == before.pose.position,
                "another pose after reading it again");
    }
}
