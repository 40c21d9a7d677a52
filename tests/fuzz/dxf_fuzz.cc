// SPDX-License-Identifier: GPL-3.0-or-later
// Drawings in ASCII DXF; walls, doors and windows by layer, as most plans have them.
#include "fuzz.h"
#include "io/importers.h"
#include "layout/schemas.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace ispace;
    return fuzz::guarded(data, size, [](std::string_view bytes) {
        ImportOptions options;
        options.units = "m";
        options.door_layers = {"D*"};
        options.window_layers = {"*WIN*"};
        // Small drawings do not make more, but for blocks in blocks: those cost time, not care.
        options.max_points = 2000;
        const Document document = readDxf(bytes, "plan.dxf", options, sceneSchemas());
        fuzz::checkText(document);
        fuzz::tryScene(document, bytes);
    });
}
