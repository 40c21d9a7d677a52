// SPDX-License-Identifier: GPL-3.0-or-later
// Buildings: records and YAML of storeys, and sites of Open-RMF.
#include "fuzz.h"
#include "site/site_scene.h"
#include "site/storeys.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    // It must not read files of the machine: paths out of the folder need one of these.
    if (bytes.find_first_of("/\\") != std::string_view::npos || !isBuilding(bytes)) return;
    static const std::string operand = scratchFolder() + "/house.yaml";
    ImportOptions options;
    options.load_files = false;
    const StoreyedDocument building = readBuilding(bytes, operand, options);
    const std::string yaml = writeBuildingYaml(building);
    const StoreyedDocument again = readBuilding(yaml, operand, options);
    require(again.digest() == building.digest(), "another digest as YAML");
    require(writeBuildingYaml(again) == yaml, "another text as YAML");
    static_cast<void>(checkBuilding(makeSiteScene(building, {}, {})));
}
