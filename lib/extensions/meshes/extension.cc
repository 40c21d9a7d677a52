// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"

#include <memory>

#include "cli/import_group.h"
#include "extensions/meshes/meshes.h"

namespace ispace::extension {

namespace {

class UpOption final : public ImportGroup {
    void declare(CommandLine& line, ImportOptions& import) override {
        line.group("Meshes and clouds");
        line.choice("--up", import.own.edit<meshes::UpAxis>().name, {"auto", "x", "y", "z"},
                    "upward axis of a mesh or a cloud", Enters::History);
        line.essential({"--up"});
    }
};

}  // namespace

Extension meshes() {
    return {
        .name = "meshes", .add = meshes::addMeshes, .import = []() -> std::unique_ptr<ImportGroup> {
            return std::make_unique<UpOption>();
        }};
}

}  // namespace ispace::extension
