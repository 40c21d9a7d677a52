// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of lib/kernel/scene and the libraries above it: scenes from text.
#pragma once

#include <string>

#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "support/test_paths.h"
#include "support/test_sensors.h"

namespace ispace::testing {

/// Returns the devices that come with the project.
inline const DeviceCatalogue& devices() {
    static const DeviceCatalogue catalogue = loadDevices(sourcePath("share/devices"));
    return catalogue;
}

/// Line 1 is the magic line, so the first of `lines` is line 2.
inline Document roomDocument(const std::string& lines) {
    return readRecordText("#env 1\n" + lines, "room.env", sceneSchemas());
}

inline Document layoutDocument(const std::string& lines) {
    return readRecordText("#3dm 1\n" + lines, "room.3dm", sceneSchemas());
}

inline Scene scene(const std::string& lines) {
    return makeScene(roomDocument(lines), nullptr, devices());
}

inline Scene scene(const std::string& room, const std::string& layout) {
    const Document document = layoutDocument(layout);
    return makeScene(roomDocument(room), &document, devices());
}

}  // namespace ispace::testing
