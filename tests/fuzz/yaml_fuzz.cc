// SPDX-License-Identifier: GPL-3.0-or-later
// The YAML form of records, in a folder with two files that include each other.
#include "fuzz.h"
#include "record/yaml/yaml.h"
#include "scene/placement_schemas.h"

namespace {

const std::string& operand() {
    static const std::string name = [] {
        const std::string& folder = ispace::fuzz::scratchFolder();
        ispace::fuzz::writeFile(folder + "/a.yaml",
                                "- parts: {p: [desk: {id: d}, chair: {at: [0, 1]}]}\n"
                                "- include: c.env\n");
        ispace::fuzz::writeFile(folder + "/b.yaml", "- include: [a.yaml, b.yaml]\n");
        ispace::fuzz::writeFile(folder + "/c.env", "#env 1\nfence path=0,0;4,0;4,3 closed=yes\n");
        return folder + "/room.yaml";
    }();
    return name;
}

/// It must not read files of the machine: paths out of the folder need one of these.
bool mayLeaveFolder(std::string_view bytes) {
    return bytes.find("clude") != std::string_view::npos &&
           bytes.find_first_of("/\\") != std::string_view::npos;
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    if (mayLeaveFolder(bytes)) return;
    const Document document = readYaml(bytes, operand(), sceneSchemas());
    checkText(document);
    const std::string yaml = writeYaml(document);
    const Document again = readYaml(yaml, "again.yaml", sceneSchemas());
    require(again.records == document.records, "other records as YAML");
    require(again.kind == document.kind, "another kind as YAML");
    require(writeYaml(again) == yaml, "another text as YAML");
    tryScene(document, bytes);
}
