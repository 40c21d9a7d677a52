// SPDX-License-Identifier: GPL-3.0-or-later
// Traces of arrange: what is read is written and read again unchanged.
#include "cover/trace_file.h"
#include "fuzz.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    const std::string text = writeTrace(readTrace(std::string(bytes), "trace.jsonl"));
    const TraceFile again = readBack([&] { return readTrace(text, "again.jsonl"); });
    require(writeTrace(again) == text, "another text after reading it");
}
