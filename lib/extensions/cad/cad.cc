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

}  // namespace

std::span<const Importer> cadImporters() {
    static constexpr Importer kRows[] = {
        importer<isDxf, readDxf>("DXF"),
        importer<isGalleryFile, readGalleryFile>("an art gallery", false),
        importer<isSvg, readSvg>("SVG"),
        {"HouseExpo JSON", true, isHouseExpo,
         [](const ImportSource& source) {
             return readHouseExpo(source.bytes, source.operand, source.options, source.schemas);
         }},
    };
    return kRows;
}

}  // namespace ispace::cad
