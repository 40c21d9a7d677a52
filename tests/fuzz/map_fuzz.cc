// SPDX-License-Identifier: GPL-3.0-or-later
// ROS maps: a picture alone, or map.yaml, a line `---` and the picture that it names.
#include "fuzz.h"
#include "io/importers.h"
#include "layout/schemas.h"
#include "raster/picture.h"

namespace {

constexpr std::string_view kSeparator = "\n---\n";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace ispace;
    return fuzz::guarded(data, size, [](std::string_view bytes) {
        const std::size_t end = bytes.find(kSeparator);
        if (end == std::string_view::npos) {
            (void)parsePicture(bytes, "map.pgm");
            return;
        }
        // The first key of this name counts: no other file is opened.
        const std::string yaml = "image: map.pgm\n" + std::string(bytes.substr(0, end));
        static const std::string picture = fuzz::scratchFolder() + "/map.pgm";
        fuzz::writeFile(picture, bytes.substr(end + kSeparator.size()));
        const Document document =
            readRosMap(yaml, fuzz::scratchFolder() + "/map.yaml", ImportOptions(), sceneSchemas());
        fuzz::checkText(document);
        fuzz::tryScene(document, bytes);
    });
}
