// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/record_group.h"

#include <algorithm>

namespace ispace {

RecordExtensions::RecordExtensions(std::span<const MakeRecordGroup> rows) {
    groups_.reserve(rows.size());
    for (const MakeRecordGroup make : rows) groups_.push_back(make());
}

void RecordExtensions::declare(CommandLine& line) const {
    for (const auto& group : groups_) group->declare(line);
}

void RecordExtensions::take(const CommandLine& line) const {
    for (const auto& group : groups_) group->take(line);
}

bool RecordExtensions::isAsked() const {
    return std::any_of(groups_.begin(), groups_.end(),
                       [](const auto& group) { return group->isAsked(); });
}

void RecordExtensions::conclude(const RecordedRun& run) const {
    for (const auto& group : groups_)
        if (group->isAsked()) group->conclude(run);
}

}  // namespace ispace
