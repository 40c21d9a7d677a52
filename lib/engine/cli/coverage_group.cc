// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/coverage_group.h"

#include <algorithm>
#include <cstddef>

namespace ispace {

CoverageExtensions::CoverageExtensions(std::span<const CoverageRow> rows) {
    groups_.reserve(rows.size());
    for (const CoverageRow& row : rows) groups_.push_back(row.make());
}

void CoverageExtensions::declare(CommandLine& line) {
    const auto before = static_cast<std::ptrdiff_t>(line.names().size());
    for (const auto& group : groups_) group->declare(line);
    const std::vector<std::string> names = line.names();
    options_.assign(names.begin() + before, names.end());
}

void CoverageExtensions::take(const CommandLine& line) const {
    for (const auto& group : groups_) group->take(line);
}

bool CoverageExtensions::isAsked() const {
    return std::any_of(groups_.begin(), groups_.end(),
                       [](const auto& group) { return group->isAsked(); });
}

bool CoverageExtensions::takesRequirement(const std::string& text) const {
    return std::any_of(groups_.begin(), groups_.end(),
                       [&text](const auto& group) { return group->takesRequirement(text); });
}

void CoverageExtensions::fit(const SiteInput& input) const {
    for (const auto& group : groups_)
        if (group->isAsked()) group->fit(input);
}

void CoverageExtensions::measure(const MeasuredSite& site, CoverageFindings& findings,
                                 bool searches) const {
    for (const auto& group : groups_)
        if (group->isAsked() && group->searches() == searches) group->measure(site, findings);
}

}  // namespace ispace
