// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/coverage_group.h"

#include <algorithm>

#include "base/error.h"
#include "cli/group_members.h"

namespace ispace {

CoverageExtensions::CoverageExtensions(std::span<const CoverageRow> rows) {
    makeMembers(rows, members_, missing_);
}

void CoverageExtensions::declare(CommandLine& line) { options_ = declareMembers(members_, line); }

void CoverageExtensions::take(const CommandLine& line) const {
    for (const Member& member : members_) member.group->take(line);
}

bool CoverageExtensions::isAsked() const {
    return std::any_of(members_.begin(), members_.end(),
                       [](const Member& member) { return member.group->isAsked(); });
}

bool CoverageExtensions::wantsWholeDensities() const {
    return std::any_of(members_.begin(), members_.end(),
                       [](const Member& member) { return member.group->wantsWholeDensities(); });
}

bool CoverageExtensions::judgesAlone() const {
    return std::any_of(members_.begin(), members_.end(),
                       [](const Member& member) { return member.group->judgesAlone(); });
}

std::string CoverageExtensions::requirements() const {
    std::string text;
    for (const Member& member : members_) text += member.group->requirements();
    return text;
}

bool CoverageExtensions::takesRequirement(const std::string& text) const {
    for (const CoverageRow& row : missing_)
        if (text.starts_with(std::string(row.missing) + ':'))
            throw UsageError("--require: `" + text + "`: it belongs to the extension " +
                             std::string(row.extension) + ", which this build lacks");
    return std::any_of(members_.begin(), members_.end(), [&text](const Member& member) {
        return member.group->takesRequirement(text);
    });
}

std::vector<std::string> CoverageExtensions::recordedSite() const {
    for (const Member& member : members_)
        if (std::vector<std::string> operands = member.group->recordedSite(); !operands.empty())
            return operands;
    return {};
}

void CoverageExtensions::fit(const SiteInput& input) const {
    for (const Member& member : members_)
        if (member.group->isAsked()) member.group->fit(input);
}

void CoverageExtensions::measure(const MeasuredSite& site, CoverageFindings& findings,
                                 bool searches) const {
    for (const Member& member : members_)
        if (member.group->isAsked() && member.group->searches() == searches)
            member.group->measure(site, findings);
}

}  // namespace ispace
