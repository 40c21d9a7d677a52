// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded scans in JSONL: the same scans, whatever the pieces.
#include <algorithm>

#include "fuzz.h"
#include "io/import_records.h"

namespace {

using namespace ispace;

struct Contents {
    std::vector<std::size_t> beams;  // of each scan
    std::string error;
};

Contents contentsOf(std::string_view bytes, std::size_t piece) {
    RecordedScans scans(fuzz::streamOf(bytes, piece), "scans.jsonl");
    Contents contents;
    try {
        while (const auto scan = scans.next()) contents.beams.push_back(scan->ranges.size());
    } catch (const FormatError& error) {
        contents.error = error.what();
    }
    return contents;
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    const std::size_t piece = takePieceSize(bytes);
    const Contents whole = contentsOf(bytes, std::max<std::size_t>(bytes.size(), 1));
    const Contents cut = contentsOf(bytes, piece);
    require(cut.error == whole.error, "another error after pieces");
    require(cut.beams == whole.beams, "other scans after pieces");
}
