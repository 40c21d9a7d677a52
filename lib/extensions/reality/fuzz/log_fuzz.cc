// SPDX-License-Identifier: GPL-3.0-or-later
// Logs of real sensors: CARMEN, JSON lines of scan, MCAP, by their first bytes.
#include "extensions/reality/log.h"
#include "fuzz.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    const reality::Log log = bytes.starts_with("\x89MCAP") ? reality::readMcapLog(bytes, "a.mcap")
                             : bytes.starts_with('{') ? reality::readScanLines(bytes, "a.jsonl")
                                                      : reality::readCarmenLog(bytes, "a.log");
    require(!log.scans.empty() || !log.clouds.empty() || !log.bursts.empty(), "an empty log");
    for (const reality::LogScan& scan : log.scans) {
        require(!scan.ranges.empty(), "a scan without beams");
        for (const float range : scan.ranges) require(range >= 0, "a range below 0");
    }
    for (const reality::LogCloud& cloud : log.clouds)
        require(cloud.rays.size() == cloud.ranges.size(), "rays without ranges");
}
