// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/memory/memory.h"
#include "extensions/memory/volume.h"
#include "scene/placement_schemas.h"

namespace ispace::extension {

Extension memory() {
    return {.name = "memory",
            .add = [] { addSceneSchemas(memory::volumeSchemas()); },
            .role = memory::makeMemory};
}

}  // namespace ispace::extension
