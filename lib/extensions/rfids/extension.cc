// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/rfids/rfid.h"

namespace ispace::extension {

Extension rfids() { return {.name = "rfids", .add = rfids::addRfids}; }

}  // namespace ispace::extension
