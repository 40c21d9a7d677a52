// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/report_group.h"

#include <algorithm>

#include "cli/common_options.h"
#include "cli/group_members.h"

namespace ispace {

ReportExtensions::ReportExtensions(std::span<const ReportRow> rows) {
    makeMembers(rows, members_, missing_);
}

void ReportExtensions::declare(CommandLine& line) { options_ = declareMembers(members_, line); }

void ReportExtensions::take(const std::string& report) const {
    if (!report.empty()) {
        std::vector<std::string> formats = {"json"};
        for (const Member& member : members_)
            for (const std::string_view format : member.group->formats())
                formats.emplace_back(format);
        for (const ReportRow& row : missing_) formats.emplace_back(row.missing);
        static_cast<void>(outputFormat({}, report, formats));  // rejects another suffix
        const std::string suffix = suffixOf(report);
        for (const ReportRow& row : missing_)
            if (row.missing == suffix || (suffix.empty() && members_.empty()))
                throw UsageError(report + ": `." + std::string(row.missing) +
                                 "` belongs to the extension " + std::string(row.extension) +
                                 ", which this build lacks");
    }
    for (const Member& member : members_) member.group->take(report);
}

std::vector<ReportGroup::SideFile> ReportExtensions::files() const {
    std::vector<ReportGroup::SideFile> files;
    for (const Member& member : members_)
        for (const ReportGroup::SideFile& file : member.group->files()) files.push_back(file);
    return files;
}

bool ReportExtensions::isAsked() const {
    return std::any_of(members_.begin(), members_.end(),
                       [](const Member& member) { return member.group->isAsked(); });
}

std::vector<std::string> ReportExtensions::writeFiles(
    std::span<const std::shared_ptr<const Scene>> scenes) const {
    std::vector<std::string> warnings;
    for (const Member& member : members_)
        if (member.group->isAsked())
            if (std::string warning = member.group->writeFiles(scenes); !warning.empty())
                warnings.push_back(std::move(warning));
    return warnings;
}

const ReportGroup* ReportExtensions::of(const std::string& report) const {
    if (report.empty()) return nullptr;
    const std::string suffix = suffixOf(report);
    if (suffix.empty() && !members_.empty()) return members_.front().group.get();
    for (const Member& member : members_) {
        const auto formats = member.group->formats();
        if (std::find(formats.begin(), formats.end(), suffix) != formats.end())
            return member.group.get();
    }
    return nullptr;
}

}  // namespace ispace
