// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/objective_extension.h"

#include <cstddef>

#include "base/error.h"

namespace ispace {

ObjectiveExtensions::ObjectiveExtensions(std::span<const ObjectiveRow> rows) {
    members_.reserve(rows.size());
    for (const ObjectiveRow& row : rows) {
        if (row.make == nullptr)
            missing_.push_back(row);
        else
            members_.push_back({std::string(row.extension), row.make()});
    }
}

std::string ObjectiveExtensions::help() const {
    std::string text;
    for (const Member& member : members_)
        text.append("; ").append(member.group->word()).append(", ").append(member.group->help());
    return text;
}

std::string ObjectiveExtensions::words() const {
    std::string text;
    for (const Member& member : members_) text.append(", ").append(member.group->word());
    return text;
}

void ObjectiveExtensions::declare(CommandLine& line) {
    for (Member& member : members_) {
        const std::size_t before = line.names().size();
        line.extension(member.extension);
        member.group->declare(line);
        line.extension("");
        const std::vector<std::string> names = line.names();
        member.options.assign(names.begin() + static_cast<std::ptrdiff_t>(before), names.end());
    }
}

std::shared_ptr<const ObjectiveGroup> ObjectiveExtensions::find(std::string_view word) const {
    for (const Member& member : members_)
        if (member.group->word() == word) return member.group;
    for (const ObjectiveRow& row : missing_)
        if (row.missing == word)
            throw UsageError('`' + std::string(word) + "`: it belongs to the extension " +
                             std::string(row.extension) + ", which this build lacks");
    return nullptr;
}

void ObjectiveExtensions::check(const CommandLine& line, const ObjectiveGroup* asked) const {
    for (const Member& member : members_)
        for (const std::string& name : member.options)
            if (member.group.get() != asked && line.given(name))
                throw UsageError(name + " goes with --objective " +
                                 std::string(member.group->word()));
}

}  // namespace ispace
