// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"

#include <memory>

#include "cli/import_group.h"
#include "extensions/maps/maps.h"
#include "io/importers.h"

namespace ispace::extension {

namespace {

class AriaOptions final : public ImportGroup {
    void declare(CommandLine& line, ImportOptions& import) override {
        line.group("ARIA maps");
        line.flag("--points", import.own.edit<maps::AriaPoints>().are_obstacles,
                  "turn points of an ARIA map into obstacles", Enters::History);
    }
};

}  // namespace

Extension maps() {
    return {
        .name = "maps",
        .add = [] { addImporters(maps::mapImporters()); },
        .import = []() -> std::unique_ptr<ImportGroup> { return std::make_unique<AriaOptions>(); }};
}

}  // namespace ispace::extension
