// SPDX-License-Identifier: GPL-3.0-or-later
// One extension does the task that its options ask for; two that are asked are an error, and so is
// an option of a group that is not asked. Options of a tool that the task does not honour are
// refused, instead of ignored.
#include "cli/option_group.h"

#include <algorithm>
#include <utility>

#include "base/error.h"

namespace ispace {

namespace {

bool contains(std::span<const std::string> names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Returns the names of the options that every task obeys.
std::vector<std::string> commonNames() {
    CommandLine line("", "", "");
    CommonOptions common;
    SceneRules rules;
    addCommonOptions(line, common, "product");
    addSceneRules(line, rules);
    addStoreyOption(line, rules, "");
    return line.names();
}

}  // namespace

ToolExtensions::ToolExtensions(std::span<const ToolExtension> rows, std::string_view tool) {
    for (const ToolExtension& row : rows) {
        if (row.tool != tool) continue;
        if (row.make == nullptr)
            missing_.push_back(row);
        else
            members_.push_back({std::string(row.extension), row.make()});
    }
}

void ToolExtensions::declare(CommandLine& line) {
    for (Member& member : members_) {
        const std::size_t before = line.names().size();
        line.extension(member.extension);
        member.group->declare(line);
        line.extension("");
        const std::vector<std::string> names = line.names();
        member.options.assign(names.begin() + static_cast<std::ptrdiff_t>(before), names.end());
    }
    for (const ToolExtension& row : missing_)
        line.renamed(std::string(row.missing), "it belongs to the extension " +
                                                   std::string(row.extension) +
                                                   ", which this build lacks");
}

ExtensionTask ToolExtensions::task(const CommandLine& line, TaskInput input) const {
    const Member* asked = nullptr;
    for (const Member& member : members_) {
        if (!member.group->isAsked()) continue;
        if (asked != nullptr)
            throw UsageError(asked->options.front() + " and " + member.options.front() +
                             " are two tasks: give one of them");
        asked = &member;
    }
    for (const Member& member : members_)
        for (const std::string& name : member.options)
            if (&member != asked && line.given(name))
                throw UsageError(name + " goes with " + member.options.front() +
                                 ": give that, too");
    if (asked == nullptr) return {};
    const std::span<const std::string_view> honoured = asked->group->honours();
    const std::vector<std::string> common = commonNames();
    for (const std::string& name : line.names())
        if (line.given(name) && !contains(asked->options, name) && !contains(common, name) &&
            std::find(honoured.begin(), honoured.end(), name) == honoured.end())
            throw UsageError(name + " does not go with " + asked->options.front() +
                             ": leave it out");
    asked->group->take(line);
    input.history_line = line.historyLine(input.operands);
    return [group = asked->group, input = std::move(input)] { group->run(input); };
}

}  // namespace ispace
