// SPDX-License-Identifier: GPL-3.0-or-later
// .env and .3dm.
#include "fuzz.h"
#include "record/text.h"
#include "scene/placement_schemas.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    const Document document = readRecordText(bytes, "room.env", sceneSchemas());
    checkText(document);
    tryScene(document, bytes);
}
