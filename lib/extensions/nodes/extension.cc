// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/nodes/node_record.h"
#include "extensions/nodes/nodes.h"
#include "scene/placement_schemas.h"

namespace ispace::extension {

Extension nodes() {
    return {.name = "nodes",
            .add = [] { addSceneSchemas(nodes::nodeSchemas()); },
            .role = nodes::makeNodes};
}

}  // namespace ispace::extension
