// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/import_group.h"

#include <cstddef>

namespace ispace {

ImportExtensions::ImportExtensions(std::span<const ImportRow> rows) : rows_(rows) {
    groups_.reserve(rows.size());
    for (const ImportRow& row : rows) groups_.push_back(row.make());
}

void ImportExtensions::declare(CommandLine& line, ImportOptions& import) const {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        line.extension(std::string(rows_[i].extension));
        groups_[i]->declare(line, import);
    }
    line.extension("");
}

std::string ImportExtensions::repeated(const ImportOptions& import) const {
    std::string words;
    for (const auto& group : groups_) words += group->repeated(import);
    return words;
}

}  // namespace ispace
