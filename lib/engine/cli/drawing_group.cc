// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/drawing_group.h"

#include <cstddef>

#include "base/error.h"

namespace ispace {

DrawingExtensions::DrawingExtensions(std::span<const DrawingRow> rows) {
    for (const DrawingRow& row : rows) {
        if (group_ != nullptr) continue;
        extension_ = row.extension;
        if (row.make != nullptr) group_ = row.make();
    }
}

void DrawingExtensions::declare(CommandLine& line) {
    if (group_ == nullptr) return;
    const auto before = static_cast<std::ptrdiff_t>(line.names().size());
    line.extension(extension_);
    group_->declare(line);
    line.extension("");
    const std::vector<std::string> names = line.names();
    options_.assign(names.begin() + before, names.end());
}

std::shared_ptr<const DrawingGroup> DrawingExtensions::take(const CommandLine& line,
                                                            const std::string& output) const {
    if (group_ == nullptr)
        throw UsageError("-o: a picture of a record belongs to the extension " + extension_ +
                         ", which this build lacks");
    group_->take(line, output);
    return group_;
}

}  // namespace ispace
