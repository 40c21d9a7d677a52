// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/record_group.h"

#include <algorithm>
#include <cstddef>

namespace ispace {

RecordExtensions::RecordExtensions(std::span<const RecordRow> rows) : rows_(rows) {
    groups_.reserve(rows.size());
    for (const RecordRow& row : rows) groups_.push_back(row.make());
}

void RecordExtensions::declare(CommandLine& line) const {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        line.extension(std::string(rows_[i].extension));
        groups_[i]->declare(line);
    }
    line.extension("");
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

void RecordExtensions::report(const RecordedRun& run, SiteParts& parts) const {
    for (const auto& group : groups_) group->report(run, parts);
}

}  // namespace ispace
