// SPDX-License-Identifier: GPL-3.0-or-later
// Binary glTF: whole files, or JSON, a line `---` and data, around which the container is put here,
// so that not every change of a length ends at the container.
#include <array>

#include "fuzz.h"
#include "io/glb.h"
#include "layout/schemas.h"
#include "model/glb_file.h"

namespace {

constexpr std::string_view kSeparator = "\n---\n";

std::string fileOf(std::string_view bytes) {
    if (ispace::isGlb(bytes)) return std::string(bytes);
    const std::size_t end = std::min(bytes.find(kSeparator), bytes.size());
    const std::array data{bytes.substr(std::min(end + kSeparator.size(), bytes.size()))};
    return ispace::glbContainer(bytes.substr(0, end), data);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace ispace;
    return fuzz::guarded(data, size, [](std::string_view bytes) {
        const std::string file = fileOf(bytes);
        const bool has_records = glbHasRecords(file);
        const Document document = readGlb(file, "room.glb", sceneSchemas());
        fuzz::require(has_records, "records where none should be");
        fuzz::checkText(document);
        fuzz::tryScene(document, bytes);
        fuzz::tryDerived(document);
    });
}
