// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/cad/cad.h"

#include "io/mesh_files.h"

namespace ispace::cad {

namespace {

/// Returns true for JSON with outlines; glTF may have such a word, too.
bool isHouseExpo(const ImportSource& source) {
    return isJson(source.bytes) && source.bytes.find("\"verts\"") != std::string_view::npos &&
           fileSuffix(source.operand) != ".gltf";
}

bool isGallery(const ImportSource& source) {
    return isGalleryFile(source.bytes, fileSuffix(source.operand) == ".pol");
}

}  // namespace

std::span<const Importer> cadImporters() {
    static constexpr Importer kRows[] = {
        importer<isDxf, readDxf>("DXF"),
        {"an art gallery", false, isGallery,
         [](const ImportSource& source) {
             return readGalleryFile(source.bytes, source.operand, source.options, source.schemas);
         }},
        importer<isSvg, readSvg>("SVG"),
        {"HouseExpo JSON", true, isHouseExpo,
         [](const ImportSource& source) {
             return readHouseExpo(source.bytes, source.operand, source.options, source.schemas);
         }},
    };
    return kRows;
}

}  // namespace ispace::cad
