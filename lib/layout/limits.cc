// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/limits.h"

#include "base/number.h"

namespace ispace {

void applyRange(const Record& record, double& min_range, double& max_range, Diagnostics& findings) {
    if (!record.has("range")) return;
    const Tuple& range = record.tuple("range");
    if (range.size() == 2) min_range = range.front();
    max_range = range.back();
    if (max_range <= 0)
        findings.add(record.finding("range", "the greatest range is 0, it must be above 0"));
    else if (min_range > max_range)
        findings.add(record.finding("range", "the least range " + formatDouble(min_range) +
                                                 " m is above the greatest, " +
                                                 formatDouble(max_range) + " m"));
}

}  // namespace ispace
