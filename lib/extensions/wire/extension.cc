// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/wire/wire_options.h"

namespace ispace::extension {

Extension wire() { return {.name = "wire", .bridge = wire::makeWireOptions}; }

}  // namespace ispace::extension
