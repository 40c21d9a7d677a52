// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"

#include <memory>
#include <string>
#include <vector>

#include "base/file.h"
#include "cli/import_group.h"
#include "extensions/gazebo/gazebo.h"
#include "extensions/gazebo/model_path.h"
#include "io/importers.h"

namespace ispace::extension {

namespace {

class ModelOptions final : public ImportGroup {
    void declare(CommandLine& line, ImportOptions& import) override {
        line.group("Gazebo worlds");
        line.texts("--models", "DIR", import.own.edit<gazebo::ModelFolders>().folders,
                   "folder with models that an SDF world names (besides its own, ../models, and "
                   "those of GAZEBO_MODEL_PATH, GZ_SIM_RESOURCE_PATH and SDF_PATH)",
                   Enters::Nothing);
    }
    [[nodiscard]] std::string repeated(const ImportOptions& import) const override {
        std::string words;
        for (const std::string& folder : import.own.get<gazebo::ModelFolders>().folders)
            words += " --models " + shellQuote(folder);
        return words;
    }
};

std::vector<std::string> searchedFolders() {
    std::vector<std::string> texts = gazebo::modelPath();
    for (std::string& folder : texts) folder.insert(0, "models in ");
    return texts;
}

}  // namespace

Extension gazebo() {
    return {.name = "gazebo",
            .add =
                [] {
                    addImporters(gazebo::gazeboImporters());
                    addImportSurroundings(searchedFolders);
                },
            .import = []() -> std::unique_ptr<ImportGroup> {
                return std::make_unique<ModelOptions>();
            }};
}

}  // namespace ispace::extension
