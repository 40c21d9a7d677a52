// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/arrange_group.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "site/arranged_site.h"

namespace ispace {

std::shared_ptr<const ArrangeSite> searchedSite(const SiteInput& input, const ArrangeOptions& how,
                                                std::vector<RoomGoals> goals) {
    if (!input.isOneRoom()) {
        const auto building =
            std::make_shared<const BuildingSite>(input.building, how, std::move(goals));
        return {building, &building->site()};
    }
    ArrangeSite site;
    site.rooms.push_back({"", input.rooms().front(), goals.empty() ? RoomGoals() : goals.front()});
    return std::make_shared<const ArrangeSite>(std::move(site));
}

ArrangeExtensions::ArrangeExtensions(std::span<const ArrangeRow> rows) {
    members_.reserve(rows.size());
    for (const ArrangeRow& row : rows) members_.push_back({std::string(row.extension), row.make()});
}

void ArrangeExtensions::declare(CommandLine& line, ArrangeGroup::Place place) {
    for (const Member& member : members_) {
        if (member.group->place() != place) continue;
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

void ArrangeExtensions::aim(const ArrangeInput& input, ArrangeOptions& how,
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
