// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/heads/head.h"
#include "extensions/heads/head_role.h"
#include "scene/placement_schemas.h"

namespace ispace::extension {

Extension heads() {
    return {.name = "heads",
            .add =
                [] {
                    addSceneSchemas(heads::headSchemas());
                    heads::addHeads();
                },
            .role = heads::makeHeads};
}

}  // namespace ispace::extension
