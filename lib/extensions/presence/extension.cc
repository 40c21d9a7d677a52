// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/presence/presence_options.h"

namespace ispace::extension {

Extension presence() {
    return {.name = "presence",
            .objectives = {presence::makePresenceObjective},
            .coverage = presence::makePresence};
}

}  // namespace ispace::extension
