// SPDX-License-Identifier: GPL-3.0-or-later
// .env and .3dm.
#include "fuzz.h"
#include "layout/schemas.h"
#include "record/text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace ispace;
    return fuzz::guarded(data, size, [](std::string_view bytes) {
        const Document document = readRecordText(bytes, "room.env", sceneSchemas());
        fuzz::checkText(document);
        fuzz::tryScene(document, bytes);
    });
}
