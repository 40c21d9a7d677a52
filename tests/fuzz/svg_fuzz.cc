// SPDX-License-Identifier: GPL-3.0-or-later
// Drawings in SVG; walls and doors by group.
#include "fuzz.h"
#include "io/importers.h"
#include "layout/schemas.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace ispace;
    return fuzz::guarded(data, size, [](std::string_view bytes) {
        ImportOptions options;
        options.units = "m";
        options.door_layers = {"D*"};
        options.max_points = 2000;
        const Document document = readSvg(bytes, "plan.svg", options, sceneSchemas());
        fuzz::checkText(document);
        fuzz::tryScene(document, bytes);
    });
}
