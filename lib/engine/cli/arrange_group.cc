// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/arrange_group.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace ispace {

ArrangeExtensions::ArrangeExtensions(std::span<const ArrangeRow> rows) {
    members_.reserve(rows.size());
    for (const ArrangeRow& row : rows) members_.push_back({std::string(row.extension), row.make()});
}

void ArrangeExtensions::declare(CommandLine& line) {
    for (const Member& member : members_) {
        line.extension(member.extension);
        member.group->declare(line);
    }
    line.extension("");
}

void ArrangeExtensions::take(const CommandLine& line, const ArrangeOptions& how) const {
    for (const Member& member : members_) member.group->take(line, how);
}

bool ArrangeExtensions::isAsked() const {
    return std::any_of(members_.begin(), members_.end(),
                       [](const Member& member) { return member.group->isAsked(); });
}

std::vector<std::string_view> ArrangeExtensions::ofFloor() const {
    std::vector<std::string_view> all;
    for (const Member& member : members_) {
        const std::vector<std::string_view> own = member.group->ofFloor();
        all.insert(all.end(), own.begin(), own.end());
    }
    return all;
}

std::vector<std::string> ArrangeExtensions::notes(const ArrangeOptions& how) const {
    std::vector<std::string> all;
    for (const Member& member : members_) {
        if (!member.group->isAsked()) continue;
        std::vector<std::string> own = member.group->notes(how);
        std::move(own.begin(), own.end(), std::back_inserter(all));
    }
    return all;
}

void ArrangeExtensions::aim(const SiteInput& input, ArrangeOptions& how,
                            std::span<RoomGoals> goals) const {
    for (const Member& member : members_)
        if (member.group->isAsked()) member.group->aim(input, how, goals);
}

ArrangeFindings ArrangeExtensions::judge(const ArrangedSite& site) const {
    ArrangeFindings findings;
    for (const Member& member : members_)
        if (member.group->isAsked()) member.group->judge(site, findings);
    return findings;
}

}  // namespace ispace
