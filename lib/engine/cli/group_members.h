// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/cli: the groups that extensions add to one command line, made from the rows
// of a build and declared in their order.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "cli/command_line.h"

namespace ispace {

/// Makes the groups of rows; those without a maker are of extensions that this build lacks.
template <typename Row, typename Member>
void makeMembers(std::span<const Row> rows, std::vector<Member>& members,
                 std::vector<Row>& missing) {
    members.reserve(rows.size());
    for (const Row& row : rows) {
        if (row.make == nullptr)
            missing.push_back(row);
        else
            members.push_back({std::string(row.extension), row.make()});
    }
}

/// Declares the options of all groups. Returns their names ("--title").
template <typename Member>
std::vector<std::string> declareMembers(const std::vector<Member>& members, CommandLine& line) {
    const auto before = static_cast<std::ptrdiff_t>(line.names().size());
    for (const Member& member : members) {
        line.extension(member.extension);
        member.group->declare(line);
    }
    line.extension("");
    const std::vector<std::string> names = line.names();
    return {names.begin() + before, names.end()};
}

}  // namespace ispace
