// SPDX-License-Identifier: GPL-3.0-or-later
// Binary glTF: whole files, or JSON, a line `---` and data, around which the container is put here,
// so that not every change of a length ends at the container.
#include <array>

#include "fuzz.h"
#include "io/glb/glb_file.h"
#include "io/glb/glb_read.h"
#include "scene/placement_schemas.h"

namespace {

std::string fileOf(std::string_view bytes) {
    if (ispace::isGlb(bytes)) return std::string(bytes);
    const std::string_view json = ispace::fuzz::filesOf(bytes).front();
    bytes.remove_prefix(std::min(json.size() + ispace::fuzz::kSeparator.size(), bytes.size()));
    return ispace::glbContainer(json, std::array{bytes});
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    const std::string file = fileOf(bytes);
    const bool has_records = glbHasRecords(file);
    const Document document = readGlb(file, "room.glb", sceneSchemas());
    require(has_records, "records where none should be");
    checkText(document);
    tryScene(document, bytes);
}
