// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/report_section.h"

#include <algorithm>

namespace ispace {

void join(ReportParts& parts, const ReportParts& more) {
    parts.insert(parts.end(), more.begin(), more.end());
    std::stable_sort(parts.begin(), parts.end(),
                     [](const auto& a, const auto& b) { return a->rank() < b->rank(); });
}

}  // namespace ispace
